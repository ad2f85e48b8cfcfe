"""Where one can walk: on the ground where nothing stands, on floors and stairs, and not through walls."""

from typing import get_args

import numpy as np
import pytest
import shapely
import trimesh

from assets.axes import agora_from_site
from assets.footholds import Footholds
from assets.footing import Floor, Footing, Solid, footing
from assets.gltf import Scene
from assets.records import PAVING, Epoch
from assets.shape import Mesh, Place
from assets.site import Monument, Site
from assets.terrain import Terrain
from assets.walkable import BODY_M, walkable
from tests.assets.geometry import across

EPOCHS: tuple[Epoch, ...] = get_args(Epoch)


@pytest.fixture(scope="module")
def ways(site: Site) -> Scene:
    return walkable(site)


@pytest.fixture(scope="module")
def footholds(ways: Scene) -> dict[Epoch, Footholds]:
    return {epoch: Footholds.of(ways, epoch) for epoch in EPOCHS}


def mesh_of(scene: Scene, epoch: Epoch) -> Mesh:
    (mesh,) = next(node for node in scene.nodes if node.name == f"walkable/{epoch}").meshes
    return mesh


def triangles_of(mesh: Mesh) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return mesh.positions_m[mesh.triangles].astype(np.float64)


def outline(monument: Monument) -> shapely.Polygon:
    return shapely.Polygon(monument.footprint.corners_en_m)


@pytest.mark.parametrize("epoch", EPOCHS)
def test_the_square_is_walked_on_at_the_ground(
    footholds: dict[Epoch, Footholds], terrain: Terrain, epoch: Epoch
) -> None:
    for east, north in ((0.0, 0.0), (-20.0, -30.0), (20.0, -45.0), (-109.0, 53.0)):
        assert footholds[epoch].height_m(east, north) == pytest.approx(terrain.ground_z_m(east, north), abs=1e-3)


@pytest.mark.parametrize("epoch", EPOCHS)
def test_off_the_monuments_the_mesh_lies_on_the_terrain(
    site: Site, ways: Scene, terrain: Terrain, epoch: Epoch
) -> None:
    centres = triangles_of(mesh_of(ways, epoch)).mean(axis=1)
    standing = shapely.union_all([outline(m) for m in site.shown_in(epoch) if m.kind != PAVING])
    free = shapely.distance(shapely.points(centres[:, :2]), standing) > 1e-3
    assert free.sum() > 1000
    assert centres[free, 2] == pytest.approx(terrain.ground_z_m(centres[free, 0], centres[free, 1]), abs=2e-3)


@pytest.mark.parametrize("epoch", EPOCHS)
def test_nothing_is_walked_on_from_below_and_nothing_is_steep(ways: Scene, epoch: Epoch) -> None:
    area = across(triangles_of(mesh_of(ways, epoch)))
    assert (area[:, 2] > 0.0).all()
    assert (area[:, 2] / np.linalg.norm(area, axis=1)).min() > 0.5


@pytest.mark.parametrize("epoch", EPOCHS)
def test_ground_and_monuments_share_out_the_level_part(site: Site, ways: Scene, terrain: Terrain, epoch: Epoch) -> None:
    """Inside the square: what is walked on, and what stands there with the room of a body around it, is all of it."""
    place = outline(site.monument("square")).buffer(-1.0)
    mesh = triangles_of(mesh_of(ways, epoch))
    walked = shapely.union_all(shapely.polygons(mesh[:, :, :2])).intersection(place)
    solids = [_solid(m, epoch) for m in site.shown_in(epoch) if m.kind != PAVING]
    blocked = shapely.union_all(solids).buffer(BODY_M, join_style="mitre").intersection(place)
    assert walked.area + blocked.area == pytest.approx(place.area, rel=1e-3)


def _solid(monument: Monument, epoch: Epoch) -> shapely.geometry.base.BaseGeometry:
    place = Place.of(monument)
    (a, b, _), (c, d, _) = place.R_site_own[:2]
    x, y = place.origin_m[:2]
    solids = [solid.outline for solid in footing(monument, epoch).solids]
    return shapely.affinity.affine_transform(shapely.union_all(solids), [a, b, c, d, x, y])


def test_a_visitor_climbs_the_steps_of_the_basilica(site: Site, footholds: dict[Epoch, Footholds]) -> None:
    v = np.array([1.0, 2.5, 3.1, 3.7, 4.5, 10.0])
    en = np.column_stack([np.full_like(v, -20.0), v]) @ agora_from_site(site.azimuth_rad)
    heights = [footholds["today"].height_m(float(e), float(n)) for e, n in en]
    assert None not in heights
    climbed = [h for h in heights if h is not None]
    assert climbed == sorted(climbed)
    assert climbed[0] == pytest.approx(0.0, abs=0.01)
    assert climbed[-1] == pytest.approx(0.9, abs=0.01)


def test_the_temple_is_climbed_in_the_roman_square_only(footholds: dict[Epoch, Footholds]) -> None:
    place = Place.at(-75.73, -16.4, 0.0, np.arctan2(-5.18, 21.59))
    east, north, _ = place.R_site_own @ np.array([1.5, 5.0, 0.0]) + place.origin_m
    assert footholds["roman"].height_m(float(east), float(north)) == pytest.approx(0.9, abs=0.01)
    assert footholds["today"].height_m(float(east), float(north)) is None
    assert footholds["roman"].height_m(-63.2, -11.9) is None  # the cella


@pytest.mark.parametrize("epoch", EPOCHS)
def test_one_can_stand_at_every_stop_and_on_every_way(
    site: Site, footholds: dict[Epoch, Footholds], epoch: Epoch
) -> None:
    for stop in site.tour:
        assert footholds[epoch].height_m(stop.e_m, stop.n_m) is not None, stop.id
    assert all(footholds[epoch].height_m(e, n) is not None for way in site.ways for e, n in way)


@pytest.mark.parametrize("epoch", EPOCHS)
def test_proxies_are_closed_and_nobody_stands_inside(site: Site, ways: Scene, epoch: Epoch) -> None:
    nodes = [node for node in ways.nodes if node.extras["role"] == "collision" and node.extras["model"] == epoch]
    solid = {m.id for m in site.shown_in(epoch) if footing(m, epoch).solids}
    assert {node.extras["monument"] for node in nodes} == solid
    centres = triangles_of(mesh_of(ways, epoch)).mean(axis=1)
    points = shapely.points(centres[:, :2])
    for node in nodes:
        for mesh in node.meshes:
            body = trimesh.Trimesh(mesh.positions_m, mesh.triangles)
            assert body.is_watertight
            assert body.volume > 0.0
            if node.name.endswith("_terrace"):
                continue  # its top is a floor
            below = shapely.union_all(np.asarray(shapely.polygons(triangles_of(mesh)[:, :, :2])))
            assert not shapely.contains_properly(below, points).any(), node.name


def test_a_proxy_is_as_large_as_the_footprint_of_a_solid_monument(site: Site, ways: Scene) -> None:
    for monument_id in ("pollio", "chalcidicum_w", "baths"):
        monument = site.monument(monument_id)
        (mesh,) = next(n for n in ways.nodes if n.name == f"collision/roman/{monument_id}").meshes
        body = trimesh.Trimesh(mesh.positions_m, mesh.triangles)
        assert body.volume == pytest.approx(outline(monument).area * np.ptp(mesh.positions_m[:, 2]), rel=1e-3)
        assert mesh.positions_m[:, 2].max() == pytest.approx(monument.base_z_m + monument.height_m, abs=1e-3)


@pytest.mark.parametrize("epoch", EPOCHS)
def test_floors_and_solids_do_not_overlap(site: Site, epoch: Epoch) -> None:
    for monument in site.shown_in(epoch):
        if monument.kind == "terrace":
            continue  # one stands on top of the solid
        parts: Footing = footing(monument, epoch)
        pieces: list[Floor | Solid] = [*parts.floors, *parts.solids]
        total = sum(piece.outline.area for piece in pieces)
        assert shapely.union_all([piece.outline for piece in pieces]).area == pytest.approx(total, abs=1e-6)
        assert total == pytest.approx(0.0 if monument.kind == PAVING else outline(monument).area, rel=1e-6)


def test_the_same_facts_give_the_same_surface(site: Site, ways: Scene) -> None:
    again = walkable(site)
    for one, two in zip(ways.nodes, again.nodes, strict=True):
        assert one.name == two.name
        for a, b in zip(one.meshes, two.meshes, strict=True):
            assert np.array_equal(a.positions_m, b.positions_m)
            assert np.array_equal(a.triangles, b.triangles)
