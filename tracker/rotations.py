"""Many rotations at once, as arrays: (N, 4) unit quaternions wxyz, Hamilton, and (N, 3) rotation vectors; nothing else."""

import numpy as np

from tracker.measurements import Matrix


def multiply(a: Matrix, b: Matrix) -> Matrix:
    """Return (N, 4) rotations that do b first, then a."""
    aw, ax, ay, az = a.T
    bw, bx, by, bz = b.T
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=1,
    )


def conjugate(q: Matrix) -> Matrix:
    """Return the (N, 4) inverse rotations."""
    return np.asarray(q * (1.0, -1.0, -1.0, -1.0))


def exp(rotation_rad: Matrix) -> Matrix:
    """Return the (N, 4) quaternions of (N, 3) rotation vectors."""
    half = 0.5 * np.linalg.norm(rotation_rad, axis=1)
    return np.column_stack([np.cos(half), 0.5 * np.sinc(half / np.pi)[:, None] * rotation_rad])


def log(q: Matrix) -> Matrix:
    """Return the (N, 3) rotation vectors of (N, 4) unit quaternions, of the shorter way round."""
    q = np.where(q[:, :1] < 0.0, -q, q)
    sine = np.linalg.norm(q[:, 1:], axis=1)
    half = np.arctan2(sine, q[:, 0])
    return np.asarray(q[:, 1:] * (2.0 / np.sinc(half / np.pi))[:, None])


def matrices(q: Matrix) -> Matrix:
    """Return (N, 3, 3) rotation matrices."""
    w, x, y, z = q.T
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def nearest_rotation(a: Matrix, b: Matrix, weights: Matrix) -> Matrix:
    """Return R, (3, 3), that best lays the (N, 3) vectors b on a: least sum of weights times |a - R b|² (Wahba's problem)."""
    u, _, vt = np.linalg.svd((a * weights[:, None]).T @ b)
    return np.asarray(u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt)
