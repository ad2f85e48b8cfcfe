"""What is taken back was never said, bit for bit."""

from collections.abc import Iterable
from dataclasses import replace
from functools import cache

from tests.tracker.precise.stream import NAMES, S, estimator, row, stream
from tracker.measurements import Measurement, Outcome, Retraction, Sighting, Standpoint
from tracker.retractable import KEPT_S, MOST, Retractable
from tracker.simulate import START_NS

SAID = (Sighting, Standpoint)
BEGUN_NS = min(m.t_recv_ns for m in stream() if isinstance(m, SAID)) - S
END_NS = max(m.t_ns for m in stream())


def retractable() -> Retractable:
    """Return one about the precise estimator."""
    return Retractable(lambda: estimator(NAMES[1]))


@cache
def begun() -> object:
    """Return the snapshot of one that has been fed what was measured before anything was said."""
    one = retractable()
    for measurement in stream():
        if measurement.t_recv_ns < BEGUN_NS:
            one.step(measurement)
    return one.snapshot()


def end(of: Iterable[Measurement]) -> tuple[object, ...]:
    """Return the last pose."""
    one = retractable()
    one.restore(begun())
    for measurement in of:
        if measurement.t_recv_ns >= BEGUN_NS:
            one.step(measurement)
    return row(one.predict(END_NS))


def taken_back(at_s: float, times: int = 1) -> list[Measurement]:
    """Return the stream, with so many retractions at a time."""
    t_ns = START_NS + round(at_s * S)
    retractions = [Retraction(t_ns, t_ns + index) for index in range(times)]
    return sorted([*stream(), *retractions], key=lambda m: m.t_recv_ns)


@cache
def without(*indices: int) -> tuple[object, ...]:
    """Return the last pose without some of what is said in the stream: three landmarks, then a place."""
    said = [m for m in stream() if isinstance(m, SAID)]
    return end(m for m in stream() if all(m is not said[index] for index in indices))


def test_the_last_word_is_taken_back() -> None:
    """The place, some seconds after it was told, with everything measured meanwhile kept."""
    assert end(taken_back(42.0)) == without(3) != without()


def test_words_are_taken_back_one_after_another() -> None:
    assert end(taken_back(42.0, times=2)) == without(2, 3)
    assert end(taken_back(42.0, times=3)) == without(1, 2, 3), "the first landmark is out of reach"
    assert end(taken_back(42.0, times=MOST + 3)) == without(1, 2, 3)


def test_what_is_said_after_that_stays() -> None:
    assert end(taken_back(30.0)) == without(1)


def test_where_nothing_was_said_lately_nothing_is_taken_back() -> None:
    one = retractable()
    early = [m for m in stream() if m.t_recv_ns < START_NS + 20 * S]
    for measurement in early:
        one.step(measurement)
    t_ns = early[-1].t_recv_ns
    assert one.step(Retraction(t_ns, t_ns)) is Outcome.REJECTED_STALE
    seen = next(m for m in stream() if isinstance(m, Sighting))
    assert one.step(replace(seen, t_ns=t_ns, t_recv_ns=t_ns)) is Outcome.USED
    later_ns = t_ns + round((KEPT_S + 1.0) * S)
    assert one.step(Retraction(later_ns, later_ns)) is Outcome.REJECTED_STALE


def test_what_was_refused_is_not_there_to_be_taken_back() -> None:
    one = retractable()
    for measurement in (m for m in stream() if m.t_recv_ns < START_NS + 30 * S):
        one.step(measurement)
    t_ns = START_NS + 30 * S
    absurd = Sighting(t_ns, t_ns, (1.0, 2.0, 3.0), (0.0, 0.0, 9.0), 0.01)
    before = row(one.predict(t_ns))
    assert one.step(absurd) is Outcome.REJECTED_GATE
    assert row(one.predict(t_ns)) == before
    assert one.step(Retraction(t_ns, t_ns)) is Outcome.USED, "the landmark before it"


def test_a_snapshot_holds_what_can_be_taken_back() -> None:
    one, other = retractable(), retractable()
    until_ns = START_NS + 40 * S
    for measurement in (m for m in stream() if m.t_recv_ns < until_ns):
        one.step(measurement)
    snapshot = one.snapshot()
    one.step(Retraction(until_ns, until_ns))
    other.restore(snapshot)
    rest = [Retraction(until_ns, until_ns), *(m for m in stream() if m.t_recv_ns >= until_ns)]
    for measurement in rest:
        other.step(measurement)
    assert row(other.predict(END_NS)) == without(3)
