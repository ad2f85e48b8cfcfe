"""Where one can walk on a site, and what stops one: a navigation mesh and collision proxies, for both models.

The mesh is the terrain where it is not too steep and nothing stands, with the floors and stairs of the monuments.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import get_args

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from assets.axes import Array, agora_from_site
from assets.footing import Floor, Footing, footing
from assets.prisms import laid, plain_mesh, prism
from assets.records import PAVING, Epoch, Monument, Site
from assets.scene import Node, Scene
from assets.shape import Place, cells, unit
from assets.terrain import Terrain, build_terrain

STEEPEST = 0.8
"""Ground whose normal's z is less is not walked on: 37 degrees."""
BODY_M = 0.25
"""How near to a solid the middle of a walker comes."""
HIGHEST_STAIR_M = 1.5
"""A stair whose foot would lie deeper has lost it: it begins here."""
INTO_GROUND_M = 1.0
"""How far a collision proxy reaches into the ground."""
WHITE = np.full((1, 1, 3), 255, dtype=np.uint8)


@dataclass(frozen=True)
class _Standing:
    """A monument's footing on the site."""

    monument: Monument
    footing: Footing
    place: Place

    def on_site(self, outline: BaseGeometry) -> BaseGeometry:
        """Return an outline of the monument's own axes in the site's."""
        (a, b, _), (c, d, _) = self.place.R_site_own[:2]
        x, y = self.place.origin_m[:2]
        return shapely.affinity.affine_transform(outline, [a, b, c, d, x, y])


def walkable(site: Site) -> Scene:
    """Return nodes `walkable/MODEL` (role `walkable`) and, per solid monument, `collision/MODEL/MONUMENT` (role `collision`).

    The extras name the `model`, and the `monument` of a proxy. Proxies are closed; the mesh lies on the terrain's own triangles.

    Raises:
        SiteError: The terrain or a monument lacks a figure.
    """
    terrain = build_terrain(site)
    nodes: list[Node] = []
    for epoch in get_args(Epoch):
        standing = [_Standing(m, footing(m, epoch), Place.of(m)) for m in site.shown_in(epoch) if m.kind != PAVING]
        if not standing and epoch not in {e for m in site.monuments for e in m.epochs}:
            continue
        mesh = plain_mesh(_surface(site, terrain, standing))
        nodes.append(Node(f"walkable/{epoch}", [mesh], {"role": "walkable", "model": epoch}))
        nodes += [_proxy(one, epoch, terrain) for one in standing if one.footing.solids]
    return Scene(nodes, {mesh.material: WHITE for node in nodes for mesh in node.meshes})


def _surface(site: Site, terrain: Terrain, standing: list[_Standing]) -> Array:
    """Triangles (m, 3, 3) to walk on."""
    solid = {one.monument.id: _solid(one) for one in standing}
    taken = shapely.union_all([Polygon(one.monument.footprint.corners_en_m) for one in standing])
    around = shapely.union_all(list(solid.values())).buffer(BODY_M, join_style="mitre")
    parts = [_ground(site, terrain, taken.union(around))]
    for one in standing:
        others = [other for other in standing if other is not one and other.monument.stands_on == one.monument.id]
        covered = [Polygon(other.monument.footprint.corners_en_m) for other in others]
        in_the_way = solid[one.monument.id] if one.monument.kind != "terrace" else shapely.Polygon()
        blocked = shapely.union_all([in_the_way.buffer(BODY_M, join_style="mitre"), *covered])
        parts += [_floor(one, floor, terrain, blocked) for floor in one.footing.floors]
    return np.concatenate(parts)


def _solid(one: _Standing) -> BaseGeometry:
    return shapely.union_all([one.on_site(solid.outline) for solid in one.footing.solids])


def _ground(site: Site, terrain: Terrain, taken: BaseGeometry) -> Array:
    """The terrain's gentle triangles within the rectangle whose levels are known, less what is taken."""
    points = terrain.grid_points_m()
    corners = points.reshape(-1, 3)[cells(*points.shape[:2])]
    normal = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    corners = corners[np.abs(normal[:, 2]) > STEEPEST]
    u0, u1, v0, v1 = site.terrain["relief_beyond_m"]
    known = np.array([(u0, v0), (u1, v0), (u1, v1), (u0, v1)]) @ agora_from_site(site.azimuth_rad)
    free = Polygon(known).difference(taken)
    return _cut(corners, free)


def _cut(triangles: Array, free: BaseGeometry) -> Array:
    """Triangles (m, 3, 3) clipped to `free`, each part on the plane of the triangle that it comes from."""
    shapely.prepare(free)
    flat = np.asarray(shapely.polygons(triangles[:, :, :2]))
    whole = shapely.contains_properly(free, flat)
    parts = [triangles[whole]]
    for corners, outline in zip(triangles[~whole], flat[~whole], strict=True):
        if free.intersects(outline):
            parts += [_on_plane(piece, corners) for piece in laid(free.intersection(outline))]
    return np.concatenate(parts)


def _on_plane(flat: Array, corners: Array) -> Array:
    """Flat triangles (m, 3, 2) lifted onto the plane through three corners (3, 3)."""
    edges = corners[1:, :2] - corners[0, :2]
    shares = np.linalg.solve(edges.T, (flat.reshape(-1, 2) - corners[0, :2]).T)
    z = corners[0, 2] + (corners[1:, 2] - corners[0, 2]) @ shares
    return np.concatenate([flat, z.reshape(-1, 3, 1)], axis=2)


def _floor(one: _Standing, floor: Floor, terrain: Terrain, blocked: BaseGeometry) -> Array:
    """A level floor, or a stair as a slope from the ground before it up to the floor."""
    pieces = laid(one.on_site(floor.outline).difference(blocked))
    flat = np.concatenate(pieces) if pieces else np.zeros((0, 3, 2))
    top = one.monument.base_z_m + floor.z_m
    z = np.full(flat.shape[:2], top)
    if floor.rises_from is not None:
        outline = floor.outline.bounds
        own = one.place.own(np.concatenate([flat, z[..., None]], axis=2))
        axis = 1 if floor.rises_from in ("south", "north") else 0
        low, high = outline[axis], outline[axis + 2]
        share = (own[..., axis] - low) / (high - low)
        share = 1.0 - share if floor.rises_from in ("north", "east") else share
        edge = shapely.get_coordinates(shapely.segmentize(one.on_site(floor.outline).boundary, 2.0))
        ground = float(np.median(terrain.ground_z_m(edge[:, 0], edge[:, 1])))
        foot = min(max(ground, top - HIGHEST_STAIR_M), top)
        z = foot * (1.0 - share) + top * share
    return np.concatenate([flat, z[..., None]], axis=2)


def _proxy(one: _Standing, epoch: Epoch, terrain: Terrain) -> Node:
    monument = one.monument
    bounds = np.array(monument.footprint.corners_en_m)
    bottom = min(float(terrain.ground_z_m(bounds[:, 0], bounds[:, 1]).min()), monument.base_z_m) - INTO_GROUND_M
    solids = [
        prism(piece, bottom, monument.base_z_m + solid.top_m)
        for solid in one.footing.solids
        for piece in _polygons(one.on_site(solid.outline))
    ]
    extras = {"role": "collision", "model": epoch, "monument": monument.id}
    return Node(f"collision/{epoch}/{monument.id}", solids, extras)


def _polygons(geometry: BaseGeometry) -> Iterator[Polygon]:
    yield from (part for part in shapely.get_parts(geometry) if isinstance(part, Polygon))
