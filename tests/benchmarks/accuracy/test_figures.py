"""Figures of runs whose errors are known: poses made of the truth, moved and turned by hand."""

from collections.abc import Callable
from dataclasses import replace
from math import cos, radians, sin
from typing import TypeAlias

import numpy as np
import pytest

from tests.benchmarks.accuracy.entrants import AHEAD_NS, PERIOD_NS, RAW, Watched, blank, rival
from tests.benchmarks.accuracy.figures import row_of
from tests.benchmarks.accuracy.scenarios import DISTURBED_FROM_S, SCENARIOS, SPELL_S
from tests.benchmarks.accuracy.world import Recording, record
from tracker.estimator import Pose
from tracker.geometry import multiply, wxyz_from_matrix
from tracker.measurements import GpsFix, TruePose, Vector3
from tracker.score import Figures
from tracker.simulate import START_NS

DURATION_S = 240.0
VARIANCE_M2, VARIANCE_RAD2 = 4.0, 0.01

Off: TypeAlias = Callable[[float], tuple[Vector3, float]]
"""By how much a pose is moved, metres, and turned to the left, radians, so many seconds into the walk."""


@pytest.fixture(scope="module")
def recording() -> Recording:
    """Four minutes, with all that a scenario may have."""
    everything = replace(SCENARIOS["three-taps"], outage=True, disturbance=True)
    return record(everything, 1, duration_s=DURATION_S)


def posed(recording: Recording, off: Off, ahead_ns: int = 0) -> list[Pose]:
    """Return the truth as poses at the ticks (or so much later), put off."""
    stamps = START_NS + np.arange(PERIOD_NS, round(DURATION_S * 1e9) - 10_000_000 - ahead_ns, PERIOD_NS) + ahead_ns
    motion = recording.walk.at(stamps)
    cov = np.diag([VARIANCE_M2] * 3 + [VARIANCE_RAD2] * 3)
    poses = []
    for t, p, R in zip(stamps.tolist(), motion.p_m, motion.R_site_body, strict=True):
        moved_m, turned_rad = off((t - START_NS) * 1e-9)
        x, y, z = (p + moved_m).tolist()
        wxyz = multiply((cos(turned_rad / 2), 0.0, 0.0, sin(turned_rad / 2)), wxyz_from_matrix(R))
        poses.append(Pose(t, (x, y, z), wxyz, (0.0, 0.0, 0.0), cov, "-", True))
    return poses


def row(recording: Recording, off: Off, off_ahead: Off | None = None) -> Figures:
    """Return the row of poses that are off by so much."""
    run = blank(recording, "ours")
    run.truth = [m for m in recording.measurements if isinstance(m, TruePose)]
    run.fixes = [m for m in recording.measurements if isinstance(m, GpsFix)]
    run.poses = posed(recording, off)
    ahead = posed(recording, off_ahead or off, AHEAD_NS)
    return row_of(recording, Watched(run, ahead, cpu_us=7.0))


def test_an_error_that_stays_is_no_jitter_and_is_de_biased_away(recording: Recording) -> None:
    found = row(recording, lambda _: ((3.0, 4.0, -2.0), radians(1.5)))
    assert found["ate_m"] == pytest.approx(5.0)
    assert found["ate_ratio"] == pytest.approx(5.0 / found["raw_m"])
    assert found["debiased_m"] == pytest.approx(0.0, abs=1e-3)
    assert found["debiased_90s_m"] == pytest.approx(0.0, abs=1e-3)
    assert found["height_m"] == pytest.approx(2.0, abs=1e-3)
    for name in ("heading_deg", "heading_walked_deg", "heading_20m_deg", "told_heading_deg", "prediction_deg"):
        assert found[name] == pytest.approx(1.5, abs=1e-2)
    for name in ("tilt_deg", "prediction_added_deg", "excursion_deg"):
        assert found[name] == pytest.approx(0.0, abs=1e-2)
    assert found["jitter_walking_m"] < 1e-3
    assert found["jitter_standing_m"] < 1e-3
    assert found["outage_end_m"] == pytest.approx(5.0, abs=1e-3)
    assert found["outage_added_m"] == pytest.approx(0.0, abs=1e-3)
    assert found["told_m"] == pytest.approx(5.0, abs=1e-3)
    assert found["told_px"] > 100.0
    assert found["nees_position"] == pytest.approx(25.0 / VARIANCE_M2 / 2.0)
    assert found["nees_heading"] == pytest.approx(radians(1.5) ** 2 / VARIANCE_RAD2, rel=1e-2)
    assert found["cpu_us"] == 7.0


def test_a_tremble_is_jitter_where_it_happens(recording: Recording) -> None:
    """3 mm at 4 Hz."""
    found = row(recording, lambda t_s: ((0.003 * sin(8.0 * np.pi * t_s), 0.0, 0.0), 0.0))
    for name in ("jitter_walking_m", "jitter_standing_m"):
        assert found[name] == pytest.approx(0.003 / np.sqrt(2.0), rel=0.05)


def test_a_slow_drift_counts_less_in_a_window_than_over_the_walk(recording: Recording) -> None:
    """Straight, a centimetre a second: the RMSE of a line about its mean is its length over the root of twelve."""
    found = row(recording, lambda t_s: ((0.01 * t_s, 0.0, 0.0), 0.0))
    assert found["debiased_90s_m"] == pytest.approx(0.9 / np.sqrt(12.0), rel=0.01)
    assert found["debiased_m"] == pytest.approx(2.2 / np.sqrt(12.0), rel=0.01)
    assert found["outage_added_m"] == pytest.approx(0.01 * SPELL_S, rel=0.01)


def test_an_excursion_is_from_where_heading_was(recording: Recording) -> None:
    middle_s = DISTURBED_FROM_S + SPELL_S / 2.0
    found = row(recording, lambda t_s: ((0.0, 0.0, 0.0), radians(5.0 if abs(t_s - middle_s) < 2.0 else 2.0)))
    assert found["excursion_deg"] == pytest.approx(3.0, abs=0.01)


def test_what_a_prediction_adds_is_told_apart(recording: Recording) -> None:
    found = row(recording, lambda _: ((0.0,) * 3, radians(2.0)), lambda _: ((0.0,) * 3, radians(2.5)))
    assert found["prediction_deg"] == pytest.approx(2.5, abs=0.01)
    assert found["prediction_added_deg"] == pytest.approx(0.5, abs=0.01)


def test_the_heading_after_twenty_metres_is_of_that_moment(recording: Recording) -> None:
    """Half a turn wrong at first, right later; the mean over all is bad and that one is not."""
    found = row(recording, lambda t_s: ((0.0,) * 3, np.pi if t_s < 22.0 else radians(1.0)))
    assert found["heading_20m_deg"] == pytest.approx(1.0, abs=0.01)
    assert found["heading_walked_deg"] == pytest.approx(1.0, abs=0.01)
    assert found["heading_deg"] > 5.0


def test_the_raw_receiver_has_a_place_and_no_attitude(recording: Recording) -> None:
    """And its place, held until the next fix arrives, is worse than at the stamps of its fixes."""
    found = row_of(recording, rival(recording, RAW))
    assert found["heading_deg"] is None
    assert found["tilt_deg"] is None
    assert found["ate_m"] > found["raw_m"] * 1.0001
    assert found["debiased_m"] < found["ate_m"]


def test_a_rival_without_place_and_north_is_asked_for_tilt_alone(recording: Recording) -> None:
    """Its poses stand at the origin, without covariance."""
    run = blank(recording, "vqf")
    run.truth = [m for m in recording.measurements if isinstance(m, TruePose)]
    run.fixes = [m for m in recording.measurements if isinstance(m, GpsFix)]
    turned = posed(recording, lambda _: ((0.0,) * 3, 2.0))
    run.poses = [replace(pose, p_site_m=(0.0, 0.0, 0.0), cov=np.zeros((6, 6))) for pose in turned]
    found = row_of(recording, Watched(run))
    assert found["tilt_deg"] == pytest.approx(0.0, abs=1e-2)
    told = {name for name, value in found.items() if value is not None}
    assert told == {"scenario", "seed", "estimator", "raw_m", "tilt_deg"}


def test_what_a_scenario_has_not_is_none(recording: Recording) -> None:
    plain = replace(recording, scenario=SCENARIOS["plain"], outage_s=None, told_ns=[])
    found = row(plain, lambda _: ((1.0, 0.0, 0.0), 0.0))
    special = ("outage_end_m", "outage_added_m", "excursion_deg", "told_m", "told_heading_deg", "told_px")
    assert [found[name] for name in special] == [None] * 6
