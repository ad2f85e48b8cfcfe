"""Shapes: outsides, tints, texture coordinates, and where their own axes lie on the site."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assets.materials import MATERIALS
from assets.shape import Place, Shape, cells, footprint_own_m, size_m, turned
from assets.site import Site
from tests.assets.geometry import ORIGIN, across, drawn, open_edges, volume_m3

LENGTH = st.floats(0.1, 50.0)


@given(size=st.tuples(LENGTH, LENGTH, LENGTH))
def test_a_box_is_closed_but_for_its_underside(size: tuple[float, float, float]) -> None:
    shape = Shape()
    shape.box("marble", (1.0, 2.0, 3.0), (1.0 + size[0], 2.0 + size[1], 3.0 + size[2]))
    triangles = drawn(shape)
    assert {point[2] for edge in open_edges(triangles) for point in edge} == {3.0}
    areas = np.abs(across(triangles)).sum(axis=0)
    assert areas == pytest.approx([2 * size[1] * size[2], 2 * size[0] * size[2], size[0] * size[1]], rel=1e-3)


def test_normals_are_those_of_the_corners_order() -> None:
    shape = Shape()
    shape.boxes("marble", np.array([[0.0, 0, 0], [5, 5, 0]]), np.array([[1.0, 2, 3], [6, 7, 1]]))
    mesh = shape.meshes(Place.at(3.0, 4.0, 5.0, 1.0))[0]
    facing = across(mesh.positions_m[mesh.triangles].astype(np.float64))
    for corner in range(3):
        assert (np.einsum("ki,ki->k", facing, mesh.normals[mesh.triangles[:, corner]]) > 0.0).all()
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0, abs=1e-5)


def test_a_surface_has_its_outside_to_the_left_of_a_along_b() -> None:
    shape = Shape()
    x, y = np.meshgrid(np.arange(3.0), np.arange(4.0), indexing="ij")
    shape.surface("earth", np.stack([x, y, 0.0 * x], axis=-1), from_above=True)
    mesh = shape.meshes(ORIGIN)[0]
    assert mesh.normals == pytest.approx(np.tile((0.0, 0.0, 1.0), (12, 1)))
    assert (across(drawn(shape))[:, 2] > 0.0).all()
    assert mesh.uvs * MATERIALS["earth"].tile_m == pytest.approx(mesh.positions_m[:, :2] * (1.0, -1.0))


def test_cells_cover_a_grid_once() -> None:
    x, y = np.meshgrid(np.arange(5.0), np.arange(3.0), indexing="ij")
    points = np.stack([x, y, 0.0 * x], axis=-1).reshape(-1, 3)
    areas = across(points[cells(5, 3)])[:, 2]
    assert areas == pytest.approx(np.full(16, 0.5))


def test_copies_are_turned_moved_and_scaled() -> None:
    part = Shape()
    part.box("marble", (1.0, 0.0, 0.0), (2.0, 1.0, 1.0))
    shape = Shape()
    shape.copies(part, np.array([[10.0, 0, 0], [0, 20, 5]]), np.array([0.0, np.pi / 2]), np.array([1.0, 2.0]))
    triangles = drawn(shape)
    assert triangles[:10].reshape(-1, 3).min(axis=0) == pytest.approx([11.0, 0.0, 0.0])
    assert triangles[10:].reshape(-1, 3).min(axis=0) == pytest.approx([-2.0, 22.0, 5.0], abs=1e-5)
    assert triangles[10:].reshape(-1, 3).max(axis=0) == pytest.approx([0.0, 24.0, 7.0], abs=1e-5)


def test_tints_multiply_the_material() -> None:
    shape = Shape()
    shape.boxes("marble", np.zeros((2, 3)), np.ones((2, 3)), np.array([[1.0, 0.5, 0.0], [0.2, 0.2, 0.2]]))
    colours = shape.meshes(ORIGIN)[0].colours
    assert {tuple(row) for row in colours[:20].tolist()} == {(255, 128, 0)}
    assert {tuple(row) for row in colours[20:].tolist()} == {(51, 51, 51)}


def test_one_mesh_per_material_in_order_of_use() -> None:
    shape = Shape()
    for material in ("tiles", "marble", "tiles"):
        shape.box(material, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    assert [(m.material, len(m.triangles)) for m in shape.meshes(ORIGIN)] == [("tiles", 20), ("marble", 10)]


@pytest.mark.parametrize(("side", "looks_to"), [(0, (0, -1)), (1, (1, 0)), (2, (0, 1)), (3, (-1, 0))])
def test_a_front_is_turned_to_its_side(side: int, looks_to: tuple[int, int]) -> None:
    width = (8.0, 5.0)[side % 2]
    part = Shape()
    part.polygons("marble", [(0.0, 0.0, 0.0), (width, 0.0, 0.0), (width, 0.0, 2.0), (0.0, 0.0, 2.0)])
    shape = Shape()
    turned(shape, part, side, 8.0, 5.0)
    triangles = drawn(shape)
    assert across(triangles).sum(axis=0)[:2] == pytest.approx(np.array(looks_to) * width * 2.0, abs=1e-5)
    edge = {0: (1, 0.0), 1: (0, 8.0), 2: (1, 5.0), 3: (0, 0.0)}[side]
    assert triangles[..., edge[0]] == pytest.approx(edge[1], abs=1e-5)


@given(e=LENGTH, n=LENGTH, yaw=st.floats(-3.0, 3.0))
def test_own_axes_and_site_are_inverse(e: float, n: float, yaw: float) -> None:
    place = Place.at(e, n, 1.0, yaw)
    point = np.array([3.0, -2.0, 7.0])
    assert place.own(place.R_site_own @ point + place.origin_m) == pytest.approx(point, abs=1e-9)


def test_a_footprint_in_its_own_axes_starts_at_its_first_corner(site: Site) -> None:
    for monument in site.monuments:
        own = footprint_own_m(monument)
        assert own[0] == pytest.approx([0.0, 0.0], abs=1e-9)
        assert own[1] == pytest.approx([size_m(monument)[0], 0.0], abs=0.1)


def test_leaves_are_lit_by_the_normals_given() -> None:
    shape = Shape()
    up = np.array([[0.0, 0.0, 1.0]])
    shape.leaves("leaves", np.array([[[0.0, 0, 0], [1, 0, 0], [0, 0, 1]]]), up, np.array([[1.0, 1.0, 1.0]]))
    assert shape.meshes(ORIGIN)[0].normals == pytest.approx(np.repeat(up, 3, axis=0))


def test_a_closed_shape_encloses_its_volume() -> None:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (2.0, 3.0, 4.0))
    shape.polygons("marble", [(0.0, 0.0, 0.0), (0.0, 3.0, 0.0), (2.0, 3.0, 0.0), (2.0, 0.0, 0.0)])
    assert not open_edges(drawn(shape))
    assert volume_m3(drawn(shape)) == pytest.approx(24.0, rel=1e-5)


def test_a_slab_is_closed() -> None:
    shape = Shape()
    shape.slab("marble", (0.0, 0.0, 1.0), (2.0, 3.0, 5.0))
    assert not open_edges(drawn(shape))
    assert volume_m3(drawn(shape)) == pytest.approx(24.0, rel=1e-5)


def test_a_leaf_is_turned_to_the_side_that_it_is_lit_from() -> None:
    shape = Shape()
    corners = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0.0, 0, 0], [0, 1, 0], [1, 0, 0]]])
    shape.leaves("leaves", corners, np.tile((0.0, 0.0, 1.0), (2, 1)), np.ones((2, 3)))
    assert (across(drawn(shape))[:, 2] > 0.0).all()


def test_long_sides_are_laid_as_grids_that_still_meet() -> None:
    plain, split = Shape(), Shape(split_m=2.0)
    for shape in (plain, split):
        shape.slab("marble", (0.0, 0.0, 0.0), (7.0, 3.0, 2.0))
    assert len(drawn(split)) > 3 * len(drawn(plain))
    assert not open_edges(drawn(split))
    assert volume_m3(drawn(split)) == pytest.approx(volume_m3(drawn(plain)))
    edges = np.linalg.norm(np.diff(drawn(split), axis=1, append=drawn(split)[:, :1]), axis=2)
    assert edges.max() <= 2.0 * np.sqrt(2.0) + 1e-6
