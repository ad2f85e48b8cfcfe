"""The chunks of an MCAP file inflated piece by piece, so that one which lies about its size is found out before it is believed."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import IO, BinaryIO, Final, cast

import lz4.frame  # type: ignore[import-untyped]
import zstandard

from server.errors import LogRefused

#: The largest chunk that a walk may have, inflated: recorders write 1 to 64 MiB.
LARGEST_BYTES: Final = 256 * 2**20
_MAGIC: Final = b"\x89MCAP0\r\n"
_RECORD: Final = struct.Struct("<BQ")
#: Start and end, inflated size, checksum, length of the name of the compression.
_CHUNK: Final = struct.Struct("<QQQII")
_CHUNK_OPCODE: Final = 6
_PIECE: Final = 1 << 20
_LONGEST_NAME: Final = 32


def check_chunks(path: Path, largest_bytes: int = LARGEST_BYTES) -> None:
    """Return where every chunk is as large as it says, and that is not too much.

    A file that was cut off passes up to there, and bytes that do not inflate at all pass too: reading a walk leaves them out.

    Raises:
        LogRefused: 415 where it is no MCAP, 413 where a chunk is too large, 422 where one is larger than it says.
    """
    with path.open("rb") as file:
        if file.read(len(_MAGIC)) != _MAGIC:
            raise LogRefused(415, "This is not an MCAP file: send a walk that was recorded as a ROS 2 bag in MCAP.")
        for number, (declared, compression, data_bytes) in enumerate(_chunks(file)):
            where = f"Chunk {number}"
            if declared > largest_bytes:
                raise LogRefused(413, f"{where} inflates to {declared} bytes, of at most {largest_bytes}.")
            size = 0
            for piece in _inflated(file, compression, data_bytes):
                size += piece
                if size > declared:
                    raise LogRefused(422, f"{where} is larger than the {declared} bytes that it says.")


def _chunks(file: BinaryIO) -> Iterator[tuple[int, str, int]]:
    """Yield each chunk's inflated size as declared, compression and size, the file at its first byte; go on behind it."""
    while len(head := file.read(_RECORD.size)) == _RECORD.size:
        opcode, length = _RECORD.unpack(head)
        begin = file.tell()
        if opcode == _CHUNK_OPCODE and length >= _CHUNK.size + 8:
            fields = file.read(_CHUNK.size)
            if len(fields) < _CHUNK.size:
                return
            _, _, declared, _, name_bytes = _CHUNK.unpack(fields)
            if name_bytes > _LONGEST_NAME:
                raise LogRefused(422, "A chunk names a compression that there is none of.")
            name, size = file.read(name_bytes), file.read(8)
            if len(size) < 8:
                return
            inside = length - _CHUNK.size - name_bytes - 8
            yield declared, name.decode(errors="replace"), min(max(inside, 0), int.from_bytes(size, "little"))
        if length >= 2**62:
            return
        file.seek(begin + length)


def _inflated(file: BinaryIO, compression: str, left: int) -> Iterator[int]:
    """Yield the sizes of a chunk's pieces as they inflate, never much more than one piece in memory."""
    if compression == "":
        yield left
    elif compression == "zstd":
        reader = zstandard.ZstdDecompressor().stream_reader(
            cast(IO[bytes], _Window(file, left)), read_across_frames=False
        )
        try:
            while piece := reader.read(_PIECE):
                yield len(piece)
        except zstandard.ZstdError:
            return
    elif compression == "lz4":
        inflater = lz4.frame.LZ4FrameDecompressor()
        source = _Window(file, left)
        try:
            while not inflater.eof:
                data = source.read(_PIECE) if inflater.needs_input else b""
                if inflater.needs_input and not data:
                    return
                yield len(inflater.decompress(data, _PIECE))
        except RuntimeError:
            return
    else:
        raise LogRefused(422, f"A chunk is compressed by {compression!r}: zstd, lz4 or nothing is read.")


class _Window:
    """So many bytes of a file and no more."""

    def __init__(self, file: BinaryIO, left: int) -> None:
        self._file, self._left = file, left

    def read(self, size: int = -1) -> bytes:
        """Return the next bytes."""
        data = self._file.read(self._left if size < 0 else min(size, self._left))
        self._left -= len(data)
        return data
