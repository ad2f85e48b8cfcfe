"""Splines and their derivatives, against differences."""

from collections.abc import Callable

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tracker.measurements import Matrix
from tracker.splines import Jet, Spline, cos, sin, slewed, smoothed

CONTROLS = np.random.default_rng(5).normal(0.0, 1.0, 60)
STEP_S = 1e-4


def _check(jet_at: Callable[[Matrix], Jet], t: Matrix) -> None:
    before, here, after = (jet_at(t + d) for d in (-STEP_S, 0.0, STEP_S))
    np.testing.assert_allclose((after.value - before.value) / (2 * STEP_S), here.rate, atol=1e-4)
    # the third derivative jumps at knots, and is some thousands here
    np.testing.assert_allclose((after.rate - before.rate) / (2 * STEP_S), here.accel, atol=0.5)


def test_rates_are_slopes() -> None:
    """Of a spline, and of products, sines and cosines by the chain rule."""
    spline, other = Spline(CONTROLS, 0.1), Spline(CONTROLS[::-1].copy(), 0.1)
    t = np.linspace(0.513, 5.4, 200)
    _check(spline.at, t)
    _check(lambda at: cos(spline.at(at)) * other.at(at) - sin(other.at(at)) * 0.5 + spline.at(at), t)


def test_equal_controls_hold_exactly_still() -> None:
    """A calibration at rest must not creep by a rounding error; beyond its ends a spline stays."""
    jet = Spline(np.full(20, 3.7), 0.1).at(np.linspace(-1.0, 9.0, 101))
    assert (jet.value == 3.7).all()
    assert (jet.rate == 0.0).all()
    assert (jet.accel == 0.0).all()


@given(st.lists(st.floats(-5.0, 5.0), min_size=2, max_size=40), st.floats(0.1, 20.0))
def test_a_slewed_course_is_never_too_fast(values: list[float], limit: float) -> None:
    """And it is the course itself where that is slow enough."""
    followed = slewed(np.array(values), limit, 0.1)
    assert (np.abs(np.diff(followed)) <= limit * 0.1 + 1e-9).all()
    assert followed[0] == values[0]
    if (np.abs(np.diff(values)) <= limit * 0.1).all():
        np.testing.assert_allclose(followed, values, atol=1e-12)


def test_smoothing_keeps_constants_and_the_mean() -> None:
    """Exactly so where it is constant for long."""
    step = np.concatenate([np.zeros(40), np.ones(40)])
    smooth = smoothed(step, 0.2, 0.1)
    assert (smooth[:30] == 0.0).all()
    assert (np.diff(smooth) >= -1e-12).all()
    np.testing.assert_allclose(smooth[-30:], 1.0)
    assert abs(float(np.sum(smooth - step))) < 1e-9


def test_jets_subtract() -> None:
    """Each part by itself."""
    one = Jet(np.array([3.0]), np.array([2.0]), np.array([1.0]))
    zero = one - one
    np.testing.assert_array_equal([zero.value, zero.rate, zero.accel], 0.0)
