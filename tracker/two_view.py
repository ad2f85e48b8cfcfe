"""Two views of rigid points: the rotation between them, and where that is not enough the direction of travel. Numpy only.

Rays are written as (x, y) on the plane z = 1 of their camera. `key` is the held keyframe's camera, `cam` the present one.
"""

import numpy as np

from tracker.measurements import Matrix

#: Cauchy's scale for 95 % efficiency on Gaussian errors.
CAUCHY_SCALE = 2.385
ROTATION_STEPS = 8
REFINE_STEPS = 6


def bearings(xy: Matrix) -> Matrix:
    """Return (N, 3) unit vectors of (N, 2) rays."""
    rays = np.column_stack([xy, np.ones(len(xy))])
    return np.asarray(rays / np.linalg.norm(rays, axis=1)[:, None])


def fit_rotation(bearings_key: Matrix, bearings_cam: Matrix, sigma_rad: float) -> Matrix:
    """Return R_key_cam, (3, 3), that best lays the present bearings on the keyframe's (Wahba's problem, reweighted).

    Cauchy weights pull the answer to what turns as one, the far points, and away from near points and mismatches.

    Args:
        bearings_key: (N, 3) unit vectors, N >= 2.
        bearings_cam: (N, 3), the same points now.
        sigma_rad: Error of one bearing; differences far above it lose their say.

    Reference:
        Markley, Attitude determination using vector observations and the singular value decomposition, 1988.
    """
    weights = np.ones(len(bearings_key))
    R_key_cam = np.eye(3)
    for _ in range(ROTATION_STEPS):
        u, _, vt = np.linalg.svd((bearings_key * weights[:, None]).T @ bearings_cam)
        R_key_cam = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
        error_rad = np.linalg.norm(bearings_key - bearings_cam @ R_key_cam.T, axis=1)
        scale = CAUCHY_SCALE * max(sigma_rad, 1.4826 * float(np.median(error_rad)))
        weights = 1.0 / (1.0 + (error_rad / scale) ** 2)
    return np.asarray(R_key_cam)


def parallax(bearings_key: Matrix, bearings_cam: Matrix, R_key_cam: Matrix) -> Matrix:
    """Return (N,) radians of displacement that the rotation does not explain."""
    return np.asarray(np.linalg.norm(bearings_key - bearings_cam @ R_key_cam.T, axis=1))


def sampson(bearings_key: Matrix, bearings_cam: Matrix, R_key_cam: Matrix, direction_key: Matrix) -> Matrix:
    """Return (N,) signed angular epipolar errors, radians: how far each pair is from coplanar with the baseline."""
    residual, _ = _residual_and_jacobian(bearings_key, bearings_cam, R_key_cam, direction_key)
    return residual


def refine(
    bearings_key: Matrix, bearings_cam: Matrix, R_key_cam: Matrix, direction_key: Matrix, sigma_rad: float
) -> tuple[Matrix, Matrix]:
    """Return (R_key_cam, direction_key) of least reweighted epipolar error, from a start nearby (Gauss-Newton).

    The essential matrix of five points carries those points' noise; this uses every inlier.

    Args:
        bearings_key: (N, 3) inliers.
        bearings_cam: (N, 3), the same points now.
        R_key_cam: (3, 3) start.
        direction_key: (3,) unit vector, start.
        sigma_rad: Error of one bearing.
    """
    for _ in range(REFINE_STEPS):
        residual, jacobian = _residual_and_jacobian(bearings_key, bearings_cam, R_key_cam, direction_key)
        weights = 1.0 / (1.0 + (residual / (CAUCHY_SCALE * sigma_rad)) ** 2)
        tangent = _tangent_basis(direction_key)
        full = np.column_stack([jacobian[:, :3], jacobian[:, 3:] @ tangent])
        normal = (full * weights[:, None]).T @ full
        # a hair of damping: where the baseline is short its direction is nearly free
        step = -np.linalg.solve(normal + 1e-9 * np.trace(normal) * np.eye(5), (full * weights[:, None]).T @ residual)
        R_key_cam = rotation_from_vector(step[:3]) @ R_key_cam
        direction_key = direction_key + tangent @ step[3:]
        direction_key = direction_key / np.linalg.norm(direction_key)
        if float(np.abs(step).max()) < 1e-7:
            break
    return np.asarray(R_key_cam), np.asarray(direction_key)


def rotation_from_vector(rotation_rad: Matrix) -> Matrix:
    """Return the (3, 3) rotation of a (3,) rotation vector (Rodrigues)."""
    angle = float(np.linalg.norm(rotation_rad))
    x, y, z = rotation_rad
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    if angle < 1e-8:
        return np.asarray(np.eye(3) + cross)
    return np.asarray(
        np.eye(3) + (np.sin(angle) / angle) * cross + ((1.0 - np.cos(angle)) / angle**2) * (cross @ cross)
    )


def _residual_and_jacobian(b_key: Matrix, b_cam: Matrix, R_key_cam: Matrix, direction: Matrix) -> tuple[Matrix, Matrix]:
    """Return (N,) Sampson errors and their (N, 6) slopes by a rotation of R_key_cam (key axes) and by direction."""
    turned = b_cam @ R_key_cam.T
    normal_cam = np.cross(direction, turned)
    normal_key = np.cross(direction, b_key)
    algebraic = np.einsum("ij,ij->i", b_key, normal_cam)
    # of a unit-bearing epipolar error the gradient by each bearing is its epipolar plane's normal
    size = np.sqrt(np.einsum("ij,ij->i", normal_cam, normal_cam) + np.einsum("ij,ij->i", normal_key, normal_key))
    size = np.maximum(size, 1e-6)
    # b_key · (d × (w × turned)) = w · (turned × (b_key × d)), and b_key · (d × turned) = d · (turned × b_key)
    by_rotation = np.cross(turned, -normal_key)
    by_direction = np.cross(turned, b_key)
    return algebraic / size, np.column_stack([by_rotation, by_direction]) / size[:, None]


def _tangent_basis(direction: Matrix) -> Matrix:
    """Return (3, 2) orthonormal vectors at right angles to a unit vector."""
    helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = np.cross(direction, helper)
    first = first / np.linalg.norm(first)
    return np.column_stack([first, np.cross(direction, first)])
