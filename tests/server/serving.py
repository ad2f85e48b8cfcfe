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

from server.app import create_app
from server.showing import Showing
from server.web_server import WebServer

TOKEN = "the-rig's-token"
HELD_S = 5.0


@contextmanager
def serving(folder: Path, **options: Any) -> Iterator[WebServer]:
    """Run a server with small pages and a model in `folder`."""
    web, models = folder / "dist", folder / "models"
    (web / "assets").mkdir(parents=True, exist_ok=True)
    models.mkdir(exist_ok=True)
    (web / "index.html").write_text("<title>index</title>")
    (web / "ar.html").write_text("<title>ar</title>")
    (web / "assets" / "ar.js").write_text("0")
    (models / "today.glb").write_bytes(b"glTF")
    app = create_app(web_folder=web, models_folder=models, site={"name": "Square"}, rig_tokens=[TOKEN], **options)
    with WebServer(app) as server:
        yield server


def rig(server: WebServer, session: str = "walk", token: str = TOKEN) -> Connection:
    """Connect as a rig."""
    return connect(
        server.rig_url(session), additional_headers={"Authorization": f"Bearer {token}"}, compression=None, proxy=None
    )


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
    """Wait for a condition; fail after five seconds."""
    deadline = monotonic() + HELD_S
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.01)


def until_closed(connection: Connection) -> None:
    """Read until the peer closes; fail where it stays silent for five seconds."""
    with suppress(ConnectionClosed):
        while True:
            connection.recv(HELD_S)
