"""The speed that steps tell."""

import numpy as np
import pytest

from tracker.precise.stride import Stride


def test_before_anything_is_known_one_walks_at_an_easy_pace() -> None:
    assert 0.8 < Stride().speed_m_s(1.5) < 1.8


def test_it_learns_how_a_walker_shakes() -> None:
    """A line that is not the one it begins with, told with noise."""
    rng = np.random.default_rng(3)
    stride = Stride()
    for spread in rng.uniform(0.5, 4.0, 400).tolist():
        stride.learn(spread, 0.4 + 0.35 * spread + float(rng.normal(0.0, 0.1)))
    assert [stride.speed_m_s(x) for x in (1.0, 3.0)] == pytest.approx([0.75, 1.45], abs=0.05)


def test_it_follows_a_walker_who_changes() -> None:
    stride = Stride()
    for slope in (0.2, 0.5):
        for step in range(2000):
            stride.learn(1.0 + step % 3, slope * (1.0 + step % 3))
    assert stride.speed_m_s(2.0) == pytest.approx(1.0, abs=0.1)


def test_nobody_runs_backwards_or_flies() -> None:
    stride = Stride()
    assert stride.speed_m_s(1000.0) == 2.5
    for _ in range(500):
        stride.learn(2.0, 0.0)
        stride.learn(3.0, 2.0)
    assert stride.speed_m_s(0.1) == 0.0
