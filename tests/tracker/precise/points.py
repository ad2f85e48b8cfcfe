"""Points of a world, as cameras see them."""

import numpy as np

from tracker.measurements import Matrix

#: Half of what a camera sees, on the plane z = 1.
_WIDE, _HIGH = 0.62, 0.46


def seen_from(R_site_cam: Matrix, p_site_cam_m: Matrix, points_m: Matrix) -> Matrix:
    """Return rays of (N, 3) points in K cameras, (N, K, 2); NaN where one is out of the picture."""
    there = np.einsum("kji,nkj->nki", R_site_cam, points_m[:, None] - p_site_cam_m)
    xy = there[..., :2] / np.maximum(there[..., 2:], 1e-3)
    is_in = (there[..., 2] > 0.5) & (np.abs(xy) < (_WIDE, _HIGH)).all(axis=-1)
    return np.where(is_in[..., None], xy, np.nan)
