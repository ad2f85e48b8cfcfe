"""Files that are no good, for tests of what takes uploads."""

import struct
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]
import zstandard

MAGIC = b"\x89MCAP0\r\n"
GIB = 2**30


def bomb(size: int) -> bytes:
    """Return a zstd frame of a few kilobytes that inflates to so many zeros and says nothing of it."""
    compressor = zstandard.ZstdCompressor(level=19).compressobj()
    piece = bytes(min(size, 16 * 2**20))
    return b"".join([compressor.compress(piece) for _ in range(size // len(piece))] + [compressor.flush()])


def with_chunk(path: Path, data: bytes, declared: int, compression: str = "zstd") -> Path:
    """Write an MCAP of one chunk that says of itself what it is told to."""
    name = compression.encode()
    body = struct.pack("<QQQII", 0, 1, declared, 0, len(name)) + name + struct.pack("<Q", len(data)) + data
    header = struct.pack("<I", 4) + b"ros2" + struct.pack("<I", 0)
    path.write_bytes(MAGIC + _record(1, header) + _record(6, body) + _record(15, bytes(20)) + MAGIC)
    return path


def lz4_bomb(size: int) -> bytes:
    """Return an lz4 frame that inflates to so many zeros."""
    return bytes(lz4.frame.compress(bytes(size), store_size=False))


def _record(opcode: int, body: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(body)) + body
