"""The start heading, from each of its sources, against a known yaw."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import conjugate, multiply, rotate, wrap_rad, wxyz_from_rpy, wxyz_from_yaw
from tracker.heading import StartHeading

ANGLES = st.floats(-3.1, 3.1)
TILTS = st.floats(-1.0, 1.0)


@given(yaw=ANGLES, roll=TILTS, pitch=TILTS, declination=st.floats(-0.5, 0.5))
def test_a_tilted_magnetometer_finds_true_north(yaw: float, roll: float, pitch: float, declination: float) -> None:
    """The field dips into the ground and points declination east of north; the level frame is off by `yaw`."""
    heading = StartHeading(declination)
    wxyz_level_body = wxyz_from_rpy((roll, pitch, 0.3))
    wxyz_site_body = multiply(wxyz_from_yaw(yaw), wxyz_level_body)
    field_site = (25e-6 * sin(declination), 25e-6 * cos(declination), -40e-6)
    for index in range(30):
        heading.magnetometer(index * 100_000_000, rotate(conjugate(wxyz_site_body), field_site), wxyz_level_body)
    assert heading.yaw_offset_rad is not None
    assert wrap_rad(heading.yaw_offset_rad - yaw) == pytest.approx(0.0, abs=1e-9)


@given(yaw=ANGLES)
def test_averages_a_compass_across_the_wrap(yaw: float) -> None:
    """Samples on both sides of west must not average to east."""
    heading = StartHeading(0.0)
    for index in range(30):
        spread = 0.2 if index % 2 else -0.2
        heading.compass(index * 100_000_000, wrap_rad(pi + spread), wxyz_from_yaw(yaw))
    assert heading.yaw_offset_rad is not None
    assert abs(wrap_rad(heading.yaw_offset_rad + yaw - pi)) < 0.15


def test_a_course_needs_walking_and_agreement() -> None:
    """A standing rig's fixes wander: they must not set north."""
    heading = StartHeading(0.0)
    for index in range(20):
        heading.course((0.3 * cos(index), 0.3 * sin(index), 0.0), wxyz_from_yaw(0.0))
        heading.course((1.3 * cos(2.5 * index), 1.3 * sin(2.5 * index), 0.0), wxyz_from_yaw(0.0))
    assert heading.yaw_offset_rad is None
    for _ in range(6):
        heading.course((0.0, 1.3, 0.0), wxyz_from_yaw(0.5))
    assert heading.yaw_offset_rad == pytest.approx(pi / 2 - 0.5)


def test_the_first_word_of_a_compass_is_used_and_small_changes_are_not() -> None:
    """Pictures are right from the start; the world turns once more only if the mean says something else."""
    heading = StartHeading(0.0)
    heading.compass(0, 1.0, wxyz_from_yaw(0.0))
    assert heading.yaw_offset_rad == 1.0
    for index in range(1, 30):
        heading.compass(index * 100_000_000, 1.03, wxyz_from_yaw(0.0))
    assert heading.yaw_offset_rad == 1.0
    assert heading.is_final
    jumpy = StartHeading(0.0)
    for index in range(30):
        jumpy.compass(index * 100_000_000, 1.0 if index else 2.0, wxyz_from_yaw(0.0))
    assert jumpy.yaw_offset_rad == pytest.approx(1.0, abs=0.11)


def _gains(heading: StartHeading, yaw: float, count: int) -> None:
    """Starts and stops in turning directions, felt in a level frame that is off by yaw."""
    for index in range(count):
        x, y = cos(2.4 * index), sin(2.4 * index)
        heading.gain((x * cos(yaw) + y * sin(yaw), y * cos(yaw) - x * sin(yaw)), (x, y))


@given(yaw=ANGLES)
def test_gains_of_velocity_find_north_whatever_the_rig_looks_at(yaw: float) -> None:
    """And they stand for good once there are enough of them."""
    heading, unsure = StartHeading(0.0), StartHeading(0.0)
    _gains(unsure, yaw, 2)
    assert unsure.yaw_offset_rad is None
    _gains(heading, yaw, 100)
    assert heading.is_final
    assert heading.yaw_offset_rad is not None
    assert wrap_rad(heading.yaw_offset_rad - yaw) == pytest.approx(0.0, abs=1e-9)


def test_gains_win_over_a_course_that_contradicts_them() -> None:
    """A rig held backwards: the course says 180 degrees, the accelerometer knows better."""
    heading = StartHeading(0.0)
    for _ in range(12):
        heading.course((1.3, 0.0, 0.0), wxyz_from_yaw(0.0))
    assert heading.yaw_offset_rad == pytest.approx(0.0)
    _gains(heading, 3.0, 12)
    assert heading.yaw_offset_rad == pytest.approx(3.0, abs=1e-6)


def test_gains_that_do_not_match_say_nothing() -> None:
    """Small ones are noise; incoherent ones are two different motions."""
    heading = StartHeading(0.0)
    for index in range(200):
        heading.gain((cos(index), sin(index)), (cos(2.5 * index), sin(2.5 * index)))
        heading.gain((0.3, 0.0), (0.3, 0.0))
    assert heading.yaw_offset_rad is None
