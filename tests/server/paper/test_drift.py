"""Drift and error figures on attitudes whose drift and error are known, and our attitude beside its rivals'."""

from math import cos, pi, sin

import numpy as np
import pytest
from numpy.typing import NDArray

from server.paper.drift import (
    Attitudes,
    by_imufusion,
    by_madgwick,
    by_us,
    by_vqf,
    calibrated,
    drift_deg_min,
    error_figures,
    rests,
    without,
)
from tracker.geometry import wxyz_from_rpy
from tracker.measurements import ImuSample

G = 9.81


def turning(seconds: float, deg_min: float, roll_rad: float = 0.0) -> Attitudes:
    """A yaw that grows evenly."""
    t_s = np.arange(0.0, seconds, 0.01)
    yaw = np.radians(deg_min) * t_s / 60.0
    return Attitudes(_ns(t_s), np.array([wxyz_from_rpy((roll_rad, 0.0, float(a))) for a in yaw]))


def _ns(t_s: NDArray[np.float64]) -> NDArray[np.int64]:
    return (t_s * 1e9).astype(np.int64)


def resting(seconds: float, offset_rad_s: float = 0.003) -> list[ImuSample]:
    """A rig on a table at 250 Hz, its gyroscope's z off."""
    times = (np.arange(round(seconds * 250)) * 4_000_000).tolist()
    return [ImuSample(t, t, (0.0, 0.0, offset_rad_s), (0.0, 0.0, G)) for t in times]


@pytest.mark.parametrize("deg_min", [0.0, 0.3, 12.0])
def test_drift_is_the_turn_by_minutes(deg_min: float) -> None:
    assert drift_deg_min(turning(40.0, deg_min)) == pytest.approx(deg_min, rel=1e-3, abs=1e-3)


def test_a_short_rest_says_nothing() -> None:
    assert drift_deg_min(turning(9.0, 1.0)) is None
    assert drift_deg_min(turning(40.0, 1.0).between(0, 0)) is None


def test_a_quaternion_and_its_negative_are_one_attitude() -> None:
    still = turning(20.0, 0.0)
    still.wxyz[::2] *= -1.0
    assert drift_deg_min(still) == pytest.approx(0.0, abs=1e-6)


def test_errors_split_into_heading_and_tilt() -> None:
    """Truth stands level; the estimate leans by 0.02 rad all the time, turns by 6 degrees, and its first heading is forgiven."""
    estimate = turning(60.0, 6.0, roll_rad=0.02)
    turned = np.array([[cos(pi / 4), 0.0, 0.0, sin(pi / 4)]])
    t_ns = _ns(np.arange(1.0, 59.0, 0.1))
    found = error_figures(estimate, t_ns, np.repeat(turned, len(t_ns), axis=0))
    assert found["tilt"] == pytest.approx(np.degrees(0.02), rel=1e-3)
    assert found["heading"] == pytest.approx(5.8 / np.sqrt(3.0), abs=0.05)
    assert found["whole"] == pytest.approx(np.hypot(found["heading"], found["tilt"]), rel=1e-3)


def test_a_rest_ends_where_the_rig_moves() -> None:
    moved = [
        ImuSample(t, t, (0.5, 0.0, 0.0) if 15e9 < t < 18e9 else (0.0, 0.0, 0.0), s.accel_m_s2)
        for s in resting(40.0)
        for t in [s.t_ns]
    ]
    (first_begin, first_end), (second_begin, second_end) = rests(moved)
    assert (first_begin, second_end) == (0, moved[-1].t_ns)
    assert 14.4e9 < first_end <= 15e9
    assert 18e9 <= second_begin < 19e9
    assert rests(resting(9.0)) == []


def test_offsets_are_what_the_paper_tables() -> None:
    samples = resting(30.0)
    offsets = calibrated(samples)
    assert 5000 <= offsets.samples < 5200
    assert offsets.end_ns < 21e9
    assert offsets.gyro_rad_s == pytest.approx((0.0, 0.0, 0.003), abs=1e-6)
    assert offsets.accel_m_s2 == pytest.approx((0.0, 0.0, G))
    assert without(samples, offsets.gyro_rad_s)[0].gyro_rad_s == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_only_the_offset_makes_a_difference_to_drift() -> None:
    """The mean of four integrates to the same angle; without the offset nothing turns."""
    samples = resting(60.0)
    own = calibrated(samples).gyro_rad_s
    for mean_samples in (1, 4):
        raw, corrected = by_madgwick(samples, mean_samples), by_madgwick(without(samples, own), mean_samples)
        assert drift_deg_min(raw) == pytest.approx(np.degrees(0.003 * 60.0), rel=1e-3)
        assert drift_deg_min(corrected) == pytest.approx(0.0, abs=1e-3)
    assert drift_deg_min(by_us(samples).between(round(25e9), round(60e9))) == pytest.approx(0.0, abs=1e-3)


def test_rivals_turn_as_we_do() -> None:
    """All three on one turning rig: a quarter turn about the vertical in ten seconds, after three at rest."""
    samples = [
        ImuSample(t, t, (0.0, 0.0, pi / 20.0 if 3e9 <= t < 13e9 else 0.0), (0.0, 0.0, G))
        for t in (np.arange(4000) * 4_000_000).tolist()
    ]
    for found in (by_madgwick(samples), by_vqf(samples), by_imufusion(samples)):
        assert found is not None
        begin, end = found.wxyz[found.t_ns <= round(2.9e9)][-1], found.wxyz[-1]
        assert 2.0 * np.arccos(abs(float(begin @ end))) == pytest.approx(pi / 2, abs=0.02)
