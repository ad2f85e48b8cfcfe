"""The lens: pixels to rays of the camera frame and back, for the three distortion models; numpy only.

Formulas are OpenCV's (and so ROS's): `plumb_bob` and `rational_polynomial` are the Brown-Conrady polynomial, `equidistant`
is Kannala and Brandt's angle polynomial. A ray is written as its crossing (x, y) with the plane z = 1.
"""

import numpy as np

from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: Fixed-point steps; measured: within 1e-7 px of exact at the corners of a strong lens (k1 = -0.3).
INVERSE_STEPS = 20
#: Half angle of the widest ray that the plane z = 1 is still good for.
MAX_ANGLE_RAD = 1.45


def project(camera: CameraModel, xy: Matrix) -> Matrix:
    """Return (N, 2) pixels of the original (distorted) picture for (N, 2) rays."""
    distorted = _distort_angle(camera, xy) if camera.distortion_model == "equidistant" else _distort(camera, xy)
    return distorted * (camera.fx_px, camera.fy_px) + (camera.cx_px, camera.cy_px)


def unproject(camera: CameraModel, points_px: Matrix) -> Matrix:
    """Return (N, 2) rays for (N, 2) pixels of the original picture; the inverse of `project` inside the picture."""
    distorted = (np.asarray(points_px, dtype=np.float64) - (camera.cx_px, camera.cy_px)) / (camera.fx_px, camera.fy_px)
    if camera.distortion_model == "equidistant":
        return _undistort_angle(camera, distorted)
    if not any(camera.distortion):
        return distorted
    xy = distorted
    for _ in range(INVERSE_STEPS):
        ratio, tangential = _radial_and_tangential(camera, xy)
        xy = (distorted - tangential) / ratio
    return xy


def scaled(camera: CameraModel, width_px: int, height_px: int) -> CameraModel:
    """Return the same camera for a picture resized to width_px by height_px (pixel centres stay pixel centres)."""
    sx, sy = width_px / camera.width_px, height_px / camera.height_px
    return CameraModel(
        width_px=width_px,
        height_px=height_px,
        fx_px=camera.fx_px * sx,
        fy_px=camera.fy_px * sy,
        cx_px=(camera.cx_px + 0.5) * sx - 0.5,
        cy_px=(camera.cy_px + 0.5) * sy - 0.5,
        distortion_model=camera.distortion_model,
        distortion=camera.distortion,
    )


def _coefficients(camera: CameraModel, count: int) -> list[float]:
    given = list(camera.distortion[:count])
    return given + [0.0] * (count - len(given))


def _radial_and_tangential(camera: CameraModel, xy: Matrix) -> tuple[Matrix, Matrix]:
    """Return the (N, 1) radial factor and the (N, 2) tangential part at (N, 2) rays."""
    k1, k2, p1, p2, k3, k4, k5, k6 = _coefficients(camera, 8)
    x, y = xy[:, 0], xy[:, 1]
    r2 = x * x + y * y
    factor = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    if camera.distortion_model == "rational_polynomial":
        factor = factor / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    tangential = np.stack(
        [2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y], axis=1
    )
    return factor[:, None], tangential


def _distort(camera: CameraModel, xy: Matrix) -> Matrix:
    factor, tangential = _radial_and_tangential(camera, xy)
    return xy * factor + tangential


def _angle_polynomial(camera: CameraModel, angle_rad: Matrix) -> Matrix:
    k1, k2, k3, k4 = _coefficients(camera, 4)
    a2 = angle_rad * angle_rad
    return np.asarray(angle_rad * (1.0 + a2 * (k1 + a2 * (k2 + a2 * (k3 + a2 * k4)))))


def _distort_angle(camera: CameraModel, xy: Matrix) -> Matrix:
    radius = np.hypot(xy[:, 0], xy[:, 1])
    bent = _angle_polynomial(camera, np.arctan(radius))
    ratio = np.divide(bent, radius, out=np.ones_like(radius), where=radius > 1e-9)
    return np.asarray(xy * ratio[:, None])


def _undistort_angle(camera: CameraModel, distorted: Matrix) -> Matrix:
    bent = np.hypot(distorted[:, 0], distorted[:, 1])
    angle = np.clip(bent, 0.0, MAX_ANGLE_RAD)
    for _ in range(INVERSE_STEPS):
        angle = np.clip(angle + bent - _angle_polynomial(camera, angle), 0.0, MAX_ANGLE_RAD)
    ratio = np.divide(np.tan(angle), bent, out=np.ones_like(bent), where=bent > 1e-9)
    return np.asarray(distorted * ratio[:, None])
