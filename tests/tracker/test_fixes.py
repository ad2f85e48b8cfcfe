"""Fixes: what a receiver claims, and what nobody can have walked."""

from math import nan

from tracker.fixes import BELIEVED, FixGate, variance_m2
from tracker.measurements import GpsFix

HERE, FAR = (0.0, 0.0, 0.0), (3000.0, 0.0, 0.0)


def _fix(*cov: float) -> GpsFix:
    return GpsFix(0, 0, 37.9, 27.3, 90.0, cov)


def test_a_variance_is_bounded_below_and_has_a_default() -> None:
    """Three centimetres from a phone are not believed; nothing, NaN or nonsense stated gives the default of that axis."""
    stated = _fix(4.0, 0.0, 0.0, 0.0, 0.001, 0.0, 0.0, 0.0, nan)
    assert variance_m2(stated, 1.0, (5.0, 6.0, 7.0)) == (4.0, 1.0, 7.0)
    assert variance_m2(_fix(*[0.0] * 9), 1.0, (5.0, 6.0, 7.0)) == (5.0, 6.0, 7.0)
    assert variance_m2(_fix(), 1.0, (5.0, 6.0, 7.0)) == (5.0, 6.0, 7.0)


def test_a_leap_is_refused_until_it_insists() -> None:
    """Five times no, the sixth time the receiver is believed, and the gate is as strict as before."""
    gate = FixGate()
    assert [gate.refuses(HERE, FAR, 1.0) for _ in range(BELIEVED + 1)] == [True] * BELIEVED + [False]
    assert gate.insisted()
    assert not gate.insisted()
    assert gate.refuses(HERE, FAR, 1.0)


def test_time_allows_distance() -> None:
    """After a bus ride the same leap is no leap; an ordinary fix in between starts the count anew."""
    gate = FixGate()
    assert not gate.refuses(HERE, FAR, 100.0)
    for _ in range(2 * BELIEVED):
        assert gate.refuses(HERE, FAR, 1.0)
        assert not gate.refuses(HERE, (3.0, 3.0, 3.0), 1.0)
        assert not gate.insisted()
