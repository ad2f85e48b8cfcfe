"""A receiver that is refused: believed when it insists for long enough, and at once when it comes back."""

from tracker.measurements import Vector3
from tracker.precise.insistence import Insistence

S = 1_000_000_000
HOME: Vector3 = (0.0, 0.0, 0.0)
AWAY: Vector3 = (50.0, 0.0, 0.0)


def _asked(insistence: Insistence, rate_hz: int, seconds: float, from_s: float = 0.0) -> list[bool]:
    times_ns = [round((from_s + index / rate_hz) * S) for index in range(round(seconds * rate_hz))]
    return [insistence.believes(t_ns, AWAY, HOME, 2.0) for t_ns in times_ns]


def test_five_fixes_of_one_a_second_are_believed() -> None:
    assert _asked(Insistence(5), 1, 5.0) == [False] * 4 + [True]


def test_a_fast_receiver_must_insist_for_as_long() -> None:
    assert _asked(Insistence(5), 10, 4.1) == [False] * 40 + [True]


def test_one_that_is_taken_in_begins_the_count_anew() -> None:
    insistence = Insistence(5)
    assert not any(_asked(insistence, 1, 4.0))
    insistence.accepted()
    assert not any(_asked(insistence, 1, 4.0, from_s=5.0))


def test_back_from_a_leap_it_is_believed_at_once() -> None:
    """The filter has gone on with the receiver for 20 m to the north since then."""
    insistence = Insistence(5)
    assert _asked(insistence, 1, 5.0)[-1]
    leapt: Vector3 = (50.0, 20.0, 0.0)
    assert not insistence.believes(20 * S, (25.0, 20.0, 0.0), leapt, 2.0)
    assert insistence.believes(21 * S, (1.0, 21.0, 0.0), leapt, 2.0)
    assert not insistence.believes(22 * S, AWAY, HOME, 2.0), "there is only one way back"


def test_after_minutes_nobody_knows_where_back_is() -> None:
    insistence = Insistence(5)
    assert _asked(insistence, 1, 5.0)[-1]
    assert not insistence.believes(400 * S, HOME, AWAY, 2.0)
