"""Who else watches: numbers and places for everybody, the newest alone, and nothing of who somebody is."""

import json
from collections.abc import Callable, Iterator
from time import monotonic
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.sync.connection import Connection

from server.company import FORGOTTEN_NS, MOST_TOLD, Watchers
from server.fanout import Mailbox
from server.messages import Eye, Look
from server.privacy import without_picture
from server.web_server import WebServer
from server.wire import encode_frame, encode_pose
from tests.server.serving import HELD_S, bytes_of, rig, serving, text_of, until_closed, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame, example_pose

SECOND_NS = 1_000_000_000
EYE = {"place_site_m": [1.0, 2.0, 1.7], "heading_rad": 0.5, "pitch_rad": -0.1}


def look(e_m: float) -> Look:
    return Look(Eye((e_m, 0.0, 1.7), 0.0, 0.0))


def seen(news: str | None) -> dict[int, float]:
    """Return east by number."""
    assert news is not None
    return {one["number"]: one["eye"]["place_site_m"][0] for one in json.loads(news)["seen"]}


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebServer]:
    with serving(tmp_path_factory.mktemp("server")) as running:
        yield running


def test_numbers_are_given_anew_when_somebody_has_left() -> None:
    watchers = Watchers()
    assert [watchers.join(name) for name in "abc"] == [1, 2, 3]
    watchers.leave("b")
    watchers.leave("b")
    assert [watchers.join(name) for name in "de"] == [2, 4]


def test_only_news_is_told_and_not_often() -> None:
    watchers = Watchers()
    watchers.join("a")
    assert json.loads(watchers.news(0) or "") == {"type": "company", "watching": 1, "seen": []}
    watchers.take("a", look(1.0), 1)
    assert watchers.news(SECOND_NS // 5) is None
    assert seen(watchers.news(SECOND_NS)) == {1: 1.0}
    assert watchers.news(2 * SECOND_NS) is None
    watchers.take("a", look(1.0), 2 * SECOND_NS)
    assert watchers.news(3 * SECOND_NS) is None, "the same look again is no news"
    watchers.take("a", Look(None), 3 * SECOND_NS)
    assert seen(watchers.news(4 * SECOND_NS)) == {}


def test_more_looks_than_ten_a_second_are_passed_over() -> None:
    watchers = Watchers()
    watchers.join("a")
    for i in range(10):
        watchers.take("a", look(float(i)), i * SECOND_NS // 50)
    assert seen(watchers.news(SECOND_NS)) == {1: 5.0}


def test_who_is_silent_is_forgotten_and_the_others_are_told() -> None:
    watchers = Watchers()
    for name in "ab":
        watchers.join(name)
        watchers.take(name, look(0.0), 0)
    assert set(seen(watchers.news(0))) == {1, 2}
    watchers.take("b", look(0.0), FORGOTTEN_NS - 1)
    assert set(seen(watchers.news(FORGOTTEN_NS))) == {2}


@given(ages=st.lists(st.integers(0, 9), min_size=1, max_size=100))
def test_of_many_the_newest_are_told(ages: list[int]) -> None:
    watchers = Watchers()
    for i, age in enumerate(ages):
        watchers.join(i)
        watchers.take(i, look(float(-age)), -age * SECOND_NS)
    told = json.loads(watchers.message())
    assert told["watching"] == len(ages)
    assert len(told["seen"]) == min(MOST_TOLD, len(ages))


def test_with_many_viewers_a_change_is_told_more_seldom() -> None:
    watchers = Watchers()
    for i in range(1000):
        watchers.join(i)
    assert watchers.news(0) is not None
    watchers.take(1, look(0.0), 1)
    assert watchers.news(SECOND_NS) is None
    assert watchers.news(5 * SECOND_NS) is not None


def test_a_look_reaches_everybody_and_ends_with_its_viewer(server: WebServer) -> None:
    with rig(server) as pushing, viewer(server) as a:
        number = text_of(a, "hello")["number"]
        with viewer(server) as b:
            assert text_of(b, "hello")["number"] == number + 1
            b.send(json.dumps({"type": "look", "eye": EYE}))
            told = company_with(a, pushing, lambda told: told["seen"] != [])
            assert told == {"type": "company", "watching": 2, "seen": [{"number": number + 1, "eye": EYE}]}
        company_with(a, pushing, lambda told: told["watching"] == 1 and told["seen"] == [])


def company_with(watching: Connection, pushing: Connection, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    """Return the first news of the company for which something holds; poses are pushed meanwhile, and drive what is told."""
    deadline = monotonic() + HELD_S
    while monotonic() < deadline:
        pushing.send(encode_pose(example_pose()))
        while isinstance(message := watching.recv(HELD_S), str):
            told = json.loads(message)
            if told["type"] == "company" and holds(told):
                return dict(told)
    raise AssertionError("it was never told")


@pytest.mark.parametrize(
    "eye",
    [
        1,
        {},
        EYE | {"place_site_m": [1.0, 2.0]},
        EYE | {"place_site_m": [1e6, 0.0, 0.0]},
        EYE | {"heading_rad": "north"},
        EYE | {"heading_rad": 1e300},
        EYE | {"pitch_rad": None},
    ],
)
def test_a_malformed_look_closes_its_viewer_alone(server: WebServer, eye: Any) -> None:
    with rig(server) as pushing, viewer(server) as good, viewer(server) as bad:
        bad.send(json.dumps({"type": "look", "eye": eye}))
        until_closed(bad)
        assert bad.close_code == 1007
        good.send(json.dumps({"type": "look", "eye": EYE}))
        company_with(good, pushing, lambda told: told["seen"] != [])


def test_who_wants_no_pictures_gets_one_frame_without_it_and_every_pose(server: WebServer) -> None:
    with rig(server, "alone") as pushing, viewer(server, "alone") as seeing:
        pushing.send(frame(1))
        assert bytes_of(seeing) == frame(1)
        with viewer(server, "alone?pictures=none") as watching:
            assert bytes_of(watching) == without_picture(frame(1))
            pushing.send(frame(2))
            pose = encode_pose(example_pose())
            pushing.send(pose)
            assert bytes_of(watching) == pose


def frame(frame_id: int) -> bytes:
    return encode_frame(example_frame(frame_id), TINY_JPEG)


def test_what_waits_to_be_told_is_replaced() -> None:
    mailbox = Mailbox()
    for i in range(1000):
        mailbox.put_company(str(i))
    assert mailbox.closing is None
