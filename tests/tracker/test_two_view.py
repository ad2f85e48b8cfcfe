"""Two views of points whose motion is known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker import two_view
from tracker.measurements import Matrix

SIGMA_RAD = 1e-3
SMALL = st.floats(-0.2, 0.2)


def _views(R_key_cam: Matrix, t_key: Matrix, noise_rad: float = 0.0, seed: int = 1) -> tuple[Matrix, Matrix]:
    """Bearings of 200 points 4 to 30 m ahead from a keyframe and from a camera that stands off it by t, turned by R."""
    rng = np.random.default_rng(seed)
    points = rng.uniform((-0.6, -0.5, 1.0), (0.6, 0.5, 1.0), (200, 3)) * rng.uniform(4.0, 30.0, (200, 1))
    seen = (points - t_key) @ R_key_cam
    key, cam = (v / np.linalg.norm(v, axis=1)[:, None] for v in (points, seen))
    noisy = cam + rng.normal(0.0, noise_rad, cam.shape)
    return key, noisy / np.linalg.norm(noisy, axis=1)[:, None]


def _angle_rad(a: Matrix, b: Matrix) -> float:
    return float(np.arccos(np.clip((np.trace(a.T @ b) - 1.0) / 2.0, -1.0, 1.0)))


@settings(deadline=None)
@given(x=SMALL, y=SMALL, z=SMALL)
def test_a_pure_turn_is_found_and_leaves_no_parallax(x: float, y: float, z: float) -> None:
    """A tenth of the points are mismatched, which changes nothing."""
    R = two_view.rotation_from_vector(np.array([x, y, z]))
    key, cam = _views(R, np.zeros(3))
    cam[:20] = np.roll(cam[:20], 1, axis=0)
    found = two_view.fit_rotation(key, cam, SIGMA_RAD)
    assert _angle_rad(found, R) < 1e-4
    assert np.median(two_view.parallax(key, cam, found)) < 1e-4


@settings(deadline=None, max_examples=40)
@given(turn=st.tuples(SMALL, SMALL, SMALL), azimuth=st.floats(-3.1, 3.1), rise=st.floats(-1.0, 1.0))
def test_refining_finds_the_direction_of_travel(turn: tuple[float, float, float], azimuth: float, rise: float) -> None:
    """From a start some degrees off, with a third of a pixel of noise, to less than a degree or two."""
    R = two_view.rotation_from_vector(np.array(turn))
    d = np.array([np.cos(azimuth) * np.cos(rise), np.sin(rise), np.sin(azimuth) * np.cos(rise)])
    key, cam = _views(R, d, noise_rad=3e-4)
    R_start = two_view.rotation_from_vector(np.array([0.01, -0.02, 0.01])) @ R
    d_start = two_view.rotation_from_vector(np.array([0.05, 0.05, -0.05])) @ d
    R_found, d_found = two_view.refine(key, cam, R_start, d_start, SIGMA_RAD)
    assert _angle_rad(R_found, R) < 0.003
    assert abs(float(d_found @ d)) > np.cos(0.04)
    residual = two_view.sampson(key, cam, R_found, d_found)
    assert np.sqrt(np.mean(residual**2)) == pytest.approx(3e-4, rel=0.35)


def test_slopes_agree_with_differences() -> None:
    """The Jacobian of the Sampson error, up to its denominator's own slope, which is left out near zero error."""
    R, d = two_view.rotation_from_vector(np.array([0.1, 0.05, -0.1])), np.array([0.6, 0.0, 0.8])
    key, cam = _views(R, d)
    at, slopes = two_view._residual_and_jacobian(key, cam, R, d)
    assert np.abs(at).max() < 1e-12
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = 1e-6
        turned = two_view.sampson(key, cam, two_view.rotation_from_vector(step) @ R, d)
        np.testing.assert_allclose(turned / 1e-6, slopes[:, axis], atol=1e-5)
        moved = two_view.sampson(key, cam, R, d + step)
        np.testing.assert_allclose(moved / 1e-6, slopes[:, 3 + axis], atol=1e-5)


@given(turn=st.tuples(SMALL, SMALL, SMALL))
def test_rotation_vectors_give_rotations(turn: tuple[float, float, float]) -> None:
    """Orthonormal, right-handed, of that angle."""
    R = two_view.rotation_from_vector(np.array(turn))
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    assert _angle_rad(np.eye(3), R) == pytest.approx(float(np.linalg.norm(turn)), abs=1e-6)


def test_bearings_have_unit_length() -> None:
    """And point along their rays."""
    b = two_view.bearings(np.array([[0.0, 0.0], [1.0, -1.0]]))
    np.testing.assert_allclose(b, [[0.0, 0.0, 1.0], np.array([1.0, -1.0, 1.0]) / np.sqrt(3.0)])
