"""Columns, roofs, arches: the right size, the right way out."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assets import parts
from assets.parts import offset, prism
from assets.shape import Shape
from tests.assets.geometry import ORIGIN, across, drawn, open_edges

HEXAGON = np.stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)], axis=-1) * 10.0


def test_a_shaft_looks_outward() -> None:
    shape = Shape()
    parts.revolved(shape, "marble", np.array([(1.0, 0.0), (0.8, 5.0)]), 16)
    triangles = drawn(shape)
    outward = triangles.mean(axis=1) * (1.0, 1.0, 0.0)
    assert (np.einsum("ki,ki->k", outward, across(triangles)) > 0.0).all()


def test_rows_and_rings_stand_where_they_should() -> None:
    assert parts.row((0.0, 1.0), (4.0, 1.0), 3, 2.0).tolist() == [[0, 1, 2], [2, 1, 2], [4, 1, 2]]
    ring = parts.ring(0.0, 9.0, 0.0, 5.0, across=6, along=10)
    assert len({tuple(place) for place in ring.tolist()}) == 2 * 10 + 2 * 4


@given(count=st.integers(1, 9), rise=st.floats(0.2, 2.5))
def test_steps_go_down_all_around_within_a_metre(count: int, rise: float) -> None:
    shape = Shape()
    parts.steps(shape, 0.0, 10.0, 0.0, 6.0, rise, count)
    triangles = drawn(shape)
    tops = sorted({round(float(z), 5) for z in triangles[across(triangles)[:, 2] > 1e-6][..., 2].ravel()})
    assert len(tops) == count
    assert tops[-1] == 0.0
    assert triangles[..., 0].min() >= -parts.STEPS_OUT_M - 1e-6


def test_an_arch_leaves_its_opening_open() -> None:
    shape = Shape()
    parts.arch(shape, "marble", 5.0, 4.0, 0.0, 1.0, 3.0, 6.0, 24)
    triangles = drawn(shape)
    points = triangles.reshape(-1, 3)
    assert np.hypot(points[:, 0] - 5.0, points[:, 2] - 3.0).min() == pytest.approx(2.0, abs=0.02)
    assert points[:, 2].max() == pytest.approx(6.0)
    front = triangles[np.abs(triangles[..., 1]).max(axis=1) < 1e-9]
    assert (across(front)[:, 1] < 0.0).all()
    assert -across(front)[:, 1].sum() == pytest.approx(4.0 * 3.0 - np.pi * 2.0, rel=0.02)


def test_the_underside_of_an_arch_looks_into_the_opening() -> None:
    shape = Shape()
    parts.arch(shape, "marble", 5.0, 4.0, 0.0, 1.0, 3.0, 6.0, 24)
    triangles = drawn(shape)
    near = np.hypot(triangles[..., 0] - 5.0, triangles[..., 2] - 3.0).max(axis=1) < 2.01
    deep = np.ptp(triangles[..., 1], axis=1) > 0.5
    under = triangles[near & deep]
    assert len(under) == 48
    inward = (5.0, 0.5, 3.0) - under.mean(axis=1)
    assert (np.einsum("ki,ki->k", across(under), inward) > 0.0).all()


def test_a_vault_looks_up_and_out() -> None:
    shape = Shape()
    parts.vault(shape, "plaster", 0.0, 10.0, 0.0, 20.0, 5.0, 9.0, "ashlar")
    curve = next(mesh for mesh in shape.meshes(ORIGIN) if mesh.material == "plaster")
    triangles = curve.positions_m[curve.triangles].astype(float)
    outward = triangles.mean(axis=1) - (5.0, 0.0, 5.0)
    outward[:, 1] = 0.0
    assert (np.einsum("ki,ki->k", outward, across(triangles)) > 0.0).all()
    ends = next(mesh for mesh in shape.meshes(ORIGIN) if mesh.material == "ashlar")
    facing = across(ends.positions_m[ends.triangles].astype(float))
    side = ends.positions_m[ends.triangles][:, 0, 1] - 10.0
    assert (facing[:, 1] * side >= 0.0).all()


def test_four_walls_stand_around_a_rectangle_without_overlap() -> None:
    shape = Shape()
    parts.walls(shape, "ashlar", 0.0, 10.0, 0.0, 6.0, 0.0, 3.0, 0.5)
    triangles = drawn(shape)
    up = across(triangles)[:, 2]
    assert up[up > 0.0].sum() == pytest.approx(10.0 * 6.0 - 9.0 * 5.0, rel=1e-5)


def test_a_prism_is_closed_but_for_its_underside() -> None:
    shape = Shape()
    prism(shape, "ashlar", HEXAGON, 1.0, 4.0)
    triangles = drawn(shape)
    assert {point[2] for edge in open_edges(triangles) for point in edge} == {1.0}
    assert across(triangles)[:, 2].sum() == pytest.approx(1.5 * np.sqrt(3.0) * 100.0, rel=1e-4)


@given(out=st.floats(-2.0, 3.0))
def test_an_outline_is_moved_out_evenly(out: float) -> None:
    moved = offset(HEXAGON, out)
    inner = 10.0 * np.cos(np.pi / 6.0)
    middles = (moved + np.roll(moved, -1, axis=0)) / 2.0
    assert np.linalg.norm(middles, axis=1) == pytest.approx(np.full(6, inner + out))


def test_a_wall_around_an_outline_encloses_its_own_volume() -> None:
    shape = Shape()
    parts.ring_wall(shape, "ashlar", HEXAGON, 1.0, 2.0, 5.0)
    triangles = drawn(shape)
    assert {point[2] for edge in open_edges(triangles) for point in edge} == {2.0}
    inner = (10.0 - 2.0 / np.sqrt(3.0)) ** 2
    lid = across(triangles)[:, 2].sum()
    assert lid == pytest.approx(1.5 * np.sqrt(3.0) * (100.0 - inner), rel=1e-4)


def test_a_pierced_wall_is_open_where_told() -> None:
    shape = Shape()
    parts.pierced(shape, "ashlar", (0.0, 10.0), (0.0, 1.0), (0.0, 5.0), [(7.0, 1.0, 1.0, 3.0), (3.0, 2.0, 0.0, 4.0)])
    front = drawn(shape)
    front = front[np.abs(front[..., 1]).max(axis=1) < 1e-9]
    assert -across(front)[:, 1].sum() == pytest.approx(10.0 * 5.0 - 2.0 * 4.0 - 1.0 * 2.0, rel=1e-5)


@pytest.mark.parametrize("facing", [-1.0, 1.0])
def test_a_door_stands_before_its_wall(facing: float) -> None:
    shape = Shape()
    parts.door(shape, 5.0, 2.0, (2.0, 3.0), facing)
    points = drawn(shape).reshape(-1, 3)
    assert ((points[:, 1] - 2.0) * facing).min() == pytest.approx(0.0, abs=1e-6)
    assert ((points[:, 1] - 2.0) * facing).max() <= 0.35
    assert {mesh.material for mesh in shape.meshes(ORIGIN)} == {"marble", "wood"}


def test_a_moulded_block_is_as_high_as_asked_and_stands_out_at_foot_and_cornice() -> None:
    shape = Shape()
    parts.moulded(shape, "ashlar", (0.0, 4.0, 0.0, 3.0), (1.0, 5.0))
    points = drawn(shape).reshape(-1, 3)
    assert points.min(axis=0) == pytest.approx([-0.25, -0.25, 1.0])
    assert points.max(axis=0) == pytest.approx([4.25, 3.25, 5.0])
