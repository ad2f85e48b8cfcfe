"""What surrounds the ruins today: mountains, paths, stacked blocks, stones, grass, shrubs and trees."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import shapely
from shapely.geometry import LinearRing, Polygon

from assets import plants, rubble
from assets.axes import Array, agora_from_site
from assets.building import drawn_many, transforms
from assets.scene import Instanced
from assets.shape import Shape
from assets.site import Site
from assets.terrain import Terrain, numbers
from assets.textures import noise

CLEAR_M = 4.0
"""Nothing stands nearer to a way that visitors take."""
FAR_RADII_M = np.array([250.0, 420.0, 600.0, 850.0, 1150.0, 1500.0, 2000.0, 2700.0])
Box: TypeAlias = tuple[float, float, float, float]
"""u from and to, v from and to, metres in the site's own axes."""
PLANTS = ("bushes", "slope_bushes", "trees", "cypresses")


@dataclass(frozen=True)
class Landscape:
    """`[landscape]` of site.toml; a site without one has stones and grass along its ways, and nothing else grows there."""

    square_uv_m: Box
    """The open place, with stacked blocks at its edges."""
    hills: Array
    """(n, 4) azimuth in degrees, spread in radians, height and reach in metres of what stands around."""
    plants: Mapping[str, Array]
    """(n, 5) how many, and the box, for each of `PLANTS`."""
    far_bushes_uv_m: Array
    """(n, 4) boxes."""

    @classmethod
    def of(cls, site: Site) -> "Landscape":
        """Read it; `SiteError` where it holds something other than the numbers it should."""
        table = site.landscape
        if "square_uv_m" in table:
            u0, u1, v0, v1 = numbers(table, "landscape", "square_uv_m", (4,)).tolist()
        else:
            uv = np.array([corner for way in site.ways for corner in way] or [(0.0, 0.0)])
            uv = uv @ agora_from_site(site.azimuth_rad).T
            (u0, v0), (u1, v1) = uv.min(axis=0).tolist(), uv.max(axis=0).tolist()
        return cls(
            (u0, u1, v0, v1),
            _rows(table, "hills", 4),
            {k: _rows(table, k, 5) for k in PLANTS},
            _rows(table, "far_bushes", 4),
        )


def _rows(table: Mapping[str, Any], key: str, width: int) -> Array:
    return numbers(table, "landscape", key, (None, width)) if key in table else np.zeros((0, width))


def walked(site: Site) -> shapely.Geometry:
    """Return where visitors walk: along the ways, and anywhere inside the convex ones."""
    ways = [LinearRing(way) for way in site.ways]
    open_places = [Polygon(way) for way in ways if abs(Polygon(way).area - way.convex_hull.area) < 1.0]
    return shapely.union_all([*ways, *open_places])


class Planting:
    """Finds places on the ground for things, clear of ways and of what stands."""

    def __init__(self, site: Site, terrain: Terrain, rng: np.random.Generator) -> None:
        self.terrain, self.rng, self.land = terrain, rng, Landscape.of(site)
        self._axes = agora_from_site(site.azimuth_rad)
        self._walked = walked(site)
        standing = [Polygon(m.footprint.corners_en_m) for m in site.shown_in("today") if m.kind != "paving"]
        self._standing = shapely.union_all(standing)
        shapely.prepare(self._walked)
        shapely.prepare(self._standing)

    def places(self, count: int, box_uv: Box, clear_m: float, off_m: float) -> Array:
        """Return at most `count` points (n, 3) on the ground of a box, `clear_m` off the ways, `off_m` off monuments."""
        u0, u1, v0, v1 = box_uv
        uv = np.stack([self.rng.uniform(u0, u1, count), self.rng.uniform(v0, v1, count)], -1)
        en = uv @ self._axes
        points = shapely.points(en)
        free = shapely.distance(points, self._walked) > clear_m if clear_m > 0.0 else np.ones(count, dtype=bool)
        free &= shapely.distance(points, self._standing) > off_m
        return np.column_stack([en, self.terrain.ground_z_m(en[:, 0], en[:, 1])])[free]


def mountains(planting: Planting) -> Shape:
    """Return the hills beyond the terrain."""
    terrain = planting.terrain
    azimuth = np.linspace(0.0, 2.0 * np.pi, 121)
    east, north = (FAR_RADII_M[:, None] * f(azimuth) for f in (np.sin, np.cos))
    rough = noise(301, 128, 2, 30, 1.1)
    bumps = rough[(np.arange(8) * 13 % 128)[:, None], np.arange(121)[None] % 120]
    rise = np.zeros_like(east)
    for centre_deg, spread, height, reach in planting.land.hills:
        off = np.angle(np.exp(1j * (azimuth - np.radians(centre_deg))))
        near = np.clip((FAR_RADII_M - 330.0) / (reach - 330.0), 0.0, 1.6)
        rise += height * np.exp(-((off / spread) ** 2)) * (np.sin(np.minimum(near, 1.0) * np.pi / 2.0) ** 1.5)[:, None]
    outward = np.clip((FAR_RADII_M - 380.0) / 900.0, 0.0, 1.0)[:, None]
    edge = terrain.ground_z_m(east, north)
    z = edge * (1.0 - 0.75 * outward) + rise + bumps * 26.0 * outward - 3.0 - 25.0 * outward
    z[0] -= 25.0
    shape = Shape()
    shape.surface("scrub", np.stack([east, north, z], -1)[::-1], 0.92, from_above=True)
    return shape


THINNED = (1, 3, 12)
"""By level: every how manieth tuft and stone is drawn."""


def grasses(planting: Planting, level: int) -> list[Instanced]:
    """Return tufts of dry grass all over, thickest in patches."""
    rng = np.random.default_rng(11)
    u0, u1, v0, v1 = planting.land.square_uv_m
    inside = planting.places(2500, (u0, u1 + 6.0, v0 - 14.0, v1 + 18.0), 0.0, -1.0)
    around = planting.places(500, (u0 - 25.0, u1 + 30.0, v0 - 45.0, v1 + 70.0), 0.0, 0.3)
    everywhere = np.concatenate([inside, around])
    patches = noise(311, 256, 3, 60, 0.8)
    i, j = (np.floor(everywhere[:, k] * 2.0).astype(int) % 256 for k in (0, 1))
    everywhere = everywhere[patches[i, j] + rng.normal(0.0, 0.5, len(everywhere)) > -0.1]
    return _strewn([plants.clump(rng) for _ in range(6)], everywhere, rng, (0.7, 1.35), THINNED[level])


def stones(planting: Planting, level: int) -> list[Instanced]:
    """Return small stones lying in the grass."""
    rng = np.random.default_rng(12)
    u0, u1, v0, v1 = planting.land.square_uv_m
    places = planting.places(3400, (u0, u1 + 6.0, v0 - 14.0, v1), 0.0, 0.2)
    variants = []
    for _ in range(6):
        part = Shape()
        size = rng.uniform((0.9, 0.7, 0.35), (1.7, 1.2, 0.7), (1, 3))
        rubble.blocks(part, rng, np.zeros((1, 3)), size, np.zeros(1), 0.16)
        variants.append(part)
    return _strewn(variants, places, rng, 0.07 * np.exp(rng.normal(0.0, 0.55, len(places))), THINNED[level])


def _strewn(
    variants: list[Shape], places_m: Array, rng: np.random.Generator, scale: tuple[float, float] | Array, every: int
) -> list[Instanced]:
    """Return places (n, 3) shared out among variants, each turned about z and scaled: from and to, or (n,)."""
    n = len(places_m)
    size = rng.uniform(*scale, n) if isinstance(scale, tuple) else scale
    T = transforms(places_m, rng.uniform(0.0, 2.0 * np.pi, n), np.repeat(size[:, None], 3, axis=1))[::every]
    many = [drawn_many(variant, T[i :: len(variants)]) for i, variant in enumerate(variants)]
    return [part for parts in many for part in parts]


def stacked(planting: Planting) -> Shape:
    """Return the architecture found here, laid up in rows and stacks at the edges of the square, and lying about."""
    shape, rng = Shape(), planting.rng
    u0, u1, v0, v1 = planting.land.square_uv_m
    strips = (
        (u0, u1, v0 + 1.0, v0 + 9.0, 60),
        (u0, u1, v1 - 5.0, v1 - 1.0, 40),
        (u1 - 9.0, u1, v0, v1, 24),
        (u0, u0 + 8.0, v0, v1, 24),
    )
    for a, b, c, d, count in strips:
        for x, y, z in planting.places(count, (a, b, c, d), CLEAR_M + 2.0, 1.6):
            rubble.stack(
                shape, rng, x, y, z, -0.26 + float(rng.choice([0.0, np.pi / 2.0])) + float(rng.normal(0.0, 0.08))
            )
    rubble.scatter(shape, rng, planting.places(420, planting.land.square_uv_m, CLEAR_M + 0.6, 0.8), 1.0)
    for place in planting.places(60, planting.land.square_uv_m, CLEAR_M + 1.0, 1.2):
        part = rubble.lying_drum(float(rng.uniform(0.45, 0.8)), float(rng.uniform(0.8, 2.2)))
        shape.copies(part, place[None], rng.uniform(0.0, np.pi, 1))
    for place in planting.places(30, planting.land.square_uv_m, CLEAR_M, 1.2):
        shape.copies(rubble.drum(float(rng.uniform(0.5, 0.8)), float(rng.uniform(0.4, 1.5))), place[None])
    return shape


_MAKERS: tuple[tuple[str, Callable[[np.random.Generator, int], Shape], float], ...] = (
    ("bushes", plants.bush, 0.6),
    ("slope_bushes", plants.slope_bush, 0.6),
    ("trees", plants.tree, 2.5),
    ("cypresses", plants.cypress, 2.0),
)
"""What grows: its name in the data, its maker, how far it keeps from monuments."""


def planted(planting: Planting, level: int) -> list[Instanced]:
    """Return shrubs and trees, none of them on a way; all are the same few, turned and scaled."""
    found = [part for row in range(len(_MAKERS)) for part in _grown(planting, row, level)]
    return found + _far_bushes(planting, level, 900)


def wooded(planting: Planting, level: int) -> list[Instanced]:
    """Return the trees and the maquis of the slopes alone: what may have grown around the city."""
    coarser = max(level, 1)  # nobody comes near them
    return _grown(planting, 2, coarser) + _grown(planting, 3, coarser) + _far_bushes(planting, coarser, 400)


def _grown(planting: Planting, row: int, level: int) -> list[Instanced]:
    """Plants of one row of the table."""
    name, make, off_m = _MAKERS[row]
    boxes = [(int(count), (u0, u1, v0, v1)) for count, u0, u1, v0, v1 in planting.land.plants[name].tolist()]
    if not boxes:
        return []
    variants = [make(np.random.default_rng(100 * row + k), level) for k in range(4)]
    rng = np.random.default_rng(30 + row)
    places = np.concatenate([planting.places(count, box, CLEAR_M + 1.5, off_m) for count, box in boxes])
    return _strewn(variants, places, rng, np.exp(rng.normal(0.0, 0.28, len(places))), 1)


def _far_bushes(planting: Planting, level: int, count: int) -> list[Instanced]:
    variants = [plants.far_bush(np.random.default_rng(40 + k), level) for k in range(4)]
    found = []
    for i, (u0, u1, v0, v1) in enumerate(planting.land.far_bushes_uv_m.tolist()):
        places = planting.places(count, (u0, u1, v0, v1), 0.0, 1.0)
        found += _strewn(variants, places, np.random.default_rng(50 + i), (1.3, 3.6 + i), 1)
    return found


def path(terrain: Terrain, rng: np.random.Generator, way_en_m: Array, width_m: float) -> Shape:
    """Return a trodden path along a polyline (n, 2), ragged at its edges, laid on the ground."""
    legs = np.diff(way_en_m, axis=0)
    reached = np.concatenate([[0.0], np.cumsum(np.hypot(legs[:, 0], legs[:, 1]))])
    along = np.arange(0.0, reached[-1], 0.9)
    middle = np.stack([np.interp(along, reached, way_en_m[:, k]) for k in (0, 1)], -1)
    smooth = np.ones(7) / 7.0
    middle = np.stack([np.convolve(np.pad(middle[:, k], 3, mode="edge"), smooth, mode="valid") for k in (0, 1)], -1)
    heading = np.gradient(middle, axis=0)
    side = np.stack([-heading[:, 1], heading[:, 0]], -1) / np.linalg.norm(heading, axis=1, keepdims=True)
    rows = []
    for edge in (0.5, 0.2, -0.2, -0.5):
        wander = np.convolve(rng.normal(0.0, 0.28, len(middle) + 4), np.ones(5) / 2.2, mode="valid")
        en = middle + side * edge * width_m * (1.0 + wander[:, None] * (abs(edge) > 0.4))
        rows.append(
            np.column_stack([en, terrain.ground_z_m(en[:, 0], en[:, 1]) + (0.03 if abs(edge) < 0.4 else 0.008)])
        )
    shape = Shape()
    shape.surface("earth", np.stack(rows), from_above=True)
    return shape
