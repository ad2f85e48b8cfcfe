"""What features that were followed over several pictures say of the poses of these, their own places left out.

A feature is a point in the camera of the first picture that shows it: x/z, y/z and 1/z, which is 0 for what is far away. What is
likely of 1/z finds a place for features that parallax leaves open, and says nothing of the poses: of a hundred features together it
would be sure how fast the camera goes.

Reference:
    Mourikis and Roumeliotis, A multi-state constraint Kalman filter for vision-aided inertial navigation, 2007.
    Montiel, Civera and Davison, Unified inverse depth parametrization for monocular SLAM, 2006.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracker.measurements import Matrix
from tracker.precise.error_model import skews
from tracker.precise.tracks import seen_in

#: What is likely of 1/z, 1/m.
INVERSE_DEPTH, INVERSE_DEPTH_SIGMA = 0.07, 0.2
_NEAREST_INVERSE_M = 5.0
#: Points nearer to the camera's plane than this, by their distance in the first picture, are behind it as far as can be told.
_LEAST_Z = 0.05
_STEPS = 3
#: Directions of the poses of which features say less than this share of what they say of the best one are left out.
_LEAST_SHARE = 1e-6


@dataclass(frozen=True, eq=False)
class Cameras:
    """The cameras of K held pictures, each on its body."""

    R_site_cam: Matrix
    """(K, 3, 3)"""
    p_site_m: Matrix
    """(K, 3)"""
    lever_site_m: Matrix
    """(K, 3) from the body to the camera."""


@dataclass(frozen=True, eq=False)
class Constraint:
    """What features say: measured minus predicted, with noise one."""

    residual: Matrix
    """(n,), n at most 6 K; none where all features are mismatches."""
    H: Matrix
    """(n, 6 K) by the bodies' positions and rotations, site, as in `tracker/precise/error_model.py`."""
    misfit: float
    """Median over features of how far off they are, squared and by dimension; one where they are as good as is believed."""


def constraint(cameras: Cameras, xy: Matrix, sigma: float, covariance: Matrix, gate_nis: float) -> Constraint:
    """Return what features say of the poses.

    Args:
        cameras: Of the pictures.
        xy: (M, K, 2) rays of features on the plane z = 1, lens undone; NaN where one was not seen.
        sigma: Error of each.
        covariance: (6 K, 6 K) of the bodies' positions and rotations.
        gate_nis: A feature that is further off than this, squared and by dimension, is a mismatch, or moves by itself.
    """
    seen = seen_in(xy)
    anchor = np.argmax(seen, axis=1)
    relative = _Relative.of(cameras, anchor)
    point = triangulate(relative, np.where(seen[..., None], xy, 0.0), seen, anchor, sigma)
    residual, by_point, by_pose = _linearised(cameras, relative, point, xy, seen, anchor)
    residual, H = _without_points(residual / sigma, by_point / sigma, by_pose / sigma)
    S = H @ covariance @ H.transpose(0, 2, 1) + np.eye(H.shape[1])
    squared = np.sum(residual * np.linalg.solve(S, residual[..., None])[..., 0], axis=1)
    nis = squared / (2 * seen.sum(axis=1) - 3)
    good = nis < gate_nis
    weight = 1.0 / np.sqrt(1.0 + nis[good])  # Cauchy's: many slide a little, and by chance the same way
    residual, H = weight[:, None] * residual[good], weight[:, None, None] * H[good]
    return Constraint(*_compressed(residual, H), float(np.median(nis)))


@dataclass(frozen=True, eq=False)
class _Relative:
    """Every camera as seen from each feature's first one."""

    R_cam_first: Matrix
    """(M, K, 3, 3)"""
    p_cam_first_m: Matrix
    """(M, K, 3) of the first camera, in the axes of each."""

    @staticmethod
    def of(cameras: Cameras, anchor: NDArray[np.int64]) -> "_Relative":
        R, p = cameras.R_site_cam, cameras.p_site_m
        R_cam_site = R.transpose(0, 2, 1)
        return _Relative(R_cam_site @ R[anchor][:, None], _each(R_cam_site, p[anchor][:, None] - p))

    def rays(self, point: Matrix) -> tuple[Matrix, Matrix]:
        """Return where points are on each camera's plane, (M, K, 2), and their depth there by that in the first, (M, K)."""
        h = _each(self.R_cam_first, _on_plane(point)[:, None]) + point[:, 2, None, None] * self.p_cam_first_m
        z = np.maximum(h[..., 2], _LEAST_Z)
        return h[..., :2] / z[..., None], z


def triangulate(
    relative: _Relative, xy: Matrix, seen: NDArray[np.bool_], anchor: NDArray[np.int64], sigma: float
) -> Matrix:
    """Return (M, 3): x/z, y/z, 1/z of each feature in its first camera, by Gauss and Newton from its first ray."""
    first, weight = xy[np.arange(len(xy)), anchor], seen[..., None].astype(np.float64)
    prior = (sigma / INVERSE_DEPTH_SIGMA) ** 2
    point = np.column_stack([first, np.full(len(first), INVERSE_DEPTH)])
    # what is left open once the first ray holds is linear in 1/z
    ahead, base = _each(relative.R_cam_first, _on_plane(point)[:, None]), relative.p_cam_first_m
    slope = weight * (xy * base[..., 2:] - base[..., :2])
    offset = weight * (ahead[..., :2] - xy * ahead[..., 2:])
    inverse_m = (np.sum(slope * offset, axis=(1, 2)) + prior * INVERSE_DEPTH) / (np.sum(slope**2, axis=(1, 2)) + prior)
    point[:, 2] = np.clip(inverse_m, 0.0, _NEAREST_INVERSE_M)
    for _ in range(_STEPS):
        rays, z = relative.rays(point)
        by_point = weight[..., None] * _by_point(relative, rays, z)
        rows = by_point.reshape(len(xy), -1, 3)
        normal = rows.transpose(0, 2, 1) @ rows
        slope = _each(rows.transpose(0, 2, 1), (weight * (xy - rays)).reshape(len(xy), -1))
        normal[:, 2, 2] += prior
        slope[:, 2] += prior * (INVERSE_DEPTH - point[:, 2])
        point = point + np.linalg.solve(normal, slope[..., None])[..., 0]
        point[:, 2] = np.clip(point[:, 2], 0.0, _NEAREST_INVERSE_M)
    return point


def _linearised(
    cameras: Cameras,
    relative: _Relative,
    point: Matrix,
    xy: Matrix,
    seen: NDArray[np.bool_],
    anchor: NDArray[np.int64],
) -> tuple[Matrix, Matrix, Matrix]:
    """Return residuals (M, 2 K), and their slopes by the points, (M, 2 K, 3), and by the bodies' poses, (M, 2 K, 6 K)."""
    count, pictures = seen.shape
    rays, z = relative.rays(point)
    residual = np.where(seen[..., None], xy - rays, 0.0)
    by_point = np.where(seen[..., None, None], _by_point(relative, rays, z), 0.0)
    by_site = np.where(seen[..., None, None], _by_plane(rays, z) @ cameras.R_site_cam.transpose(0, 2, 1), 0.0)
    inverse_m, lever = point[:, 2, None, None, None], skews(cameras.lever_site_m)
    to_first = _each(cameras.R_site_cam[anchor], _on_plane(point))
    to = to_first[:, None] + point[:, 2, None, None] * (cameras.p_site_m[anchor][:, None] - cameras.p_site_m)
    own = np.concatenate([-inverse_m * by_site, by_site @ (skews(to) + inverse_m * lever)], axis=-1)
    turn_first = skews(to_first)[:, None] + inverse_m * lever[anchor][:, None]
    of_first = np.concatenate([inverse_m * by_site, -by_site @ turn_first], axis=-1)
    by_pose = np.zeros((count, pictures, 2, pictures, 6))
    each, rows = np.arange(pictures), np.arange(count)
    by_pose[:, each, :, each] = own.transpose(1, 0, 2, 3)
    by_pose[rows, :, :, anchor] += of_first
    return (
        residual.reshape(count, -1),
        by_point.reshape(count, -1, 3),
        by_pose.reshape(count, 2 * pictures, 6 * pictures),
    )


def _without_points(residual: Matrix, by_point: Matrix, by_pose: Matrix) -> tuple[Matrix, Matrix]:
    """Return residuals and slopes across all that the points could explain, of noise one as before."""
    Q, _ = np.linalg.qr(by_point, mode="complete")
    across = Q[:, :, 3:].transpose(0, 2, 1)
    return _each(across, residual), across @ by_pose


def _compressed(residual: Matrix, H: Matrix) -> tuple[Matrix, Matrix]:
    """Return as few rows that say the same: no more than there are columns."""
    H = H.reshape(-1, H.shape[-1])
    found, axes = np.linalg.eigh(H.T @ H)
    kept = (found > _LEAST_SHARE * found[-1]) & (found > 0.0)
    root, axes = np.sqrt(found[kept]), axes[:, kept]
    return (axes.T @ (H.T @ residual.ravel())) / root, root[:, None] * axes.T


def _by_point(relative: _Relative, rays: Matrix, z: Matrix) -> Matrix:
    """Return slopes of rays by x/z, y/z and 1/z in the first camera, (M, K, 2, 3)."""
    h = np.concatenate([relative.R_cam_first[..., :2], relative.p_cam_first_m[..., None]], axis=-1)
    return np.asarray(_by_plane(rays, z) @ h)


def _by_plane(rays: Matrix, z: Matrix) -> Matrix:
    """Return slopes of rays by the point in the camera's axes, (M, K, 2, 3)."""
    slopes = np.zeros((*z.shape, 2, 3))
    slopes[..., 0, 0] = slopes[..., 1, 1] = 1.0
    slopes[..., 2] = -rays
    return slopes / z[..., None, None]


def _each(matrices: Matrix, vectors: Matrix) -> Matrix:
    """Return the product of each matrix with its vector."""
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def _on_plane(point: Matrix) -> Matrix:
    return np.column_stack([point[:, :2], np.ones(len(point))])
