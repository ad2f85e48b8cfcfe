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
