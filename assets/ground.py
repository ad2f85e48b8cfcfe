"""The terrain as a mesh, and paving laid on it."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array, agora_from_site
from assets.materials import MATERIALS
from assets.shape import Mesh, Place, Shape, cells, unit
from assets.site import Monument
from assets.terrain import Terrain

LIFT_M = 0.04
"""How far paving lies over the terrain, so that the two never fight for a pixel."""
STEEPEST = 0.55
"""Triangles whose normal's z is less are banks: flat, of bare earth."""


def terrain_meshes(
    terrain: Terrain, material_of: Callable[[Array], NDArray[np.str_]], tint_of: Callable[[Array], Array]
) -> list[Mesh]:
    """Return the whole terrain, one mesh per material.

    Args:
        terrain: The height field.
        material_of: From points (n, 3), site frame, to the material of the cell about each.
        tint_of: From points (n, 3) to a tint (n, 3) of the material there.
    """
    points = terrain.grid_points_m()
    a, b, _ = points.shape
    triangles = cells(a, b)
    corners = points.reshape(-1, 3)
    centres = corners[triangles].mean(axis=1)
    half = len(triangles) // 2
    both = material_of((centres[:half] + centres[half:]) / 2.0)
    material = np.concatenate([both, both])
    sides = corners[triangles]
    across = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    gentle = unit(across)[:, 2] > STEEPEST
    normals = _gentle_normals(len(corners), triangles[gentle], across[gentle])
    tints = tint_of(corners)
    names = [str(name) for name in dict.fromkeys(material[gentle].tolist())]
    meshes = [_part(name, corners, normals, tints, triangles[gentle & (material == name)]) for name in names]
    banks = Shape()
    banks.polygons("earth", sides[~gentle], 0.9)
    return [*meshes, *banks.meshes(Place.at(0.0, 0.0, 0.0))]


def _gentle_normals(count: int, triangles: NDArray[np.int64], across: Array) -> Array:
    """Normals of the corners, from gentle triangles only: a level place stays level to the edge of a bank."""
    total = np.zeros((count, 3))
    for corner in range(3):
        np.add.at(total, triangles[:, corner], across)
    return unit(total)


def _part(name: str, points: Array, normals: Array, tints: Array, triangles: NDArray[np.int64]) -> Mesh:
    used, renumbered = np.unique(triangles, return_inverse=True)
    return Mesh(
        name,
        points[used].astype(np.float32),
        normals[used].astype(np.float32),
        (points[used][:, :2] * (1.0, -1.0) / MATERIALS[name].tile_m).astype(np.float32),
        np.clip(tints[used] * 255.0, 0.0, 255.0).round().astype(np.uint8),
        renumbered.reshape(-1, 3).astype(np.uint32),
    )


def paving_mesh(terrain: Terrain, monument: Monument, material: str, tint: float = 1.0) -> Mesh:
    """Return a footprint that lies along the axes of the square as paving, laid on the terrain's own triangles."""
    axes = agora_from_site(terrain.azimuth_rad)
    uv = np.array(monument.footprint.corners_en_m) @ axes.T
    (u0, v0), (u1, v1) = uv.min(axis=0), uv.max(axis=0)
    u, v = _lines(terrain.u_m, u0, u1), _lines(terrain.v_m, v0, v1)
    en = np.stack(np.meshgrid(u, v, indexing="ij"), -1).reshape(-1, 2) @ axes
    points = np.column_stack([en, terrain.ground_z_m(en[:, 0], en[:, 1]) + LIFT_M])
    up = np.tile((0.0, 0.0, 1.0), (len(points), 1))
    mesh = _part(material, points, up, np.full((len(points), 3), tint), cells(len(u), len(v)))
    along = points[:, :2] @ axes.T / MATERIALS[material].tile_m
    return Mesh(material, mesh.positions_m, mesh.normals, along.astype(np.float32), mesh.colours, mesh.triangles)


def _lines(grid: Array, low: float, high: float) -> Array:
    inside = grid[(grid > low + 1e-6) & (grid < high - 1e-6)]
    return np.concatenate([[low], inside, [high]])
