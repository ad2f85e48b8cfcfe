"""Shapes under construction: polygons and smooth surfaces in a monument's own axes, laid on the site as meshes.

A monument's own axes: x from the first corner of its footprint to the second, y to its left, z up from its floor; metres.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from assets.axes import Array
from assets.materials import MATERIALS
from assets.site import Monument

STEEPEST_FLOOR = 0.75
"""Faces whose normal's z is above this take their texture from above, others from the side."""


@dataclass(frozen=True)
class Mesh:
    """Triangles of one material, site frame."""

    material: str
    positions_m: NDArray[np.float32]
    """(n, 3)"""
    normals: NDArray[np.float32]
    """(n, 3), unit."""
    uvs: NDArray[np.float32]
    """(n, 2) in repeats of the material's texture."""
    colours: NDArray[np.uint8]
    """(n, 3) red green blue, linear, multiplied with the texture."""
    triangles: NDArray[np.uint32]
    """(m, 3), counter-clockwise from outside."""


@dataclass(frozen=True)
class Place:
    """Where a shape's own axes lie on the site."""

    origin_m: Array
    """(3,) site frame."""
    R_site_own: Array
    """(3, 3)"""

    @classmethod
    def at(cls, east_m: float, north_m: float, z_m: float, yaw_rad: float = 0.0) -> "Place":
        """Return axes at a point, x turned counter-clockwise from east by `yaw_rad`."""
        sin, cos = np.sin(yaw_rad), np.cos(yaw_rad)
        return cls(np.array([east_m, north_m, z_m]), np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]))

    @classmethod
    def of(cls, monument: Monument) -> "Place":
        """Return the monument's own axes at its floor level."""
        (e0, n0), (e1, n1) = monument.footprint.corners_en_m[:2]
        return cls.at(e0, n0, monument.base_z_m, float(np.arctan2(n1 - n0, e1 - e0)))

    def own(self, points_site_m: ArrayLike) -> Array:
        """Return (..., 3) points of the site in these axes."""
        return (np.asarray(points_site_m, dtype=np.float64) - self.origin_m) @ self.R_site_own


def footprint_own_m(monument: Monument) -> Array:
    """Return the footprint's corners (n, 2) in the monument's own axes."""
    corners = np.array([(e, n, monument.base_z_m) for e, n in monument.footprint.corners_en_m])
    return Place.of(monument).own(corners)[:, :2]


def size_m(monument: Monument) -> tuple[float, float]:
    """Return length (along x) and width (along y) of a footprint, in the monument's own axes."""
    length, width = footprint_own_m(monument).max(axis=0)
    return float(length), float(width)


@dataclass
class _Batch:
    material: str
    points: Array
    normals: Array
    uvs: Array
    tint: Array
    triangles: NDArray[np.int64]


@dataclass
class Shape:
    """What has been built so far. `tint` darkens or colours a part: one number or (red, green, blue), 1 is the material itself."""

    batches: list[_Batch] = field(default_factory=list)
    split_m: float = 0.0
    """Four-sided polygons with longer edges are laid as grids, so that light baked into corners has corners to lie in; 0: never."""

    def polygons(self, material: str, corners: ArrayLike, tint: ArrayLike = 1.0) -> None:
        """Add flat convex polygons, (n, 3) or (k, n, 3), counter-clockwise from outside; `tint` may have one row per polygon."""
        points = np.asarray(corners, dtype=np.float64)
        points = points[None] if points.ndim == 2 else points
        if self.split_m > 0.0 and points.shape[1] == 4:
            points, tint = _split(points, np.asarray(tint, dtype=np.float64), self.split_m)
        k, n, _ = points.shape
        normal = unit(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]))
        normals = np.repeat(normal[:, None], n, axis=1)
        fan = np.array([(0, i, i + 1) for i in range(1, n - 1)])
        triangles = (fan[None] + np.arange(k)[:, None, None] * n).reshape(-1, 3)
        tints = np.asarray(tint, dtype=np.float64)
        tints = np.repeat(tints[:, None], n, axis=1).reshape(k * n, -1) if tints.ndim == 2 else tints
        self._add(material, points.reshape(-1, 3), normals.reshape(-1, 3), _planar(points, normal), tints, triangles)

    def surface(self, material: str, points: ArrayLike, tint: ArrayLike = 1.0, from_above: bool = False) -> None:
        """Add a smooth surface through a grid of points, (a, b, 3): outside is to the left of a seen along b.

        Its texture follows the grid, or lies on it as seen `from_above`.
        """
        p = np.asarray(points, dtype=np.float64)
        a, b, _ = p.shape
        normals = unit(np.cross(np.gradient(p, axis=0), np.gradient(p, axis=1)))
        along_a = np.concatenate([np.zeros((1, b)), np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=2), axis=0)])
        along_b = np.concatenate(
            [np.zeros((a, 1)), np.cumsum(np.linalg.norm(np.diff(p, axis=1), axis=2), axis=1)], axis=1
        )
        uvs = p[..., :2] * (1.0, -1.0) if from_above else np.stack([along_a, along_b], -1)
        self._add(material, p.reshape(-1, 3), normals.reshape(-1, 3), uvs, tint, cells(a, b))

    def panels(self, material: str, corners: ArrayLike, uvs_m: ArrayLike, tint: ArrayLike = 1.0) -> None:
        """Add flat four-sided polygons (k, 4, 3) with the texture laid as told, (k, 4, 2) in metres; `tint` may have k rows."""
        points, uvs = np.asarray(corners, dtype=np.float64), np.asarray(uvs_m, dtype=np.float64)
        normal = unit(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]))
        fan = np.array([(0, 1, 2), (0, 2, 3)])
        triangles = (fan[None] + np.arange(len(points))[:, None, None] * 4).reshape(-1, 3)
        tints = np.asarray(tint, dtype=np.float64)
        tints = np.repeat(tints, 4, axis=0) if tints.ndim == 2 else tints
        self._add(material, points.reshape(-1, 3), np.repeat(normal, 4, axis=0), uvs, tints, triangles)

    def leaves(self, material: str, corners: Array, normals: Array, tint: Array) -> None:
        """Add loose triangles (k, 3, 3), each lit as if it faced its normal (k, 3) and turned to that side, with a tint (k, 3)."""
        k = len(corners)
        facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        away = np.einsum("ki,ki->k", facing, normals) < 0.0
        corners = np.where(away[:, None, None], corners[:, ::-1], corners)
        uvs = corners[..., :2] + corners[..., 2:] * (0.7, 0.5)
        flat = (np.repeat(normals, 3, axis=0), uvs, np.repeat(tint, 3, axis=0), np.arange(3 * k).reshape(k, 3))
        self._add(material, corners.reshape(-1, 3), *flat)

    def box(self, material: str, low: Sequence[float], high: Sequence[float], tint: ArrayLike = 1.0) -> None:
        """Add an upright box without its underside."""
        self.boxes(material, np.array([low]), np.array([high]), tint)

    def slab(self, material: str, low: Sequence[float], high: Sequence[float], tint: ArrayLike = 1.0) -> None:
        """Add an upright box with its underside, for what is seen from below."""
        self.box(material, low, high, tint)
        (x0, y0, z), (x1, y1, _) = low, high
        shade = np.asarray(tint, dtype=np.float64) * 0.88
        self.polygons(material, [(x0, y1, z), (x1, y1, z), (x1, y0, z), (x0, y0, z)], shade)

    def boxes(self, material: str, low: Array, high: Array, tint: ArrayLike = 1.0) -> None:
        """Add upright boxes from (k, 3) lower to (k, 3) upper corners, without undersides; `tint` may have one row per box."""
        corners = np.stack([low, high])[_BOX, :, np.arange(3)]  # (5, 4, 3, k) after fancy indexing
        faces = np.moveaxis(corners, -1, 0).reshape(-1, 4, 3)
        tints = np.asarray(tint, dtype=np.float64)
        self.polygons(material, faces, np.repeat(tints, 5, axis=0) if tints.ndim == 2 else tints)

    def copies(self, part: "Shape", offsets_m: Array, yaw_rad: Array | None = None, scale: Array | None = None) -> None:
        """Add `part` once per row of `offsets_m` (k, 3), turned about z by `yaw_rad` (k,) and enlarged by `scale` (k,)."""
        k = len(offsets_m)
        yaw, size = np.zeros(k) if yaw_rad is None else yaw_rad, np.ones(k) if scale is None else scale
        sin, cos, zero, one = np.sin(yaw), np.cos(yaw), np.zeros(k), np.ones(k)
        turn = np.stack([cos, -sin, zero, sin, cos, zero, zero, zero, one], -1).reshape(k, 1, 3, 3)
        for batch in part.batches:
            n = len(batch.points)
            points = (turn @ batch.points[None, :, :, None])[..., 0] * size[:, None, None] + offsets_m[:, None]
            normals = (turn @ batch.normals[None, :, :, None])[..., 0]
            triangles = batch.triangles[None] + np.arange(k)[:, None, None] * n
            uvs, tint = np.tile(batch.uvs, (k, 1)), np.tile(batch.tint, (k, 1))
            flat = (points.reshape(-1, 3), normals.reshape(-1, 3), uvs, tint, triangles.reshape(-1, 3))
            self.batches.append(_Batch(batch.material, *flat))

    def meshes(self, place: Place) -> list[Mesh]:
        """Return the shape on the site, one mesh per material, in the order of the materials' first use."""
        names = list(dict.fromkeys(batch.material for batch in self.batches))
        return [_joined(name, [b for b in self.batches if b.material == name], place) for name in names]

    def _add(
        self, material: str, points: Array, normals: Array, uvs: Array, tint: ArrayLike, triangles: NDArray[np.int64]
    ) -> None:
        tints = np.asarray(tint, dtype=np.float64)
        rows = np.broadcast_to(tints if tints.ndim else np.full(3, float(tints)), (len(points), 3))
        self.batches.append(_Batch(material, points, normals, uvs.reshape(-1, 2), np.array(rows), triangles))


def turned(shape: Shape, part: Shape, side: int, length_m: float, width_m: float) -> None:
    """Add `part`, whose front lies on y = 0 and looks to -y, on a side of a rectangle: 0 south, 1 east, 2 north, 3 west."""
    offset = ((0.0, 0.0), (length_m, 0.0), (length_m, width_m), (0.0, width_m))[side]
    shape.copies(part, np.array([[*offset, 0.0]]), np.array([side * np.pi / 2.0]))


def _joined(material: str, batches: list[_Batch], place: Place) -> Mesh:
    starts = np.cumsum([0] + [len(b.points) for b in batches[:-1]])
    return Mesh(
        material,
        (np.concatenate([b.points for b in batches]) @ place.R_site_own.T + place.origin_m).astype(np.float32),
        (np.concatenate([b.normals for b in batches]) @ place.R_site_own.T).astype(np.float32),
        (np.concatenate([b.uvs for b in batches]) / MATERIALS[material].tile_m).astype(np.float32),
        np.clip(np.concatenate([b.tint for b in batches]) * 255.0, 0.0, 255.0).round().astype(np.uint8),
        np.concatenate([b.triangles + s for b, s in zip(batches, starts, strict=True)]).astype(np.uint32),
    )


def _split(quads: Array, tint: Array, longest_m: float) -> tuple[Array, Array]:
    """Cut (k, 4, 3) four-sided polygons into grids with edges of at most `longest_m`; `tint` follows where it has k rows."""
    edges = np.linalg.norm(np.roll(quads, -1, axis=1) - quads, axis=2)
    counts = np.ceil(np.stack([edges[:, ::2].max(axis=1), edges[:, 1::2].max(axis=1)], -1) / longest_m - 1e-9)
    counts = np.maximum(counts.astype(int), 1)
    pieces, tints = [], []
    for a, b in np.unique(counts, axis=0):
        chosen = (counts == (a, b)).all(axis=1)
        p = quads[chosen][:, :, None, None]
        s, t = np.linspace(0.0, 1.0, a + 1)[None, :, None, None], np.linspace(0.0, 1.0, b + 1)[None, None, :, None]
        grid = (1 - s) * (1 - t) * p[:, 0] + s * (1 - t) * p[:, 1] + s * t * p[:, 2] + (1 - s) * t * p[:, 3]
        cut = np.stack([grid[:, :-1, :-1], grid[:, 1:, :-1], grid[:, 1:, 1:], grid[:, :-1, 1:]], axis=3)
        pieces.append(cut.reshape(-1, 4, 3))
        tints.append(np.repeat(tint[chosen], a * b, axis=0) if tint.ndim == 2 else tint)
    return np.concatenate(pieces), np.concatenate(tints) if tint.ndim == 2 else tint


_BOX = np.array(
    [
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],  # top
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 1]],
        [[0, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 1]],
    ]
)
"""The five faces of a box, counter-clockwise from outside: 0 the lower, 1 the upper value of x, y, z."""


def unit(vectors: Array) -> Array:
    """Return vectors (..., 3) at length 1; a vector of no length stays."""
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def _planar(points: Array, normal: Array) -> Array:
    """Texture coordinates in metres of (k, n, 3) flat polygons: from above on floors, along and down elsewhere."""
    flat = normal[:, 2] > STEEPEST_FLOOR
    along = unit(np.stack([-normal[:, 1], normal[:, 0], np.zeros(len(normal))], -1))
    along[np.abs(normal[:, 2]) > 0.999] = (1.0, 0.0, 0.0)
    along[flat & (np.abs(normal[:, 2]) <= 0.999)] = (1.0, 0.0, 0.0)
    down = np.cross(along, normal)
    down[flat] = (0.0, -1.0, 0.0)
    return np.stack([np.einsum("kni,ki->kn", points, along), np.einsum("kni,ki->kn", points, down)], -1)


def cells(a: int, b: int) -> NDArray[np.int64]:
    """Return two triangles per cell of an (a, b) grid, split from its first to its last corner; all the first ones come first."""
    first = (np.arange(a - 1)[:, None] * b + np.arange(b - 1)).ravel()
    next_a, next_b, last = first + b, first + 1, first + b + 1
    return np.concatenate([np.stack([first, next_a, last], -1), np.stack([first, last, next_b], -1)])
