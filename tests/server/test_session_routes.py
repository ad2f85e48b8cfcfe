"""Sessions renamed, ended and replayed by an operator, seen from viewers and rigs."""

import json
import threading
from collections.abc import Iterator
from pathlib import Path
from time import monotonic_ns
from typing import Any

import httpx
import pytest

from server.errors import LinkRefused
from server.log_store import LogStore
from server.messages import ControlReply
from server.options import SITE
from server.push import RigLink
from server.replays import Replays
from server.sessions import ENDED, Sessions
from server.web_server import WebServer
from server.wire import decode_frame, encode_frame, encode_pose
from tests.server.serving import HELD_S, bytes_of, rig, serving, text_of, token, until, until_closed, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame, example_pose
from tests.walks import write_walk


@pytest.fixture
def server(tmp_path: Path) -> Iterator[WebServer]:
    """A server that keeps one walk, and replays it twice at a time."""
    sessions = Sessions(monotonic_ns)
    store = LogStore(tmp_path / "data", max_bytes=10**8, max_total_bytes=10**9, keep_days=0.0, now_s=lambda: 0.0)
    write_walk(tmp_path / "data" / "logs" / "tour.mcap", 6.0)
    running: list[WebServer] = []
    replays = Replays(
        sessions,
        store,
        site=SITE,
        link=lambda name: (running[0].rig_url(name), token("rig", name)),
        most=2,
        idle_s=600.0,
        memory_bytes=4 * 10**9,
    )
    with serving(tmp_path, sessions=sessions, store=store, replays=replays) as served:
        running.append(served)
        yield served


def ask(server: WebServer, method: str, path: str, body: object = None) -> httpx.Response:
    with httpx.Client(trust_env=False, timeout=60.0) as client:
        return client.request(method, server.url.rstrip("/") + path, json=body)


def listed(server: WebServer) -> dict[str, dict[str, Any]]:
    return {one["name"]: one for one in ask(server, "GET", "/api/sessions").json()["sessions"]}


def test_a_late_joiner_gets_state_newest_frame_and_newest_pose_at_once(server: WebServer) -> None:
    with rig(server) as pushing:
        pushing.send(json.dumps({"type": "state", "session": {"estimator": "gps-imu/precise"}}))
        pushing.send(encode_frame(example_frame(7), TINY_JPEG))
        pushing.send(encode_pose(example_pose()))
        until(lambda: 'agora_poses_total{session="walk"} 1' in ask(server, "GET", "/metrics").text)
        with viewer(server) as late:
            assert json.loads(late.recv(HELD_S))["session"]["estimator"] == "gps-imu/precise"
            assert decode_frame(bytes_of(late))[0].frame_id == 7
            assert bytes_of(late) == encode_pose(example_pose())


def test_a_renamed_session_keeps_its_address_and_tells_its_viewers(server: WebServer) -> None:
    with rig(server), viewer(server) as watching:
        assert text_of(watching, "hello")["session"]["title"] is None
        assert ask(server, "PATCH", "/api/sessions/walk", {"title": " Τετράγωνος Ἀγορά "}).status_code == 200
        assert text_of(watching, "state")["session"]["title"] == "Τετράγωνος Ἀγορά"
        assert listed(server)["walk"]["title"] == "Τετράγωνος Ἀγορά"
        assert ask(server, "PATCH", "/api/sessions/walk", {"title": ""}).json()["title"] is None
        for body in ({"title": "a\nb"}, {"title": "a" * 101}, {"title": 1}, {}, {"title": "a", "name": "b"}):
            assert ask(server, "PATCH", "/api/sessions/walk", body).status_code == 422
    assert ask(server, "PATCH", "/api/sessions/none", {"title": "a"}).status_code == 404


def test_an_ended_session_is_gone_and_its_rig_does_not_come_back(server: WebServer) -> None:
    link = RigLink(
        server.rig_url("walk"), token("rig", "walk"), lambda request: ControlReply(request.request_id, ok=True)
    )
    with link:
        until(lambda: "walk" in listed(server))
        with viewer(server) as watching, rig(server, "other") as other:
            assert ask(server, "DELETE", "/api/sessions/walk").status_code == 204
            until(lambda: link.refused is not None)
            assert isinstance(link.refused, LinkRefused)
            assert "operator has ended" in str(link.refused)
            until_closed(watching)
            assert watching.close_code == ENDED
            other.ping().wait(HELD_S)
            assert set(listed(server)) == {"other"}
    assert ask(server, "DELETE", "/api/sessions/walk").status_code == 404


def test_two_viewers_watch_one_walk_by_different_estimators(server: WebServer) -> None:
    names = []
    for estimator in ("gps-imu/famm", "truth"):
        begun = ask(server, "POST", "/api/sessions", {"log": "tour", "estimator": estimator})
        assert begun.status_code == 201
        assert (begun.json()["kind"], begun.json()["log"]) == ("replay", "tour")
        names.append(begun.json()["name"])
    assert names == ["tour", "tour-2"]
    assert ask(server, "POST", "/api/sessions", {"log": "tour"}).status_code == 503
    with viewer(server, "tour") as one, viewer(server, "tour-2") as two:
        shown = {decode_frame(bytes_of(one))[0].estimator, decode_frame(bytes_of(two))[0].estimator}
        assert shown == {"gps-imu/famm", "truth"}
        one.send(json.dumps({"type": "control", "request_id": "1", "action": "pause"}))
        assert text_of(one, "reply")["ok"] is True
        assert listed(server)["tour-2"]["playback"]["playing"] is True
        assert ask(server, "DELETE", "/api/logs/tour").status_code == 204
        for connection in (one, two):
            until_closed(connection)
            assert connection.close_code == ENDED
    assert listed(server) == {}


def test_a_replay_that_cannot_be_is_refused_in_a_sentence_and_leaves_no_session(
    server: WebServer, tmp_path: Path
) -> None:
    for body, status in (
        ({"log": "none"}, 404),
        ({"log": "../tour"}, 404),
        ({"log": "tour", "estimator": "magic"}, 422),
        ({"log": "tour", "estimator": "camera-gps-imu/famm"}, 422),
        ({"log": "tour", "speed": 2}, 422),
    ):
        refused = ask(server, "POST", "/api/sessions", body)
        assert (refused.status_code, str(tmp_path) in refused.text) == (status, False)
    assert listed(server) == {}


def test_no_process_and_no_thread_is_left(server: WebServer) -> None:
    before = set(threading.enumerate())
    assert ask(server, "POST", "/api/sessions", {"log": "tour"}).status_code == 201
    assert ask(server, "DELETE", "/api/sessions/tour").status_code == 204
    until(lambda: {t for t in threading.enumerate() if "asyncio" not in t.name and "AnyIO" not in t.name} <= before)
    assert listed(server) == {}
