"""Levels of detail: wide things in cells, levels by distance, and what a view costs."""

import math

import numpy as np

from assets.levels import LEVELS, MANY_TRIANGLES, REACH_M, cost_of, drawn_of, level_at, with_copies_cut, with_meshes_cut
from assets.scene import Instanced, Node, Scene, expanded
from assets.shape import Mesh, Place, Shape
from assets.site import View

HERE = Place.at(0.0, 0.0, 0.0)


def box(east_m: float, north_m: float, material: str = "marble") -> Mesh:
    shape = Shape()
    shape.box(material, (east_m, north_m, 0.0), (east_m + 1.0, north_m + 1.0, 1.0))
    return shape.meshes(HERE)[0]


def view_to(heading_deg: float) -> View:
    return View("v", {"en": "v"}, 0.0, 0.0, math.radians(heading_deg), 0.0)


def rows(*east_m: float) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    T = np.tile(np.eye(4), (len(east_m), 1, 1))
    T[:, 0, 3] = east_m
    return T


def test_wide_things_are_cut_into_cells_and_nothing_is_lost() -> None:
    low = np.array([[x, y, 0.0] for x in range(-200, 200, 10) for y in (-60, 0)])
    carpet = Shape()
    carpet.boxes("grass", low, low + np.array([5.0, 5.0, 1.0]))
    part = Instanced(box(0.0, 0.0), rows(-400.0, 1.0, 2.0, 60.0))
    whole = Scene([Node("grass", carpet.meshes(HERE), {"role": "plant"}, [part])], {})
    cut = with_copies_cut(with_meshes_cut(whole))
    assert all(node.name.startswith("grass@") and node.extras == {"role": "plant"} for node in cut.nodes)
    assert sum(node.triangles for node in cut.nodes) == whole.nodes[0].triangles
    (before,), after = (expanded(scene).nodes for scene in (whole, cut))
    assert sorted(corners_of(before)) == sorted(corner for node in after for corner in corners_of(node))
    for node in after:
        east = [corner[0] for corner in corners_of(node)]
        assert max(east) - min(east) <= (48.0 + 10.0 if min(map(abs, east)) < 130.0 else 288.0)


def corners_of(node: Node) -> list[tuple[float, ...]]:
    """Return all corners of all triangles."""
    return [tuple(corner) for m in node.meshes for corner in m.positions_m[m.triangles.ravel()].round(3).tolist()]


def test_monuments_and_the_backdrop_stay_whole() -> None:
    meshes = [box(-100.0, 0.0), box(100.0, 0.0)]
    scene = Scene([Node("stoa/roof", meshes, {"monument": "stoa"}), Node("hills", meshes, {"role": "backdrop"})], {})
    assert [node.name for node in with_copies_cut(with_meshes_cut(scene)).nodes] == ["stoa/roof", "hills"]


def test_levels_follow_the_distance() -> None:
    assert [level_at(d) for d in (0.0, REACH_M[0], REACH_M[0] + 0.1, REACH_M[1], REACH_M[1] + 0.1)] == [0, 0, 1, 1, 2]


def test_a_view_costs_what_it_shows_at_the_level_for_its_distance() -> None:
    near, far = (
        Node("near", [box(-1.0, 10.0)], {"monument": "near"}),
        Node("far", [box(0.0, 100.0)], {"monument": "far"}),
    )
    plain = {level: [drawn_of(near), drawn_of(far)] for level in LEVELS}
    triangles = near.triangles
    assert cost_of(view_to(0.0), 1.65, plain) == (2, 2 * triangles)  # two levels of marble are two batches
    assert cost_of(view_to(180.0), 1.65, plain) == (0, 0)
    assert cost_of(view_to(0.0), 1.65, {0: [drawn_of(near)], 2: []}) == (1, triangles)
    assert cost_of(view_to(0.0), 1.65, {2: [drawn_of(near)]}) == (0, 0)


def test_one_of_several_reconstructions_is_counted() -> None:
    rivals = [drawn_of(Node("tomb", [box(0.0, 10.0)], {"monument": "tomb", "variant": name})) for name in ("a", "b")]
    assert cost_of(view_to(0.0), 1.65, {0: rivals}) == (1, rivals[0].triangles)


def test_many_copies_are_a_draw_call_of_their_own_and_few_join_the_rest() -> None:
    mesh = box(0.0, 10.0)
    few = Instanced(mesh, rows(0.0, 2.0))
    many = Instanced(mesh, np.tile(np.eye(4), (MANY_TRIANGLES // len(mesh.triangles) + 1, 1, 1)))
    assert cost_of(view_to(0.0), 1.65, {0: [drawn_of(Node("a", [mesh], {"monument": "a"}, [few]))]})[0] == 1
    assert cost_of(view_to(0.0), 1.65, {0: [drawn_of(Node("a", [mesh], {"monument": "a"}, [many]))]})[0] == 2
