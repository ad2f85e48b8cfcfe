"""The whole server over loopback: pages, both sockets, hostile input, and that it leaves nothing behind."""

import json
import socket
import threading
from collections.abc import Iterator
from pathlib import Path
from time import monotonic, sleep

import httpx
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from websockets.exceptions import ConnectionClosed, InvalidStatus

from server.access import Access
from server.app import create_app
from server.errors import AddressUnavailable, PortInUse
from server.session import REPLACED
from server.web_server import WebServer
from server.wire import decode_frame, encode_frame, encode_pose
from tests.server.serving import HELD_S, bytes_of, rig, serving, text_of, token, until, until_closed, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame, example_pose


def frame(frame_id: int, jpeg: bytes = TINY_JPEG) -> bytes:
    return encode_frame(example_frame(frame_id), jpeg)


def get(server: WebServer, path: str, **headers: str) -> httpx.Response:
    return httpx.get(server.url.rstrip("/") + path, headers=headers, trust_env=False)


@pytest.fixture
def server(tmp_path: Path) -> Iterator[WebServer]:
    with serving(tmp_path) as running:
        yield running


@pytest.fixture(scope="module")
def long_lived(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebServer]:
    with serving(tmp_path_factory.mktemp("server")) as running:
        yield running


@pytest.mark.parametrize(
    ("path", "status", "has"),
    [
        ("/", 200, "index"),
        ("/ar", 200, "<title>ar"),
        ("/replay/walk-1", 200, "<title>replay"),
        ("/assets/ar.js", 200, "0"),
        ("/models/today.glb", 200, "glTF"),
        ("/models/none.glb", 404, ""),
        ("/models/..%2Fdist%2Findex.glb", 404, ""),
        ("/%2e%2e/secret", 404, ""),
        ("/api/site", 200, "Square"),
        ("/api/version", 200, '"wire":1'),
        ("/api/sessions", 200, '{"sessions":[]}'),
        ("/health", 503, '"ok":false'),
        ("/ready", 200, '"ok":true'),
        ("/metrics", 200, "agora_sessions 0"),
        ("/metrics", 200, "agora_tasks "),
        ("/console", 404, "console"),
        ("/docs", 404, ""),
        ("/openapi.json", 200, "Agora"),
    ],
)
def test_pages(long_lived: WebServer, path: str, status: int, has: str) -> None:
    response = get(long_lived, path)
    assert (response.status_code, has in response.text) == (status, True)
    assert response.headers["content-security-policy"].startswith("default-src 'self'")
    assert response.headers["x-content-type-options"] == "nosniff"
    assert "strict-transport-security" not in response.headers


def test_another_hosts_name_is_refused(long_lived: WebServer) -> None:
    assert get(long_lived, "/", Host="evil.example").status_code == 403
    assert get(long_lived, "/", Host="[").status_code == 403
    assert get(long_lived, "/", Host="localhost:1").status_code == 200


def test_another_sites_page_may_not_connect(server: WebServer) -> None:
    with rig(server), pytest.raises(InvalidStatus, match="403"):
        viewer(server, origin="http://evil.example")
    with viewer(server, origin=server.url.rstrip("/")) as welcome:
        assert text_of(welcome, "hello")["version"] == 1


def test_a_late_joiner_gets_state_and_newest_frame_at_once(server: WebServer) -> None:
    with rig(server) as pushing:
        pushing.send(json.dumps({"type": "state", "session": {"kind": "replay", "log": "a.mcap", "duration_s": 9}}))
        playback = {"playing": True, "position_s": 1.0, "speed": 1.0, "looping": False}
        pushing.send(json.dumps({"type": "state", "playback": playback}))
        pushing.send(frame(1))
        pushing.send(frame(2))
        until(lambda: get(server, "/health").status_code == 200)
        until(lambda: 'frames_total{session="walk"} 2' in get(server, "/metrics").text)
        with viewer(server) as late:
            hello = json.loads(late.recv(HELD_S))
            assert hello["type"] == "hello"
            assert hello["session"]["log"] == "a.mcap"
            assert hello["session"]["playback"] == playback
            assert late.recv(HELD_S) == frame(2)
            pose = encode_pose(example_pose())
            pushing.send(pose)
            assert bytes_of(late) == pose


def test_viewers_are_told_when_the_rig_leaves_and_comes_back(server: WebServer) -> None:
    with rig(server) as first, viewer(server) as watching:
        assert text_of(watching, "hello")["session"]["connected"] is True
        first.close()
        gone = text_of(watching, "state")["session"]
        assert gone["connected"] is False
        assert "left" in gone["notice"]
        with rig(server):
            assert text_of(watching, "state")["session"]["connected"] is True


def test_a_second_rig_takes_the_session(server: WebServer) -> None:
    with rig(server) as first, rig(server) as second:
        with pytest.raises(ConnectionClosed):
            first.recv(HELD_S)
        assert first.close_code == REPLACED
        with viewer(server) as watching:
            second.send(frame(5))
            assert bytes_of(watching) == frame(5)


def test_controls_reach_the_rig_and_replies_their_own_viewer(server: WebServer) -> None:
    with rig(server) as pushing, viewer(server) as a, viewer(server) as b:
        for asking, action in ((a, "play"), (b, "pause")):
            asking.send(json.dumps({"type": "control", "request_id": "1", "action": action, "value": None}))
        requests = [json.loads(pushing.recv(HELD_S)) for _ in range(2)]
        for request in reversed(requests):
            ok = request["action"] == "play"
            pushing.send(json.dumps({"type": "reply", "request_id": request["request_id"], "ok": ok}))
        assert text_of(a, "reply") == {
            "type": "reply",
            "request_id": "1",
            "ok": True,
            "error": None,
            "did_seek": False,
        }
        assert text_of(b, "reply")["ok"] is False


def test_a_request_without_an_answer_fails_when_the_rig_leaves(server: WebServer) -> None:
    with rig(server) as pushing, viewer(server) as asking:
        asking.send(json.dumps({"type": "control", "request_id": "x", "action": "seek", "value": 3}))
        assert json.loads(pushing.recv(HELD_S))["value"] == 3
        pushing.close()
        assert "left" in text_of(asking, "reply")["error"]
        asking.send(json.dumps({"type": "control", "request_id": "y", "action": "play"}))
        assert text_of(asking, "reply")["request_id"] == "y"


def test_a_stalled_viewer_delays_nobody(server: WebServer) -> None:
    large = TINY_JPEG + bytes(1_000_000)
    with rig(server) as pushing, viewer(server, max_queue=1), viewer(server, max_size=None) as quick:
        assert text_of(quick, "hello")
        for i in range(20):
            t_begin = monotonic()
            pushing.send(frame(i, large))
            assert decode_frame(bytes_of(quick))[0].frame_id == i
            quick.send(json.dumps({"type": "ack", "frame_id": i}))
            assert monotonic() - t_begin < 2.0
        assert 'agora_viewers{session="walk"} 2' in get(server, "/metrics").text


def test_a_viewer_that_reads_nothing_loses_its_place_when_the_walk_ends(server: WebServer) -> None:
    """It cannot hear the farewell, and the rest of what it was sent would wait for it for ever."""
    large = TINY_JPEG + bytes(3_000_000)
    operator = {"Authorization": f"Bearer {token('operator')}"}
    with rig(server) as pushing, viewer(server, max_queue=1):
        for i in range(6):
            pushing.send(frame(i, large))
        until(lambda: 'frames_total{session="walk"} 6' in get(server, "/metrics").text)
        assert httpx.delete(f"{server.url}api/sessions/walk", headers=operator, trust_env=False).status_code == 204
        until(lambda: not server.app.state.visitors.sockets._open)


@pytest.mark.parametrize(
    "message", ["", "[]", "{", '{"type":"ack"}', '{"type":"ack","frame_id":-1}', "9" * 5000, b"AGF1"]
)
def test_a_viewers_malformed_message_closes_it_alone(long_lived: WebServer, message: str | bytes) -> None:
    with rig(long_lived) as pushing, viewer(long_lived) as good, viewer(long_lived) as bad:
        bad.send(message)
        until_closed(bad)
        assert bad.close_code == 1007
        assert bad.close_reason
        pushing.send(frame(3))
        assert bytes_of(good) == frame(3)


@pytest.mark.parametrize(
    "message", ["{}", b"", b"AGF1", frame(1)[:-3], '{"type":"state","duration_s":"long"}', "[" * 60000]
)
def test_a_rigs_malformed_message_closes_it_alone(long_lived: WebServer, message: str | bytes) -> None:
    with rig(long_lived, "bad") as bad, rig(long_lived, "good") as pushing, viewer(long_lived, "good") as good:
        bad.send(message)
        with pytest.raises(ConnectionClosed):
            bad.recv(HELD_S)
        assert bad.close_code == 1007
        pushing.send(frame(4))
        assert bytes_of(good) == frame(4)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(message=st.one_of(st.binary(max_size=500), st.text(max_size=200)))
def test_fuzz_leaves_the_server_alive(long_lived: WebServer, message: str | bytes) -> None:
    with rig(long_lived, "fuzz") as pushing, viewer(long_lived, "fuzz") as watching:
        pushing.send(message)
        watching.send(message)
        for connection in (pushing, watching):
            until_closed(connection)
    assert get(long_lived, "/api/version").status_code == 200


def test_unknown_sessions_and_names_are_refused(long_lived: WebServer) -> None:
    with viewer(long_lived, "nobody") as lost, pytest.raises(ConnectionClosed):
        lost.recv(HELD_S)
    assert lost.close_code == 4404
    with pytest.raises(InvalidStatus, match="403"):
        rig(long_lived, "a%20b", token("rig", "a"))


def test_a_port_in_use_is_one_sentence(long_lived: WebServer, tmp_path: Path) -> None:
    app = create_app(web_folder=tmp_path, models_folder=tmp_path, site={}, access=Access.for_loopback())
    with pytest.raises(PortInUse, match=rf"^Port {long_lived.port} .* is taken .*--port\.$"):
        WebServer(app, port=long_lived.port)
    with pytest.raises(AddressUnavailable, match=r"203\.0\.113\.1"):
        WebServer(app, host="203.0.113.1")
    with pytest.raises(AddressUnavailable, match="99999"):
        WebServer(app, port=99999)


def test_pages_that_are_not_built_say_so(tmp_path: Path) -> None:
    app = create_app(web_folder=tmp_path / "no", models_folder=tmp_path / "no", site={}, access=Access.for_loopback())
    with WebServer(app) as server:
        assert get(server, "/ar").status_code == 503
        assert "make setup" in get(server, "/").text
        assert get(server, "/models/today.glb").status_code == 404
        assert get(server, "/favicon.ico").status_code == 404
        assert get(server, "/ready").status_code == 503


def test_no_thread_and_no_port_is_left(tmp_path: Path) -> None:
    before = set(threading.enumerate())
    with serving(tmp_path) as server:
        port = server.port
        with rig(server) as pushing, viewer(server) as watching:
            pushing.send(frame(1))
            assert bytes_of(watching) == frame(1)
            t_begin = monotonic()
            server.close()
            assert monotonic() - t_begin < 4.0
    until(lambda: set(threading.enumerate()) <= before)
    sleep(0.01)
    with socket.create_server(("127.0.0.1", port)):
        pass


def test_a_stalled_viewer_does_not_hold_up_the_stop(tmp_path: Path) -> None:
    large = TINY_JPEG + bytes(3_000_000)
    with serving(tmp_path) as server, rig(server) as pushing, viewer(server, max_queue=1):
        for i in range(10):
            pushing.send(frame(i, large))
        until(lambda: 'frames_total{session="walk"} 10' in get(server, "/metrics").text)
        t_begin = monotonic()
        server.close()
        assert monotonic() - t_begin < 5.0
