"""The start heading's error, seen by the camera while walking."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.visual_course import VisualCourse

S = 1_000_000_000


def _walked(turn_rad: float, steps: int = 20) -> VisualCourse:
    """A walk on a circle whose camera's directions are off by an angle."""
    course = VisualCourse()
    for index in range(steps):
        at = 0.3 * index
        course.step(index * S // 4, (cos(at - turn_rad), sin(at - turn_rad)), (0.4 * cos(at), 0.4 * sin(at)))
    return course


@given(st.floats(-pi + 0.001, pi - 0.001))
def test_any_angle_is_found(turn_rad: float) -> None:
    course = _walked(turn_rad)
    assert course.turn_rad == pytest.approx(turn_rad, abs=1e-9)
    assert course.turned((cos(1.0 - turn_rad), sin(1.0 - turn_rad))) == pytest.approx((cos(1.0), sin(1.0)))


def test_a_few_steps_are_not_believed() -> None:
    course = _walked(0.5, steps=5)
    assert course.turn_rad is None
    assert course.turned((1.0, 0.0)) is None


def test_directions_that_disagree_are_not_believed() -> None:
    course = VisualCourse()
    for index in range(40):
        course.step(index * S // 4, (cos(2.0 * index), sin(2.0 * index)), (0.4, 0.0))
    assert course.turn_rad is None


def test_standing_and_looking_up_tell_nothing() -> None:
    course = VisualCourse()
    for index in range(40):
        course.step(index * S // 4, (1.0, 0.0), (0.001, 0.0))
        course.step(index * S // 4, (0.1, 0.0), (0.4, 0.0))
    assert course.turn_rad is None


def test_an_old_angle_gives_way() -> None:
    course = _walked(0.5)
    for index in range(2000, 2040):
        course.step(index * S // 4, (cos(0.2), sin(0.2)), (0.4, 0.0))
    assert course.turn_rad == pytest.approx(-0.2, abs=0.01)


@given(st.floats(-pi + 0.001, pi - 0.001))
def test_a_correction_leaves_nothing_to_correct(turn_rad: float) -> None:
    course = _walked(turn_rad)
    course.turn(turn_rad)
    assert course.turn_rad == pytest.approx(0.0, abs=1e-9)
