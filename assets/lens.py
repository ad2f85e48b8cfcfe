"""What a lens does to a picture: where each pixel of the distorted picture lies in a distortion-free one."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from assets.axes import Array

NONE, EQUIDISTANT = "none", "equidistant"
MODELS = (NONE, "plumb_bob", "rational_polynomial", EQUIDISTANT)
WIDEST = 4.0
"""Tangent of the widest half angle that one flat picture can hold."""


@dataclass(frozen=True)
class Pinhole:
    """A distortion-free camera; pixel (0, 0) is the centre of the top-left pixel."""

    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float


@dataclass(frozen=True)
class Lens:
    """A camera with distortion, OpenCV's models and coefficients."""

    pinhole: Pinhole
    """Size and intrinsics of the distorted picture."""
    distortion_model: str
    distortion: tuple[float, ...]

    @property
    def is_straight(self) -> bool:
        """Whether the picture is distortion-free."""
        return self.distortion_model == NONE or (self.distortion_model != EQUIDISTANT and not any(self.distortion))

    def rays(self) -> Array:
        """Return (height, width, 2) x/z and y/z of the ray through every pixel centre."""
        if self.distortion_model not in MODELS:
            raise ValueError(f"distortion_model is {self.distortion_model!r}, not one of {', '.join(MODELS)}")
        p = self.pinhole
        x, y = np.meshgrid(np.arange(p.width_px, dtype=np.float64), np.arange(p.height_px, dtype=np.float64))
        pixels = np.stack([x, y], axis=-1).reshape(-1, 1, 2)
        K = np.array([[p.fx_px, 0.0, p.cx_px], [0.0, p.fy_px, p.cy_px], [0.0, 0.0, 1.0]])
        if self.distortion_model == EQUIDISTANT:
            rays = cv2.fisheye.undistortPoints(pixels, K, _padded(self.distortion, 4))
        else:
            criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-9)
            rays = cv2.undistortPointsIter(pixels, K, _padded(self.distortion, 8), np.eye(3), np.eye(3), criteria)
        return np.asarray(rays, dtype=np.float64).reshape(p.height_px, p.width_px, 2)

    def oversized(self) -> tuple[Pinhole, NDArray[np.float32]]:
        """Return a pinhole camera that sees all this lens sees, and (height, width, 2) where each pixel lies in its picture."""
        rays = np.clip(self.rays(), -WIDEST, WIDEST)
        low, high = rays.min(axis=(0, 1)), rays.max(axis=(0, 1))
        p = self.pinhole
        margin_px = 2.0
        cx, cy = margin_px - low[0] * p.fx_px, margin_px - low[1] * p.fy_px
        width = int(np.ceil(high[0] * p.fx_px + cx + margin_px))
        height = int(np.ceil(high[1] * p.fy_px + cy + margin_px))
        place = rays * (p.fx_px, p.fy_px) + (cx, cy)
        return Pinhole(width, height, p.fx_px, p.fy_px, cx, cy), place.astype(np.float32)


def _padded(distortion: Sequence[float], length: int) -> Array:
    values = np.zeros(length)
    values[: len(distortion)] = distortion
    return values
