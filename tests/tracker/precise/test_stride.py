"""The speed that steps tell, and the way that one goes on."""

from math import pi

import numpy as np
import pytest

from tracker.geometry import wxyz_from_yaw
from tracker.measurements import Vector3
from tracker.precise.error_model import start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings
from tracker.precise.stride import Stride

SETTINGS = PreciseSettings()


def _nav(v_m_s: Vector3, yaw_rad: float = 0.0) -> Navigation:
    return Navigation(0, (0.0, 0.0, 0.0), v_m_s, wxyz_from_yaw(yaw_rad))


def _north(speed_m_s: float) -> Navigation:
    return _nav((0.0, speed_m_s, 0.0))


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


def test_who_has_just_stopped_teaches_nothing() -> None:
    stride = _walked()
    for _ in range(200):
        stride.learn(1.5, _north(0.1))
    assert stride.speed_m_s(2.0) == pytest.approx(1.2, abs=0.02)


def test_nobody_runs_backwards_or_flies() -> None:
    stride = Stride()
    assert stride.speed_m_s(1000.0) == 2.5
    for _ in range(500):
        stride.learn(2.0, _north(0.6))
        stride.learn(3.0, _north(2.0))
    assert stride.speed_m_s(0.1) == 0.0


def _state(v_m_s: Vector3, yaw_rad: float = 0.0) -> ErrorState:
    settings = PreciseSettings()
    covariance = start_covariance(settings, (1.0, 1.0, 1.0), 0.3, 0.1)
    return ErrorState(settings, _nav(v_m_s, yaw_rad), Biases(), covariance, 9.8)


def _walked(noise_m_s: float = 0.0) -> Stride:
    """Whoever has walked eastwards for a while, looking ahead."""
    rng, stride = np.random.default_rng(5), Stride()
    for _ in range(600):
        stride.learn(2.0, _nav((1.2 + float(rng.normal(0.0, noise_m_s)), 0.0, 0.0)))
    return stride


def _seen(stride: Stride, state: ErrorState) -> tuple[Vector3, Vector3]:
    """Return by what a state is corrected, and the deviations: along the way, across it, upwards."""
    (residual, _), noise = stride.onward(2.0, state, SETTINGS)
    x, y, z = residual.tolist()
    a, b, c = np.sqrt(np.diag(noise)).tolist()
    return (x, y, z), (a, b, c)


def test_who_walks_goes_on_the_way_they_face() -> None:
    residual, _ = _seen(_walked(), _state((1.0, 0.0, 0.1)))
    assert residual == pytest.approx((0.2, 0.0, -0.1), abs=0.02)


def test_the_less_evenly_one_went_the_less_is_known_of_the_speed() -> None:
    _, (even, *_) = _seen(_walked(), _state((1.2, 0.0, 0.0)))
    _, (uneven, *_) = _seen(_walked(0.4), _state((1.2, 0.0, 0.0)))
    assert even < 0.2 < 0.5 < uneven < 0.7


def test_the_further_the_facing_is_from_the_way_the_less_it_counts() -> None:
    """At sixty degrees aside it is a glance; the speed is along the way nevertheless."""
    (along, course, _), (_, doubt, _) = _seen(_walked(), _state((1.2, 0.0, 0.0), yaw_rad=pi / 3))
    assert along == pytest.approx(0.0, abs=0.02)
    assert course == pytest.approx(pi / 3, abs=0.02)
    assert doubt > pi / 3
    assert _seen(_walked(), _state((1.2, 0.0, 0.0)))[1][1] < 0.2


def test_who_begins_to_walk_goes_where_they_face() -> None:
    (along, across, _), (_, doubt, _) = _seen(_walked(), _state((0.0, 0.2, 0.0), yaw_rad=pi / 2))
    assert along == pytest.approx(1.0, abs=0.02)
    assert across == pytest.approx(0.0, abs=0.02)
    assert doubt < 0.3


@pytest.mark.parametrize("speed_m_s", [0.3, 1.1])
@pytest.mark.parametrize("yaw_rad", [0.0, 1.2, 3.0])
def test_its_slopes_are_those_of_its_residual(yaw_rad: float, speed_m_s: float) -> None:
    stride, step = _walked(), 1e-6
    state = _state((speed_m_s, 0.2, 0.05), yaw_rad)
    (residual, blocks), _ = stride.onward(2.0, state, SETTINGS)
    H = np.zeros((3, len(state.covariance)))
    for where, block in blocks:
        H[:, where] += block
    for column in (3, 4, 5, 8):
        error = np.zeros(len(state.covariance))
        error[column] = step
        moved = state.copied()
        moved.move(error)
        (after, _), _ = stride.onward(2.0, moved, SETTINGS)
        assert (residual - after) / step == pytest.approx(H[:, column], abs=1e-4)


def test_of_a_rig_in_the_hands_nothing_says_that_it_goes_anywhere() -> None:
    residual, sigma = _seen_held(1.0)
    assert residual == pytest.approx((-1.0, 0.0, 0.0))
    assert sigma == pytest.approx(0.4)
    assert _seen_held(1e6)[1] == pytest.approx(1.6)


def _seen_held(spread_m_s2: float) -> tuple[Vector3, float]:
    (residual, _), noise = Stride().onward(spread_m_s2, _state((1.0, 0.0, 0.0)), SETTINGS)
    x, y, z = residual.tolist()
    return (x, y, z), float(np.sqrt(noise[0, 0]))
