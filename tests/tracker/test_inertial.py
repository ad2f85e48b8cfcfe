"""Dead reckoning against motions whose integrals are known."""

import pytest

from tracker.calibration import MeanSample
from tracker.geometry import wxyz_from_yaw
from tracker.inertial import InertialPath

G = 9.81
LEVEL = (1.0, 0.0, 0.0, 0.0)


def _walk(
    path: InertialPath, accel_x: float, seconds: float, start_s: float = 0.0, yaw_offset: float | None = 0.0
) -> None:
    for index in range(1, int(seconds * 50) + 1):
        t_ns = int((start_s + index * 0.02) * 1e9)
        path.step(MeanSample(t_ns, 0.02, (0.0, 0.0, 0.0), (accel_x, 0.0, G)), LEVEL, yaw_offset)


def test_constant_acceleration() -> None:
    """p = a t^2 / 2 along the direction that the yaw offset gives body x."""
    path = InertialPath(G)
    _walk(path, 0.5, 2.0, yaw_offset=1.5707963)
    dx, dy, dz = path.displacement_m(int(0.02e9), int(2e9))
    assert (dx, dz) == pytest.approx((0.0, 0.0), abs=1e-6)
    # the leak of a velocity that no fix has set slows it; without a fix the IMU alone is not believed for long
    assert 0.4 < dy < 0.5 * 0.5 * 1.98**2


def test_a_reset_velocity_is_carried() -> None:
    """After a fix the displacement is v t while nothing pushes."""
    path = InertialPath(G)
    _walk(path, 0.0, 0.5)
    path.correct_velocity(int(0.5e9), (1.0, -0.5, 0.0))
    _walk(path, 0.0, 1.0, start_s=0.5)
    assert path.displacement_m(int(0.5e9), int(1.5e9)) == pytest.approx((1.0, -0.5, 0.0), rel=0.02)
    assert path.displacement_m(int(1.5e9), int(1.7e9)) == pytest.approx((0.2, -0.1, 0.0), abs=1e-6)


def test_without_north_a_force_moves_nothing() -> None:
    """A force whose direction is unknown would move the rig the wrong way."""
    path = InertialPath(G)
    _walk(path, 1.0, 1.0, yaw_offset=None)
    assert path.displacement_m(0, int(1e9)) == (0.0, 0.0, 0.0)


def test_reads_between_samples() -> None:
    """A picture's stamp falls between two samples."""
    path = InertialPath(G)
    path.step(MeanSample(0, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, G)), LEVEL, 0.0)
    path.step(MeanSample(100, 1e-7, (0.0, 0.0, 0.0), (0.0, 0.0, G)), wxyz_from_yaw(0.2), 0.0)
    state = path.at(50)
    assert state is not None
    assert state.wxyz_level_body == pytest.approx(wxyz_from_yaw(0.1))
