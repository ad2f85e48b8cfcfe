"""The rig: where each sensor sits, and what the camera's lens does."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from tracker.measurements import Matrix

DistortionModel = Literal["plumb_bob", "rational_polynomial", "equidistant"]


@dataclass(frozen=True)
class CameraModel:
    """A calibrated camera, OpenCV's conventions: pixel (0, 0) is the centre of the top-left pixel."""

    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float
    distortion_model: DistortionModel = "plumb_bob"
    distortion: tuple[float, ...] = ()
    """plumb_bob: k1 k2 p1 p2 k3; rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6; equidistant: k1 k2 k3 k4. Shorter means zeros."""

    @property
    def K(self) -> Matrix:
        """(3, 3) intrinsic matrix."""
        return np.array([[self.fx_px, 0.0, self.cx_px], [0.0, self.fy_px, self.cy_px], [0.0, 0.0, 1.0]])


#: Where a camera's intrinsics are unknown: a usual webcam, 60 degrees wide.
_GUESSED_FOCAL = 0.87


def guessed_camera(width_px: int, height_px: int) -> CameraModel:
    """Return a usual webcam, for a camera that was never calibrated and pictures of such a size."""
    focal_px = _GUESSED_FOCAL * max(width_px, height_px)
    return CameraModel(width_px, height_px, focal_px, focal_px, (width_px - 1) / 2.0, (height_px - 1) / 2.0)


def _identity() -> Matrix:
    return np.eye(4)


#: Looking along body x: camera right = body -y, camera down = body -z, camera forward = body x.
R_BODY_CAM_FORWARD: Matrix = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def _camera_forward() -> Matrix:
    T_body_cam = np.eye(4)
    T_body_cam[:3, :3] = R_BODY_CAM_FORWARD
    return T_body_cam


@dataclass(frozen=True)
class Rig:
    """Extrinsics as (4, 4) transforms, and the camera where its intrinsics are known."""

    T_body_imu: Matrix = field(default_factory=_identity)
    T_body_gps: Matrix = field(default_factory=_identity)
    T_body_cam: Matrix = field(default_factory=_camera_forward)
    camera: CameraModel | None = None
    """None where the log has no camera or its intrinsics are unknown (all zero)."""
