"""How a material looks in a file: WebP pictures of its colour, its bumps and its roughness, or its mean colour alone."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from assets.materials import MATERIALS
from assets.textures import Texture

COLOUR_QUALITY, NORMAL_QUALITY, ROUGHNESS_QUALITY = 78, 82, 55
"""WebP's, 1 to 100: normals show their blocks first."""
FIRST_PX, FINE_PX, ROUGHNESS_PX = 256, 1024, 256
"""Largest side of a texture on the first paint, of the full ones, and of the roughness maps, which nobody sees as such."""
BYTES_PER_TEXEL = 16 / 3
"""Four on the graphics card, and a third more for the smaller copies."""


@dataclass(frozen=True)
class Surface:
    """What is written of one material. Pictures may be None."""

    colour: Texture | None
    normal: Texture | None = None
    """glTF's: x along u, y against v (upwards in the picture), blue green red."""
    roughness: NDArray[np.uint8] | None = None
    """(n, n)"""
    mean_rgb: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Linear; the colour where there is no picture of it."""

    @property
    def texels(self) -> int:
        """How many pixels its pictures have."""
        return sum(p.shape[0] * p.shape[1] for p in (self.colour, self.normal, self.roughness) if p is not None)


def first_surfaces(textures: Mapping[str, Texture]) -> dict[str, Surface]:
    """Return small colours: what a page can draw with at once."""
    return {name: Surface(_at_most(texture, FIRST_PX)) for name, texture in textures.items()}


def plain_surfaces(textures: Mapping[str, Texture]) -> dict[str, Surface]:
    """Return mean colours: for files whose pictures stand in a file of their own."""
    return {name: Surface(None, mean_rgb=_mean_rgb(texture)) for name, texture in textures.items()}


def full_surfaces(textures: Mapping[str, Texture]) -> dict[str, Surface]:
    """Return everything that the materials have, by name."""
    full = {}
    for name, texture in sorted(textures.items()):
        material = MATERIALS[name]
        normal, roughness = material.normal, material.roughness_map
        full[name] = Surface(
            _at_most(texture, FINE_PX),
            None if normal is None else _at_most(normal(), FINE_PX),
            None if roughness is None else _at_most(roughness(), ROUGHNESS_PX),
        )
    return full


def gpu_bytes(surfaces: Iterable[Surface]) -> int:
    """Return what the textures take on a graphics card."""
    return round(sum(surface.texels for surface in surfaces) * BYTES_PER_TEXEL)


def webp(picture: NDArray[np.uint8], quality: int) -> bytes:
    """Return a picture (blue green red, or one channel) as WebP."""
    return bytes(cv2.imencode(".webp", picture, [cv2.IMWRITE_WEBP_QUALITY, quality])[1])


def _at_most(picture: NDArray[np.uint8], side_px: int) -> NDArray[np.uint8]:
    if picture.shape[0] <= side_px:
        return picture
    return np.asarray(cv2.resize(picture, (side_px, side_px), interpolation=cv2.INTER_AREA), dtype=np.uint8)


def _mean_rgb(texture: Texture) -> tuple[float, float, float]:
    value = texture.reshape(-1, 3)[:, ::-1] / 255.0
    linear = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4).mean(axis=0)
    return float(linear[0]), float(linear[1]), float(linear[2])
