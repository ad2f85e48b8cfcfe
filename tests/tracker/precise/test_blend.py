"""A correction is faded in: what is shown does not jump, and ends where the filter is."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import angle_between_rad, exp, multiply
from tracker.precise.blend import Blend
from tracker.precise.navigation import Navigation

S = 1_000_000_000
LAG_NS = S // 2
START = Navigation(S, (1.0, 2.0, 3.0), (0.4, 0.5, 0.6), (1.0, 0.0, 0.0, 0.0))

offsets = st.tuples(*[st.floats(-0.5, 0.5)] * 3)
turns = st.tuples(*[st.floats(-0.05, 0.05)] * 3)


def _moved(nav: Navigation, by_m: tuple[float, ...], turn_rad: tuple[float, ...]) -> Navigation:
    p = tuple(a + b for a, b in zip(nav.p_m, by_m, strict=True))
    v = tuple(a - b for a, b in zip(nav.v_m_s, by_m, strict=True))
    return Navigation(nav.t_ns, p, v, multiply(exp(turn_rad), nav.wxyz_site_body))  # type: ignore[arg-type]


def _assert_same(a: Navigation, b: Navigation) -> None:
    assert a.p_m == pytest.approx(b.p_m)
    assert a.v_m_s == pytest.approx(b.v_m_s, abs=1e-9)
    assert angle_between_rad(a.wxyz_site_body, b.wxyz_site_body) == pytest.approx(0.0, abs=1e-6)


@given(offsets, turns)
def test_no_jump_and_no_remainder(by_m: tuple[float, ...], turn_rad: tuple[float, ...]) -> None:
    blend, corrected = Blend(0.8, 0.3, 0.8, 0.5), _moved(START, by_m, turn_rad)
    blend.corrected(START, corrected)
    _assert_same(blend.shown(corrected, S + LAG_NS), START)
    _assert_same(blend.shown(corrected, 20 * S), corrected)
    half = blend.shown(corrected, S + LAG_NS + round(0.8 * np.log(2.0) * S))
    assert half.p_m == pytest.approx([0.5 * (a + b) for a, b in zip(START.p_m, corrected.p_m, strict=True)])


@given(offsets, offsets)
def test_a_second_correction_does_not_lose_the_first(first_m: tuple[float, ...], second_m: tuple[float, ...]) -> None:
    """What is shown just before it is shown just after it."""
    blend, level, later = Blend(0.8, 0.3, 0.8, 0.5), (0.0, 0.0, 0.0), START._replace(t_ns=2 * S)
    blend.corrected(START, _moved(START, first_m, level))
    now_ns, before = 2 * S + LAG_NS, _moved(later, first_m, level)
    shown = blend.shown(before, now_ns)
    after = _moved(before, second_m, level)
    blend.corrected(before, after)
    _assert_same(blend.shown(after, now_ns), shown)


def test_a_new_beginning_is_shown_at_once() -> None:
    blend, far = Blend(0.8, 0.3, 0.8, 0.5), _moved(START, (30.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    blend.corrected(START, far)
    _assert_same(blend.shown(far, S), far)
    turned = _moved(START, (0.0, 0.0, 0.0), (0.0, 0.0, 0.5))
    blend.corrected(START, turned)
    _assert_same(blend.shown(turned, S), turned)


@given(offsets, turns)
def test_the_offset_is_what_is_shown_less_the_state(by_m: tuple[float, ...], turn_rad: tuple[float, ...]) -> None:
    blend, corrected = Blend(0.8, 0.3, 0.8, 0.5), _moved(START, by_m, turn_rad)
    blend.corrected(START, corrected)
    shown, offset = blend.shown(corrected, 2 * S), blend.offset(2 * S)
    assert offset[:3] == pytest.approx(np.subtract(shown.p_m, corrected.p_m))
    assert offset[3:6] == pytest.approx(np.subtract(shown.v_m_s, corrected.v_m_s))
    x, y, z = offset[6:].tolist()
    turned = multiply(exp((x, y, z)), corrected.wxyz_site_body)
    assert angle_between_rad(turned, shown.wxyz_site_body) == pytest.approx(0.0, abs=1e-6)


@given(offsets, turns, st.floats(0.0, 3.0))
def test_who_begins_to_walk_sees_no_jump_and_then_what_is_left_sooner(
    by_m: tuple[float, ...], turn_rad: tuple[float, ...], after_s: float
) -> None:
    blend, corrected, at_ns = Blend(0.8, 0.3, 0.8, 0.5), _moved(START, by_m, turn_rad), S + round(after_s * S)
    blend.corrected(START, corrected)
    before = blend.shown(corrected, at_ns + LAG_NS)
    blend.pace(at_ns, stands=False)
    _assert_same(blend.shown(corrected, at_ns + LAG_NS), before)
    half = blend.shown(corrected, at_ns + LAG_NS + round(0.3 * np.log(2.0) * S))
    assert half.p_m == pytest.approx([0.5 * (a + b) for a, b in zip(before.p_m, corrected.p_m, strict=True)])


def test_pace_kept_is_nothing_done() -> None:
    blend, corrected = Blend(0.8, 0.3, 0.8, 0.5), _moved(START, (0.1, 0.2, 0.3), (0.01, 0.0, 0.02))
    blend.corrected(START, corrected)
    before = blend.shown(corrected, 2 * S)
    blend.pace(round(1.7 * S), stands=True)
    assert blend.shown(corrected, 2 * S) == before
