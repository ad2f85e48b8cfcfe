"""Cross products with vectors, as matrices."""

import numpy as np

from tracker.measurements import Matrix


def cross_matrices(v: Matrix) -> Matrix:
    """Return [v]x of (..., 3) vectors, (..., 3, 3)."""
    cross = np.zeros((*v.shape[:-1], 3, 3))
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return np.asarray(cross - np.swapaxes(cross, -1, -2))
