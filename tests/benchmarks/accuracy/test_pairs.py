"""Walk against walk, by hand."""

import pytest

from tests.benchmarks.accuracy.goals import CAMERA, GPS_IMU, by_cell
from tests.benchmarks.accuracy.pairs import against
from tracker.score import Figures


def row(estimator: str, seed: int, **figures: float | None) -> Figures:
    """Return a row of the plain walks."""
    return {"scenario": "plain", "seed": seed, "estimator": estimator, **figures}


def test_only_walks_that_both_have_walked_are_compared() -> None:
    """Half the rival's error on each of two walks; the third is ours alone, and headings are told by nobody else."""
    ours = [row(GPS_IMU, seed, ate_m=float(seed), heading_deg=1.0) for seed in (1, 2, 3)]
    theirs = [row("gps", seed, ate_m=2.0 * seed, heading_deg=None) for seed in (1, 2, 4)]
    (found,) = against(by_cell([*ours, *theirs, row(CAMERA, 1, ate_m=1.0)]))
    assert (found["estimator"], found["rival"], found["figure"], found["n"]) == (GPS_IMU, "gps", "ate_m", 2)
    assert found["ratio_median"] == pytest.approx(0.5)
    assert found["wins"] == 2
