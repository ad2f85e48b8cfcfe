"""The speed that steps tell, and the way that one goes on."""

from dataclasses import replace

import numpy as np
import pytest

from tracker.measurements import Vector3
from tracker.precise.settings import PreciseSettings
from tracker.precise.stride import Stride

SETTINGS = replace(PreciseSettings(), stride_sigma_m_s=0.3, facing_sigma_m_s=0.4)
LEVEL = (1.0, 0.0, 0.0, 0.0)


def _north(speed_m_s: float) -> Vector3:
    return (0.0, speed_m_s, 0.0)


def test_before_anything_is_known_one_walks_at_an_easy_pace() -> None:
    assert 0.8 < Stride().speed_m_s(1.5) < 1.8


def test_it_learns_how_a_walker_shakes() -> None:
    """A line that is not the one it begins with, told with noise."""
    rng = np.random.default_rng(3)
    stride = Stride()
    for spread in rng.uniform(0.5, 4.0, 400).tolist():
        stride.learn(spread, _north(0.4 + 0.35 * spread + float(rng.normal(0.0, 0.1))))
    assert [stride.speed_m_s(x) for x in (1.0, 3.0)] == pytest.approx([0.75, 1.45], abs=0.05)


def test_it_follows_a_walker_who_changes() -> None:
    stride = Stride()
    for slope in (0.2, 0.5):
        for step in range(2000):
            stride.learn(1.0 + step % 3, _north(slope * (1.0 + step % 3)))
    assert stride.speed_m_s(2.0) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("spread", [0.0, 2.0])
def test_a_walker_who_always_shakes_alike_has_one_speed(spread: float) -> None:
    """Nothing tells a slope then, for hours, and it is no division by nothing."""
    stride = Stride()
    for _ in range(20_000):
        stride.learn(spread, _north(1.2))
    assert stride.speed_m_s(spread) == pytest.approx(1.2, abs=0.02)


def test_nobody_runs_backwards_or_flies() -> None:
    stride = Stride()
    assert stride.speed_m_s(1000.0) == 2.5
    for _ in range(500):
        stride.learn(2.0, _north(0.0))
        stride.learn(3.0, _north(2.0))
    assert stride.speed_m_s(0.1) == 0.0


def test_who_walks_goes_on_the_way_they_face_and_that_is_less_sure() -> None:
    stride = Stride()
    for step in range(600):
        stride.step((0.0, 0.0, 9.8 + 2.0 * (-1.0) ** step), LEVEL, 0.02)
        stride.learn(2.0, (1.2, 0.0, 0.0))
    velocity, noise = stride.onward(2.0, SETTINGS)
    assert velocity == pytest.approx((1.2, 0.0, 0.0), abs=0.02)
    assert np.sqrt(np.diag(noise)) == pytest.approx([0.3, 0.5, 0.3])


def test_of_a_rig_in_the_hands_nothing_says_that_it_goes_anywhere() -> None:
    velocity, noise = Stride().onward(1.0, SETTINGS)
    assert velocity == (0.0, 0.0, 0.0)
    assert np.sqrt(np.diag(noise)) == pytest.approx([0.4, 0.4, 0.4])
    assert Stride().onward(1e6, SETTINGS)[1].max() == pytest.approx(1.6**2)
