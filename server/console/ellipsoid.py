"""A covariance as an ellipsoid. Pure."""

from typing import Final

import numpy as np

from tracker.geometry import wxyz_from_matrix
from tracker.measurements import Matrix, Vector3, Wxyz

#: An ellipsoid of this many standard deviations holds a normal error in space 19 times of 20.
SIGMAS: Final = 2.8
#: Thinner ones are not seen, and larger ones hide the whole square.
_THINNEST_M, _LARGEST_M = 0.02, 60.0


def ellipsoid(covariance_m2: Matrix) -> tuple[Vector3, Wxyz]:
    """Return the half axes, metres, and the axes' directions in the frame of a (3, 3) covariance."""
    variances, axes = np.linalg.eigh(covariance_m2)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] = -axes[:, 0]
    a, b, c = np.clip(SIGMAS * np.sqrt(np.maximum(variances, 0.0)), _THINNEST_M, _LARGEST_M).tolist()
    return (a, b, c), wxyz_from_matrix(axes)
