"""What is left of the last chunk of a file that was cut off: its messages up to where it breaks."""

import struct
from collections.abc import Iterator
from io import BytesIO
from typing import BinaryIO

import lz4.frame  # type: ignore[import-untyped]
import zstandard
from mcap.opcode import Opcode
from mcap.records import McapRecord
from mcap.stream_reader import StreamReader

#: Opcode and length of a record; then of a chunk its first and last arrival, uncompressed size and checksum.
_RECORD, _CHUNK = struct.Struct("<BQ"), struct.Struct("<QQQI")
#: A cut chunk larger than this is damage, not a recording.
_LARGEST = 1 << 28


def cut_chunk(file: BinaryIO, offset: int) -> Iterator[McapRecord]:
    """Yield the whole records of the chunk that begins at an offset and does not end; none where there is no such chunk."""
    file.seek(offset)
    data = file.read(_LARGEST)
    try:
        opcode, _ = _RECORD.unpack_from(data)
        if opcode != Opcode.CHUNK:
            return
        at = _RECORD.size + _CHUNK.size
        (length,) = struct.unpack_from("<I", data, at)
        compression = data[at + 4 : at + 4 + length].decode("ascii")
        content = _uncompressed(compression, data[at + 4 + length + 8 :])
        yield from StreamReader(BytesIO(content), skip_magic=True).records
    except Exception:  # the break itself: what the cut bytes make struct, zstd, lz4 and mcap raise
        return


def _uncompressed(compression: str, data: bytes) -> bytes:
    """Return as much as can be had of a stream whose end is missing."""
    if compression == "zstd":
        return zstandard.ZstdDecompressor().decompressobj().decompress(data)
    if compression == "lz4":
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data))
    return data
