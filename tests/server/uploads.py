"""Files that are no good, for tests of what takes uploads."""

import struct
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]

MAGIC = b"\x89MCAP0\r\n"
_BLOCK = 128 * 1024


def bomb(size: int) -> bytes:
    """Return a zstd frame that inflates to at least so many zeros: blocks of one byte repeated (RFC 8878)."""
    blocks = -(-size // _BLOCK)
    block = struct.pack("<I", 1 << 1 | _BLOCK << 3)[:3] + b"\0"
    last = struct.pack("<I", 1 | 1 << 1 | _BLOCK << 3)[:3] + b"\0"
    # no content size, no checksum, a window of 128 KiB
    return b"\x28\xb5\x2f\xfd" + b"\x00\x38" + block * (blocks - 1) + last


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
