"""The chain of keyframes: displacements add up in site, and gaps are bridged by the IMU."""

import numpy as np
import pytest

from tracker.camera_path import CameraPath
from tracker.measurements import VisualMotion
from tracker.rig import R_BODY_CAM_FORWARD

S = 1_000_000_000
EAST = R_BODY_CAM_FORWARD  # a camera that looks east, upright
NOWHERE = (0.0, 0.0, 0.0)


def _motion(t_s: float, t_key_s: float, direction: tuple[float, float, float]) -> VisualMotion:
    t_ns, key_ns = int(t_s * S), int(t_key_s * S)
    return VisualMotion(t_ns, t_ns, 0, key_ns, np.eye(3), direction, 100, 5.0, False)


def test_steps_add_up_from_the_keyframe() -> None:
    """A second picture of the same keyframe does not add to the first; one of another keyframe does."""
    path = CameraPath()
    key = path.begin(0, EAST, NOWHERE)
    path.chain(_motion(0.5, 0.0, (0.0, 0.0, 1.0)), key, (0.6, 0.0, 0.0), EAST, NOWHERE)
    path.chain(_motion(1.0, 0.0, (0.0, 0.0, 1.0)), key, (1.2, 0.0, 0.0), EAST, NOWHERE)
    newest = path.newest
    assert newest is not None
    assert newest.p_m == pytest.approx((1.2, 0.0, 0.0))
    held = path.held(1 * S)
    assert held is newest
    path.chain(_motion(1.5, 1.0, (1.0, 0.0, 0.0)), held, (0.0, -0.5, 0.0), EAST, NOWHERE)
    assert path.newest is not None
    assert path.newest.p_m == pytest.approx((1.2, -0.5, 0.0))


def test_tr_is_the_step_in_the_keyframes_own_axes() -> None:
    """Forward is the optical axis, east here; south is to the camera's right."""
    path = CameraPath()
    key = path.begin(0, EAST, NOWHERE)
    path.chain(_motion(0.5, 0.0, (0.0, 0.0, 1.0)), key, (0.6, 0.0, 0.0), EAST, NOWHERE)
    assert path.Tr[:3, 3] == pytest.approx((0.0, 0.0, 0.6))
    path.chain(_motion(0.6, 0.0, (1.0, 0.0, 0.0)), key, (0.0, -0.5, 0.0), EAST, NOWHERE)
    assert path.Tr[:3, 3] == pytest.approx((0.5, 0.0, 0.0))


def test_a_gap_is_bridged_by_the_inertial_path() -> None:
    """Dark seconds: the next keyframe begins where the IMU says."""
    path = CameraPath()
    path.chain(_motion(0.5, 0.0, NOWHERE), path.begin(0, EAST, NOWHERE), NOWHERE, EAST, (1.0, 0.0, 0.0))
    assert path.begin(9 * S, EAST, (5.0, 2.0, 0.0)).p_m == (4.0, 2.0, 0.0)


def test_near_means_half_a_second() -> None:
    """The picture of a fix is the nearest, and none where none is near."""
    path = CameraPath()
    for tenth in (1, 2, 3):
        path.chain(_motion(tenth / 10, 0.0, NOWHERE), path.begin(0, EAST, NOWHERE), NOWHERE, EAST, NOWHERE)
    near = path.near(int(0.22 * S))
    assert near is not None
    assert near.t_ns == int(0.2 * S)
    assert path.near(int(0.81 * S)) is None
    assert path.held(int(0.25 * S)) is None
