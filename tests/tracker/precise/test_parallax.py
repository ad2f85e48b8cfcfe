"""What features say of poses: laws that need no second implementation."""

import numpy as np
import pytest
from numpy.random import Generator

from tests.tracker.precise.points import seen_from
from tracker.geometry import exp, matrix_from_wxyz
from tracker.measurements import Matrix
from tracker.precise.parallax import Cameras, constraint
from tracker.precise.tracks import seen_in
from tracker.rig import R_BODY_CAM_FORWARD

SIGMA = 0.001
LEVER_M = np.array([0.1, -0.05, 0.08])
PICTURES = 6
SURE = 1e-12 * np.eye(6 * PICTURES)
EVERYTHING = 1e9


def poses(rng: Generator) -> tuple[Matrix, Matrix]:
    """Bodies that walk ahead and look about a little: rotations (K, 3, 3) and places (K, 3)."""
    turns = [exp(tuple(0.1 * rng.normal(size=3))) for _ in range(PICTURES)]
    R_site_body = np.array([matrix_from_wxyz(turn) for turn in turns])
    return R_site_body, np.array([[0.4 * k, 0.0, 1.65] for k in range(PICTURES)]) + 0.05 * rng.normal(
        size=(PICTURES, 3)
    )


def cameras(R_site_body: Matrix, p_m: Matrix) -> Cameras:
    lever_m = R_site_body @ LEVER_M
    return Cameras(R_site_body @ R_BODY_CAM_FORWARD, p_m + lever_m, lever_m)


def moved(R_site_body: Matrix, p_m: Matrix, error: Matrix) -> tuple[Matrix, Matrix]:
    """Return the poses moved by an error as the filter writes it, (6 K,)."""
    by = error.reshape(-1, 6)
    turned = np.array([matrix_from_wxyz(exp(tuple(row))) for row in by[:, 3:]]) @ R_site_body
    return turned, p_m + by[:, :3]


def drawn(seed: int) -> tuple[Matrix, Matrix, Matrix]:
    rng = np.random.default_rng(seed)
    R_site_body, p_m = poses(rng)
    points_m = np.column_stack([rng.uniform(6.0, 25.0, 60), rng.uniform(-8.0, 8.0, 60), rng.uniform(-1.0, 6.0, 60)])
    true = cameras(R_site_body, p_m)
    xy = seen_from(true.R_site_cam, true.p_site_m, points_m)
    return R_site_body, p_m, xy[seen_in(xy).sum(axis=1) >= 3]


@pytest.mark.parametrize("seed", range(5))
def test_the_slope_is_that_of_the_residual(seed: int) -> None:
    """Poses that are off by a little are told just that, as far as anything is told: H^T r = H^T H e."""
    R_site_body, p_m, xy = drawn(seed)
    error = 1e-4 * np.random.default_rng([seed, 1]).normal(size=6 * PICTURES)
    none, e = np.zeros_like(error), error
    told = []
    for off in (none, e):
        said = constraint(cameras(*moved(R_site_body, p_m, -off)), xy, SIGMA, SURE, EVERYTHING)
        told.append((said.H.T @ said.residual, said.H.T @ said.H))
    (at_rest, _), (away, information) = told
    expected = information @ error
    assert away - at_rest == pytest.approx(expected, abs=0.02 * np.abs(expected).max())


@pytest.mark.parametrize("seed", range(5))
def test_nobody_can_tell_where_all_of_it_is_nor_how_large(seed: int) -> None:
    """Cameras moved or turned as one see the same, and so do some that are twice as far apart in a world twice as large."""
    R_site_body, p_m, xy = drawn(seed)
    said = constraint(cameras(R_site_body, p_m), xy, SIGMA, SURE, EVERYTHING)
    as_one = np.zeros((PICTURES, 6, 6))
    as_one[:, :, :] = np.eye(6)
    for k, (x, y, z) in enumerate(p_m):
        as_one[k, :3, 3:] = -np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    apart = np.zeros((PICTURES, 6))
    apart[:, :3] = cameras(R_site_body, p_m).p_site_m - p_m[0]
    assert np.abs(said.H @ apart.ravel()).max() < 1e-6 * np.abs(said.H).max()
    assert np.abs(said.H @ as_one.reshape(-1, 6)).max() < 1e-6 * np.abs(said.H).max()


def test_what_is_not_there_says_nothing() -> None:
    """Features that slipped are left out, and a picture in which one was not seen has no say by it."""
    R_site_body, p_m, xy = drawn(7)
    slipped = xy.copy()
    slipped[::6, 2:4] += 0.2
    clean = constraint(cameras(R_site_body, p_m), np.delete(xy, np.s_[::6], axis=0), SIGMA, SURE, 9.0)
    said = constraint(cameras(R_site_body, p_m), slipped, SIGMA, SURE, 9.0)
    assert pytest.approx(clean.H.T @ clean.H, rel=1e-6) == said.H.T @ said.H
    alone = constraint(cameras(R_site_body, p_m), slipped[::6], SIGMA, SURE, 9.0)
    assert (len(alone.residual), alone.H.shape) == (0, (0, 6 * PICTURES))
    assert alone.misfit > 100.0
    half = xy.copy()
    half[:, 5] = np.nan
    said = constraint(cameras(R_site_body, p_m), half, SIGMA, SURE, EVERYTHING)
    assert np.abs(said.H[:, 30:]).max() == 0.0


def test_a_doubtful_pose_does_not_make_a_mismatch() -> None:
    """What is far off only because the filter knew no better is taken in."""
    R_site_body, p_m, xy = drawn(8)
    error = np.zeros((PICTURES, 6))
    error[3, :3] = 0.3
    away, said = cameras(*moved(R_site_body, p_m, error.ravel())), []
    for doubt in (SURE, 0.1 * np.eye(6 * PICTURES)):
        said.append(float(np.sum(constraint(away, xy, SIGMA, doubt, 9.0).H ** 2)))
    sure, doubtful = said
    assert sure < 0.3 * doubtful
