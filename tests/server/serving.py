"""A real server on loopback, and real clients, for the tests of this folder."""

import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.sync.connection import Connection

from server.access import Access
from server.app import create_app
from server.grants import LOCAL
from server.showing import Showing
from server.tls import Tls
from server.tokens import Issued
from server.web_server import WebServer

ACCESS = Access.with_secret(bytes(32), LOCAL)
HELD_S = 60.0  # what is awaited takes milliseconds; a machine full of other work takes its time


@contextmanager
def serving(folder: Path, tls: Tls | None = None, **options: Any) -> Iterator[WebServer]:
    """Run a server with small pages and a model in `folder`."""
    web, models = folder / "dist", folder / "models"
    (web / "assets").mkdir(parents=True, exist_ok=True)
    models.mkdir(exist_ok=True)
    (web / "index.html").write_text("<title>index</title>")
    (web / "ar.html").write_text("<title>ar</title>")
    (web / "replay.html").write_text("<title>replay</title>")
    (web / "assets" / "ar.js").write_text("0")
    (models / "today.glb").write_bytes(b"glTF")
    app = create_app(web_folder=web, models_folder=models, site={"name": "Square"}, **{"access": ACCESS, **options})
    with WebServer(app, tls=tls) as server:
        yield server


def token(role: Issued, session: str | None = None, *, for_s: float = 3600.0) -> str:
    """Return a token of the servers of these tests."""
    return ACCESS.signer.issue(role, int(ACCESS.signer.now_s() + for_s), session)


def rig(server: WebServer, session: str = "walk", shown: str | None = None) -> Connection:
    """Connect as a rig, with the session's token or what else is shown."""
    bearer = {"Authorization": f"Bearer {token('rig', session) if shown is None else shown}"}
    return connect(server.rig_url(session), additional_headers=bearer, compression=None, proxy=None)


def viewer(server: WebServer | Showing, session: str = "walk", **options: Any) -> Connection:
    """Connect as a viewer."""
    url = server.url.replace("http", "ws", 1) + f"ws/view/{session}"
    return connect(url, compression=None, proxy=None, close_timeout=0.5, **options)


def text_of(connection: Connection, kind: str) -> dict[str, Any]:
    """Return the next text message of a type; others are skipped."""
    deadline = monotonic() + HELD_S
    while monotonic() < deadline:
        message = connection.recv(HELD_S)
        if isinstance(message, str) and (parsed := json.loads(message))["type"] == kind:
            return dict(parsed)
    raise TimeoutError(kind)


def bytes_of(connection: Connection) -> bytes:
    """Return the next binary message; text is skipped."""
    while True:
        message = connection.recv(HELD_S)
        if isinstance(message, bytes):
            return message


def until(condition: Any) -> None:
    """Wait for a condition; fail after a minute."""
    deadline = monotonic() + HELD_S
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.01)


def until_closed(connection: Connection) -> None:
    """Read until the peer closes; fail where it stays silent for a minute."""
    with suppress(ConnectionClosed):
        while True:
            connection.recv(HELD_S)
