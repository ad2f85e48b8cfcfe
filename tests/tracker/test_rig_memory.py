"""What a rig has learned, from one walk to the next: by UTC in the file, never after a new calibration, never fatal."""

import os
from pathlib import Path

import numpy as np
import pytest

from tracker.precise.memory import SIZE, Memory
from tracker.rig_memory import load_memory, memory_place, save_memory

MEMORY = Memory(7_000_000_000, np.linspace(-0.01, 0.01, SIZE), 1e-4 * np.eye(SIZE))
UTC_NS = 1_790_000_000_000_000_000


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    path = tmp_path / "rigs" / "mine.toml"
    path.parent.mkdir()
    path.write_text("# a rig\n")
    return path


def test_the_next_start_has_a_clock_of_its_own(rig: Path) -> None:
    save_memory(rig, MEMORY, UTC_NS)
    assert memory_place(rig).name == "mine.memory.toml"
    found = load_memory(rig, UTC_NS - 5_000_000_000)
    assert found is not None
    assert found.t_ns == 12_000_000_000
    assert np.array_equal(found.mean, MEMORY.mean)
    assert np.array_equal(found.covariance, MEMORY.covariance)
    assert [path.name for path in rig.parent.iterdir() if path.name.startswith(".")] == []


def test_where_there_is_none_nothing_is_known(rig: Path) -> None:
    assert load_memory(rig, 0) is None


def test_a_new_calibration_makes_it_useless(rig: Path) -> None:
    save_memory(rig, MEMORY, UTC_NS)
    written_ns = memory_place(rig).stat().st_mtime_ns
    os.utime(rig, ns=(written_ns + 1_000_000, written_ns + 1_000_000))
    assert load_memory(rig, UTC_NS) is None


@pytest.mark.parametrize("text", ["", "t_ns = 4", "nonsense", "\x00"])
def test_what_is_broken_is_left_out(rig: Path, text: str) -> None:
    memory_place(rig).write_text(text)
    assert load_memory(rig, UTC_NS) is None
    memory_place(rig).write_bytes(b"\xff\xfe\x00")
    assert load_memory(rig, UTC_NS) is None


def test_a_place_that_cannot_be_written_to_ends_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    save_memory(tmp_path / "file" / "rig.toml", MEMORY, UTC_NS)
