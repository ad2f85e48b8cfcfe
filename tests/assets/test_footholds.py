"""Where feet can stand: the surface's own heights, the highest where several lie over each other, and nothing beside it."""

import numpy as np
import pytest

from assets.axes import Array
from assets.footholds import Footholds

SEED = 7


def slope(z0_m: float, *, low: float = -20.0, high: float = 20.0) -> Array:
    """Two triangles over a square of the map that rise 1 in 10 to the east."""
    corners = np.array([(e, n, z0_m + 0.1 * e) for e, n in ((low, low), (high, low), (high, high), (low, high))])
    return corners[[[0, 1, 2], [0, 2, 3]]]


def test_the_height_is_that_of_the_slope_wherever_one_asks() -> None:
    footholds = Footholds(slope(3.0))
    for e, n in np.random.default_rng(SEED).uniform(-20.0, 20.0, (200, 2)).tolist():
        assert footholds.height_m(e, n) == pytest.approx(3.0 + 0.1 * e, abs=1e-9)


@pytest.mark.parametrize("at", [(-20.0, -20.0), (20.0, 20.0), (0.0, 0.0), (8.0, -8.0), (20.0, -16.0)])
def test_edges_corners_and_seams_belong_to_it(at: tuple[float, float]) -> None:
    assert Footholds(slope(0.0)).height_m(*at) == pytest.approx(0.1 * at[0], abs=1e-6)


@pytest.mark.parametrize("at", [(20.1, 0.0), (0.0, -20.1), (-1e6, 0.0), (23.0, 23.0)])
def test_nobody_stands_beside_it(at: tuple[float, float]) -> None:
    assert Footholds(slope(0.0)).height_m(*at) is None


def test_of_floors_over_each_other_the_highest_counts() -> None:
    footholds = Footholds(np.concatenate([slope(4.0, low=-5.0, high=5.0), slope(0.0)]))
    assert footholds.height_m(1.0, 1.0) == pytest.approx(4.1)
    assert footholds.height_m(6.0, 1.0) == pytest.approx(0.6)
