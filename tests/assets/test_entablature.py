"""Entablatures: between the heights asked, mitred all around, ornamented only at the finest level."""

from typing import Literal

import numpy as np
import pytest

from assets.entablature import ENTABLATURE, entablature
from assets.shape import Shape
from tests.assets.geometry import drawn, open_edges, volume_m3

FACES = (0.0, 10.0, 0.0, 1.0)
Order = Literal["ionic", "doric"]


@pytest.mark.parametrize("order", ["ionic", "doric"])
@pytest.mark.parametrize("level", [0, 1, 2])
def test_it_lies_between_its_heights_and_stands_out_a_little_over_a_third(order: Order, level: int) -> None:
    shape = Shape()
    entablature(shape, order, FACES, 5.0, 1.5, level)
    points = drawn(shape).reshape(-1, 3)
    assert (points[:, 2].min(), points[:, 2].max()) == (pytest.approx(5.0), pytest.approx(6.5))
    assert points[:, 1].min() == pytest.approx(-0.36 * 1.5, abs=0.06)
    assert points[:, 0].max() == pytest.approx(10.0 + 0.36 * 1.5, abs=0.06)


@pytest.mark.parametrize("level", [1, 2])
def test_a_plain_one_is_watertight(level: int) -> None:
    shape = Shape()
    entablature(shape, "ionic", FACES, 5.0, 1.5, level)
    assert not open_edges(drawn(shape))
    assert volume_m3(drawn(shape)) > 10.0


def test_its_profile_rises_and_ends_at_the_top() -> None:
    for rows in ENTABLATURE.values():
        heights = [share for _, share, _ in rows]
        assert heights == sorted(heights)
        assert (heights[0], heights[-1]) == (0.0, 1.0)


@pytest.mark.parametrize(("order", "low", "high"), [("ionic", 0.70, 0.785), ("doric", 0.42, 0.78)])
def test_ornament_is_on_the_fronts_asked(order: Order, low: float, high: float) -> None:
    plain, ornamented = Shape(), Shape()
    entablature(plain, order, FACES, 0.0, 1.0, 0, ())
    entablature(ornamented, order, FACES, 0.0, 1.0, 0, (2,))
    more = drawn(ornamented)[len(drawn(plain)) :]
    assert len(more) >= 8 * 8
    assert more[..., 1].min() >= 1.0 - 1e-6
    band = more[(more[..., 2].min(axis=1) > low - 1e-3) & (more[..., 2].max(axis=1) < high + 1e-3)]
    assert len(band) >= 8 * 8


def test_a_hollow_one_is_open_within() -> None:
    shape = Shape()
    entablature(shape, "ionic", (0.0, 10.0, 0.0, 6.0), 5.0, 1.5, 1, hollow_m=0.8)
    triangles = drawn(shape)
    middle = np.array([5.0, 3.0])
    over = (triangles[..., :2].min(axis=1) < middle).all(axis=1) & (triangles[..., :2].max(axis=1) > middle).all(axis=1)
    level = np.ptp(triangles[..., 2], axis=1) < 1e-9
    assert not (over & level).any()
