"""Corners of a model: where they are on the site, that they are drawn once, and which have something behind them."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from assets.axes import Array
from assets.corners import CELL_M, FOCAL_PX, HEIGHT_PX, WIDTH_PX, CornerAtlas, lifted, looking
from assets.materials import MATERIALS
from assets.scene import Node, Scene
from assets.shape import Place, Shape

EYE_M = 1.6


def flat(e_m: Array, n_m: Array) -> Array:
    return np.zeros_like(e_m + n_m)


@pytest.fixture
def blocks() -> Scene:
    """A paved floor, and a block of 2 m to the north on it."""
    shape = Shape()
    shape.box("paving", (-60.0, -60.0, -1.0), (60.0, 60.0, 0.0))
    shape.box("marble", (-1.0, 8.0, 0.0), (1.0, 10.0, 2.0))
    textures = {name: MATERIALS[name].paint() for name in ("paving", "marble")}
    return Scene([Node("all", shape.meshes(Place.at(0.0, 0.0, 0.0)), {})], textures)


@pytest.fixture
def atlas(open_gl: None, blocks: Scene, tmp_path: Path) -> Iterator[CornerAtlas]:
    with CornerAtlas(lambda: blocks, "blocks", flat, EYE_M, tmp_path) as atlas:
        yield atlas


def test_a_corner_of_a_picture_is_where_its_ray_meets_what_it_shows() -> None:
    """A white square in the middle of a wall 4 m to the north; what is beside it lies at 9 m, and sky above."""
    picture = np.zeros((HEIGHT_PX, WIDTH_PX, 3), np.uint8)
    picture[480:560, 180:260] = 255
    depth_m = np.full((HEIGHT_PX, WIDTH_PX), 4.0)
    depth_m[:, 240:] = 9.0
    depth_m[:500] = np.inf
    points, strength, on_rim = lifted(picture, depth_m, looking(np.array([10.0, 20.0, 1.6]), np.pi / 2))
    # the square's lower corners; its upper ones stand in the sky
    assert len(points) == 2
    assert (strength > 0.0).all()
    left = points[:, 0].argmin()
    assert points[left] == pytest.approx(
        (10.0 + (180 - 215.5) / FOCAL_PX * 4.0, 24.0, 1.6 - 39.5 / FOCAL_PX * 4.0), abs=0.03
    )
    assert points[1 - left, 1] == pytest.approx(29.0, abs=1e-6)
    assert not on_rim.any()


def test_what_lies_before_something_far_is_on_a_rim() -> None:
    picture = np.zeros((HEIGHT_PX, WIDTH_PX, 3), np.uint8)
    picture[480:560, 180:260] = 255
    depth_m = np.where(picture[..., 0] > 0, 4.0, 9.0)
    points, _, on_rim = lifted(picture, depth_m, looking(np.zeros(3), np.pi / 2))
    assert len(points) == 4
    assert on_rim.all()
    assert points[:, 1] == pytest.approx(4.0)


def test_corners_lie_on_the_model_and_the_strongest_come_first(atlas: CornerAtlas) -> None:
    corners = atlas.corners(np.array([0.3, -0.4, 1.6]))
    assert len(corners.p_site_m) > 1000
    assert (np.diff(corners.strength) <= 0.0).all()
    x, y, z = corners.p_site_m.T
    on_block = (np.abs(x) < 1.05) & (y > 7.9) & (y < 10.1) & (z > 0.1) & (z < 2.1)
    on_floor = np.abs(z) < 0.1
    far = np.hypot(x, y) > 59.0  # the floor's own edge
    assert (on_block | on_floor | far).all()
    assert on_block.any()
    bearing = np.arctan2(y, x)[on_floor]
    assert all(((bearing > a) & (bearing < a + np.pi / 4)).any() for a in np.arange(-4, 4) * np.pi / 4)


def test_a_square_is_drawn_once(atlas: CornerAtlas, blocks: Scene, tmp_path: Path) -> None:
    """Everywhere on it the same corners, and another atlas reads them without a model; the next square is another."""

    def missing() -> Scene:
        raise AssertionError("not to be drawn again")

    first = atlas.corners(np.array([0.9, 0.0, 1.6]))
    assert atlas.corners(np.array([-0.9, 0.9, 1.7])) is first
    with CornerAtlas(missing, "blocks", flat, EYE_M, tmp_path) as again:
        np.testing.assert_array_equal(again.corners(np.zeros(3)).p_site_m, first.p_site_m)
        with pytest.raises(AssertionError, match="not to be drawn"):
            again.corners(np.array([CELL_M, 0.0, 1.6]))
    with CornerAtlas(missing, "another", flat, EYE_M, tmp_path) as other, pytest.raises(AssertionError):
        other.corners(np.zeros(3))
