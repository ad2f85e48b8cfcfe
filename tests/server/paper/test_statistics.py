"""Paired comparisons: against scipy's own test, against cases worked by hand, and seed for seed whatever the order."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import ttest_rel

from server.paper.statistics import by_cell, claims, metric, paired, summary

SENSORS = ("gps-imu", "camera-gps-imu")


def _row(dataset: int, seed: int, sensors: str, model: str, scale: float, p0r0: float = 0.5) -> dict[str, Any]:
    """A row whose figures are all the walk's difficulty, that is the seed, times how good a model is."""
    value = scale * (1.0 + 0.1 * seed)
    return {
        "dataset": dataset,
        "seed": seed,
        "sensors": sensors,
        "model": model,
        "filter_error_m": {"mean": value, "std": 0.1},
        "filter_error_rad": {"mean": value, "std": 0.1},
        "truth": {"ate_rmse_m": value, "rpe_10s_m": value, "heading_rmse_deg": value, "jitter_rms_m": value},
        "gps": {"ate_rmse_m": 2.0},
        "nees_position": value,
        "loop_closure_m": value if dataset == 5 else None,
        "motion_model_share": {"P0R0": p0r0, "P1R1": 1.0 - p0r0},
    }


def _study(scales: dict[tuple[int, str, str], float]) -> list[dict[str, Any]]:
    return [_row(d, seed, s, m, scale) for (d, s, m), scale in scales.items() for seed in range(1, 5)]


def test_the_interval_is_scipys() -> None:
    """Student's interval and the means are those of scipy's paired t-test."""
    rng = np.random.default_rng(3)
    theirs = rng.uniform(1.0, 2.0, 16)
    ours = theirs + rng.normal(-0.1, 0.2, 16)
    found, test = paired(ours.tolist(), theirs.tolist()), ttest_rel(ours, theirs).confidence_interval(0.95)
    assert found["interval_t"] == pytest.approx([test.low, test.high])
    assert found["difference_mean"] == pytest.approx(np.mean(ours) - np.mean(theirs))
    assert found["ratio_median"] == pytest.approx(np.median(ours / theirs))
    assert found["wins"] == np.sum(ours < theirs)
    # resampling knows nothing of Student, and still tells nearly the same
    assert found["interval_bootstrap"] == pytest.approx(found["interval_t"], abs=0.03)


def test_pairs_see_what_means_hide() -> None:
    """A model that is better by 1 % on walks that differ by ten times is surely better."""
    theirs = np.geomspace(1.0, 10.0, 8)
    found = paired((0.99 * theirs).tolist(), theirs.tolist())
    assert found["interval_t"][1] < 0.0
    assert found["interval_bootstrap"][1] < 0.0
    assert found["ratio_mean"] == pytest.approx(0.99)
    assert found["wins"] == 8


@given(st.lists(st.tuples(st.floats(0.1, 10.0), st.floats(0.1, 10.0)), min_size=2, max_size=20))
def test_swapping_turns_the_sign(pairs: list[tuple[float, float]]) -> None:
    """What ours gains theirs loses."""
    ours, theirs = [a for a, _ in pairs], [b for _, b in pairs]
    there, back = paired(ours, theirs), paired(theirs, ours)
    assert there["difference_mean"] == pytest.approx(-back["difference_mean"], abs=1e-9)
    assert there["interval_t"] == pytest.approx([-back["interval_t"][1], -back["interval_t"][0]], abs=1e-9)
    assert there["wins"] + back["wins"] + sum(a == b for a, b in pairs) == len(pairs)


@pytest.mark.parametrize(("ours", "theirs"), [([1.0], [1.0]), ([1.0, 2.0], [1.0]), ([], [])])
def test_what_is_not_paired_is_refused(ours: list[float], theirs: list[float]) -> None:
    """One seed tells no spread, and two lists of unlike length no pairs."""
    with pytest.raises(ValueError, match="seeds"):
        paired(ours, theirs)


def test_rows_are_paired_by_seed_not_by_place() -> None:
    """The order of the rows does not matter."""
    rows = _study({(1, "gps-imu", "cmm"): 1.0, (1, "gps-imu", "famm"): 0.9})
    there, back = summary(rows), summary(rows[::-1])
    assert there == back
    row = next(r for r in there["against_cmm"] if r["metric"] == "ate_m")
    assert row["ratio_mean"] == pytest.approx(0.9)
    assert row["wins"] == row["n"] == 4


def test_a_seed_that_one_model_lacks_is_left_out() -> None:
    """A pair needs both."""
    rows = _study({(1, "gps-imu", "cmm"): 1.0, (1, "gps-imu", "famm"): 0.9})[:-1]
    row = next(r for r in summary(rows)["against_cmm"] if r["metric"] == "filter_error_m")
    assert row["n"] == 3


def test_claims_name_the_cells() -> None:
    """What is won, what is not, and by which sensors, as worked by hand."""
    scales = {(d, s, "cmm"): 1.0 for d in range(1, 6) for s in SENSORS}
    scales |= {(d, s, "famm"): 0.9 for d in range(1, 6) for s in SENSORS}
    scales[3, "camera-gps-imu", "famm"] = 1.2
    scales[2, "camera-gps-imu", "cmm"] = 0.5
    found = summary(_study(scales))["claims"]
    assert found["famm_filter_error_not_lower"] == ["2/camera-gps-imu", "3/camera-gps-imu"]
    assert len(found["famm_filter_error_lower"]) == len(found["famm_filter_error_lower_surely"]) == 8
    assert found["famm_ate_ratio_median"]["2/camera-gps-imu"] == pytest.approx(1.8)
    assert "2/camera-gps-imu" not in found["famm_ate_at_most_cmm"]
    scales[1, "gps-imu", "famm"] = 1.004
    printed = summary(_study(scales))["claims"]
    assert set(printed["famm_ate_at_most_1_00"]) - set(printed["famm_ate_at_most_cmm"]) == {"1/gps-imu"}
    # dataset 2 under CMM is better with the camera; under FAMM, and in the others, it makes no difference
    assert found["camera_better"] == ["2/cmm"]
    assert found["camera_worse_by_2_percent"] == []
    assert found["stationary_p0r0_share"]["gps-imu"]["mean"] == pytest.approx(0.5)
    assert set(found["loop_closure_m"]) == {f"{s}/{m}" for s in SENSORS for m in ("cmm", "famm")}


def test_a_camera_that_harms_is_named() -> None:
    """By more than two percent, and only where somebody moves."""
    scales = {(d, s, m): 1.0 for d in (2, 3) for s in SENSORS for m in ("cmm", "famm")}
    scales[2, "camera-gps-imu", "famm"] = 1.03
    scales[2, "camera-gps-imu", "cmm"] = 1.01
    scales[3, "camera-gps-imu", "famm"] = 2.0
    found = summary(_study(scales))["claims"]
    assert found["camera_worse_by_2_percent"] == ["2/famm/ate_m", "2/famm/rpe_10s_m"]


def test_a_missing_figure_is_none_not_zero() -> None:
    """A walk too short for a relative error has none, and is compared in what it has."""
    rows = _study({(3, "gps-imu", "cmm"): 1.0, (3, "gps-imu", "famm"): 0.9})
    for row in rows:
        row["truth"]["rpe_10s_m"] = None
    assert metric(rows[0], "rpe_10s_m") is None
    assert metric({**rows[0], "truth": None}, "ate_m") is None
    found = summary(rows)
    assert "rpe_10s_m" not in {row["metric"] for row in found["against_cmm"]}
    assert all(cell["rpe_10s_m"] is None for cell in found["cells"])


def test_cells_hold_every_row() -> None:
    """Nothing is dropped, and nothing counted twice."""
    rows = _study({(d, s, "cmm"): 1.0 for d in (1, 2) for s in SENSORS})
    table = by_cell(rows)
    assert len(table) == 4
    assert sum(len(seeds) for seeds in table.values()) == len(rows)
    assert claims([], [], [])["camera_better"] == []
