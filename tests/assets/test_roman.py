"""The ancient square against its facts: every monument there, named, as high and as wide as the data say."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from assets.errors import SiteError
from assets.ground import LIFT_M
from assets.materials import MATERIALS
from assets.records import PAVING, Evidence, Monument, Site
from assets.roman import BUILDERS, build_roman
from assets.scene import Node, Scene
from assets.site import load_site
from assets.terrain import Terrain
from tests.assets.conftest import SITE
from tests.assets.geometry import corners

SHOWN = load_site(SITE).shown_in("roman")
STANDING = [monument for monument in SHOWN if monument.kind != PAVING]
LAID = [monument for monument in SHOWN if monument.kind == PAVING]


def node_of(scene: Scene, monument: Monument) -> Node:
    return next(node for node in scene.nodes if node.name == monument.id)


def all_of(scene: Scene, monument: Monument, role: str = "building") -> NDArray[np.float64]:
    """Return the triangles (m, 3, 3) of a monument's elements, rivals of its default reconstruction left out."""
    nodes = [n for n in scene.nodes if n.extras.get("monument") == monument.id and n.extras["role"] == role]
    return np.concatenate([corners(n) for n in nodes if n.extras.get("variant") in (None, monument.default_variant)])


def outline(monument: Monument) -> shapely.Polygon:
    return shapely.Polygon(monument.footprint.corners_en_m)


def name(monument: Monument) -> str:
    return monument.id


def test_every_monument_is_there_once_and_nothing_else(site: Site, roman: Scene) -> None:
    names = [node.name for node in roman.nodes]
    shown = [monument.id for monument in site.shown_in("roman")]
    assert [name for name in names if "/" not in name] == ["ground", *shown, "mountains", "plants"]
    assert len(set(names)) == len(names)


def test_an_element_is_named_after_its_monument(roman: Scene) -> None:
    for node in roman.nodes:
        if "/" in node.name:
            assert node.extras["monument"] == node.name.partition("/")[0]


@pytest.mark.parametrize("monument", STANDING, ids=name)
def test_a_monument_is_as_high_as_its_figure(monument: Monument, roman: Scene) -> None:
    top = all_of(roman, monument)[..., 2].max()
    assert top == pytest.approx(monument.base_z_m + monument.height_m, abs=0.05)


@pytest.mark.parametrize("monument", STANDING, ids=name)
def test_a_monument_stands_on_its_footprint(monument: Monument, roman: Scene) -> None:
    points = all_of(roman, monument).reshape(-1, 3)
    at_floor = points[np.abs(points[:, 2] - monument.base_z_m) < 0.06]
    built = shapely.MultiPoint(at_floor[:, :2]).convex_hull
    assert shapely.hausdorff_distance(built, outline(monument).convex_hull) < 0.25


@pytest.mark.parametrize("monument", STANDING, ids=name)
def test_nothing_stands_out_by_more_than_a_metre(monument: Monument, roman: Scene) -> None:
    points = all_of(roman, monument).reshape(-1, 3)
    around = outline(monument).buffer(1.0, join_style="mitre")
    assert shapely.distance(shapely.points(points[:, :2]), around).max() < 1e-4


@pytest.mark.parametrize("monument", STANDING, ids=name)
def test_a_monument_reaches_into_the_ground(monument: Monument, roman: Scene, terrain: Terrain) -> None:
    points = corners(node_of(roman, monument)).reshape(-1, 3)
    edge = np.array(shapely.segmentize(outline(monument).exterior, 3.0).coords)
    below = terrain.ground_z_m(edge[:, 0], edge[:, 1])
    on_terrace = monument.id in {"temple_domitian", "altar_domitian"}
    floor = -6.0 + 10.0 if on_terrace else np.percentile(below, 50)
    assert points[:, 2].min() < floor


@pytest.mark.parametrize("monument", LAID, ids=name)
def test_paving_lies_on_the_ground_of_its_footprint(monument: Monument, roman: Scene, terrain: Terrain) -> None:
    triangles = corners(node_of(roman, monument))
    points = triangles.reshape(-1, 3)
    assert points[:, 2] == pytest.approx(terrain.ground_z_m(points[:, 0], points[:, 1]) + LIFT_M, abs=1e-3)
    laid = shapely.MultiPoint(points[:, :2]).convex_hull
    assert shapely.hausdorff_distance(laid, outline(monument).convex_hull) < 0.25
    flat = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])[:, 2]
    assert (flat > 0.0).all()


def test_evidence_and_source_travel_with_every_monument(site: Site, roman: Scene) -> None:
    for monument in site.shown_in("roman"):
        extras = node_of(roman, monument).extras
        assert extras["evidence"] == monument.evidence
        assert extras["source"] == ", ".join(monument.sources)
        assert extras["height_m"] == monument.height_m
        assert extras["footprint_en"] == [list(corner) for corner in monument.footprint.corners_en_m]


@pytest.mark.parametrize("model", ["roman", "today"])
def test_every_node_says_how_it_is_known_and_by_whom(site: Site, model: str, roman: Scene, today: Scene) -> None:
    for node in {"roman": roman, "today": today}[model].nodes:
        assert node.extras["evidence"] in get_args(Evidence), node.name
        assert set(str(node.extras["source"]).split(", ")) <= {*site.sources, "design"}, node.name
        assert node.extras["role"] in {"ground", "building", "plant", "backdrop"}
        monument = node.extras.get("monument")
        variants = {v.id for v in site.monument(monument).variants} if monument else set()
        assert node.extras.get("variant") in {None, *variants}, node.name


def test_roofs_and_what_else_left_no_trace_are_hypothetical(roman: Scene) -> None:
    for node in roman.nodes:
        if node.name.endswith(("/roof", "/upper_walls")):
            assert node.extras["evidence"] == "hypothetical"
            assert node.extras["source"] == "design"


def test_what_was_found_is_attested(roman: Scene) -> None:
    known = {node.name: node.extras["evidence"] for node in roman.nodes}
    for name in (
        "basilica_stoa/columns",
        "basilica_stoa/inner_columns",
        "prytaneion/porch_columns",
        "bouleuterion/seats",
    ):
        assert known[name] == "attested"


def test_the_ground_is_ground(roman: Scene) -> None:
    ground = {node.name for node in roman.nodes if node.extras["role"] == "ground"}
    assert ground == {"ground", "square", "south_street", "domitian_street"}


def test_levels_have_the_same_nodes_and_are_ever_leaner(site: Site, roman: Scene) -> None:
    levels = [roman, *(build_roman(site, lambda share: None, level) for level in (1, 2))]
    for other in levels[1:]:
        assert [(n.name, n.extras) for n in other.nodes] == [(n.name, n.extras) for n in roman.nodes]
    finest, middle, first = (sum(node.triangles for node in scene.nodes) for scene in levels)
    assert finest <= 410_000
    assert middle < 0.7 * finest
    assert first < 0.35 * finest


def test_every_colonnade_has_its_columns(site: Site, roman: Scene) -> None:
    for monument_id, count in (("basilica_stoa", 67), ("south_stoa", 62), ("east_stoa", 24)):
        monument = site.monument(monument_id)
        height, half = monument.measure("column_height_m"), monument.measure("column_diameter_m") / 2.0
        triangles = all_of(roman, monument)
        level = monument.base_z_m + height - 0.05 * height
        around = triangles[(triangles[..., 2].min(axis=1) < level) & (triangles[..., 2].max(axis=1) > level)]
        tops = shapely.union_all(shapely.points(around.reshape(-1, 3)[:, :2]).tolist()).buffer(half * 0.9)
        assert len(shapely.get_parts(tops)) >= count


def test_all_textures_are_there(roman: Scene, today: Scene) -> None:
    for scene in (roman, today):
        assert set(scene.textures) == {name for node in scene.nodes for name in node.materials}
        assert set(scene.textures) <= set(MATERIALS)


def test_every_kind_has_a_builder(site: Site) -> None:
    assert {m.kind for m in site.shown_in("roman")} - {PAVING} == set(BUILDERS)


def test_a_kind_that_nothing_builds_is_named(site: Site) -> None:
    odd = replace(site.monument("pollio"), kind="ziggurat")
    with pytest.raises(
        SiteError, match=r"'pollio' is of kind 'ziggurat', which nothing builds; use one of altar, arch"
    ):
        build_roman(replace(site, monuments=(odd,)), lambda share: None)


def test_a_higher_figure_gives_a_higher_monument(site: Site) -> None:
    pollio = site.monument("pollio")
    taller = replace(
        pollio, figures=dict(pollio.figures) | {"height_m": replace(pollio.figures["height_m"], value=9.0)}
    )
    scene = build_roman(replace(site, monuments=(taller,)), lambda share: None)
    assert corners(scene.nodes[1])[..., 2].max() == pytest.approx(pollio.base_z_m + 9.0, abs=0.05)


def test_every_face_is_lit_from_the_side_that_is_drawn(roman: Scene) -> None:
    for node in roman.nodes:
        for mesh in [*node.meshes, *(part.mesh for part in node.instances)]:
            sides = mesh.positions_m[mesh.triangles].astype(np.float64)
            facing = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
            lit = mesh.normals[mesh.triangles].mean(axis=1)
            assert (np.einsum("ki,ki->k", facing, lit) >= -1e-4).all(), (node.name, mesh.material)
