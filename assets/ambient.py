"""Light from the whole sky, baked into the colours of corners: what stands close by and above takes it away."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.shape import Mesh, unit
from assets.terrain import Terrain

CELL_M = 0.5
"""Side of the cubes that stand for what takes light."""
REACH_M = np.arange(0.5, 5.01, 0.5)
"""How far out along a ray it is asked whether a cube is full."""
DARKEST = 0.42
LARGEST_PATCH_M = 0.35
"""Triangles are sampled this densely to find the cubes that they fill."""


class Light:
    """Finds how much of the sky's light reaches points near some meshes."""

    def __init__(self, meshes: Sequence[Mesh], terrain: Terrain) -> None:
        """Fill cubes with the meshes (site frame) and with the ground under them."""
        points = np.concatenate([_samples(mesh) for mesh in meshes])
        self._low = points.min(axis=0) - 1.5 * CELL_M
        shape = np.ceil((points.max(axis=0) - self._low) / CELL_M).astype(int) + 2
        self._full: NDArray[np.bool_] = np.zeros(shape, dtype=np.bool_)
        i, j, k = self._cells(points).T
        self._full[i, j, k] = True
        east, north = (self._low[axis] + (np.arange(shape[axis]) + 0.5) * CELL_M for axis in (0, 1))
        east, north = np.meshgrid(east, north, indexing="ij")
        ground = terrain.ground_z_m(east, north)
        height = self._low[2] + (np.arange(shape[2]) + 0.5) * CELL_M
        self._full |= height < ground[..., None] - 0.1

    def shaded(self, mesh: Mesh) -> Mesh:
        """Return the mesh with its corners darkened where little of the sky is seen."""
        level = 1.0 - (1.0 - DARKEST) * self.taken(mesh.positions_m.astype(np.float64), mesh.normals.astype(np.float64))
        colours = np.clip(mesh.colours * level[:, None], 0.0, 255.0).round().astype(np.uint8)
        return replace(mesh, colours=colours)

    def taken(self, points_m: Array, normals: Array) -> Array:
        """Return the share (n,) of a half sky that is hidden from points (n, 3) that face `normals` (n, 3)."""
        blocked, total = np.zeros(len(points_m)), np.zeros(len(points_m))
        start = points_m + normals * (0.75 * CELL_M)
        for ray in _RAYS:
            facing = normals @ ray
            towards = np.flatnonzero(facing > 0.0)
            free = np.ones(len(towards))
            for reach in REACH_M[::-1]:
                hit = self._is_full(start[towards] + ray * reach)
                free[hit] = (reach / REACH_M[-1]) ** 0.5 * 0.7
            blocked[towards] += facing[towards] * (1.0 - free)
            total[towards] += facing[towards]
        return np.asarray(blocked / np.maximum(total, 1e-9))

    def _cells(self, points_m: Array) -> NDArray[np.int64]:
        return np.asarray(np.floor((points_m - self._low) / CELL_M), dtype=np.int64)

    def _is_full(self, points_m: Array) -> NDArray[np.bool_]:
        cells = self._cells(points_m)
        limit = np.array(self._full.shape) - 1
        inside = ((cells >= 0) & (cells <= limit)).all(axis=1)
        i, j, k = np.clip(cells, 0, limit).T
        return np.asarray(self._full[i, j, k] & inside)


def _samples(mesh: Mesh) -> Array:
    """Points all over the triangles, spread evenly, the same ones at every run."""
    corners = mesh.positions_m[mesh.triangles].astype(np.float64)
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.linalg.norm(np.cross(a, b), axis=1) / 2.0
    count = np.ceil(area / LARGEST_PATCH_M**2).astype(int) + 1
    owner = np.repeat(np.arange(len(corners)), count)
    n = np.arange(len(owner))
    s, t = n * 0.7548776662466927 % 1.0, n * 0.5698402909980532 % 1.0
    over = s + t > 1.0
    s, t = np.where(over, 1.0 - s, s), np.where(over, 1.0 - t, t)
    return np.asarray(corners[owner, 0] + s[:, None] * a[owner] + t[:, None] * b[owner])


def _directions() -> Array:
    steps = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if (x, y, z) != (0, 0, 0)])
    return unit(steps.astype(np.float64))


_RAYS = _directions()
