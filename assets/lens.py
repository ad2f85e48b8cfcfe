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
INVERSE_STEPS = 40


@dataclass(frozen=True)
class Pinhole:
    """A distortion-free camera; pixel (0, 0) is the centre of the top-left pixel."""

    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float


def finer(camera: Pinhole, times: int) -> Pinhole:
    """Return the camera with `times` by `times` pixels for each one, which together cover the same."""
    edge = (times - 1) / 2.0
    return Pinhole(
        times * camera.width_px,
        times * camera.height_px,
        times * camera.fx_px,
        times * camera.fy_px,
        times * camera.cx_px + edge,
        times * camera.cy_px + edge,
    )


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
        pixels = np.stack([x, y], axis=-1)
        if self.distortion_model == EQUIDISTANT:
            K = np.array([[p.fx_px, 0.0, p.cx_px], [0.0, p.fy_px, p.cy_px], [0.0, 0.0, 1.0]])
            flat = cv2.fisheye.undistortPoints(pixels.reshape(-1, 1, 2), K, _padded(self.distortion, 4))
            return np.asarray(flat, dtype=np.float64).reshape(pixels.shape)
        return _straightened((pixels - (p.cx_px, p.cy_px)) / (p.fx_px, p.fy_px), self.distortion)

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


def _straightened(distorted: Array, distortion: Sequence[float]) -> Array:
    """Invert OpenCV's polynomial (k1 k2 p1 p2 k3 k4 k5 k6) at (..., 2) by fixed-point steps."""
    k1, k2, p1, p2, k3, k4, k5, k6 = _padded(distortion, 8)
    rays = distorted
    for _ in range(INVERSE_STEPS):
        x, y = rays[..., 0], rays[..., 1]
        r2 = x * x + y * y
        factor = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)))
        shift = np.stack([2 * p1 * x * y + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + 2 * p2 * x * y], axis=-1)
        rays = (distorted - shift) / factor[..., None]
    return rays
