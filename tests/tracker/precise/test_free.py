"""The free integral carries states exactly, whatever it has drifted to and in whatever order samples came."""

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import angle_between_rad, normalise, rotate
from tracker.measurements import ImuSample, Vector3
from tracker.precise.free import FreeIntegral
from tracker.precise.navigation import Biases, Navigation, advance, mean

G = 9.8
MS = 1_000_000
LAG_NS = 50 * MS
ZERO: Vector3 = (0.0, 0.0, 0.0)


def _samples(count: int) -> list[ImuSample]:
    rng = np.random.default_rng(7)
    samples = []
    for index in range(count):
        (a, b, c), (d, e, f) = rng.normal(0.0, 0.5, 3).tolist(), rng.normal(0.0, 1.0, 3).tolist()
        samples.append(ImuSample(10 * MS * index, 10 * MS * index, (a, b, c), (d, e, f + G)))
    return samples


def _integral(samples: Iterable[ImuSample]) -> FreeIntegral:
    free = FreeIntegral(G, LAG_NS)
    for sample in samples:
        free.add(sample)
    return free


def _assert_close(a: Navigation, b: Navigation) -> None:
    assert a.t_ns == b.t_ns
    assert a.p_m == pytest.approx(b.p_m, abs=1e-9)
    assert a.v_m_s == pytest.approx(b.v_m_s, abs=1e-9)
    assert angle_between_rad(a.wxyz_site_body, b.wxyz_site_body) < 1e-6


def test_any_state_is_carried_as_its_own_integral_would() -> None:
    samples = _samples(30)
    nav = Navigation(100 * MS, (5.0, -3.0, 1.0), (0.3, 1.0, 0.1), normalise((0.5, 0.1, -0.3, 0.8)))
    carried = _integral(samples).carry(nav, 290 * MS)
    for before, after in pairwise(samples[10:]):
        gyro, accel = mean(before.gyro_rad_s, after.gyro_rad_s), mean(before.accel_m_s2, after.accel_m_s2)
        nav = advance(nav, after.t_ns, gyro, accel, Biases(), G)
    _assert_close(carried, nav)


def test_carrying_back_undoes_carrying_on() -> None:
    free = _integral(_samples(30))
    nav = Navigation(103 * MS, (5.0, -3.0, 1.0), (0.3, 1.0, 0.1), normalise((0.5, 0.1, -0.3, 0.8)))
    _assert_close(free.carry(free.carry(nav, 255 * MS), 103 * MS), nav)


@given(st.permutations(range(12)), st.lists(st.integers(0, 11), max_size=4))
def test_late_samples_leave_no_trace(order: list[int], learnt: list[int]) -> None:
    """Bit for bit, also where biases were learnt on the way."""
    samples = _samples(12)
    in_order, shuffled = FreeIntegral(G, LAG_NS), FreeIntegral(G, LAG_NS)
    for free in (in_order, shuffled):
        for index in sorted(set(learnt)):
            free.learn(10 * MS * index, Biases((0.01 * index, 0.0, 0.0), (0.0, 0.1 * index, 0.0)))
    for index in range(12):
        in_order.add(samples[index])
        shuffled.add(samples[order[index]])
    start = Navigation(0, ZERO, ZERO, (1.0, 0.0, 0.0, 0.0))
    for t_ns in range(0, 110 * MS, 3 * MS):
        assert in_order.carry(start, t_ns) == shuffled.carry(start, t_ns)


def test_a_bias_is_taken_off_once_the_filter_had_known_it() -> None:
    """The step after the sample at which the filter, with its lag, had just passed what told it."""
    free, start = FreeIntegral(G, LAG_NS), Navigation(0, ZERO, ZERO, (1.0, 0.0, 0.0, 0.0))
    free.learn(20 * MS, Biases((0.0, 0.0, 1.0)))
    for index in range(12):
        free.add(ImuSample(10 * MS * index, 10 * MS * index, (0.0, 0.0, 1.0), (0.0, 0.0, G)))

    def yaw(t_ns: int) -> float:
        x, y, _ = rotate(free.carry(start, t_ns).wxyz_site_body, (1.0, 0.0, 0.0))
        return float(np.arctan2(y, x))

    assert yaw(80 * MS) == pytest.approx(0.08)
    assert yaw(110 * MS) == pytest.approx(0.08)


def test_after_the_newest_sample_it_turns_for_a_moment_and_goes_straight_on() -> None:
    free = _integral([ImuSample(10 * MS * i, 10 * MS * i, (0.0, 0.0, 2.0), (0.0, 0.0, G)) for i in range(5)])
    tilted = Navigation(40 * MS, ZERO, (1.0, 0.5, 0.0), (1.0, 0.0, 0.0, 0.0))
    ahead = free.carry(tilted, 540 * MS)
    x, y, _ = rotate(ahead.wxyz_site_body, (1.0, 0.0, 0.0))
    assert np.arctan2(y, x) == pytest.approx(0.2)
    assert ahead.p_m == pytest.approx((0.5, 0.25, 0.0))
    assert ahead.v_m_s == pytest.approx((1.0, 0.5, 0.0))


def test_two_seconds_are_kept_whatever_the_rate() -> None:
    fast, slow = _integral(_samples(1000)), FreeIntegral(G, LAG_NS)
    assert 2000 * MS <= fast.newest_ns - fast.oldest_ns <= 2010 * MS
    for second in range(5):
        slow.add(ImuSample(3000 * MS * second, 0, ZERO, (0.0, 0.0, G)))
    assert slow.newest_ns - slow.oldest_ns == 3000 * MS, "one before the two seconds, to begin from"
