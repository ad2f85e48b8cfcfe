"""Plain solids and surfaces for what is never looked at: navigation, collision, depth. One material, no texture."""

from collections.abc import Sequence

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from assets.axes import Array
from assets.shape import Mesh, unit

MATERIAL = "plaster"
MERGE_M = 1e-4
SLIVER_M = 2e-3
"""Triangles that are less high than this are left out: rounding tilts them at will."""


def plain_mesh(corners: Array) -> Mesh:
    """Return triangles, corners (m, 3, 3), as one mesh in which neighbours share their corners; slivers are left out."""
    rounded = np.round(corners.reshape(-1, 3) / MERGE_M) * MERGE_M
    points, index = np.unique(rounded, axis=0, return_inverse=True)
    triangles: NDArray[np.int64] = index.reshape(-1, 3).astype(np.int64)
    ends = points[triangles]
    longest = np.linalg.norm(np.roll(ends, -1, axis=1) - ends, axis=2).max(axis=1)
    doubled = np.linalg.norm(np.cross(ends[:, 1] - ends[:, 0], ends[:, 2] - ends[:, 0]), axis=1)
    return indexed_mesh(points, triangles[doubled > SLIVER_M * longest])


def indexed_mesh(points: Array, triangles: NDArray[np.int64]) -> Mesh:
    """Return points (n, 3) and triangles (m, 3) as a mesh; its normals are smooth, for nobody sees them."""
    sides = points[triangles]
    across = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    normals = np.zeros_like(points)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], across)
    return Mesh(
        MATERIAL,
        points.astype(np.float32),
        _upright(unit(normals)).astype(np.float32),
        np.zeros((len(points), 2), dtype=np.float32),
        np.full((len(points), 3), 255, dtype=np.uint8),
        triangles.astype(np.uint32),
    )


def _upright(normals: Array) -> Array:
    """Where sides cancel each other out, any direction will do."""
    lost = np.linalg.norm(normals, axis=1) < 0.5
    return np.where(lost[:, None], (0.0, 0.0, 1.0), normals)


def prism(outline: Polygon, low_m: float, high_m: float) -> Mesh:
    """Return a closed solid with vertical sides over an outline (site frame), which may have holes."""
    solid = trimesh.creation.extrude_polygon(outline, high_m - low_m, engine="earcut")
    points = np.asarray(solid.vertices, dtype=np.float64) + np.array([0.0, 0.0, low_m])
    return indexed_mesh(points, np.asarray(solid.faces, dtype=np.int64))


def laid(geometry: BaseGeometry) -> Sequence[Array]:
    """Return the triangles (m, 3, 2) of every polygon of a geometry, counter-clockwise; lines, points and slivers are left out."""
    polygons = [p for p in shapely.get_parts(geometry) if isinstance(p, Polygon) and p.area > 0.0]
    return [_triangulated(polygon) for polygon in polygons]


def _triangulated(polygon: Polygon) -> Array:
    points, faces = trimesh.creation.triangulate_polygon(polygon, engine="earcut")
    corners = np.asarray(points)[np.asarray(faces)]
    ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    clockwise = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0] < 0.0
    corners[clockwise] = corners[clockwise][:, ::-1]
    return np.asarray(corners, dtype=np.float64)
