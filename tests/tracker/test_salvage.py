"""A cut file, to the last message before the cut, however it was compressed."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType, Writer

from tracker.container import Container, Stored

COUNT = 4000


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.LZ4, CompressionType.NONE])
@pytest.mark.parametrize("share", [0.4, 0.8])
def test_messages_up_to_the_cut(tmp_path: Path, compression: CompressionType, share: float) -> None:
    """All in one chunk, which the cut leaves without an end: what comes back is a beginning, unharmed and about as long."""
    whole, cut = tmp_path / "whole.mcap", tmp_path / "cut.mcap"
    rng = np.random.default_rng(1)
    payloads = [bytes(rng.integers(0, 64, 200, np.uint8)) for _ in range(COUNT)]
    with whole.open("wb") as file:
        writer: Any = Writer(file, chunk_size=1 << 24, compression=compression)
        writer.start()
        schema = writer.register_schema("test/msg/Bytes", "ros2msg", b"uint8[] data")
        channel = writer.register_channel("/bytes", "cdr", schema)
        for number, payload in enumerate(payloads):
            writer.add_message(channel, log_time=number, data=payload, publish_time=number)
        writer.finish()
    cut.write_bytes(whole.read_bytes()[: round(whole.stat().st_size * share)])
    seen: list[Stored] = []
    container = Container(cut, seen.append)
    assert container.truncated
    assert [stored.data for stored in seen] == payloads[: len(seen)]
    assert len(seen) > (share - 0.25) * COUNT
    assert list(container.messages()) == seen
    assert list(container.messages(start_ns=100)) == seen[100:]


def test_damage_in_the_first_chunk_costs_that_chunk(tmp_path: Path) -> None:
    """The channels are told there, and once more at the end of the file."""
    path = tmp_path / "walk.mcap"
    with path.open("wb") as file:
        writer: Any = Writer(file, chunk_size=4000)
        writer.start()
        channel = writer.register_channel("/bytes", "cdr", writer.register_schema("test/msg/Bytes", "ros2msg", b""))
        for number in range(100):
            writer.add_message(channel, log_time=number, data=bytes([number]) * 200, publish_time=number)
        writer.finish()
    data = bytearray(path.read_bytes())
    data[120] ^= 0xFF
    path.write_bytes(data)
    seen: list[Stored] = []
    container = Container(path, seen.append)
    assert container.damage == {"corrupt_chunk": 1}
    assert 60 < len(seen) < 100
    assert [stored.t_recv_ns for stored in container.messages()] == list(range(100 - len(seen), 100))


def test_a_cut_in_the_first_record_leaves_nothing(tmp_path: Path) -> None:
    """And raises nothing."""
    path = tmp_path / "cut.mcap"
    path.write_bytes(b"\x89MCAP0\r\n\x06\x10\x00")
    assert Container(path, lambda stored: pytest.fail("there is no message")).truncated
