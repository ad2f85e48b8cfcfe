"""Stretches without inertial samples: the doubt grows with time, the pictures carry the attitude across, and nothing is made up."""

from math import degrees

import numpy as np
import pytest

from tests.tracker.precise.stream import NAMES, S, estimator, stream, walk
from tracker.geometry import wrap_rad, wxyz_from_matrix, yaw_of
from tracker.measurements import ImuSample, MagSample, Measurement
from tracker.precise.activity import Activity
from tracker.precise.compass import Compass
from tracker.precise.error_model import start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.gap import AfterGap, doubt, drift, held, is_gap
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings
from tracker.simulate import START_NS

LEVEL = (1.0, 0.0, 0.0, 0.0)


def _without_imu(from_s: float, to_s: float) -> list[Measurement]:
    lost = (ImuSample, MagSample)
    return [m for m in stream() if not (isinstance(m, lost) and from_s * S <= m.t_ns - START_NS < to_s * S)]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("gap_s", [0.3, 0.9, 2.0, 4.0])
def test_the_heading_is_right_after_a_gap_or_said_to_be_unknown(name: str, gap_s: float) -> None:
    """Whatever the head did meanwhile. Half a second once cost the heading: 171 degrees off, and said to be known."""
    into, due_ns, seen = estimator(name), 0, []
    for measurement in _without_imu(20.0, 20.0 + gap_s):
        into.step(measurement)
        t_ns = measurement.t_recv_ns
        if t_ns < START_NS + round((20.0 + gap_s + 0.3) * S) or t_ns < due_ns:
            continue
        due_ns = t_ns + S // 5
        pose = into.predict(t_ns)
        assert pose is not None
        yaw_rad = yaw_of(wxyz_from_matrix(walk().at(np.array([t_ns])).R_site_body[0]))
        off_deg = abs(degrees(wrap_rad(yaw_of(pose.wxyz_site_body) - yaw_rad)))
        seen.append((t_ns, pose.heading_known, off_deg))
    assert all(off_deg < 25.0 for _, is_known, off_deg in seen if is_known), seen
    after_3_s = [is_known for t_ns, is_known, _ in seen if t_ns > START_NS + round((20.0 + gap_s + 3.0) * S)]
    assert len(after_3_s) > 50
    assert np.mean(after_3_s) > 0.9


def _state() -> ErrorState:
    settings = PreciseSettings()
    nav = Navigation(0, (1.0, 2.0, 3.0), (1.0, 0.0, 0.0), LEVEL)
    return ErrorState(settings, nav, Biases(), start_covariance(settings, (1.0, 1.0, 1.0), 0.1, 0.05), 9.8)


def test_drift_holds_velocity_and_attitude_and_doubts_them_more_with_time() -> None:
    """In one step or in many: a random walk."""
    one, many = _state(), _state()
    drift(one, 2 * S)
    for t_ns in range(S // 4, 2 * S + 1, S // 4):
        drift(many, t_ns)
    assert one.nav == held(_state().nav, 2 * S) == Navigation(2 * S, (3.0, 2.0, 3.0), (1.0, 0.0, 0.0), LEVEL)
    np.testing.assert_allclose(one.covariance, many.covariance, rtol=1e-9, atol=1e-9)
    gained = np.diag(one.covariance) - np.diag(_state().covariance)
    _, v, tilt, turn = doubt(2.0)
    np.testing.assert_allclose(gained[3:9], [v, v, v, tilt, tilt, turn], rtol=1e-3)
    before = one.covariance.copy()
    drift(one, S)
    np.testing.assert_array_equal(one.covariance, before)


def test_gravity_tells_the_tilt_after_a_gap() -> None:
    """A rig that leans by 0.1 rad about east without knowing it."""
    state, after = _state(), AfterGap(0)
    lean_rad = 0.1
    force = (0.0, 9.8 * np.sin(lean_rad), 9.8 * np.cos(lean_rad))
    due = [after.take(ImuSample(index * S // 100, 0, (0.0, 0.0, 0.0), force), state) for index in range(1, 81)]
    # and only with the tilt can a compass be asked: all directions are tried when it has had its time
    assert due == [None] * 49 + ["level"] + [None] * 29 + ["heading"]
    residual, [(_, H)] = after.level()
    dx, dy = np.linalg.lstsq(H[:, :2], residual, rcond=None)[0]
    assert (dx, dy) == (pytest.approx(lean_rad, abs=2e-3), pytest.approx(0.0, abs=1e-9))


def test_what_is_a_gap() -> None:
    """The slowest units say something every 60 ms."""
    assert not is_gap(0, 65_000_000)
    assert is_gap(0, 250_000_000)


def test_a_compass_follows_the_corrections_of_the_heading() -> None:
    """What it was told was against the heading before: a correction by it must not be taken for a second one."""
    compass = Compass(0.0)
    compass.heading(2.0)
    compass.turned(2.0)
    assert compass.yaw_rad(LEVEL) == pytest.approx(0.0)
    compass.forget()
    assert compass.yaw_rad(LEVEL) is None


@pytest.mark.parametrize("name", NAMES)
def test_with_a_compass_the_first_heading_is_near_the_truth(name: str) -> None:
    """Also when it is away from what the filter had assumed by more than a right angle."""
    into = estimator(name)
    for measurement in stream():
        into.step(measurement)
        pose = into.predict(measurement.t_recv_ns)
        if pose is not None:
            break
    assert pose is not None
    truth = walk().at(np.array([pose.t_ns]))
    off_rad = wrap_rad(yaw_of(pose.wxyz_site_body) - yaw_of(wxyz_from_matrix(truth.R_site_body[0])))
    assert abs(degrees(off_rad)) < 12.0


def test_one_sample_after_a_gap_does_not_look_like_standing() -> None:
    """Nothing is said of what the walker does before there is half a second of it again."""
    activity = Activity()
    shaken = [ImuSample(i * S // 100, 0, (0.0, 0.0, 0.0), (0.0, 0.0, 9.8 + 2.0 * (-1.0) ** i)) for i in range(200)]
    for sample in shaken[:100]:
        activity.step(sample)
    activity.forget()
    later = [activity.step(sample) for sample in shaken[150:]]
    assert not any(later[:50])
    assert not activity.stands
