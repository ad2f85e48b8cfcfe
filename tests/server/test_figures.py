"""What a tracker tells operators of itself."""

from typing import Any

import msgspec
import pytest

from server.figures import FigureTeller
from server.messages import parse_from_rig
from tracker.estimator import Innovation

START_NS = 5_000_000_000


class Telling:
    """A teller, its clock and what it has sent."""

    def __init__(self) -> None:
        self.now_ns, self.sent = 0, list[dict[str, Any]]()
        self.teller = FigureTeller(self._send, START_NS, lambda: self.now_ns)

    def _send(self, text: str) -> None:
        parse_from_rig(text)
        self.sent.append(msgspec.json.decode(text))

    def look(self, *times_s: float, after_s: float = 2.0, **rejected: int) -> None:
        """Have it look at innovations of some times."""
        self.now_ns += round(after_s * 1e9)
        news = [Innovation(START_NS + round(t * 1e9), (3.0, 4.0, 0.0), (0.0, 0.0, 0.2), "P1R1") for t in times_s]
        self.teller.look(news, rejected)

    @property
    def times_s(self) -> list[list[float]]:
        """Of the updates of each message."""
        return [[round(update["t_s"], 6) for update in message["updates"]] for message in self.sent]


def test_nothing_is_told_before_somebody_asks_and_then_all_of_it() -> None:
    telling = Telling()
    telling.look(0.25, 0.5)
    assert telling.sent == []
    telling.teller.ask()
    telling.look(0.75, rejected_gate=3)
    telling.look(1.0)
    assert telling.times_s == [[0.25, 0.5, 0.75], [1.0]]
    assert [message["anew"] for message in telling.sent] == [True, False]
    assert telling.sent[0]["rejected"] == {"rejected_gate": 3}
    assert telling.sent[0]["updates"][0] == {
        "t_s": 0.25,
        "position_m": 5.0,
        "rotation_rad": pytest.approx(0.2),
        "motion_model": "P1R1",
    }


def test_a_second_passes_between_two_and_whoever_comes_later_gets_all() -> None:
    telling = Telling()
    telling.teller.ask()
    telling.look(0.25)
    telling.look(0.5, after_s=0.3)
    telling.look(0.75, after_s=0.8)
    telling.teller.ask()
    telling.look(1.0, after_s=0.1)
    assert telling.times_s == [[0.25], [0.5, 0.75], [0.25, 0.5, 0.75, 1.0]]


def test_an_estimator_that_is_taken_back_tells_its_times_once_more() -> None:
    telling = Telling()
    telling.teller.ask()
    telling.look(0.25, 0.5, 0.75)
    telling.look(0.4, 0.6)
    telling.look(0.8)
    assert telling.times_s == [[0.25, 0.5, 0.75], [0.4, 0.6], [0.8]]
    telling.teller.ask()
    telling.look()
    assert telling.times_s[-1] == [0.25, 0.4, 0.6, 0.8]


def test_another_estimator_begins_anew() -> None:
    telling = Telling()
    telling.teller.ask()
    telling.look(0.25)
    telling.teller.begin()
    telling.look(0.1)
    assert telling.times_s == [[0.25], [0.1]]
    assert telling.sent[1]["anew"]


def test_many_are_told_in_several_messages() -> None:
    telling = Telling()
    telling.teller.ask()
    telling.look(*(0.25 * i for i in range(600)))
    assert [len(times) for times in telling.times_s] == [256, 256, 88]
    assert [message["anew"] for message in telling.sent] == [True, False, False]
