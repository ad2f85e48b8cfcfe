"""Pictures are turned upright by gravity, in quarter turns that do not flutter."""

from math import cos, radians, sin

import numpy as np
import pytest

from tracker.measurements import ImuSample
from tracker.rig import Rig
from tracker.upright import Upright


def _sample(roll_rad: float) -> ImuSample:
    """A rig that looks level along body x, rolled to its right by an angle."""
    return ImuSample(0, 0, (0.0, 0.0, 0.0), (0.0, 9.81 * sin(roll_rad), 9.81 * cos(roll_rad)))


@pytest.mark.parametrize(("roll_deg", "turns"), [(0, 0), (90, 3), (180, 2), (-90, 1)])
def test_the_turn_undoes_the_roll(roll_deg: float, turns: int) -> None:
    """A camera rolled clockwise shows the world turned counter-clockwise: turning the picture clockwise as far rights it."""
    upright = Upright(Rig())
    upright.step(_sample(radians(-roll_deg)))
    assert upright.quarter_turns == turns


def test_a_phone_held_upright() -> None:
    """The sky is at the left of the stored picture: image right is down. One turn clockwise."""
    T_body_cam = np.eye(4)
    # columns: image right = down, image down = left, forward = forward, in body axes (forward, left, up)
    T_body_cam[:3, :3] = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    upright = Upright(Rig(T_body_cam=T_body_cam))
    upright.step(_sample(0.0))
    assert upright.quarter_turns == 1


def test_a_tilted_head_does_not_flutter() -> None:
    """Around 45 degrees nothing changes; well beyond it does, after a while."""
    upright = Upright(Rig())
    upright.step(_sample(0.0))
    for degrees in (40.0, 50.0) * 2000:
        upright.step(_sample(radians(degrees)))
        assert upright.quarter_turns == 0
    for _ in range(2000):
        upright.step(_sample(radians(85.0)))
    assert upright.quarter_turns in (1, 3)
