"""The console's connection to its server: every walk there is watched, as any viewer would. For one event loop."""

import asyncio
import json
import logging
import ssl
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final
from urllib.request import HTTPSHandler, ProxyHandler, Request, build_opener

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException
from websockets.typing import Subprotocol

from server.console.walk import Walk
from server.errors import MalformedMessage
from server.messages import Ack, ControlReply, ControlRequest, encode
from server.push import pinned
from server.wire import MAX_FRAME_BYTES, SUBPROTOCOL

_logger = logging.getLogger(__name__)

_LIST_EVERY_S: Final = 2.0
_LIST_S: Final = 5.0
_LARGEST_LIST: Final = 4_000_000
#: A replay that is to be worked out anew takes its time.
_ANSWER_S: Final = 60.0


@dataclass
class _Watched:
    walk: Walk
    task: "asyncio.Task[None] | None" = None
    connection: ClientConnection | None = None
    asked: dict[str, "asyncio.Future[ControlReply]"] = field(default_factory=dict)


class Watcher:
    """All walks of one server."""

    def __init__(self, url: str, token: str | None, trust: str | None) -> None:
        """Nothing is asked yet.

        Args:
            url: Of the server's pages, ending in a slash.
            token: An operator's; None where everybody may look.
            trust: The certificate, PEM, that the server must show.
        """
        self._url = url
        self._headers = {} if token is None else {"Authorization": f"Bearer {token}"}
        self._ssl: ssl.SSLContext | None = None if trust is None else pinned(trust)
        self._watched: dict[str, _Watched] = {}
        self._requests = 0

    @property
    def walks(self) -> list[Walk]:
        """All that there are now."""
        return [watched.walk for watched in self._watched.values()]

    def get(self, name: str) -> Walk | None:
        """Return a walk, if there is one of that name."""
        watched = self._watched.get(name)
        return None if watched is None else watched.walk

    async def run(self) -> None:
        """Watch until cancelled."""
        try:
            while True:
                names = await asyncio.to_thread(self._names)
                if names is not None:
                    self._follow(names)
                await asyncio.sleep(_LIST_EVERY_S)
        finally:
            self._follow([])

    def _follow(self, names: list[str]) -> None:
        for name in [name for name in self._watched if name not in names]:
            gone = self._watched.pop(name)
            if gone.task is not None:
                gone.task.cancel()
        for name in names:
            watched = self._watched.setdefault(name, _Watched(Walk(name)))
            if watched.task is None or watched.task.done():
                watched.task = asyncio.create_task(self._watch(watched))

    async def ask(self, name: str, action: str, value: object = None) -> ControlReply:
        """Ask a walk's rig for something and return what it answers; a reply of our own where it does not."""
        watched = self._watched.get(name)
        if watched is None or watched.connection is None:
            return ControlReply("", ok=False, error="This walk is not there any more.")
        self._requests += 1
        key = str(self._requests)
        future = watched.asked[key] = asyncio.get_running_loop().create_future()
        try:
            await watched.connection.send(encode(ControlRequest(key, action, value)))  # type: ignore[arg-type]
            return await asyncio.wait_for(future, _ANSWER_S)
        except (WebSocketException, TimeoutError):
            return ControlReply(key, ok=False, error="The walk does not answer: try again.")
        finally:
            del watched.asked[key]

    async def acknowledge(self, walk: Walk) -> None:
        """Tell the server that the frames that came are done with, so that it sends new ones: this is what sets their pace."""
        watched = self._watched.get(walk.name)
        if not walk.unacknowledged or watched is None or watched.connection is None:
            return
        newest, walk.unacknowledged = walk.unacknowledged[-1], []
        with suppress(WebSocketException):
            await watched.connection.send(encode(Ack(newest)))

    async def _watch(self, watched: _Watched) -> None:
        walk = watched.walk
        url = f"{self._url.replace('http', 'ws', 1)}ws/view/{walk.name}"
        try:
            async with connect(
                url,
                additional_headers=self._headers,
                subprotocols=[Subprotocol(SUBPROTOCOL)],
                compression=None,
                proxy=None,
                max_size=MAX_FRAME_BYTES,
                ssl=self._ssl,
            ) as connection:
                watched.connection = connection
                walk.unacknowledged = []
                await connection.send(encode(ControlRequest("figures", "figures")))
                async for message in connection:
                    self._take(watched, message)
        except (OSError, WebSocketException, MalformedMessage) as exc:
            _logger.info("the console lost a walk", extra={"session": walk.name, "why": str(exc)})
        finally:
            watched.connection = None

    def _take(self, watched: _Watched, message: str | bytes) -> None:
        if isinstance(message, bytes):
            watched.walk.take_frame(message)
            return
        reply = watched.walk.take_text(message)
        if reply is not None and (future := watched.asked.get(reply.request_id)) is not None and not future.done():
            future.set_result(reply)

    def _names(self) -> list[str] | None:
        """Return the names of all walks; None where the server does not answer."""
        opener = build_opener(ProxyHandler({}), HTTPSHandler(context=self._ssl))
        try:
            with opener.open(Request(f"{self._url}api/sessions", headers=self._headers), timeout=_LIST_S) as answer:
                return [str(session["name"]) for session in json.loads(answer.read(_LARGEST_LIST))["sessions"]]
        except (OSError, ValueError, KeyError, TypeError):
            return None
