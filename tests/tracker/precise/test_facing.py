"""Which way a walker goes, beside the way that they face."""

from math import cos, pi, radians, sin

import numpy as np
import pytest

from tracker.geometry import wrap_rad, wxyz_from_yaw
from tracker.measurements import Vector3
from tracker.precise.facing import Facing


def _going(course_rad: float) -> Vector3:
    return (1.2 * cos(course_rad), 1.2 * sin(course_rad), 0.0)


def _learn(facing: Facing, quarters: int, aside_rad: float) -> None:
    for step in range(quarters):
        yaw_rad = 0.1 * step
        facing.learn(_going(yaw_rad + aside_rad), wxyz_from_yaw(wrap_rad(yaw_rad)))


def test_before_anything_is_known_one_goes_ahead() -> None:
    assert Facing().course_rad(wxyz_from_yaw(1.0)) == pytest.approx(1.0)


@pytest.mark.parametrize("aside_deg", [-60.0, 15.0, 90.0, 175.0])
def test_a_rig_that_is_worn_askew_is_learned_whichever_way_one_goes(aside_deg: float) -> None:
    facing = Facing()
    _learn(facing, 500, radians(aside_deg))
    assert facing.aside_rad == pytest.approx(radians(aside_deg), abs=radians(2.0))
    assert facing.spread_rad < radians(4.0)


def test_a_glance_aside_is_not_how_a_rig_is_worn() -> None:
    """Two and a half seconds of looking to the side, just when the receiver falls silent."""
    facing = Facing()
    _learn(facing, 60, 0.0)
    _learn(facing, 10, radians(-60.0))
    assert abs(facing.aside_rad) < radians(2.0)


def test_of_a_rig_in_the_hand_that_points_anywhere_the_facing_tells_nothing() -> None:
    facing, rng = Facing(), np.random.default_rng(7)
    for aside_rad in rng.uniform(-pi, pi, 400).tolist():
        facing.learn(_going(aside_rad), (1.0, 0.0, 0.0, 0.0))
    assert facing.spread_rad > 1.0


def test_who_stands_goes_nowhere() -> None:
    facing = Facing()
    for _ in range(400):
        facing.learn((0.0, 0.1, 0.0), (1.0, 0.0, 0.0, 0.0))
    assert facing.aside_rad == 0.0
