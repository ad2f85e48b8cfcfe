"""Buildings under construction: elements with their evidence, rivals, wings, copies, and where their axes lie."""

from dataclasses import replace

import numpy as np
import pytest

from assets.building import Building, transforms
from assets.monuments.memmius import memmius
from assets.monuments.temple import temple
from assets.orders import column
from assets.shape import Shape, size_m
from assets.site import Site
from assets.terrain import Terrain
from tests.assets.geometry import corners


def post() -> Shape:
    return column("doric", 0.5, 3.0, 2)


def test_an_element_is_known_as_its_figure_is(site: Site) -> None:
    basilica = site.monument("basilica_stoa")
    building = Building(basilica)
    building.element()
    building.element("columns", by="front_columns")
    building.guess("roof")
    known = {name: (e.evidence, e.source) for name, e in building.elements.items()}
    assert known[""] == (basilica.evidence, ", ".join(basilica.sources))
    assert known["columns"] == ("attested", basilica.figures["front_columns"].source)
    assert known["roof"] == ("hypothetical", "design")


def test_a_source_that_the_monument_does_not_name_is_not_claimed(site: Site) -> None:
    building = Building(site.monument("pollio"))
    building.element("statues", evidence="attested", source="VICI")
    assert building.elements["statues"].source == "SIGN"


def test_nodes_bear_the_elements_names_and_evidence(site: Site, terrain: Terrain) -> None:
    building = Building(site.monument("pollio"), level=2)
    building.element().box("marble", (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    building.guess("nothing")
    building.guess("columns")
    building.many("columns", post(), np.array([[0.0, 0, 0], [3, 0, 0]]))
    building.many("columns", post(), np.array([[6.0, 0, 0]]))
    body, columns = building.nodes(terrain)
    assert (body.name, columns.name) == ("pollio", "pollio/columns")
    assert body.extras["height_m"] == site.monument("pollio").height_m
    assert columns.extras == {"role": "building", "evidence": "hypothetical", "source": "design", "monument": "pollio"}
    assert [len(part.T_site_part) for part in columns.instances] == [3]


@pytest.mark.parametrize("side", [0, 1, 2, 3])
def test_the_front_lies_on_the_side_that_it_faces(site: Site, side: int) -> None:
    monument = site.monument("baths")
    building = Building(monument)
    width, depth = building.face(side)
    assert {width, depth} == set(size_m(monument))
    place = building.place()
    ends = np.array([[0.0, 0.0, 0.0], [width, 0.0, 0.0]]) @ place.R_site_own.T + place.origin_m
    outline = np.array(monument.footprint.corners_en_m)
    assert ends[0, :2] == pytest.approx(outline[side], abs=0.05)
    assert ends[1, :2] == pytest.approx(outline[(side + 1) % 4], abs=0.05)


def test_a_wing_is_turned_and_moved_with_its_copies(site: Site, terrain: Terrain) -> None:
    building = Building(site.monument("pollio"), level=2)
    wing = building.wing()
    wing.element("columns").box("marble", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    wing.many("columns", post(), np.array([[4.0, 0.0, 0.0]]))
    building.join(wing, (10.0, 0.0), np.pi / 2.0, 1.0)
    _, T = building.elements["columns"].many[0]
    assert T[0] @ (0.0, 0.0, 0.0, 1.0) == pytest.approx([10.0, 4.0, 1.0, 1.0])
    place = building.place()
    own = place.own(corners(building.nodes(terrain)[0]).reshape(-1, 3)[:30])
    assert own.min(axis=0) == pytest.approx([8.0, 0.0, 1.0], abs=1e-4)
    assert own.max(axis=0) == pytest.approx([10.0, 1.0, 4.0], abs=1e-4)


def test_transforms_turn_scale_and_move() -> None:
    T = transforms(np.array([[1.0, 2.0, 3.0]]), np.pi / 2.0, np.array([[2.0, 1.0, 1.0]]))
    assert T[0] @ (1.0, 0.0, 0.0, 1.0) == pytest.approx([1.0, 4.0, 3.0, 1.0])


def test_rivals_are_nodes_of_their_own_the_default_first(site: Site, terrain: Terrain) -> None:
    monument = site.monument("memmius")
    building = Building(monument, level=2)
    memmius(building)
    nodes = building.nodes(terrain)
    told = [node.extras["variant"] for node in nodes if "variant" in node.extras]
    assert told[0] == monument.default_variant
    assert set(told) == {variant.id for variant in monument.variants}
    for variant in monument.variants:
        top = max(corners(n)[..., 2].max() for n in nodes if n.extras.get("variant") == variant.id)
        assert top == pytest.approx(monument.base_z_m + monument.as_variant(variant.id).height_m, abs=0.05)


def test_one_rival_may_be_chosen(site: Site, terrain: Terrain) -> None:
    monument = site.monument("temple_agora")
    for variant in monument.variants:
        building = Building(monument, level=2, chosen=variant.id)
        temple(building)
        told = {node.extras.get("variant") for node in building.nodes(terrain)}
        assert told == {None, variant.id}


def test_a_monument_without_rivals_has_no_variants(site: Site, terrain: Terrain) -> None:
    alone = replace(site.monument("temple_agora"), variants=(), default_variant=None)
    building = Building(alone, level=2)
    temple(building)
    assert all("variant" not in node.extras for node in building.nodes(terrain))
