"""The terrain as a mesh, and paving laid on it."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array, agora_from_site
from assets.materials import MATERIALS
from assets.shape import Mesh, Place, Shape, cells, unit
from assets.site import Monument
from assets.terrain import Terrain
from assets.textures import PAVING_GRID, noise

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
    """Return a footprint that lies along the axes of the square as paving, laid on the terrain's own triangles.

    Level paving is laid in rows of slabs, each row another one of the texture's and shifted along, so that nothing repeats.
    """
    axes = agora_from_site(terrain.azimuth_rad)
    uv = np.array(monument.footprint.corners_en_m) @ axes.T
    (u0, v0), (u1, v1) = uv.min(axis=0), uv.max(axis=0)
    u, v = _lines(terrain.u_m, u0, u1), _lines(terrain.v_m, v0, v1)
    en = np.stack(np.meshgrid(u, v, indexing="ij"), -1).reshape(-1, 2) @ axes
    levels = terrain.ground_z_m(en[:, 0], en[:, 1])
    if float(np.ptp(levels)) < 1e-6:
        return _rows_of_slabs(axes, (u, (v0, v1)), float(levels[0]) + LIFT_M, material, tint)
    points = np.column_stack([en, levels + LIFT_M])
    up = np.tile((0.0, 0.0, 1.0), (len(points), 1))
    mesh = _part(material, points, up, tint * _worn(points), cells(len(u), len(v)))
    along = points[:, :2] @ axes.T / MATERIALS[material].tile_m
    return Mesh(material, mesh.positions_m, mesh.normals, along.astype(np.float32), mesh.colours, mesh.triangles)


def _rows_of_slabs(
    axes: Array, lines: tuple[Array, tuple[float, float]], z_m: float, material: str, tint: float
) -> Mesh:
    """Rows along u, as high as a course of the texture."""
    u, (v0, v1) = lines
    tile_m = MATERIALS[material].tile_m
    high = tile_m / PAVING_GRID[0]
    count = max(1, round((v1 - v0) / high))
    edges = np.linspace(v0, v1, count + 1)
    rng = np.random.default_rng(43)
    course, shift = rng.integers(0, PAVING_GRID[0], count), rng.uniform(0.0, 1.0, count)
    n = len(u)
    points, uvs, triangles = [], [], []
    for i in range(count):
        for k in (0, 1):
            en = np.column_stack([u, np.full(n, edges[i + k])]) @ axes
            points.append(np.column_stack([en, np.full(n, z_m)]))
            uvs.append(np.column_stack([u / tile_m + shift[i], np.full(n, -(course[i] + k) / PAVING_GRID[0])]))
        triangles.append(cells(2, n)[:, ::-1] + 2 * n * i)
    corners = np.concatenate(points)
    up = np.tile((0.0, 0.0, 1.0), (len(corners), 1))
    mesh = _part(material, corners, up, tint * _worn(corners), np.concatenate(triangles))
    laid = np.concatenate(uvs).astype(np.float32)
    return Mesh(material, mesh.positions_m, mesh.normals, laid, mesh.colours, mesh.triangles)


def _worn(points_m: Array) -> Array:
    """Tints (n, 3) of paving: patches darker with dirt, metres wide."""
    patches = noise(202, 256, 3, 60, 0.8)
    i, j = (np.floor(points_m[:, k] / 2.5).astype(int) % 256 for k in (0, 1))
    level = np.clip(0.93 + 0.06 * patches[i, j], 0.75, 1.0)[:, None]
    return np.asarray(level * (1.0, 0.995, 0.985))


def _lines(grid: Array, low: float, high: float) -> Array:
    inside = grid[(grid > low + 1e-6) & (grid < high - 1e-6)]
    return np.concatenate([[low], inside, [high]])
