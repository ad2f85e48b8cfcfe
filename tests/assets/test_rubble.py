"""Ruins' parts: worn, but where and as large as they should be, and the same for the same generator."""

import numpy as np
import pytest

from assets import plants, rubble
from assets.shape import Shape
from tests.assets.geometry import across, drawn


def test_blocks_are_about_as_large_as_asked_and_look_outward() -> None:
    shape, rng = Shape(), np.random.default_rng(2)
    rubble.blocks(shape, rng, np.array([[5.0, 0.0, 1.0]]), np.array([[2.0, 1.0, 0.5]]), np.array([0.0]))
    triangles = drawn(shape)
    size = np.ptp(triangles.reshape(-1, 3), axis=0)
    assert size == pytest.approx([2.0, 1.0, 0.56], abs=0.25)
    outward = triangles.mean(axis=1) - (5.0, 0.0, 1.2)
    assert (np.einsum("ki,ki->k", outward, across(triangles)) > 0.0).all()


def test_a_broken_wall_stays_between_its_heights_and_on_its_line() -> None:
    shape, rng = Shape(), np.random.default_rng(3)
    rubble.broken_wall(shape, rng, "rustic", (1.0, 1.0), (31.0, 1.0), 0.8, (0.5, 3.0), 2.0)
    points = drawn(shape).reshape(-1, 3)
    tops = points[points[:, 2] > 2.0][:, 2] - 2.0
    assert tops.min() > 0.2
    assert tops.max() < 3.6
    assert np.ptp(tops) > 0.5
    assert points[:, 0].min() == pytest.approx(1.0, abs=1e-5)
    assert points[:, 0].max() == pytest.approx(31.0, abs=1e-5)
    assert np.abs(points[:, 1] - 1.0).max() < 0.45


@pytest.mark.parametrize("part", [rubble.drum(0.8, 1.5), rubble.lying_drum(0.8, 1.5)])
def test_a_drum_looks_outward(part: Shape) -> None:
    triangles = drawn(part)
    middle = (triangles.reshape(-1, 3).min(axis=0) + triangles.reshape(-1, 3).max(axis=0)) / 2.0
    assert (np.einsum("ki,ki->k", triangles.mean(axis=1) - middle, across(triangles)) > 0.0).all()


def test_a_row_of_blocks_has_gaps() -> None:
    shape, rng = Shape(), np.random.default_rng(4)
    rubble.row_of_blocks(shape, rng, np.array([0.0, 0.0]), np.array([60.0, 0.0]), (0.9, 0.4), 0.0)
    blocks = len(drawn(shape)) // 10
    assert 30 < blocks < round(60.0 / 1.15)


@pytest.mark.parametrize("make", [plants.bush, plants.slope_bush, plants.far_bush, plants.tree, plants.cypress])
def test_a_plant_is_the_same_for_the_same_generator(make: object) -> None:
    assert callable(make)
    first, second, other = (drawn(make(np.random.default_rng(seed))) for seed in (5, 5, 6))
    assert (first == second).all()
    assert first.shape == other.shape
    assert not (first == other).all()
    assert 0.5 < first[..., 2].max() < 11.0
    assert first[..., 2].min() > -0.6
