"""The site as it stands today: where visitors walk nothing stands, and what the site is known for is there."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from assets.errors import SiteError
from assets.landscape import walked
from assets.scene import Scene
from assets.site import Site
from assets.terrain import Terrain
from assets.today import RUINS, build_today
from tests.assets.geometry import corners
from tracker.choreography import AGORA_TOUR


def standing(scene: Scene, terrain: Terrain) -> shapely.Geometry:
    """Return the outlines, from above, of all that rises over a step from the ground near the square."""
    outlines = []
    for node in scene.nodes:
        if node.extras["role"] == "building" or node.name == "plants":
            triangles = corners(node)
            near = np.hypot(triangles[..., 0] + 40.0, triangles[..., 1] + 10.0).min(axis=1) < 130.0
            triangles = triangles[near]
            ground = terrain.ground_z_m(triangles[..., 0], triangles[..., 1])
            tall = (triangles[..., 2] - ground).max(axis=1) > 0.15
            outlines.extend(shapely.polygons(triangles[tall][..., :2]))
    return shapely.MultiPolygon([p for p in outlines if p.area > 1e-6])


def test_the_ways_are_the_tours(site: Site) -> None:
    assert site.ways == (AGORA_TOUR.ring_en_m, AGORA_TOUR.loop_en_m)


def test_nothing_stands_within_two_metres_of_the_tour(site: Site, today: Scene, terrain: Terrain) -> None:
    tour = shapely.union_all(
        [shapely.LinearRing(AGORA_TOUR.ring_en_m).buffer(1.5), shapely.Polygon(AGORA_TOUR.loop_en_m)]
    )
    triangles = shapely.get_parts(standing(today, terrain))
    assert len(triangles) > 10_000
    assert shapely.distance(triangles, tour).min() >= 2.0


def test_the_walked_place_holds_the_inside_of_convex_ways_only(site: Site) -> None:
    place = walked(site)
    assert shapely.contains(place, shapely.Point(0.0, -20.0))
    assert not shapely.contains(place, shapely.Point(-63.0, -12.0))


def test_every_monument_of_today_is_there_but_the_paving_under_the_grass(site: Site, today: Scene) -> None:
    names = [node.name for node in today.nodes]
    shown = [m.id for m in site.shown_in("today") if m.id != "square"]
    assert names == ["ground", *shown, "mountains", "paths", "stacked_blocks", "stones", "grass", "plants"]


def test_about_a_dozen_columns_of_the_basilica_stand_again(site: Site, today: Scene) -> None:
    basilica = site.monument("basilica_stoa")
    triangles = corners(next(node for node in today.nodes if node.name == "basilica_stoa"))
    high = triangles[triangles[..., 2].min(axis=1) > basilica.base_z_m + 2.95]
    columns = shapely.union_all(shapely.points(high.reshape(-1, 3)[:, :2]).tolist()).buffer(0.5)
    assert 10 <= len(shapely.get_parts(columns)) <= 16


def test_no_ruin_is_higher_than_its_monument_was_by_more_than_a_fallen_block(site: Site, today: Scene) -> None:
    for monument in site.shown_in("today"):
        if monument.kind in RUINS and monument.kind not in {"basin", "steps"}:
            top = corners(next(node for node in today.nodes if node.name == monument.id))[..., 2].max()
            assert top <= monument.base_z_m + monument.height_m + 0.9


def test_the_arch_and_the_socle_stand(site: Site, today: Scene) -> None:
    for monument_id, least_m in (("fountain_domitian", 8.6), ("pollio", 5.5), ("memmius", 6.5)):
        node = next(node for node in today.nodes if node.name == monument_id)
        assert corners(node)[..., 2].max() > site.monument(monument_id).base_z_m + least_m


def test_plants_and_grass_grow_on_the_ground(today: Scene, terrain: Terrain) -> None:
    for name in ("grass", "plants"):
        points = corners(next(node for node in today.nodes if node.name == name)).reshape(-1, 3)[::97]
        over = points[:, 2] - terrain.ground_z_m(points[:, 0], points[:, 1])
        assert np.percentile(over, 1.0) > -0.75  # the rest are at the foot of banks
        assert over.max() < 20.0


def test_a_kind_that_nothing_builds_is_named(site: Site) -> None:
    odd = replace(site.monument("pollio"), kind="ziggurat")
    with pytest.raises(SiteError, match=r"'pollio' is of kind 'ziggurat', which nothing builds"):
        build_today(replace(site, monuments=(odd,)), lambda share: None)


def test_levels_have_the_same_nodes_and_are_ever_leaner(site: Site, today: Scene) -> None:
    levels = [today, *(build_today(site, lambda share: None, level) for level in (1, 2))]
    for other in levels[1:]:
        assert [(n.name, n.extras) for n in other.nodes] == [(n.name, n.extras) for n in today.nodes]
    finest, middle, first = (sum(node.triangles for node in scene.nodes) for scene in levels)
    assert finest <= 370_000
    assert finest > middle > first


def test_what_grows_is_drawn_from_a_few_parts(today: Scene) -> None:
    for name in ("stones", "grass", "plants"):
        node = next(node for node in today.nodes if node.name == name)
        assert not node.meshes
        assert sum(len(part.T_site_part) for part in node.instances) > 30 * len(node.instances)
