"""`Tr` against scipy's rotations, and its angles there and back."""

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.transformation import euler_from_rotation, tr_from_euler, transformation

angles = st.floats(-pi, pi)
tilts = st.floats(-1.5, 1.5)


@given(angles, angles, angles)
def test_the_printed_matrix_is_rx_ry_rz(rx: float, ry: float, rz: float) -> None:
    """Capital letters in scipy: turns about the axes as they have been turned so far, x first."""
    Tr = tr_from_euler(rx, ry, rz, (1.0, 2.0, 3.0))
    assert np.allclose(Tr[:3, :3], Rotation.from_euler("XYZ", [rx, ry, rz]).as_matrix(), atol=1e-12)
    assert Tr[:3, 3].tolist() == [1.0, 2.0, 3.0]
    assert Tr[3].tolist() == [0.0, 0.0, 0.0, 1.0]


@given(angles, tilts, angles)
def test_angles_come_back(rx: float, ry: float, rz: float) -> None:
    found = euler_from_rotation(tr_from_euler(rx, ry, rz, (0.0, 0.0, 0.0))[:3, :3])
    assert np.allclose(np.cos(np.array(found) - (rx, ry, rz)), 1.0, atol=1e-9)


@pytest.mark.parametrize("ry", [pi / 2, -pi / 2])
def test_where_two_axes_fall_together_the_rotation_is_kept(ry: float) -> None:
    R = tr_from_euler(0.3, ry, -0.8, (0.0, 0.0, 0.0))[:3, :3]
    found = euler_from_rotation(R)
    assert found[0] == 0.0
    assert np.allclose(tr_from_euler(*found, (0.0, 0.0, 0.0))[:3, :3], R, atol=1e-9)


def test_a_motion_moves_a_point_of_the_camera_to_the_keyframe() -> None:
    R = Rotation.from_rotvec([0.1, -0.2, 0.3]).as_matrix()
    moved = transformation(R, (0.5, 0.0, 1.0)) @ np.array([1.0, 2.0, 3.0, 1.0])
    assert moved[:3] == pytest.approx(R @ [1.0, 2.0, 3.0] + [0.5, 0.0, 1.0])
