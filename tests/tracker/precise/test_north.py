"""North is told by walking or by a compass, not by standing: a rig that only turns on the spot keeps the turn that it felt."""

from collections.abc import Iterator

import numpy as np
import pytest

from tests.tracker.precise.stream import S, estimator, stream
from tracker.geodesy import SiteFrame
from tracker.geometry import wrap_rad, yaw_of
from tracker.measurements import GpsFix, ImuSample, MagSample, Measurement
from tracker.simulate import AGORA_ORIGIN, START_NS

#: A telephone at arm's length, turned round once in 24 s after four of standing, then held still.
STILL_S, TURN_S, END_S = 4.0, 24.0, 32.0
ARM_M, IMU_HZ = 0.4, 50


def _full_turn(seed: int) -> Iterator[Measurement]:
    """Yield inertial samples and fixes without velocities, whose error wanders by a metre or two."""
    rng, site, wander = np.random.default_rng(seed), SiteFrame(AGORA_ORIGIN), np.zeros(3)
    for index in range(round(END_S * IMU_HZ)):
        t_s = index / IMU_HZ
        t_ns = START_NS + index * S // IMU_HZ
        rate = 2.0 * np.pi / TURN_S if STILL_S <= t_s < STILL_S + TURN_S else 0.0
        inwards = -ARM_M * rate**2
        gx, gy, gz = np.add(rng.normal(0.0, 0.003, 3), (0.0, 0.0, rate)).tolist()
        ax, ay, az = np.add(rng.normal(0.0, 0.05, 3), (inwards, 0.0, 9.8)).tolist()
        yield ImuSample(t_ns, t_ns, (gx, gy, gz), (ax, ay, az))
        if index % IMU_HZ == 0:
            wander += 0.3 * rng.normal(size=3)
            x, y, z = wander.tolist()
            yield GpsFix(
                t_ns, t_ns, *site.geodetic_from_site((x, y, z)), (25.0, 0.0, 0.0, 0.0, 25.0, 0.0, 0.0, 0.0, 64.0)
            )


@pytest.mark.parametrize("seed", range(3))
def test_a_turn_on_the_spot_closes(seed: int) -> None:
    one, yaws = estimator("gps-imu/precise"), {}
    for measurement in _full_turn(seed):
        one.step(measurement)
        pose = one.predict(measurement.t_ns)
        if pose is not None:
            assert not pose.heading_known
            yaws[(measurement.t_ns - START_NS) / S] = yaw_of(pose.wxyz_site_body)
    at = sorted(yaws)
    first, last = yaws[next(t for t in at if t > 3.0)], yaws[at[-1]]
    assert abs(wrap_rad(last - first)) < np.radians(3.0)


def test_nobody_tells_north_to_a_rig_without_receiver_and_compass() -> None:
    one = estimator("gps-imu/precise")
    for measurement in stream():
        if isinstance(measurement, ImuSample):
            one.step(measurement)
    pose = one.predict(measurement.t_recv_ns)
    assert pose is not None
    assert not pose.heading_known
    assert np.sqrt(pose.cov[5, 5]) > 1.5
    assert np.sqrt(pose.cov[3, 3]) < 0.03


def test_a_compass_tells_north_without_a_receiver() -> None:
    one = estimator("gps-imu/precise")
    for measurement in stream():
        if isinstance(measurement, ImuSample | MagSample):
            one.step(measurement)
    pose = one.predict(measurement.t_recv_ns)
    assert pose is not None
    assert pose.heading_known
