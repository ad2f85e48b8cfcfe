"""What a webcam does with light: how long it exposes, what moves meanwhile, what lens and sensor add. Numbers in, numbers out.

Pictures are (height, width, 3) uint8, blue green red. Light is their square, since the renderer's gamma is 2: 1 saturates.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.lens import Pinhole

Picture: TypeAlias = NDArray[np.uint8]
Light: TypeAlias = NDArray[np.float32]
SHORTEST_S, LONGEST_S = 1.0 / 250.0, 1.0 / 120.0
"""Of a webcam in sunshine."""
USUAL_S = math.sqrt(SHORTEST_S * LONGEST_S)
"""The exposure at which a picture gets the renderer's own brightness."""
WANTED_LIGHT = 0.35
"""Mean of a well exposed picture: 151 of 255 levels."""
SHUTTER_STEP_S = 1e-4
"""The unit in which a USB camera takes its exposure."""
LAG_S = 0.6
"""A step in the scene's brightness is two thirds made up for in this time."""
DARKEST_LIGHT = 1e-3
"""Less is metered as this: a black picture asks for much light, not for infinitely much."""
STEP_PX, MOST_MOMENTS = 2.0, 8
"""Moments of one exposure lie so close that their pictures run together; 8 are enough for 16 pixels."""
METERED_AT_M = 5.0
"""Where the blur is measured: near ground moves more than distant ruins when the visitor walks."""
FULL_WELL_E, READ_NOISE_E = 4500.0, 3.0
"""Electrons of a saturated pixel, and the deviation of reading one: a small sensor."""
VIGNETTE = 0.2
"""Share of the light that is lost in the corners."""


@dataclass(frozen=True)
class Exposure:
    """How long the next picture is exposed: a slow controller that steers the mean light to `WANTED_LIGHT`."""

    wanted_s: float = USUAL_S
    """Where the controller is, between the steps that a camera can take."""

    @property
    def time_s(self) -> float:
        """How long the shutter is open: whole steps, so that a still scene gets the very same picture again."""
        return float(np.clip(round(self.wanted_s / SHUTTER_STEP_S) * SHUTTER_STEP_S, SHORTEST_S, LONGEST_S))

    @property
    def brightness(self) -> float:
        """Light of the picture over that of `USUAL_S`."""
        return self.time_s / USUAL_S

    def after(self, bgr: Picture, dt_s: float) -> "Exposure":
        """Return the exposure of a picture `dt_s` after this one, which was taken with the present exposure."""
        metered = max(float(np.mean(light_of(bgr))), DARKEST_LIGHT)
        right_s = np.clip(self.time_s * WANTED_LIGHT / metered, SHORTEST_S, LONGEST_S)
        share = 1.0 - np.exp(-dt_s / LAG_S)
        return Exposure(float(self.wanted_s * (right_s / self.wanted_s) ** share))


def light_of(bgr: Picture) -> Light:
    """Return the light of a picture, 0 to 1."""
    return np.asarray(np.square(bgr, dtype=np.float32) / 255.0**2, dtype=np.float32)


def picture_of(light: Light) -> Picture:
    """Return the picture of some light; what is over 1 saturates."""
    return (np.sqrt(np.clip(light, 0.0, 1.0)) * np.float32(255.0) + np.float32(0.5)).astype(np.uint8)


def motion_px(T_site_first: Array, T_site_last: Array, camera: Pinhole) -> float:
    """Return how far the picture moves between two poses (4, 4) of its camera: the most of nine points 5 m ahead.

    Distortion moves nothing by more than a few per cent and is left out.
    """
    x, y = np.meshgrid(np.array([0.05, 0.5, 0.95]) * camera.width_px, np.array([0.05, 0.5, 0.95]) * camera.height_px)
    focal, centre = np.array([camera.fx_px, camera.fy_px]), np.array([camera.cx_px, camera.cy_px])
    before = np.stack([x.ravel(), y.ravel()], axis=-1)
    points = np.column_stack([(before - centre) / focal, np.ones(len(before))]) * METERED_AT_M
    T_last_first = np.linalg.inv(T_site_last) @ T_site_first
    seen = points @ T_last_first[:3, :3].T + T_last_first[:3, 3]
    after = seen[:, :2] / np.maximum(seen[:, 2:], 0.1) * focal + centre
    return float(np.linalg.norm(after - before, axis=1).max())


def moments(time_s: float, moved_px: float) -> Array:
    """Return the moments (n,) of an exposure at which to draw, seconds from its middle; one where nothing moves."""
    count = int(np.clip(np.ceil(moved_px / STEP_PX), 1, MOST_MOMENTS))
    return ((np.arange(count) + 0.5) / count - 0.5) * time_s


def mean_of(pictures: Sequence[Picture]) -> Picture:
    """Return the picture of all their light, which is how motion blurs."""
    if len(pictures) == 1:
        return pictures[0]
    return picture_of(np.mean([light_of(bgr) for bgr in pictures], axis=0, dtype=np.float32))


def vignette(camera: Pinhole) -> Light:
    """Return the share of light (height, width) that each pixel gets: falling with the square of the distance from the centre."""
    y, x = np.mgrid[: camera.height_px, : camera.width_px].astype(np.float32)
    squared = (x - camera.cx_px) ** 2 + (y - camera.cy_px) ** 2
    corner = np.float32((camera.width_px**2 + camera.height_px**2) / 4.0)
    return np.asarray(1.0 - VIGNETTE * squared / corner, dtype=np.float32)


def sensed(bgr: Picture, falloff: Light, rng: np.random.Generator) -> Picture:
    """Return what the sensor reads: light under the vignette with shot noise (its variance grows with light) and read noise."""
    light = light_of(bgr) * falloff[..., None]
    sigma = np.sqrt(light / np.float32(FULL_WELL_E) + np.float32((READ_NOISE_E / FULL_WELL_E) ** 2))
    return picture_of(light + sigma * rng.standard_normal(light.shape, dtype=np.float32))
