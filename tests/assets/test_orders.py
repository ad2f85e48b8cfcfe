"""Columns by their order: as high and as wide as asked at every level, fluted where they are finest."""

from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assets.orders import CAPITAL_D, FLUTES, column
from assets.records import Order
from tests.assets.geometry import ORIGIN, across, corners, drawn

ORDERS: tuple[Order, ...] = get_args(Order)


@given(
    order=st.sampled_from(ORDERS),
    diameter=st.floats(0.3, 1.5),
    slenderness=st.floats(6.0, 12.0),
    level=st.integers(0, 2),
)
def test_a_column_is_as_high_and_as_wide_as_asked(
    order: Order, diameter: float, slenderness: float, level: int
) -> None:
    points = drawn(column(order, diameter, diameter * slenderness, level)).reshape(-1, 3)
    assert points[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    below_horns = points[points[:, 2] <= diameter * slenderness + 1e-4]
    assert below_horns[:, 2].max() == pytest.approx(diameter * slenderness, rel=1e-5)
    assert (points[:, 2].max() > below_horns[:, 2].max()) == (order == "bull" and level == 0)
    shaft = points[(points[:, 2] > 0.55 * diameter) & (points[:, 2] < diameter * (slenderness - 1.2))]
    assert (np.hypot(shaft[:, 0], shaft[:, 1]) <= diameter / 2.0 + 1e-5).all()


@pytest.mark.parametrize("order", ORDERS)
def test_coarser_levels_are_leaner(order: Order) -> None:
    counts = [len(drawn(column(order, 0.7, 6.0, level))) for level in (0, 1, 2)]
    assert counts[0] > 2 * counts[2]
    assert counts[0] > counts[1] > counts[2]
    assert counts[0] <= 700


@pytest.mark.parametrize("order", ORDERS)
def test_a_finest_shaft_has_the_flutes_of_its_order(order: Order) -> None:
    triangles = drawn(column(order, 1.0, 10.0, 0))
    low, high = triangles[..., 2].min(axis=1), triangles[..., 2].max(axis=1)
    crossed = triangles[(low < 2.0) & (high > 2.0)]
    normals = across(crossed)
    turns = np.unique(np.round(np.arctan2(normals[:, 1], normals[:, 0]), 3))
    assert len(turns) == 2 * FLUTES[order]


def test_a_shaft_narrows_faster_towards_the_top() -> None:
    points = drawn(column("ionic", 1.0, 10.0, 1)).reshape(-1, 3)
    rings = {}
    for z in np.unique(np.round(points[:, 2], 3)):
        at = points[np.abs(points[:, 2] - z) < 1e-3]
        if 0.5 <= z <= 10.0 - CAPITAL_D["ionic"] + 1e-6:
            rings[float(z)] = float(np.hypot(at[:, 0], at[:, 1]).min())
    radii = [rings[z] for z in sorted(rings)][:3]
    heights = sorted(rings)[:3]
    slopes = -np.diff(radii) / np.diff(heights)
    assert slopes[1] > slopes[0] > 0.0


def test_bulls_lean_out_along_the_row() -> None:
    points = drawn(column("bull", 1.0, 8.0, 0)).reshape(-1, 3)
    ionic = drawn(column("ionic", 1.0, 8.0, 0)).reshape(-1, 3)
    assert np.abs(points[:, 0]).max() > 1.3 * np.abs(ionic[:, 0]).max()
    assert np.abs(points[:, 1]).max() == pytest.approx(np.abs(ionic[:, 1]).max(), abs=0.2)


def test_only_the_shaft_is_of_another_stone() -> None:
    shape = column("corinthian", 0.5, 4.0, 0, "granite", fluted=False)
    granite = next(mesh for mesh in shape.meshes(ORIGIN) if mesh.material == "granite")
    heights = corners([granite])[..., 2]
    assert heights.min() == pytest.approx(0.25)
    assert heights.max() == pytest.approx(4.0 - CAPITAL_D["corinthian"] * 0.5)


@pytest.mark.parametrize("level", [0, 1])
def test_volutes_look_outward(level: int) -> None:
    triangles = drawn(column("ionic", 1.0, 8.0, level))
    middle = np.array([0.6, 0.0, 8.0 - 0.48 * CAPITAL_D["ionic"]])
    long = np.ptp(triangles[..., 1], axis=1) > 0.9
    away = np.hypot(triangles[..., 0] - middle[0], triangles[..., 2] - middle[2])
    roll = triangles[long & (np.abs(away - 0.24) < 1e-3).all(axis=1)]
    assert len(roll) >= 12
    assert (np.einsum("ki,ki->k", across(roll), roll.mean(axis=1) - middle) > 0.0).all()
