"""Rotations: laws on random attitudes, and scipy as the second implementation."""

from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker import geometry as g
from tracker.measurements import Vector3, Wxyz

component = st.floats(-1.0, 1.0)
vectors = st.tuples(component, component, component)
quaternions = (
    st.tuples(component, component, component, component)
    .filter(lambda q: sum(c * c for c in q) > 1e-3)
    .map(g.normalise)
)


def scipy_of(q: Wxyz) -> Rotation:
    return Rotation.from_quat([q[1], q[2], q[3], q[0]])


@given(quaternions, quaternions, vectors)
def test_multiply_and_rotate_agree_with_scipy(a: Wxyz, b: Wxyz, v: Vector3) -> None:
    theirs = (scipy_of(a) * scipy_of(b)).apply(v)
    assert np.allclose(g.rotate(g.multiply(a, b), v), theirs, atol=1e-12)
    assert np.allclose(g.matrix_from_wxyz(a), scipy_of(a).as_matrix(), atol=1e-12)


@given(quaternions)
def test_a_rotation_and_its_inverse_cancel(q: Wxyz) -> None:
    assert np.allclose(g.multiply(q, g.conjugate(q)), g.IDENTITY, atol=1e-12)


@given(st.tuples(*[st.floats(-1.8, 1.8)] * 3))
def test_log_undoes_exp_up_to_half_a_turn(v: Vector3) -> None:
    if np.linalg.norm(v) < pi - 1e-6:
        assert np.allclose(g.log(g.exp(v)), v, atol=1e-9)


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-8, 1e-5, 1e-4, 1.0001e-4, pi - 1e-9])
def test_exp_and_log_hold_near_their_singular_points(size: float) -> None:
    v = (0.6 * size, -0.8 * size, 0.0)
    assert np.allclose(g.exp(v)[1:], Rotation.from_rotvec(v).as_quat()[:3], atol=1e-15)
    assert np.allclose(g.log(g.exp(v)), v, atol=1e-9)


@given(quaternions)
def test_matrix_and_angle_round_trips(q: Wxyz) -> None:
    assert g.angle_between_rad(g.wxyz_from_matrix(g.matrix_from_wxyz(q)), q) < 1e-6
    assert g.angle_between_rad(g.wxyz_from_rpy(g.rpy_from_wxyz(q)), q) < 1e-5


@given(quaternions)
def test_roll_pitch_yaw_are_those_of_scipy(q: Wxyz) -> None:
    angles = g.rpy_from_wxyz(q)
    if abs(angles[1]) < 1.5:
        differences = [
            g.wrap_rad(ours - theirs) for ours, theirs in zip(angles, scipy_of(q).as_euler("ZYX")[::-1], strict=True)
        ]
        assert np.allclose(differences, 0.0, atol=1e-7)


@given(st.floats(-50.0, 50.0))
def test_wrap_keeps_the_direction(angle_rad: float) -> None:
    wrapped = g.wrap_rad(angle_rad)
    assert -pi <= wrapped < pi
    assert np.isclose(np.cos(wrapped), np.cos(angle_rad), atol=1e-9)


@given(st.floats(-3.0, 3.0), st.floats(-1.4, 1.4), st.floats(-3.1, 3.1))
def test_gravity_gives_the_tilt_back(yaw: float, pitch: float, roll: float) -> None:
    """An attitude rebuilt from the gravity it feels and its own yaw is the attitude itself."""
    attitude = Rotation.from_euler("ZYX", [yaw, pitch, roll])
    up_body = attitude.inv().apply([0.0, 0.0, 9.81])
    level = g.wxyz_level_from_gravity((float(up_body[0]), float(up_body[1]), float(up_body[2])))
    assert np.allclose(g.rotate(level, tuple(up_body)), (0.0, 0.0, 9.81), atol=1e-9)
    x, y, z, w = (float(c) for c in attitude.as_quat())
    assert g.angle_between_rad(g.multiply(g.wxyz_from_yaw(yaw), level), (w, x, y, z)) < 1e-6


@given(quaternions, quaternions)
def test_slerp_ends_where_it_says(a: Wxyz, b: Wxyz) -> None:
    assert g.angle_between_rad(g.slerp(a, b, 0.0), a) < 1e-6
    assert g.angle_between_rad(g.slerp(a, b, 1.0), b) < 1e-6


@given(quaternions, vectors)
def test_inverse_transform(q: Wxyz, p: Vector3) -> None:
    assert np.allclose(g.inverse(g.transform(q, p)) @ g.transform(q, p), np.eye(4), atol=1e-12)


def test_nothing_can_be_normalised_from_zero() -> None:
    with pytest.raises(ValueError, match="length"):
        g.normalise((0.0, 0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="specific force"):
        g.wxyz_level_from_gravity((0.0, 0.0, 0.0))
