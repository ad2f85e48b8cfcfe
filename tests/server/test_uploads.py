"""Walks uploaded, listed, downloaded and deleted; what is no walk, too large or not allowed is refused with its status."""

import json
import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import httpx
import pytest

from server.access import Access
from server.log_store import LogStore
from server.web_server import WebServer
from server.wire import encode_frame
from tests.server.serving import ACCESS, bytes_of, rig, serving, token, viewer
from tests.server.uploads import bomb, with_chunk
from tests.server.wire_examples import TINY_JPEG, example_frame
from tests.walks import write_walk

MAX_BYTES = 10**6


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return write_walk(tmp_path_factory.mktemp("logs") / "walk.mcap", 3.0).read_bytes()


@pytest.fixture
def store(tmp_path: Path) -> LogStore:
    return LogStore(tmp_path / "data", max_bytes=MAX_BYTES, max_total_bytes=10**7, keep_days=0.0, now_s=lambda: 0.0)


@pytest.fixture
def server(tmp_path: Path, store: LogStore) -> Iterator[WebServer]:
    with serving(tmp_path, store=store) as running:
        yield running


def ask(server: WebServer, method: str, path: str, **options: object) -> httpx.Response:
    with httpx.Client(trust_env=False, timeout=30.0) as client:
        return client.request(method, server.url.rstrip("/") + path, **options)  # type: ignore[arg-type]


def test_a_walk_comes_back_as_it_was_sent_until_it_is_deleted(server: WebServer, walk: bytes, tmp_path: Path) -> None:
    sent = ask(server, "PUT", "/api/logs/a", content=walk)
    assert sent.status_code == 201
    assert (sent.json()["name"], sent.json()["bytes"], sent.json()["counts"]["gps"]) == ("a", len(walk), 3)
    assert list((tmp_path / "data" / "quarantine").iterdir()) == []
    assert ask(server, "GET", "/api/logs").json() == {"logs": [{"name": "a", "bytes": len(walk)}]}
    assert ask(server, "GET", "/api/logs/a").content == walk
    assert ask(server, "PUT", "/api/logs/a", content=walk).status_code == 409
    assert ask(server, "DELETE", "/api/logs/a").status_code == 204
    assert ask(server, "GET", "/api/logs/a").status_code == 404
    assert ask(server, "DELETE", "/api/logs/a").status_code == 404


def test_ten_gigabytes_are_refused_before_they_are_sent(server: WebServer) -> None:
    with socket.create_connection(("127.0.0.1", server.port), 10.0) as peer:
        head = f"PUT /api/logs/a HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nContent-Length: {10 * 10**9}\r\n\r\n"
        peer.sendall(head.encode())
        answer = peer.makefile("rb").read().decode()  # the server ends the connection itself
    assert answer.startswith("HTTP/1.1 413 ")
    assert "10000000000" in answer


def test_a_body_that_does_not_say_how_long_it_is_is_cut_at_the_limit(
    server: WebServer, walk: bytes, tmp_path: Path
) -> None:
    def endless() -> Iterator[bytes]:
        yield walk
        for _ in range(100):
            yield bytes(64 * 1024)

    with suppress(httpx.WriteError):  # the server hangs up while we are still sending
        assert ask(server, "PUT", "/api/logs/a", content=endless()).status_code == 413
    assert ask(server, "GET", "/api/logs").json() == {"logs": []}
    assert list((tmp_path / "data" / "quarantine").iterdir()) == []


def test_what_is_no_walk_is_refused_and_leaves_nothing(server: WebServer, tmp_path: Path) -> None:
    data = bomb(50 * 10**9)[: MAX_BYTES - 10**5]  # what fits inflates to 29 GB
    bombed = with_chunk(tmp_path / "b", data, 50 * 10**9).read_bytes()
    lying = with_chunk(tmp_path / "l", data, 10**6).read_bytes()
    empty = with_chunk(tmp_path / "e", b"", 0, "").read_bytes()
    for body, status in ((b"GIF89a", 415), (b"", 415), (bombed, 413), (lying, 422), (empty, 422), (bombed[:8], 422)):
        refused = ask(server, "PUT", "/api/logs/bad", content=body)
        assert (refused.status_code, bool(refused.json()["detail"])) == (status, True)
        assert str(tmp_path) not in refused.text
    assert ask(server, "GET", "/api/logs").json() == {"logs": []}
    assert list((tmp_path / "data" / "quarantine").iterdir()) == []


@pytest.mark.parametrize("name", ["..%2f..%2fetc%2fpasswd", "%2e%2e", ".hidden", "a%00b", "a" * 65, "a%20b", "..%5cb"])
def test_a_name_that_is_a_path_is_refused(server: WebServer, walk: bytes, name: str, tmp_path: Path) -> None:
    before = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    for method in ("PUT", "GET", "DELETE"):
        answered = ask(server, method, f"/api/logs/{name}", content=walk if method == "PUT" else None)
        assert answered.status_code in (404, 405, 422)
    assert sorted(path for path in tmp_path.rglob("*") if path.is_file()) == before


def test_a_sender_that_leaves_in_the_middle_leaves_nothing_and_disturbs_nobody(
    server: WebServer, walk: bytes, tmp_path: Path
) -> None:
    with (
        rig(server) as pushing,
        viewer(server) as watching,
        socket.create_connection(("127.0.0.1", server.port), 10.0) as peer,
    ):
        head = f"PUT /api/logs/a HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nContent-Length: {len(walk)}\r\n\r\n"
        peer.sendall(head.encode() + walk[:9000])
        pushing.send(encode_frame(example_frame(1), TINY_JPEG))
        assert decode_id(bytes_of(watching)) == 1
    assert ask(server, "PUT", "/api/logs/b", content=walk).status_code == 201
    assert list((tmp_path / "data" / "quarantine").iterdir()) == []
    assert [log["name"] for log in ask(server, "GET", "/api/logs").json()["logs"]] == ["b"]


def decode_id(message: bytes) -> int:
    return int.from_bytes(message[8:12], "little")


def test_only_an_operator_comes_near_the_walks(tmp_path: Path, store: LogStore, walk: bytes) -> None:
    with serving(tmp_path, store=store, access=Access(ACCESS.signer, ACCESS.codes)) as server:
        shown = {
            role: {"Authorization": f"Bearer {token(role, 'a' if role == 'rig' else None)}"}
            for role in ("viewer", "rig", "operator")
        }
        assert ask(server, "PUT", "/api/logs/a", content=walk, headers=shown["operator"]).status_code == 201
        for headers, status in (({}, 401), (shown["viewer"], 403), (shown["rig"], 403)):
            for method, path in (
                ("GET", "/api/logs"),
                ("GET", "/api/logs/a"),
                ("DELETE", "/api/logs/a"),
                ("PUT", "/api/logs/b"),
                ("POST", "/api/sessions"),
                ("DELETE", "/api/sessions/a"),
                ("PATCH", "/api/sessions/a"),
            ):
                body = json.dumps({"log": "a"}) if method in ("POST", "PATCH") else None
                assert ask(server, method, path, headers=headers, content=body).status_code == status
        assert ask(server, "GET", "/api/logs/a", headers=shown["operator"]).content == walk


def test_a_server_without_walks_is_well_until_it_stops(server: WebServer) -> None:
    assert ask(server, "GET", "/health").json() == {"ok": True, "sessions": []}
    assert ask(server, "GET", "/ready").json() == {"ok": True, "reason": None}
    server.app.state.sessions.stopping = True
    assert ask(server, "GET", "/ready").status_code == 503
