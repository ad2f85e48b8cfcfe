"""Triangles sorted into squares of ground, so that a picture draws only those that it shows, the nearest first."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.lens import Pinhole

CELL_M = 32.0


@dataclass(frozen=True)
class Chunk:
    """A run of triangles and the ball that holds them."""

    first: int
    """Index of its first corner in the ordered list."""
    count: int
    """Of corners."""
    middle_m: Array
    """(3,)"""
    radius_m: float


def chunked(
    positions_m: NDArray[np.float32], triangles: NDArray[np.uint32]
) -> tuple[NDArray[np.uint32], tuple[Chunk, ...]]:
    """Return the triangles (m, 3) in the order of their cells, and the cells."""
    cell = np.floor(positions_m[triangles].mean(axis=1)[:, :2] / CELL_M).astype(np.int64)
    key = cell[:, 0] * 100003 + cell[:, 1]
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=key[order][0] - 1))
    ordered = triangles[order]
    ends = [*starts[1:], len(ordered)]
    return ordered, tuple(_chunk(positions_m, ordered, int(a), int(b)) for a, b in zip(starts, ends, strict=True))


def _chunk(positions_m: NDArray[np.float32], triangles: NDArray[np.uint32], first: int, last: int) -> Chunk:
    points = positions_m[triangles[first:last].ravel()].astype(np.float64)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    return Chunk(3 * first, 3 * (last - first), middle, float(np.linalg.norm(points - middle, axis=1).max()))


def seen(chunks: tuple[Chunk, ...], T_cam_site: Array, camera: Pinhole) -> list[tuple[float, Chunk]]:
    """Return the chunks whose balls reach into the picture, with their distance along the line of sight."""
    middles = np.array([chunk.middle_m for chunk in chunks]) @ T_cam_site[:3, :3].T + T_cam_site[:3, 3]
    radii = np.array([chunk.radius_m for chunk in chunks])
    reach = middles[:, 2] + radii
    visible = reach > 0.0
    for axis, focal, centre, size in (
        (0, camera.fx_px, camera.cx_px, camera.width_px),
        (1, camera.fy_px, camera.cy_px, camera.height_px),
    ):
        for sign, edge in ((-1.0, (centre + 0.5) / focal), (1.0, (size - 0.5 - centre) / focal)):
            outside = sign * middles[:, axis] - edge * middles[:, 2]
            visible &= outside <= radii * np.hypot(1.0, edge)
    return [(float(middles[i, 2] - radii[i]), chunks[i]) for i in np.flatnonzero(visible)]
