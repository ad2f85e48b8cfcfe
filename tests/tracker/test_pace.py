"""The walker's pace: remembered while it is known, given back while nothing else is."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import wxyz_from_yaw
from tracker.pace import Pace

G = 9.81
NORTH_IS_KNOWN = (1.0, 0.0)


def _feel(pace: Pace, seconds: float, yaw_rad: float, step_m_s2: float) -> None:
    """Two steps a second while facing a direction."""
    for index in range(int(seconds * 60)):
        pace.step((0.0, 0.0, G + step_m_s2 * sin(2.0 * pi * 2.0 * index / 60)), wxyz_from_yaw(yaw_rad), 1.0 / 60)


@given(yaw=st.floats(-3.1, 3.1), aside=st.floats(-1.0, 1.0), turn=st.floats(-1.5, 1.5))
def test_goes_on_as_fast_and_turns_with_the_walker(yaw: float, aside: float, turn: float) -> None:
    """Whoever looks a little aside of their path still does after a corner."""
    pace = Pace()
    _feel(pace, 3.0, yaw, 2.0)
    for _ in range(20):
        pace.learn((1.3 * cos(yaw + aside), 1.3 * sin(yaw + aside), 0.0), NORTH_IS_KNOWN)
    _feel(pace, 12.0, yaw + turn, 2.0)
    assert pace.is_walking
    expected = (1.3 * cos(yaw + aside + turn), 1.3 * sin(yaw + aside + turn), 0.0)
    assert pace.velocity_m_s(NORTH_IS_KNOWN) == pytest.approx(expected, abs=0.02)


def test_who_stands_does_not_go_on() -> None:
    """No steps, no velocity; slow velocities teach no direction."""
    pace = Pace()
    assert pace.velocity_m_s(NORTH_IS_KNOWN) == (0.0, 0.0, 0.0)
    _feel(pace, 3.0, 0.0, 2.0)
    pace.learn((1.2, 0.0, 0.0), NORTH_IS_KNOWN)
    pace.learn((0.0, 0.3, 0.0), NORTH_IS_KNOWN)
    assert pace.velocity_m_s(NORTH_IS_KNOWN)[0] == pytest.approx(1.2)
    _feel(pace, 5.0, 0.0, 0.05)
    assert not pace.is_walking
    assert pace.velocity_m_s(NORTH_IS_KNOWN) == (0.0, 0.0, 0.0)
