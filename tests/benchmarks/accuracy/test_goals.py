"""Verdicts on rows made by hand."""

import numpy as np
import pytest
from scipy.stats import chi2

from tests.benchmarks.accuracy.goals import BATCH, CAMERA, GPS_IMU, summary
from tests.benchmarks.accuracy.tables import goals_table, medians_table
from tracker.score import Figures

SEEDS = range(101, 117)


def rows(estimator: str, scenario: str = "plain", spread: float = 0.0, **figures: float) -> list[Figures]:
    """Return a row for each seed, all figures a little different."""
    return [
        {
            "scenario": scenario,
            "seed": seed,
            "estimator": estimator,
            **{name: value * (1.0 + spread * (n - 7.5) / 7.5) for name, value in figures.items()},
        }
        for n, seed in enumerate(SEEDS)
    ]


def verdicts(found: Figures) -> dict[tuple[str, str], str]:
    """Return what was met, by goal and estimator."""
    return {(row["goal"], row["estimator"]): row["met"] for row in found["goals"]}


@pytest.mark.parametrize(("ratio", "met"), [(0.74, "aim"), (0.75, "aim"), (0.76, "at least"), (0.91, "no")])
def test_a_median_is_held_to_both_marks(ratio: float, met: str) -> None:
    found = summary(rows(GPS_IMU, ate_ratio=ratio))
    assert verdicts(found) == {("ATE over raw GPS's", GPS_IMU): met}


def test_units_are_those_of_the_goal() -> None:
    (row,) = summary(rows(CAMERA, jitter_walking_m=0.006))["goals"]
    assert (row["value"], row["unit"], row["met"]) == (pytest.approx(6.0), "mm", "at least")


def test_an_interval_lies_about_the_median() -> None:
    (row,) = summary(rows(GPS_IMU, spread=0.5, tilt_deg=0.2))["goals"]
    low, high = row["interval"]
    assert 0.1 < low < row["value"] < high < 0.3
    assert row["worst"] == pytest.approx(0.3)
    (alone,) = summary(rows(GPS_IMU, tilt_deg=0.2)[:1])["goals"]
    assert alone["interval"] is None


def test_the_ratio_to_the_batch_is_of_the_same_walks() -> None:
    """And void where the batch is beaten by anything online that has its sensors: it has no camera."""
    ours, batch = rows(GPS_IMU, spread=0.5, ate_m=1.15), rows(BATCH, spread=0.5, ate_m=1.0)
    found = summary([*ours, *batch])
    assert found["batch_is_a_ceiling"] is True
    (row,) = (row for row in found["goals"] if "batch" in row["goal"])
    assert row["value"] == pytest.approx(1.15)
    assert row["interval"] == pytest.approx([1.15, 1.15])
    assert row["met"] == "at least"
    assert summary([*ours, *batch, *rows("gtsam/fixed-lag", ate_m=0.9)])["batch_is_a_ceiling"] is False
    assert summary([*ours, *batch, *rows(CAMERA, ate_m=0.9)])["batch_is_a_ceiling"] is True
    assert summary(ours)["batch_is_a_ceiling"] is None


def test_consistency_is_a_band() -> None:
    """The aim is the chi-square's 95 % for one draw of each dimension a walk."""
    low, high = (float(chi2.ppf(share, 2 * len(SEEDS))) / (2 * len(SEEDS)) for share in (0.025, 0.975))
    for value, met in ((low + 0.01, "aim"), (high + 0.01, "at least"), (0.39, "no"), (2.51, "no")):
        found = summary(rows(GPS_IMU, nees_position=value))
        assert verdicts(found) == {("NEES per dimension, horizontal position", GPS_IMU): met}


def test_pooled_is_the_mean_and_not_the_median() -> None:
    walks = rows(GPS_IMU, scenario="understated", nees_heading=0.5)
    walks[0]["nees_heading"] = 0.5 + 16.0
    (row,) = summary(walks)["goals"]
    assert row["value"] == pytest.approx(1.5)


def test_medians_leave_out_what_is_not_there() -> None:
    found = summary([*rows("vqf", heading_deg=2.0), *rows("gps", ate_m=2.0)])
    by_name = {row["estimator"]: row for row in found["medians"]}
    assert by_name["vqf"]["heading_deg"] == 2.0
    assert by_name["gps"]["ate_m"] == 2.0
    assert "ate_m" not in by_name["vqf"]
    assert found["goals"] == []


def test_tables_have_a_line_for_every_row() -> None:
    found = summary(rows(GPS_IMU, ate_ratio=0.8, tilt_deg=float(np.float64(0.1))))
    assert goals_table(found["goals"]).row_count == 2
    assert medians_table(found["medians"]).row_count == 1
