"""Chunks that lie about their size are found out, at the cost of a piece of memory."""

import tracemalloc
from pathlib import Path

import pytest

from server.chunks import LARGEST_BYTES, check_chunks
from server.errors import LogRefused
from tests.server.uploads import MAGIC, bomb, lz4_bomb, with_chunk
from tests.walks import write_walk

MIB = 2**20


def refusal(path: Path) -> LogRefused:
    with pytest.raises(LogRefused) as caught:
        check_chunks(path)
    return caught.value


def test_a_walk_passes_whole_and_cut_off(tmp_path: Path) -> None:
    walk = write_walk(tmp_path / "walk.mcap", 3.0)
    check_chunks(walk)
    walk.write_bytes(walk.read_bytes()[:-3000])
    check_chunks(walk)


def test_a_chunk_that_says_that_it_is_50_gb_is_too_large(tmp_path: Path) -> None:
    refused = refusal(with_chunk(tmp_path / "a.mcap", bomb(MIB), 50 * 10**9))
    assert (refused.status, "50000000000" in str(refused)) == (413, True)


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_chunk_that_is_larger_than_it_says_is_found_out_piece_by_piece(tmp_path: Path, compression: str) -> None:
    data = bomb(50 * 10**9) if compression == "zstd" else lz4_bomb(64 * MIB)
    path = with_chunk(tmp_path / "a.mcap", data, 2 * MIB, compression)
    tracemalloc.start()
    try:
        refused = refusal(path)
        assert tracemalloc.get_traced_memory()[1] < 16 * MIB
    finally:
        tracemalloc.stop()
    assert refused.status == 422


def test_what_does_not_inflate_is_left_to_the_reader(tmp_path: Path) -> None:
    for compression in ("zstd", "lz4"):
        check_chunks(with_chunk(tmp_path / "a.mcap", b"no frame at all" * 9, 100, compression))
    check_chunks(with_chunk(tmp_path / "b.mcap", bomb(MIB)[:-20], LARGEST_BYTES))


@pytest.mark.parametrize(
    ("content", "status"),
    [(b"", 415), (b"PK\x03\x04" * 9, 415), (MAGIC + b"\x06" + (2**63).to_bytes(8, "little"), None)],
)
def test_what_is_no_mcap_is_refused_and_a_bare_beginning_passes(
    tmp_path: Path, content: bytes, status: int | None
) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(content)
    if status is None:
        check_chunks(path)
    else:
        assert refusal(path).status == status


def test_a_compression_that_nobody_knows_is_named(tmp_path: Path) -> None:
    assert "brotli" in str(refusal(with_chunk(tmp_path / "a.mcap", b"x", 1, "brotli")))
    assert refusal(with_chunk(tmp_path / "b.mcap", b"x", 1, "z" * 40)).status == 422
