"""Other draws of a recorded walk's receiver: its fixes err as they are meant to, and nothing else of the walk changes."""

from pathlib import Path

import numpy as np
import pytest

from tests.benchmarks.accuracy.redrawn import SIZE_M, TIME_S, WHITE_M, draws, errors_m, received
from tests.walks import write_walk
from tracker.evaluate import log_origin
from tracker.geodesy import SiteFrame
from tracker.log import Log
from tracker.measurements import GpsFix, Matrix, Measurement


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one walk, without a camera."""
    found = tmp_path_factory.mktemp("draws")
    write_walk(found / "short.mcap", 30.0)
    return found


def _places_m(log: Log, measurements: list[Measurement]) -> Matrix:
    site = SiteFrame(log_origin(log))
    fixes = [m for m in measurements if isinstance(m, GpsFix)]
    return np.array([site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m) for fix in fixes])


def test_only_the_fixes_change_and_the_same_draw_is_the_same(folder: Path) -> None:
    log = Log.open(folder / "short.mcap")
    recorded, one, again, other = list(log.messages(camera=False)), received(log, 1), received(log, 1), received(log, 2)
    assert one == again
    assert [m.t_recv_ns for m in one] == sorted(m.t_recv_ns for m in one)
    assert [m for m in one if not isinstance(m, GpsFix)] == [m for m in recorded if not isinstance(m, GpsFix)]
    assert np.abs(_places_m(log, one) - _places_m(log, other)).max() > 0.3


def test_errors_are_as_large_as_claimed_and_last_for_a_minute() -> None:
    seconds = np.arange(121) * 1_000_000_000
    found = np.array([errors_m(seconds, seed) for seed in range(400)])
    variance = SIZE_M**2 + WHITE_M**2
    assert found.var(axis=0)[[0, 60, 120]] == pytest.approx(np.tile(variance, (3, 1)), rel=0.25)
    shared = (found[:, 0] * found[:, 60]).mean(axis=0)
    assert shared == pytest.approx(SIZE_M**2 * np.exp(-1.0), rel=0.4)
    steps = np.diff(found, axis=1).var(axis=(0, 1))
    assert steps == pytest.approx(2.0 * WHITE_M**2 + 2.0 * SIZE_M**2 * (1.0 - np.exp(-1.0 / TIME_S)), rel=0.05)


def test_a_row_for_each_draw_is_written(folder: Path, tmp_path: Path) -> None:
    rows = draws(
        tmp_path / "draws.json",
        folder,
        wanted=("precise",),
        folder=tmp_path / "kept",
        seeds=(1, 2),
        logs=("short", "missing"),
    )
    assert [(row["log"], row["seed"]) for row in rows] == [("short", 1), ("short", 2)]
    assert all(0.0 < row["ate_m"] < 20.0 and row["raw_m"] > row["raw_debiased_m"] > 0.0 for row in rows)
    assert rows[0]["raw_m"] != rows[1]["raw_m"]
    assert (tmp_path / "draws.json").is_file()
