"""The precise estimator on simulated walks: whatever start, and what people say to it."""

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from math import cos, pi, sin

import numpy as np
import pytest

from tests.tracker.precise import stream
from tests.tracker.precise.stream import S
from tracker.estimator import Estimator, Pose
from tracker.geometry import matrix_from_wxyz, wrap_rad
from tracker.measurements import (
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Measurement,
    Sighting,
    Standpoint,
    TruePose,
    Vector3,
)
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

_estimator = partial(stream.estimator, stream.NAMES[0])


@pytest.fixture(scope="module")
def walk() -> Walk:
    """A minute and a half."""
    return Walk(WalkSettings(seed=12, duration_s=90.0, imu_hz=100.0, mag_hz=5.0), default_rig())


@pytest.fixture(scope="module")
def measurements(walk: Walk) -> list[Measurement]:
    """Without truth."""
    return [m for m in simulate(walk) if not isinstance(m, TruePose)]


def _fed(estimator: Estimator, measurements: Iterable[Measurement]) -> Pose:
    for measurement in measurements:
        estimator.step(measurement)
    pose = estimator.predict(measurement.t_recv_ns)
    assert pose is not None
    return pose


def _truth(walk: Walk, pose: Pose) -> tuple[Vector3, np.ndarray[tuple[int, int], np.dtype[np.float64]]]:
    motion = walk.at(np.array([pose.t_ns]))
    x, y, z = motion.p_m[0].tolist()
    return (x, y, z), motion.R_site_body[0]


def _heading_off_rad(walk: Walk, pose: Pose) -> float:
    turn = matrix_from_wxyz(pose.wxyz_site_body) @ _truth(walk, pose)[1].T
    return abs(wrap_rad(float(np.arctan2(turn[1, 0], turn[0, 0]))))


def _tilt_off_rad(walk: Walk, pose: Pose) -> float:
    up = matrix_from_wxyz(pose.wxyz_site_body)[2] @ _truth(walk, pose)[1][2]
    return float(np.arccos(np.clip(up, -1.0, 1.0)))


def test_a_walk_is_followed(walk: Walk, measurements: list[Measurement]) -> None:
    pose = _fed(_estimator(), measurements)
    assert _heading_off_rad(walk, pose) < 0.08
    assert _tilt_off_rad(walk, pose) < 0.01
    assert pose.heading_known


@pytest.mark.parametrize("turned_rad", [0.0, 0.5 * pi, pi])
def test_north_is_found_whatever_the_compass_says(
    walk: Walk, measurements: list[Measurement], turned_rad: float
) -> None:
    def misled(measurement: Measurement) -> Measurement:
        if not isinstance(measurement, MagSample):
            return measurement
        (x, y, z), c, s = measurement.field_body_t, cos(turned_rad), sin(turned_rad)
        return replace(measurement, field_body_t=(c * x - s * y, s * x + c * y, z))

    # iron goes with the rig no longer than its start: after half a minute the sensor is taken away
    until_ns = START_NS + 30 * S
    fed = [misled(m) for m in measurements if not isinstance(m, MagSample) or m.t_ns < until_ns]
    assert _heading_off_rad(walk, _fed(_estimator(), fed)) < 0.1


def test_north_is_found_without_a_compass_and_until_then_not_claimed(
    walk: Walk, measurements: list[Measurement]
) -> None:
    fed = [m for m in measurements if not isinstance(m, MagSample)]
    estimator = _estimator()
    standing = _fed(estimator, [m for m in fed if m.t_recv_ns < START_NS + 10 * S])
    assert not standing.heading_known
    assert standing.cov[5, 5] > 1.0
    walked = _fed(estimator, [m for m in fed if m.t_recv_ns >= START_NS + 10 * S])
    assert walked.heading_known
    assert _heading_off_rad(walk, walked) < 0.1
    assert _heading_off_rad(walk, walked) < 4.0 * walked.cov[5, 5] ** 0.5


def test_an_absurd_fix_moves_nothing_and_an_insistent_one_does(walk: Walk, measurements: list[Measurement]) -> None:
    def moved(measurement: Measurement, since_s: float, until_s: float) -> Measurement:
        if isinstance(measurement, GpsFix) and since_s * S <= measurement.t_ns - START_NS < until_s * S:
            return replace(measurement, lat_deg=measurement.lat_deg + 0.01)
        return measurement

    once = _fed(_estimator(), [moved(m, 60.0, 61.5) for m in measurements])
    (x, y, _), _ = _truth(walk, once)
    assert np.hypot(once.p_site_m[0] - x, once.p_site_m[1] - y) < 6.0
    for_good = _fed(_estimator(), [moved(m, 60.0, 999.0) for m in measurements])
    assert for_good.p_site_m[1] - y > 1000.0


def test_pointing_out_landmarks_corrects_the_place(walk: Walk, measurements: list[Measurement]) -> None:
    """Three directions to known points, on no circle with the visitor: what the receiver was off by is found, as is claimed."""
    at_ns = START_NS + 60 * S
    T_site_cam = walk.T_site_cam(at_ns)
    sightings = []
    for index, (right, far) in enumerate([(-12.0, 4.0), (0.0, 25.0), (15.0, 3.0)]):
        point = T_site_cam[:3, 3] + T_site_cam[:3, :3] @ np.array([right, -1.0, far])
        ray = T_site_cam[:3, :3].T @ (point - T_site_cam[:3, 3])
        x, y, z = (ray / np.linalg.norm(ray)).tolist()
        px, py, pz = point.tolist()
        sightings.append(Sighting(at_ns + index, at_ns + index, (px, py, pz), (x, y, z), 0.003))
    fed = sorted([*(m for m in measurements if m.t_recv_ns < at_ns + 10 * S), *sightings], key=lambda m: m.t_recv_ns)
    pose = _fed(_estimator(), fed)
    without = _fed(_estimator(), [m for m in fed if not isinstance(m, Sighting)])
    (x, y, _), _ = _truth(walk, pose)
    off_m = np.hypot(pose.p_site_m[0] - x, pose.p_site_m[1] - y)
    assert off_m < 1.0 < np.hypot(without.p_site_m[0] - x, without.p_site_m[1] - y)
    assert off_m < 3.0 * np.sqrt(np.trace(pose.cov[:2, :2]))
    assert np.trace(pose.cov[:2, :2]) < 0.3 * np.trace(without.cov[:2, :2])
    assert _heading_off_rad(walk, pose) < 0.04


def test_standing_at_a_known_point(walk: Walk, measurements: list[Measurement]) -> None:
    at_ns = START_NS + 60 * S
    x, y, z = walk.at(np.array([at_ns])).p_m[0].tolist()
    said = Standpoint(at_ns, at_ns, (x, y, z), 0.1)
    fed = sorted([*(m for m in measurements if m.t_recv_ns < at_ns + 10 * S), said], key=lambda m: m.t_recv_ns)
    pose = _fed(_estimator(), fed)
    (x, y, _), _ = _truth(walk, pose)
    assert np.hypot(pose.p_site_m[0] - x, pose.p_site_m[1] - y) < 0.7


def test_the_ground_gives_the_height(walk: Walk, measurements: list[Measurement]) -> None:
    pose = _fed(_estimator(eyes_z_m=lambda east, north: 1.65), measurements)
    assert abs(pose.p_site_m[2] - _truth(walk, pose)[0][2]) < 0.1
    assert abs(_fed(_estimator(), measurements).p_site_m[2] - _truth(walk, pose)[0][2]) > 0.1


def test_without_a_receiver_it_is_an_attitude_filter(walk: Walk, measurements: list[Measurement]) -> None:
    pose = _fed(_estimator(), [m for m in measurements if isinstance(m, ImuSample | MagSample)])
    assert _tilt_off_rad(walk, pose) < 0.03
    assert _heading_off_rad(walk, pose) < 0.25


def test_an_outage_is_walked_through(walk: Walk, measurements: list[Measurement]) -> None:
    quiet = [
        m
        for m in measurements
        if not (isinstance(m, GpsFix | GpsVelocity) and START_NS + 50 * S < m.t_ns < START_NS + 80 * S)
    ]
    estimator = _estimator()
    before = _fed(estimator, [m for m in quiet if m.t_recv_ns < START_NS + 50 * S])
    after = _fed(estimator, [m for m in quiet if START_NS + 50 * S <= m.t_recv_ns < START_NS + 80 * S])

    def off(pose: Pose) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        (x, y, _), (px, py, _) = _truth(walk, pose)[0], pose.p_site_m
        return np.array([px - x, py - y])

    assert np.linalg.norm(off(after) - off(before)) < 4.0
    assert after.cov[0, 0] > before.cov[0, 0]
