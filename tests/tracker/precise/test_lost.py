"""It says when it is lost: by its covariance, by a heading that is not known, by no pose at all; and finds itself again."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.precise.stream import S, estimator, feed, stream, walk
from tracker.estimator import Pose
from tracker.geometry import wrap_rad, yaw_of
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Measurement, Vector3
from tracker.precise.estimator import PreciseEstimator
from tracker.precise.navigation import Navigation
from tracker.simulate import START_NS

RECEIVER = (GpsFix, GpsVelocity)
SENSORS = (ImuSample, *RECEIVER)


def _poses(measurements: list[Measurement], one: PreciseEstimator | None = None) -> dict[int, Pose | None]:
    """Return what was to be seen once a second, by the second."""
    one = one or estimator("gps-imu/precise")
    poses: dict[int, Pose | None] = {}
    for measurement in measurements:
        one.step(measurement)
        poses.setdefault((measurement.t_recv_ns - START_NS) // S, one.predict(measurement.t_recv_ns))
    return poses


def _sensors(change: Callable[[float, Measurement], Measurement | None], seconds: float = 45.0) -> list[Measurement]:
    """Return a walk's inertial samples and what its receiver tells, changed by the second they are of; None leaves one out."""
    all_ = (change((m.t_ns - START_NS) / S, m) for m in stream(seconds) if isinstance(m, SENSORS))
    return [m for m in all_ if m is not None]


def _off_m(pose: Pose) -> float:
    x, y, _ = walk().at(np.array([pose.t_ns])).p_m[0].tolist()
    return float(np.hypot(pose.p_site_m[0] - x, pose.p_site_m[1] - y))


def _heading_off_rad(pose: Pose) -> float:
    R = walk().at(np.array([pose.t_ns])).R_site_body[0]
    return abs(wrap_rad(yaw_of(pose.wxyz_site_body) - float(np.arctan2(R[1, 0], R[0, 0]))))


def _sigma_m(pose: Pose | None) -> float:
    assert pose is not None
    return float(np.sqrt(np.trace(pose.cov[:2, :2])))


def test_doubt_grows_while_the_receiver_is_silent() -> None:
    """By what the walker may have done; the error keeps within it, and fixes end it."""
    poses = _poses(_sensors(lambda t, m: None if isinstance(m, RECEIVER) and 20.0 < t < 40.0 else m))
    doubts_m = [_sigma_m(poses[second]) for second in (20, 25, 39)]
    assert doubts_m == sorted(doubts_m)
    assert doubts_m[-1] ** 2 > doubts_m[0] ** 2 + 0.5
    last, again = poses[39], poses[43]
    assert last is not None
    assert _off_m(last) < 4.0 * _sigma_m(last)
    assert _sigma_m(again) < doubts_m[-1]


def test_there_is_no_pose_while_the_inertial_sensor_is_silent_and_a_new_one_after() -> None:
    """Nobody knows what the rig has done in between: heading is found anew."""
    poses = _poses(_sensors(lambda t, m: None if isinstance(m, ImuSample) and 20.0 < t < 26.0 else m))
    assert poses[19] is not None
    assert all(poses[second] is None for second in range(22, 26))
    first = next(pose for second, pose in poses.items() if second > 25 and pose is not None)
    assert not first.heading_known
    last = poses[44]
    assert last is not None
    assert last.heading_known
    assert _heading_off_rad(last) < 0.2
    assert _off_m(last) < 4.0 * _sigma_m(last)


def _nonsense(rate_rad_s: float, force_m_s2: float) -> Callable[[float, Measurement], Measurement]:
    rng = np.random.default_rng(0)

    def direction(length: float) -> Vector3:
        v = rng.normal(size=3)
        x, y, z = (length * v / np.linalg.norm(v)).tolist()
        return (x, y, z)

    def changed(t_s: float, m: Measurement) -> Measurement:
        if not isinstance(m, ImuSample) or not 20.0 < t_s < 25.0:
            return m
        return replace(m, gyro_rad_s=direction(rate_rad_s), accel_m_s2=direction(force_m_s2))

    return changed


@pytest.mark.parametrize(("rate_rad_s", "force_m_s2"), [(49.0, 390.0), (10.0, 100.0)])
def test_after_five_seconds_of_nonsense_it_begins_again(rate_rad_s: float, force_m_s2: float) -> None:
    poses = _poses(_sensors(_nonsense(rate_rad_s, force_m_s2)))
    assert any(poses[second] is None for second in range(20, 30))
    last = poses[44]
    assert last is not None
    assert last.heading_known
    assert _off_m(last) < 4.0 * _sigma_m(last)
    assert _heading_off_rad(last) < 0.2


def test_numbers_that_are_none_end_in_a_new_beginning() -> None:
    """What a filter that has diverged leaves behind is not shown, and not kept."""
    one = estimator("gps-imu/precise")
    feed(one, [m for m in _sensors(lambda t, m: m) if m.t_recv_ns < START_NS + 20 * S])
    best = one._engine.best
    best.nav = Navigation(best.nav.t_ns, (float("nan"),) * 3, best.nav.v_m_s, best.nav.wxyz_site_body)
    assert one.predict(START_NS + 20 * S) is None
    poses = _poses([m for m in _sensors(lambda t, m: m) if m.t_recv_ns >= START_NS + 20 * S], one)
    last = poses[44]
    assert last is not None
    assert _off_m(last) < 4.0 * _sigma_m(last)


def test_without_a_receiver_it_knows_its_tilt_and_says_that_it_knows_no_place() -> None:
    poses = _poses([m for m in stream() if isinstance(m, ImuSample)])
    assert poses[2] is None, "a receiver may still tell"
    pose = poses[40]
    assert pose is not None
    assert _sigma_m(pose) > 500.0
    assert np.sqrt(pose.cov[3, 3]) < 0.03
