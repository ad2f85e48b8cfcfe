"""Dead reckoning against motions whose integrals are known."""

import pytest

from tracker.calibration import MeanSample
from tracker.geometry import wxyz_from_yaw
from tracker.inertial import TRUSTED_S, VELOCITY_S, InertialPath
from tracker.pace import share_of

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


def test_a_known_velocity_is_carried() -> None:
    """What a receiver says of the velocity is taken from its stamp on, also where the path has gone on since."""
    path = InertialPath(G)
    _walk(path, 0.0, 1.0)
    path.correct_velocity(int(0.5e9), (1.0, -0.5, 0.0))
    path.correct_velocity(int(0.5e9), (7.0, 7.0, 7.0))  # of the same time: it says nothing new
    _walk(path, 0.0, 0.5, start_s=1.0)
    share = share_of(TRUSTED_S, VELOCITY_S)
    for until_s in (1.0, 1.5):
        moved = path.displacement_m(int(0.5e9), int(until_s * 1e9))
        assert moved == pytest.approx((share * (until_s - 0.5), -0.5 * share * (until_s - 0.5), 0.0), abs=1e-9)
    assert path.displacement_m(int(0.1e9), int(0.4e9)) == (0.0, 0.0, 0.0)
    assert path.displacement_m(int(1.5e9), int(1.7e9)) == pytest.approx((0.2 * share, -0.1 * share, 0.0), abs=1e-9)


def test_fixes_without_velocity_teach_it_in_seconds() -> None:
    """A receiver that tells only where it is: ten seconds of walking, and the path walks as fast."""
    path = InertialPath(G)
    _walk(path, 0.0, 1.0)
    for second in range(1, 11):
        before = path.at(second * 10**9)
        assert before is not None
        _walk(path, 0.0, 1.0, start_s=second)
        path.correct_by_displacement(second * 10**9, (second + 1) * 10**9, (0.0, 1.2, 0.0), before.p_m)
    newest = path.newest
    assert newest is not None
    assert newest.v_m_s == pytest.approx((0.0, 1.2, 0.0), abs=0.05)


def test_a_long_silence_ends_in_the_walkers_pace() -> None:
    """After an outage's first seconds a velocity that no step supports dies away instead of running off."""
    path = InertialPath(G)
    _walk(path, 0.0, 0.5)
    path.correct_velocity(int(0.5e9), (1.0, 0.0, 0.0))
    _walk(path, 0.3, 20.0, start_s=0.5)
    newest = path.newest
    assert newest is not None
    assert abs(newest.v_m_s[0]) < 0.5


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
