"""A start heading that was wrong is put right by the camera while walking, and by nothing else."""

from collections.abc import Iterator
from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest

from tracker.estimators import Settings, build
from tracker.geomagnetism import declination_rad
from tracker.geometry import matrix_from_wxyz, wrap_rad
from tracker.measurements import MagSample, Measurement, VisualMotion
from tracker.paper import PaperSettings
from tracker.readings import SensorSettings
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

WRONG_RAD = 0.6
S = 1_000_000_000


def _seen(walk: Walk) -> Iterator[VisualMotion]:
    """What a faultless camera makes of a walk: a keyframe every second, three pictures to each."""
    for t_ns in range(START_NS + 21 * S, START_NS + 60 * S, S):
        T_site_key = walk.T_site_cam(t_ns)
        for quarter in (1, 2, 3, 4):
            now_ns = t_ns + quarter * S // 4
            T = np.linalg.inv(T_site_key) @ walk.T_site_cam(now_ns)
            length_m = float(np.linalg.norm(T[:3, 3]))
            x, y, z = (T[:3, 3] / length_m).tolist() if length_m > 0.1 else (0.0, 0.0, 0.0)
            yield VisualMotion(now_ns, now_ns, 0, t_ns, T[:3, :3], (x, y, z), 200, 20.0, quarter == 4)


def _misled(measurement: Measurement) -> Measurement:
    """Turn the magnetometer's field about the vertical, as iron beside the start does."""
    if not isinstance(measurement, MagSample):
        return measurement
    x, y, z = measurement.field_body_t
    c, s = cos(WRONG_RAD), sin(WRONG_RAD)
    return replace(measurement, field_body_t=(c * x - s * y, s * x + c * y, z))


@pytest.fixture(scope="module")
def walk() -> Walk:
    """A minute."""
    return Walk(WalkSettings(seed=2, duration_s=60.0, imu_hz=100.0), default_rig())


@pytest.fixture(scope="module")
def measurements(walk: Walk) -> list[Measurement]:
    """With a faultless camera and a magnetometer that is wrong."""
    everything = [*map(_misled, simulate(walk)), *_seen(walk)]
    return sorted(everything, key=lambda m: m.t_recv_ns)


def _heading_error_rad(walk: Walk, measurements: list[Measurement], *, camera_north: bool) -> float:
    settings = Settings(PaperSettings(SensorSettings(camera_north=camera_north)))
    estimator = build(
        "camera-gps-imu/famm",
        origin=AGORA_ORIGIN,
        rig=default_rig(),
        declination_rad=declination_rad(AGORA_ORIGIN, START_NS),
        settings=settings,
    )
    for measurement in measurements:
        estimator.step(measurement)
    pose = estimator.predict(START_NS + 60 * S)
    assert pose is not None
    turn = matrix_from_wxyz(pose.wxyz_site_body) @ walk.at(np.array([START_NS + 60 * S])).R_site_body[0].T
    return abs(wrap_rad(float(np.arctan2(turn[1, 0], turn[0, 0]))))


def test_the_camera_finds_north(walk: Walk, measurements: list[Measurement]) -> None:
    assert _heading_error_rad(walk, measurements, camera_north=True) < 0.15
    assert _heading_error_rad(walk, measurements, camera_north=False) > 0.4
