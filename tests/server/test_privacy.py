"""The camera's picture: the walker's own view has it; everybody else while the walker shares it, and not a picture longer."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from websockets.sync.connection import Connection

from server.access import Access
from server.messages import ControlReply, Figures, encode
from server.privacy import without_picture
from server.push import RigLink
from server.web_server import WebServer
from server.wire import decode_frame, encode_frame
from tests.server.serving import HELD_S, bytes_of, rig, serving, text_of, token, until, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame


def frame(frame_id: int) -> bytes:
    return encode_frame(example_frame(frame_id), TINY_JPEG)


def watch(server: WebServer, role: Any, session: str | None = None) -> Connection:
    return viewer(server, additional_headers={"Authorization": f"Bearer {token(role, session)}"})


def ask(asking: Connection, action: str, value: Any) -> dict[str, Any]:
    asking.send(json.dumps({"type": "control", "request_id": "1", "action": action, "value": value}))
    return text_of(asking, "reply")


@pytest.fixture
def server(tmp_path: Path) -> Iterator[WebServer]:
    with serving(tmp_path, access=Access.with_secret(bytes(32))) as running:
        yield running


def test_a_frame_without_its_picture_is_the_same_but_for_that() -> None:
    hidden = without_picture(frame(3))
    meta, jpeg = decode_frame(hidden)
    assert hidden[:384] == frame(3)[:384]
    assert meta.frame_id == 3
    picture = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    assert np.ptp(picture) == 0
    assert len(jpeg) < 1000


def test_only_the_walkers_own_view_has_the_picture(server: WebServer) -> None:
    with rig(server) as pushing, watch(server, "rig", "walk") as walker:
        assert text_of(walker, "hello")["sees"] is True
        pushing.send(frame(1))
        assert bytes_of(walker) == frame(1)
        for role in ("viewer", "operator", "admin"):
            with watch(server, role) as late:
                assert text_of(late, "hello")["sees"] is False
                assert bytes_of(late) == without_picture(frame(1))
                pushing.send(frame(1))
                assert bytes_of(late) == without_picture(frame(1))
                assert bytes_of(walker) == frame(1)
                walker.send('{"type":"ack","frame_id":1}')


def test_the_walker_shares_and_stops_sharing(server: WebServer) -> None:
    with (
        RigLink(server.rig_url("walk"), token("rig", "walk"), lambda request: pytest.fail("not the walk's")) as link,
        watch_when_there(server) as guest,
        watch(server, "rig", "walk") as walker,
    ):
        link.send_frame(frame(1))
        assert bytes_of(guest) == without_picture(frame(1))
        guest.send('{"type":"ack","frame_id":1}')
        assert ask(walker, "share", True)["ok"]
        assert text_of(guest, "state")["session"]["sharing"] is True
        assert bytes_of(guest) == frame(1)
        assert ask(walker, "share", False)["ok"]
        assert bytes_of(guest) == without_picture(frame(1))
        assert ask(walker, "share", "perhaps")["ok"] is False


def watch_when_there(server: WebServer) -> Connection:
    """Watch as a viewer, once the rig has come."""
    sessions = server.app.state.sessions
    until(lambda: any(session.connected for session in sessions))
    return watch(server, "viewer")


@pytest.mark.parametrize("role", ["viewer", "operator", "admin"])
def test_nobody_shares_the_picture_but_the_walker(server: WebServer, role: Any) -> None:
    with rig(server) as pushing, watch(server, role) as asking:
        reply = ask(asking, "share", True)
        assert (reply["ok"], bool(reply["error"])) == (False, True)
        pushing.send(frame(1))
        assert bytes_of(asking) == without_picture(frame(1))


def test_sharing_ends_when_the_rig_leaves_or_another_takes_the_session(server: WebServer) -> None:
    shared = json.dumps({"type": "state", "session": {"sharing": True}})
    with rig(server) as first, watch(server, "viewer") as guest:
        first.send(shared)
        first.send(frame(1))
        assert bytes_of(guest) == frame(1)
        guest.send('{"type":"ack","frame_id":1}')
        with rig(server) as second:
            assert bytes_of(guest) == without_picture(frame(1))
            guest.send('{"type":"ack","frame_id":1}')
            second.send(shared)
            assert bytes_of(guest) == frame(1)
            guest.send('{"type":"ack","frame_id":1}')
            second.close()
            assert bytes_of(guest) == without_picture(frame(1))
            with watch(server, "viewer") as late:
                assert text_of(late, "hello")["session"]["sharing"] is False
                assert bytes_of(late) == without_picture(frame(1))


@pytest.mark.parametrize(("role", "ok"), [("viewer", False), ("rig", False), ("operator", True), ("admin", True)])
@pytest.mark.parametrize(("action", "value"), [("settings", "precise.lag_s=1.0"), ("figures", None)])
def test_only_operators_look_into_the_tracker(server: WebServer, role: Any, ok: bool, action: str, value: Any) -> None:
    with RigLink(
        server.rig_url("walk"), token("rig", "walk"), lambda asked: ControlReply(asked.request_id, True)
    ) as link:
        until(lambda: link.connected)
        with watch(server, role, "walk" if role == "rig" else None) as asking:
            assert ask(asking, action, value)["ok"] is ok
            link.send_text(encode(Figures(anew=True, updates=[], rejected={})))
            link.send_state({"notice": "after"})
            told: list[dict[str, Any]] = [{"type": "nothing"}]
            while told[-1]["type"] != "state" or told[-1]["session"]["notice"] != "after":
                told.append(json.loads(asking.recv(HELD_S)))
            assert any(message["type"] == "figures" for message in told) is (ok and action == "figures")
