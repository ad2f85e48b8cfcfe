"""Who is turned away, with which status, while the rest of the service goes on: each attack beside a walk that is being watched."""

import json
import logging
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect
from websockets.sync.connection import Connection

from server.access import Access
from server.limits import Limits
from server.tokens import Signer
from server.web_server import WebServer
from server.wire import MAX_FRAME_BYTES, encode_frame
from tests.server.serving import HELD_S, bytes_of, rig, serving, text_of, token, until, until_closed, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame

STRICT = Limits(requests_per_s=0.001, burst=30, connections=8, header_s=0.3, proxies=frozenset())


def strict_access() -> Access:
    """Return the access of a server that lets nobody in without a token."""
    return Access.with_secret(bytes(32))


def frame(frame_id: int) -> bytes:
    return encode_frame(example_frame(frame_id), TINY_JPEG)


def bearer(shown: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {shown}"}


class Undisturbed:
    """A server with one walk, and somebody who watches it."""

    def __init__(self, server: WebServer, pushing: Connection, watching: Connection) -> None:
        self.server, self._pushing, self._watching = server, pushing, watching
        self._frames = 0

    def check(self) -> None:
        """The walk still reaches its viewer."""
        self._frames += 1
        self._pushing.send(frame(self._frames))
        assert bytes_of(self._watching) == frame(self._frames)
        self._watching.send(json.dumps({"type": "ack", "frame_id": self._frames}))

    def get(self, path: str, **headers: str) -> httpx.Response:
        return httpx.get(self.server.url.rstrip("/") + path, headers=headers, trust_env=False)

    def post(self, path: str, **options: Any) -> httpx.Response:
        return httpx.post(self.server.url.rstrip("/") + path, trust_env=False, **options)


@contextmanager
def walk_on(folder: Path, **options: Any) -> Iterator[Undisturbed]:
    with ExitStack() as stack:
        server = stack.enter_context(serving(folder, **{"access": strict_access(), **options}))
        pushing = stack.enter_context(rig(server))
        # the walker's own view: the rig's token
        watching = stack.enter_context(viewer(server, additional_headers=bearer(token("rig", "walk"))))
        undisturbed = Undisturbed(server, pushing, watching)
        undisturbed.check()
        yield undisturbed
        undisturbed.check()


@pytest.fixture(scope="module")
def held(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Undisturbed]:
    with walk_on(tmp_path_factory.mktemp("server")) as undisturbed:
        yield undisturbed


@pytest.fixture
def walk(held: Undisturbed) -> Iterator[Undisturbed]:
    yield held
    held.check()


FORGED = Signer(bytes([1]) * 32).issue("rig", 4_000_000_000, "walk")
BAD_RIGS = {
    "none": ("walk", "", 401),
    "forged": ("walk", FORGED, 401),
    "expired": ("walk", token("rig", "walk", for_s=-1.0), 401),
    "of another session": ("walk", token("rig", "other"), 403),
    "a viewer's": ("walk", token("viewer", "walk"), 403),
    "an operator's": ("walk", token("operator"), 403),
    "an administrator's": ("walk", token("admin"), 403),
}


@pytest.mark.parametrize(("session", "shown", "status"), BAD_RIGS.values(), ids=BAD_RIGS)
def test_a_rig_is_refused_whose_token_is(walk: Undisturbed, session: str, shown: str, status: int) -> None:
    with pytest.raises(InvalidStatus, match=str(status)):
        rig(walk.server, session, shown)


def test_a_cookie_makes_no_rig(walk: Undisturbed) -> None:
    access: Access = walk.server.app.state.access
    cookie = f"{access.cookie}={token('rig', 'walk')}"
    with pytest.raises(InvalidStatus, match="401"):
        connect(walk.server.rig_url("walk"), additional_headers={"Cookie": cookie}, proxy=None)
    with viewer(walk.server, additional_headers={"Cookie": cookie}) as watching:
        assert text_of(watching, "hello")


BAD_VIEWERS = {
    "nothing": {},
    "forged": bearer(FORGED),
    "expired": bearer(token("viewer", for_s=-1.0)),
    "of another session": bearer(token("viewer", "other")),
    "another rig's": bearer(token("rig", "other")),
    "no bearer": {"Authorization": f"Basic {token('viewer')}"},
}


@pytest.mark.parametrize("shown", BAD_VIEWERS.values(), ids=BAD_VIEWERS)
def test_a_viewer_is_refused_who_shows(walk: Undisturbed, shown: dict[str, str]) -> None:
    with viewer(walk.server, additional_headers=shown) as stranger, pytest.raises(ConnectionClosed):
        stranger.recv(HELD_S)
    assert stranger.close_code == 4403
    assert stranger.close_reason


@pytest.mark.parametrize(
    "path", ["/api/sessions", "/api/logs", "/api/logs/walk", "/api/access", "/metrics", "/console"]
)
@pytest.mark.parametrize("shown", ["", FORGED, token("operator", for_s=-1.0)], ids=["nothing", "forged", "expired"])
def test_who_shows_nothing_valid_gets_401(walk: Undisturbed, path: str, shown: str) -> None:
    response = walk.get(path, **(bearer(shown) if shown else {}))
    assert response.status_code == 401
    assert response.headers["www-authenticate"] == "Bearer"
    assert response.headers["content-security-policy"].startswith("default-src 'self'")


@pytest.mark.parametrize(
    ("role", "session", "path", "status"),
    [
        ("viewer", None, "/api/sessions", 200),
        ("viewer", None, "/api/logs", 403),
        ("viewer", None, "/api/logs/walk", 403),
        ("viewer", None, "/metrics", 403),
        ("viewer", None, "/console", 403),
        ("rig", "walk", "/api/logs", 403),
        ("rig", "walk", "/metrics", 403),
        ("operator", "walk", "/api/logs", 403),
        ("operator", None, "/api/logs", 200),
        ("operator", None, "/metrics", 200),
        ("admin", None, "/api/logs", 200),
    ],
)
def test_a_role_opens_its_own_doors(walk: Undisturbed, role: Any, session: str | None, path: str, status: int) -> None:
    assert walk.get(path, **bearer(token(role, session))).status_code == status


def test_a_token_of_one_session_lists_that_one(walk: Undisturbed) -> None:
    def names(shown: str) -> list[str]:
        return [session["name"] for session in walk.get("/api/sessions", **bearer(shown)).json()["sessions"]]

    assert names(token("viewer", "walk")) == names(token("viewer")) == ["walk"]
    assert names(token("viewer", "other")) == []


def test_health_tells_strangers_no_names(walk: Undisturbed) -> None:
    assert walk.get("/health").json() == {"ok": True}
    assert walk.get("/health", **bearer(token("operator"))).json()["sessions"][0]["name"] == "walk"


def test_a_viewer_cannot_control_a_walk(walk: Undisturbed) -> None:
    with viewer(walk.server, additional_headers=bearer(token("viewer"))) as guest:
        guest.send(json.dumps({"type": "control", "request_id": "1", "action": "pause"}))
        reply = text_of(guest, "reply")
        assert (reply["ok"], "token watches" in reply["error"]) == (False, True)


def test_a_socket_ends_with_its_token(tmp_path: Path) -> None:
    """Those who are in when a token expires are put out, rigs and viewers alike."""
    with ExitStack() as stack:
        server = stack.enter_context(serving(tmp_path, access=strict_access()))
        pushing = stack.enter_context(rig(server, "brief", token("rig", "brief", for_s=2.0)))
        shown = bearer(token("viewer", for_s=2.0))
        watching = stack.enter_context(viewer(server, "brief", additional_headers=shown))
        for connection in (pushing, watching):
            until_closed(connection)
            assert (connection.close_code, "expired" in (connection.close_reason or "")) == (4403, True)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", ""])
def test_a_foreign_origin_is_refused(walk: Undisturbed, origin: str) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        viewer(walk.server, additional_headers=bearer(token("viewer")) | {"Origin": origin})
    assert walk.post("/api/codes", headers=bearer(token("viewer")) | {"Origin": origin}).status_code == 403
    assert walk.post("/enter", headers={"Origin": origin}, data={"token": token("viewer")}).status_code == 403


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "192.0.2.1", "[", ""])
def test_another_name_in_the_host_is_refused(walk: Undisturbed, host: str) -> None:
    assert walk.get("/api/sessions", Host=host, **bearer(token("viewer"))).status_code == 403


def test_an_address_is_a_name_where_the_server_is_on_every_network(tmp_path: Path) -> None:
    with walk_on(tmp_path, any_address=True) as walk:
        assert walk.get("/ready", Host="192.0.2.1:80").status_code == 200
        assert walk.get("/ready", Host="[2001:db8::1]:80").status_code == 200
        assert walk.get("/ready", Host="rebound.example").status_code == 403


@pytest.mark.parametrize(
    "name", ["..%2F..%2Fetc%2Fpasswd", "%2e%2e%2fsecret", "..", "%00", "walk%2F..%2F..", "a" * 3000]
)
def test_no_path_leads_out_of_the_logs(walk: Undisturbed, name: str) -> None:
    response = walk.get(f"/api/logs/{name}", **bearer(token("operator")))
    assert response.status_code == 404
    assert "root:" not in response.text


@pytest.mark.parametrize("message", ["{", "[]", '{"type":"ack","frame_id":"x"}', "9" * 5000, b"AGF1"])
def test_a_bad_message_closes_its_sender_alone(walk: Undisturbed, message: str | bytes) -> None:
    with viewer(walk.server, additional_headers=bearer(token("viewer"))) as bad:
        bad.send(message)
        until_closed(bad)
        assert bad.close_code == 1007


def test_a_message_that_says_it_is_larger_than_any_is_not_waited_for(walk: Undisturbed) -> None:
    with viewer(walk.server, additional_headers=bearer(token("viewer"))) as bad:
        bad.socket.sendall(b"\x82\xff" + (MAX_FRAME_BYTES + 1).to_bytes(8, "big") + bytes(4))
        until_closed(bad)
        assert bad.close_code == 1009


def test_a_viewer_that_talks_without_end_is_closed(walk: Undisturbed) -> None:
    def talk(bad: Connection) -> None:
        for _ in range(10_000):
            bad.send('{"type":"ack","frame_id":1}')
        until_closed(bad)
        raise EOFError

    with viewer(walk.server, additional_headers=bearer(token("viewer"))) as bad:
        with pytest.raises((ConnectionClosed, EOFError)):
            talk(bad)
        assert bad.close_code == 1008


@pytest.mark.parametrize("chunked", [False, True], ids=["declared", "chunked"])
def test_a_large_body_gets_413(walk: Undisturbed, chunked: bool) -> None:
    piece = bytes(1024)
    content = iter([piece] * 65) if chunked else piece * 65
    assert walk.post("/enter", content=content).status_code == 413


def test_slow_heads_get_408(tmp_path: Path) -> None:
    with walk_on(tmp_path, limits=STRICT) as walk:
        for head in (b"", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "):
            with socket.create_connection(("127.0.0.1", walk.server.port), HELD_S) as slow:
                slow.sendall(head)
                assert slow.recv(100).startswith(b"HTTP/1.1 408 ")
                assert slow.recv(100) == b""
            walk.check()


def test_a_second_slow_head_gets_408_too(tmp_path: Path) -> None:
    with ExitStack() as stack:
        walk = stack.enter_context(walk_on(tmp_path, limits=STRICT))
        with socket.create_connection(("127.0.0.1", walk.server.port), HELD_S) as slow:
            slow.sendall(b"HEAD /none HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nGET / HT")
            answers = b""
            while part := slow.recv(1000):
                answers += part
            assert answers.startswith((b"HTTP/1.1 404 ", b"HTTP/1.1 405 "))
            assert b"HTTP/1.1 408 " in answers


def test_more_connections_than_an_address_may_have_get_429(tmp_path: Path) -> None:
    limits = Limits(connections=8, proxies=frozenset())
    with walk_on(tmp_path, limits=limits) as walk, ExitStack() as stack:
        address = ("127.0.0.1", walk.server.port)
        idle = [stack.enter_context(socket.create_connection(address, HELD_S)) for _ in range(6)]  # and two sockets
        with socket.create_connection(address, HELD_S) as refused:
            assert refused.recv(100).startswith(b"HTTP/1.1 429 ")
        walk.check()
        idle[0].close()

        def admitted() -> bool:
            with socket.create_connection(address, HELD_S) as again:
                again.sendall(b"GET /ready HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
                return again.recv(100).startswith(b"HTTP/1.1 200 ")

        until(admitted)


def test_more_requests_than_an_address_may_make_get_429(tmp_path: Path) -> None:
    limits = Limits(requests_per_s=0.001, burst=50)
    with walk_on(tmp_path, limits=limits) as walk:
        with httpx.Client(base_url=walk.server.url, trust_env=False) as client:
            answers = [client.get("/ready") for _ in range(60)]
            assert answers[0].status_code == 200
            assert answers[-1].status_code == 429
            assert answers[-1].headers["retry-after"] == "1"
            assert client.get("/ready", headers={"X-Forwarded-For": "192.0.2.7"}).status_code == 200  # by the proxy
        with pytest.raises(InvalidStatus, match="429"):
            viewer(walk.server)


def test_a_one_time_code_becomes_a_cookie_once_and_is_gone_from_the_address(walk: Undisturbed) -> None:
    made = walk.post("/api/codes", headers=bearer(token("rig", "walk")))
    assert made.status_code == 201
    entered = walk.get(made.json()["path"])
    assert (entered.status_code, entered.headers["location"]) == (303, "/ar?session=walk")
    name, _, rest = entered.headers["set-cookie"].partition("=")
    assert "HttpOnly; SameSite=Strict" in rest
    assert made.json()["code"] not in rest + entered.headers["location"]
    cookie = f"{name}={rest.partition(';')[0]}"
    assert walk.get("/api/access", Cookie=cookie).json()["role"] == "rig"
    again = walk.get(made.json()["path"])
    assert (again.status_code, "set-cookie" in again.headers) == (401, False)
    assert "used already" in again.text


def test_a_token_shown_at_the_entrance_becomes_a_cookie(walk: Undisturbed) -> None:
    with httpx.Client(base_url=walk.server.url, trust_env=False) as browser:
        page = browser.get("/enter")
        assert "form-action 'self'" in page.headers["content-security-policy"]
        assert page.headers["referrer-policy"] == "strict-origin"
        assert browser.post("/enter", data={"token": FORGED}).status_code == 401
        assert browser.post("/enter", data={}).status_code == 401
        assert browser.post("/enter", data={"token": token("viewer")}).headers["location"] == "/"
        assert browser.get("/api/access").json()["role"] == "viewer"
        browser.post("/leave")
        assert browser.get("/api/access").status_code == 401


@pytest.mark.parametrize(
    ("role", "body", "status"),
    [
        ("admin", {"role": "viewer", "hours": 1}, 201),
        ("admin", {"role": "rig"}, 422),
        ("admin", {"role": "local"}, 422),
        ("admin", {"role": "viewer", "session": "../x"}, 422),
        ("operator", {"role": "viewer"}, 403),
        ("viewer", {"role": "admin"}, 403),
    ],
)
def test_only_an_administrator_lets_others_in(walk: Undisturbed, role: Any, body: dict[str, Any], status: int) -> None:
    made = walk.post("/api/codes", headers=bearer(token(role)), json=body)
    assert made.status_code == status
    if status == 201:
        entered = walk.get(made.json()["path"])
        cookie = entered.headers["set-cookie"].partition(";")[0]
        assert walk.get("/api/access", Cookie=cookie).json()["role"] == "viewer"


def test_no_secret_comes_into_the_journal(walk: Undisturbed, caplog: pytest.LogCaptureFixture) -> None:
    secret = token("operator")
    with caplog.at_level(logging.DEBUG):
        walk.get("/api/sessions", **bearer(secret))
        walk.get(f"/enter?code={secret}")
        walk.get(f"/enter?code={secret[:-1]}")
        with viewer(walk.server, f"walk?token={secret}") as stranger:
            until_closed(stranger)
    mine = [record.getMessage() for record in caplog.records if not record.name.startswith(("httpx", "httpcore"))]
    theirs = [line for line in mine if not line.startswith(("> ", "< ", "= "))]  # the test's own client, not the server
    assert not [line for line in theirs if secret[:-1] in line]


def test_both_sides_agree_on_the_version(walk: Undisturbed) -> None:
    shown = bearer(token("viewer"))
    with viewer(walk.server, additional_headers=shown, subprotocols=["agora.v9", "agora.v1"]) as watching:
        assert watching.subprotocol == "agora.v1"
        assert text_of(watching, "hello")["version"] == 1
    with viewer(walk.server, additional_headers=shown, subprotocols=["agora.v9"]) as other:
        with pytest.raises(ConnectionClosed):
            other.recv(HELD_S)
        assert (other.close_code, "agora.v1" in (other.close_reason or "")) == (4406, True)
    newer = bearer(token("rig", "walk"))
    with pytest.raises(InvalidStatus, match="406"):
        connect(walk.server.rig_url("walk"), additional_headers=newer, subprotocols=["agora.v9"], proxy=None)  # type: ignore[list-item]
