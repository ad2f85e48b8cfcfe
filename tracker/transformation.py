"""The paper's transformation `Tr` (eq. 1): three Euler angles and a translation in one (4, 4) matrix.

The printed matrix is R = Rx Ry Rz. Angles exist for the paper's filter and its tables only; everything else uses quaternions
or matrices.

Reference:
    Bostanci et al., Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models, arXiv 1512.02766, eq. (1).
"""

from math import asin, atan2, cos, sin

import numpy as np

from tracker.measurements import Matrix, Vector3


def tr_from_euler(rx_rad: float, ry_rad: float, rz_rad: float, t_m: Vector3) -> Matrix:
    """Return Tr, (4, 4), entry by entry as eq. 1 prints it."""
    cx, sx, cy, sy, cz, sz = cos(rx_rad), sin(rx_rad), cos(ry_rad), sin(ry_rad), cos(rz_rad), sin(rz_rad)
    return np.array(
        [
            [cy * cz, -cy * sz, sy, t_m[0]],
            [sx * sy * cz + cx * sz, -sx * sy * sz + cx * cz, -sx * cy, t_m[1]],
            [-cx * sy * cz + sx * sz, cx * sy * sz + sx * cz, cx * cy, t_m[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def euler_from_rotation(R: Matrix) -> Vector3:
    """Return (R_x, R_y, R_z) of a (3, 3) rotation, R_y in [-pi/2, pi/2]; where R_y = ±pi/2, R_x is given as 0 (eq. 1)."""
    sine = min(1.0, max(-1.0, float(R[0, 2])))
    if abs(sine) > 1.0 - 1e-12:
        return 0.0, asin(sine), atan2(float(R[1, 0]), float(R[1, 1]))
    return atan2(-float(R[1, 2]), float(R[2, 2])), asin(sine), atan2(-float(R[0, 1]), float(R[0, 0]))


def transformation(R_key_cam: Matrix, t_key_m: Vector3) -> Matrix:
    """Return Tr, (4, 4): the camera's motion since its keyframe as eq. 1 writes it.

    Args:
        R_key_cam: (3, 3) present camera to keyframe.
        t_key_m: From the keyframe's centre to the present one, keyframe axes: the essential matrix's direction times the
            length that something else must give.
    """
    return tr_from_euler(*euler_from_rotation(R_key_cam), t_key_m)
