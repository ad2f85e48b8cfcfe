"""A correction is faded in: what is shown does not jump, and ends where the filter is."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import angle_between_rad, exp, multiply
from tracker.precise.blend import Blend
from tracker.precise.navigation import Navigation

S = 1_000_000_000
START = Navigation(S, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))

offsets = st.tuples(*[st.floats(-0.5, 0.5)] * 3)
turns = st.tuples(*[st.floats(-0.05, 0.05)] * 3)


def _moved(by_m: tuple[float, ...], turn_rad: tuple[float, ...]) -> Navigation:
    p = tuple(a + b for a, b in zip(START.p_m, by_m, strict=True))
    return Navigation(S, p, START.v_m_s, multiply(exp(turn_rad), START.wxyz_site_body))  # type: ignore[arg-type]


@given(offsets, turns)
def test_no_jump_and_no_remainder(by_m: tuple[float, ...], turn_rad: tuple[float, ...]) -> None:
    blend, corrected = Blend(0.5), _moved(by_m, turn_rad)
    blend.corrected(START, corrected)
    now, later = blend.shown(corrected), blend.shown(corrected._replace(t_ns=20 * S))
    assert now.p_m == pytest.approx(START.p_m)
    assert angle_between_rad(now.wxyz_site_body, START.wxyz_site_body) == pytest.approx(0.0, abs=1e-6)
    assert later.p_m == pytest.approx(corrected.p_m)
    assert angle_between_rad(later.wxyz_site_body, corrected.wxyz_site_body) == pytest.approx(0.0, abs=1e-6)


def test_a_new_beginning_is_shown_at_once() -> None:
    blend, far = Blend(0.5), _moved((30.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    blend.corrected(START, far)
    assert blend.shown(far) == far
