"""The console behind its server: who is let in, that viser answers there and nowhere else, and that it ends with its server."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

import httpx
import numpy as np
import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.sync.connection import Connection
from websockets.typing import Subprotocol

from server.access import Access
from server.console.hosting import ConsoleHost, Link
from server.options import SITE
from server.web_server import WebServer
from server.wire import encode_frame
from tests.server.serving import ACCESS, rig, serving, token, until
from tests.server.wire_examples import example_frame
from tracker.pictures import encode_jpeg

VISER = Subprotocol(f"viser-v{viser.__version__}")
PATIENCE_S = 60.0
"""The process imports all of viser and of the tracker, on a machine that may be busy."""
STRICT = Access.with_secret(bytes(32))
"""Lets nobody in without a token, and takes those of `tests.server.serving`."""


@contextmanager
def with_console(folder: Path, access: Access = ACCESS) -> Iterator[tuple[WebServer, ConsoleHost]]:
    """Run a server with a console."""
    host = ConsoleHost(SITE, lambda: Link(running[0].url, token("operator")))
    running: list[WebServer] = []
    with serving(folder, console=host, access=access) as server:
        running.append(server)
        yield server, host


def open_console(server: WebServer, **headers: str) -> Connection:
    """Connect as viser's page does."""
    url = server.url.replace("http", "ws", 1) + "console"
    return connect(
        url, subprotocols=[VISER], additional_headers=headers, compression=None, proxy=None, max_size=None,
        open_timeout=PATIENCE_S,
    )  # fmt: skip


def until_it_tells(console: Connection, *names: bytes) -> None:
    """Read what viser sends until it has named all of some nodes."""
    deadline, left = monotonic() + PATIENCE_S, set(names)
    while left:
        assert monotonic() < deadline, f"viser never told of {left}"
        message = console.recv(PATIENCE_S, decode=False)
        left -= {name for name in left if name in unpacked(message)}


def unpacked(message: bytes) -> bytes:
    """Return a message of viser's as it was before it was compressed."""
    import zstandard

    start = message.find(b"\x28\xb5\x2f\xfd")
    return (
        message
        if start < 0
        else message[:start] + zstandard.ZstdDecompressor().decompressobj().decompress(message[start:])
    )


def test_walks_appear_in_the_console_and_it_ends_with_its_server(tmp_path: Path) -> None:
    picture = encode_jpeg(np.full((48, 64, 3), 99, np.uint8))
    with with_console(tmp_path) as (server, host), rig(server) as walker:
        walker.send('{"type":"state","session":{"kind":"live","estimator":"gps-imu/famm"}}')
        walker.send(encode_frame(example_frame(), picture))
        with open_console(server) as console:
            assert console.subprotocol == VISER
            until_it_tells(console, b"/walks/walk/ellipsoid", b"/walks/walk/camera", b"/site/buildings/marble-attested")
            running = host._console
            assert running is not None
            assert running.process.poll() is None
            with pytest.raises(InvalidStatus, match="403"):  # beside the server, without its secret
                connect(f"ws://127.0.0.1:{running.port}/", subprotocols=[VISER], proxy=None)
            assert httpx.get(f"http://127.0.0.1:{running.port}/", trust_env=False).status_code == 403
    until(lambda: running.process.poll() is not None)


@pytest.mark.parametrize(
    ("shown", "status"), [(None, 401), (token("viewer"), 403), (token("rig", "walk"), 403), (token("operator", "walk"), 403)]
)  # fmt: skip
def test_nobody_but_operators_is_let_in_and_nothing_is_started_for_others(
    tmp_path: Path, shown: str | None, status: int
) -> None:
    headers = {} if shown is None else {"Authorization": f"Bearer {shown}"}
    with with_console(tmp_path, STRICT) as (server, host):
        assert httpx.get(f"{server.url}console", headers=headers, trust_env=False).status_code == status
        with pytest.raises(InvalidStatus, match="403"):
            open_console(server, **headers)
        assert host._console is None


def test_the_page_is_visers_and_reaches_nobody_else(tmp_path: Path) -> None:
    async def start() -> tuple[str, str]:
        return "ws://127.0.0.1:9/", "secret"

    with with_console(tmp_path) as (server, host):
        host.open = start  # type: ignore[method-assign]
        answer = httpx.get(f"{server.url}console", trust_env=False)
    assert (answer.status_code, "Viser client" in answer.text) == (200, True)
    policy = answer.headers["content-security-policy"]
    assert policy.startswith("default-src 'none'")
    assert "http" not in policy
    assert "'unsafe-eval'" not in policy
    assert "frame-ancestors 'none'" in policy


def test_a_console_that_nobody_looks_at_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s, ended = [0.0], []
    monkeypatch.setattr("server.console.hosting.monotonic", lambda: now_s[0])
    monkeypatch.setattr(ConsoleHost, "close", lambda self: ended.append(now_s[0]))

    async def look() -> None:
        host = ConsoleHost(SITE, lambda: Link("http://127.0.0.1:1/"))
        host._console = object()  # type: ignore[assignment]
        host.enter()
        now_s[0] = 10_000.0
        host.look_after()
        host.leave()
        now_s[0] += 299.0
        host.look_after()
        assert ended == []
        now_s[0] += 2.0
        host.look_after()

    asyncio.run(look())
    assert ended == [10_301.0]
