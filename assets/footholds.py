"""Where feet can stand at a place: the walkable surface, looked up quickly enough to be asked at every step."""

from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.records import Epoch
from assets.scene import Scene

#: Triangles are kept by squares of this side, m: few enough in each to try them all.
_SQUARE_M = 8.0
#: What lies on an edge is inside, whichever of its two triangles rounding puts it out of.
_EDGE = 1e-6


class Footholds:
    """The heights of a surface of triangles."""

    def __init__(self, triangles: Array) -> None:
        """`triangles` is (m, 3, 3), site frame; none stands upright."""
        corner, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
        self._corner = corner
        self._to_shares = np.linalg.inv(np.stack([ab[:, :2], ac[:, :2]], axis=2))
        """(m, 2, 2): from a step on the map to its shares of both sides."""
        self._rise_m = np.stack([ab[:, 2], ac[:, 2]], axis=1)
        self._by_square = _by_square(triangles[:, :, :2])

    @classmethod
    def of(cls, scene: Scene, epoch: Epoch) -> "Footholds":
        """Return those of one model's surface in what `assets.walkable.walkable` made."""
        (mesh,) = next(node for node in scene.nodes if node.name == f"walkable/{epoch}").meshes
        return cls(mesh.positions_m[mesh.triangles].astype(np.float64))

    def height_m(self, east_m: float, north_m: float) -> float | None:
        """Return the height of the highest place to stand at a point, above the square's paving; None where there is none."""
        near = self._by_square.get((int(east_m // _SQUARE_M), int(north_m // _SQUARE_M)))
        if near is None:
            return None
        step = np.array([east_m, north_m]) - self._corner[near, :2]
        shares = np.einsum("kij,kj->ki", self._to_shares[near], step)
        inside = (shares.min(axis=1) >= -_EDGE) & (shares.sum(axis=1) <= 1.0 + _EDGE)
        if not inside.any():
            return None
        z = self._corner[near, 2] + (shares * self._rise_m[near]).sum(axis=1)
        return float(z[inside].max())


def _by_square(outlines: Array) -> dict[tuple[int, int], NDArray[np.int64]]:
    """Return which triangles, (m, 3, 2), may lie in each square."""
    low = np.floor((outlines.min(axis=1) - _EDGE) / _SQUARE_M).astype(int)
    high = np.floor((outlines.max(axis=1) + _EDGE) / _SQUARE_M).astype(int)
    found: dict[tuple[int, int], list[int]] = defaultdict(list)
    for index, ((i0, j0), (i1, j1)) in enumerate(zip(low.tolist(), high.tolist(), strict=True)):
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                found[i, j].append(index)
    return {square: np.array(indices, np.int64) for square, indices in found.items()}
