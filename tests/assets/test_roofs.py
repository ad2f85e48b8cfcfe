"""Tiled roofs: they meet their ridges and eaves, look up, and lead the water down."""

import numpy as np
import pytest

from assets import roofs
from assets.shape import Mesh, Shape
from tests.assets.geometry import ORIGIN, across, drawn, open_edges, volume_m3

HEXAGON = np.stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)], axis=-1) * 10.0


def tiles_of(shape: Shape) -> Mesh:
    return next(mesh for mesh in shape.meshes(ORIGIN) if mesh.material == "tiles")


@pytest.mark.parametrize("level", [0, 1, 2])
def test_a_gable_roof_meets_its_ridge_and_its_eaves(level: int) -> None:
    shape = Shape()
    roofs.gable(shape, shape, (0.0, 10.0, 0.0, 6.0), 4.0, 6.0, level)
    triangles = drawn(shape)
    assert triangles[..., 2].max() == pytest.approx(6.0, abs=0.06)
    assert triangles[..., :2].reshape(-1, 2).min(axis=0) == pytest.approx([-0.5, -0.5], abs=0.06)
    assert triangles[..., :2].reshape(-1, 2).max(axis=0) == pytest.approx([10.5, 6.5], abs=0.06)


def test_only_the_finest_roof_has_its_cover_tiles_in_relief() -> None:
    counts = []
    for level in (0, 1, 2):
        shape = Shape()
        roofs.plane(shape, 0.0, 16.0, (0.0, 4.0), (3.0, 5.0), level)
        counts.append(len(tiles_of(shape).triangles))
    assert counts[0] >= 15 * 5
    assert counts[1] == counts[2] == 2


@pytest.mark.parametrize(("low", "high"), [(0.0, 5.0), (5.0, 0.0)])
def test_a_lean_to_looks_up_and_its_rows_lie_along_the_eaves(low: float, high: float) -> None:
    shape = Shape()
    roofs.lean_to(shape, shape, (0.0, 8.0), (low, 3.0), (high, 4.5), 1)
    tiles = tiles_of(shape)
    corners = tiles.positions_m[tiles.triangles].astype(float)
    assert (across(corners)[:, 2] > 0.0).all()
    down = tiles.uvs[:, 1]
    assert np.corrcoef(down, tiles.positions_m[:, 2])[0, 1] < -0.99


def test_the_two_sides_of_a_lean_to_look_outward() -> None:
    shape, ends = Shape(), Shape()
    roofs.lean_to(shape, ends, (0.0, 8.0), (0.0, 3.0), (5.0, 4.5), 1)
    facing = across(drawn(ends))
    middle = drawn(ends).mean(axis=1)[:, 0] - 4.0
    assert (facing[:, 0] * middle > 0.0).all()


def test_a_hipped_roof_is_watertight() -> None:
    shape = Shape()
    roofs.hip(shape, HEXAGON, np.column_stack([np.clip(HEXAGON[:, 0], -3.0, 3.0), np.zeros(6)]), 5.0, 8.0)
    triangles = drawn(shape)
    assert not open_edges(triangles)
    assert volume_m3(triangles) > 0.0
