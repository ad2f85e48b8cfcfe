"""What the tests ask of meshes."""

import numpy as np
from numpy.typing import NDArray

from assets.scene import Node
from assets.shape import Mesh, Place, Shape

Points = NDArray[np.float64]
ORIGIN = Place.at(0.0, 0.0, 0.0)


def corners(meshes: list[Mesh] | Node) -> Points:
    """Return the triangles (m, 3, 3) of some meshes, or of a node with all copies of its parts."""
    many = [part.expanded() for part in meshes.instances] if isinstance(meshes, Node) else []
    parts = [*meshes.meshes, *many] if isinstance(meshes, Node) else meshes
    return np.concatenate([mesh.positions_m[mesh.triangles] for mesh in parts]).astype(np.float64)


def drawn(shape: Shape) -> Points:
    """Return the triangles (m, 3, 3) of a shape in its own axes."""
    return corners(shape.meshes(ORIGIN))


def across(triangles: Points) -> Points:
    """Return the area vectors (m, 3), by the order of the corners."""
    return np.asarray(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2.0)


def volume_m3(triangles: Points) -> float:
    """Return what a closed surface encloses; negative where it is inside out."""
    return float((triangles.mean(axis=1) * across(triangles)).sum() / 3.0)


def open_edges(triangles: Points) -> set[tuple[tuple[float, ...], tuple[float, ...]]]:
    """Return the edges that do not have a second triangle on their other side, as pairs of rounded points."""
    ends = np.round(triangles, 4) + 0.0
    edges = [
        (tuple(t[a].tolist()), tuple(t[b].tolist()))
        for t in ends
        for a, b in ((0, 1), (1, 2), (2, 0))
        if (t[a] != t[b]).any()
    ]
    there = set(edges)
    return {(a, b) for a, b in there if (b, a) not in there}
