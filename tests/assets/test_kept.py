"""Arrays that are made once."""

from pathlib import Path

import numpy as np

from assets.kept import kept_arrays


def test_arrays_are_made_once_and_read_after(tmp_path: Path) -> None:
    made: list[int] = []

    def make() -> dict[str, np.ndarray[tuple[int, ...], np.dtype[np.generic]]]:
        made.append(1)
        return {"a": np.arange(5), "b": np.eye(2, dtype=np.float32)}

    path = tmp_path / "deep" / "x.npz"
    first, second = kept_arrays(path, make), kept_arrays(path, make)
    assert len(made) == 1
    for name in ("a", "b"):
        np.testing.assert_array_equal(first[name], second[name])
        assert first[name].dtype == second[name].dtype
    assert [found.name for found in path.parent.iterdir()] == ["x.npz"]


def test_a_broken_file_is_made_again(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    kept_arrays(path, lambda: {"a": np.arange(5)})
    path.write_bytes(path.read_bytes()[:100])
    assert kept_arrays(path, lambda: {"a": np.arange(7)})["a"].shape == (7,)
    path.write_bytes(b"")
    assert kept_arrays(path, lambda: {"a": np.arange(9)})["a"].shape == (9,)
    assert kept_arrays(path, lambda: {"a": np.arange(1)})["a"].shape == (9,)
