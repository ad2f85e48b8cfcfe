"""Bumps and gloss painted with numpy: normal maps and roughness maps that go with the textures, tileable as these are.

Normal maps are glTF's: x along u, y upwards in the picture, stored blue green red.
"""

import numpy as np
from numpy.typing import NDArray

from assets import textures
from assets.axes import Array
from assets.textures import SIZE, Texture, courses, noise

Grey = NDArray[np.uint8]
"""(n, n)"""


def normals(height_px: Array) -> Texture:
    """Return the normal map of a height field (n, n), heights in pixels, that goes on over its edges."""
    across = (np.roll(height_px, -1, axis=1) - np.roll(height_px, 1, axis=1)) / 2.0
    down = (np.roll(height_px, -1, axis=0) - np.roll(height_px, 1, axis=0)) / 2.0
    length = np.sqrt(across**2 + down**2 + 1.0)
    stacked = np.stack([1.0 / length, down / length, -across / length], -1)
    return np.ascontiguousarray(((stacked * 0.5 + 0.5) * 255.0).round().astype(np.uint8))


def grey(share: Array) -> Grey:
    """Return a roughness map from shares of 1 (n, n)."""
    return np.ascontiguousarray((np.clip(share, 0.0, 1.0) * 255.0).round().astype(np.uint8))


def marble() -> Texture:
    """Dressed with a fine chisel."""
    return normals(0.5 * noise(3, SIZE, 30, 200, 0.6) + 0.9 * noise(2, SIZE, 3, 40, 1.2))


def marble_gloss() -> Grey:
    """Smoother where hands and weather polished it."""
    return grey(0.55 + 0.1 * noise(2, SIZE, 3, 40, 1.2) + 0.05 * noise(4, SIZE, 30, 200, 0.4))


def ashlar() -> Texture:
    """Close joints, faces not quite in one plane."""
    tone, joint = courses(11, 8, 4, 3.5, 1.0)
    return normals(3.0 * joint + 0.8 * tone * joint + 0.5 * noise(13, SIZE, 20, 200, 0.7))


def rustic() -> Texture:
    """Bosses within drafted margins."""
    tone, joint = courses(21, 7, 4, 22.0, 1.0)
    return normals(14.0 * joint**0.5 + 3.5 * joint * noise(22, SIZE, 6, 120, 0.9) + 1.0 * tone)


def plaster() -> Texture:
    """Trowelled."""
    return normals(1.6 * noise(31, SIZE, 2, 30, 1.1) + 0.25 * noise(32, SIZE, 30, 200, 0.4))


def painted() -> Texture:
    """Mouldings in stucco around the panels."""
    edge = textures.panel_edges()
    return normals(4.0 * np.clip(edge, 0.0, 1.0) + 0.3 * noise(34, SIZE, 4, 60, 0.9))


def paving() -> Texture:
    """Slabs with worn edges."""
    tone, joint = courses(41, *textures.PAVING_GRID, 6.0, 1.0, textures.PAVING_PX)
    return normals(4.0 * joint**0.7 + 1.0 * tone * joint + 0.7 * noise(43, textures.PAVING_PX, 20, 300, 0.7))


def paving_gloss() -> Grey:
    """Middles of slabs polished by feet."""
    _, joint = courses(41, *textures.PAVING_GRID, 40.0, 1.0, textures.PAVING_PX)
    return grey(0.82 - 0.22 * joint + 0.06 * noise(42, textures.PAVING_PX, 2, 80, 0.9))


def tiles() -> Texture:
    """Pan tiles between round cover tiles, each lapping the one below."""
    y, x = np.mgrid[0:SIZE, 0:SIZE].astype(np.float64)
    cover = np.clip(np.cos(2.0 * np.pi * x * textures.TILE_COVERS / SIZE) - 0.25, 0.0, 1.0) ** 0.5
    lap = (y * textures.TILE_ROWS / SIZE) % 1.0
    return normals(11.0 * cover + 4.0 * lap + 0.8 * noise(52, SIZE, 20, 120, 0.7))


def grass() -> Texture:
    """Tussocks."""
    return normals(2.4 * noise(62, SIZE, 16, 140, 0.6) + 0.8 * noise(63, SIZE, 60, 240, 0.2))


def earth() -> Texture:
    """Gravel."""
    return normals(1.6 * noise(72, SIZE, 30, 110, 0.3) + 2.0 * noise(71, SIZE, 4, 40, 0.9))


def stone() -> Texture:
    """Pits and cracks."""
    pits = np.clip((np.abs(noise(83, SIZE, 6, 90, 1.0)) - 0.12) * 5.0, 0.0, 1.0)
    return normals(2.6 * pits + 2.2 * noise(81, SIZE, 2, 60, 0.9) + 0.6 * noise(84, SIZE, 50, 250, 0.2))


def wood() -> Texture:
    """Grain and the gaps between boards."""
    return normals(1.2 * textures.grain() + 3.0 * np.clip(textures.board_gaps() * 1.4, 0.0, 1.0))


def water() -> Texture:
    """Small waves."""
    return normals(2.2 * noise(121, SIZE, 3, 40, 1.4))
