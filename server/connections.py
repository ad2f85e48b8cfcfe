"""uvicorn's two protocols with a door before them: how many connections an address has, and how long a request's head may take.

A request whose head never ends (slow loris) would else hold its connection for ever: uvicorn times only the pause between requests.

A WebSocket's route finds a line of its own in its scope, see `line.py`.
"""

import asyncio
from typing import Any, ClassVar, cast

from starlette.types import Scope
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from server.limits import Visitors
from server.line import SocketLine, offer_line

_TOO_MANY = b"HTTP/1.1 429 Too Many Requests\r\nRetry-After: 1\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"
_TOO_SLOW = b"HTTP/1.1 408 Request Timeout\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"


class _Http(H11Protocol):
    visitors: ClassVar[Visitors]
    _peer: str | None = None
    """Who has a place at the door for this connection; None once it was handed over."""
    _head: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Count it, or turn it away."""
        super().connection_made(cast(asyncio.Transport, transport))
        peer = self.client[0] if self.client else ""
        if not self.visitors.admit(peer):
            self.transport.write(_TOO_MANY)
            self.transport.close()
            return
        self._peer = peer
        self._await_head()

    def data_received(self, data: bytes) -> None:
        """Take bytes; the clock stops once they have made a request."""
        if self.transport.is_closing():
            return
        before = self.cycle
        super().data_received(data)
        if self.cycle is not before:
            self._stop_waiting()

    def on_response_complete(self) -> None:
        """Wait for the next request, which may come within the pause that uvicorn allows and then has its own time."""
        before = self.cycle
        super().on_response_complete()
        if self.cycle is before and self._peer is not None and not self.transport.is_closing():
            self._await_head()

    def handle_websocket_upgrade(self, event: Any) -> None:
        """Hand the connection over, with its place at the door."""
        self._stop_waiting()
        peer, self._peer = self._peer, None
        super().handle_websocket_upgrade(event)
        protocol = self.transport.get_protocol()
        if isinstance(protocol, _Socket):
            protocol.peer = peer

    def connection_lost(self, exc: Exception | None) -> None:
        """Give the place back."""
        super().connection_lost(exc)
        self._stop_waiting()
        _leave(self.visitors, self._peer)
        self._peer = None

    def _await_head(self) -> None:
        self._stop_waiting()
        self._head = self.loop.call_later(self.visitors.limits.header_s, self._give_up)

    def _stop_waiting(self) -> None:
        if self._head is not None:
            self._head.cancel()
            self._head = None

    def _give_up(self) -> None:
        if not self.transport.is_closing():
            self.transport.write(_TOO_SLOW)
            self.transport.close()


class _Socket(WebSocketsSansIOProtocol):
    visitors: ClassVar[Visitors]
    peer: str | None = None
    """Whose place at the door it has."""
    line: SocketLine | None = None

    def connection_lost(self, exc: Exception | None) -> None:
        """Give the place back."""
        super().connection_lost(exc)
        _leave(self.visitors, self.peer)
        self.peer = None

    def handle_connect(self, event: Any) -> None:
        """Begin the route, which finds a line in its scope."""
        super().handle_connect(event)
        if not self.close_sent:
            self.line = SocketLine(self)
            offer_line(cast(Scope, self.scope), self.line)

    def resume_writing(self) -> None:
        """Note that all has gone."""
        super().resume_writing()
        if self.line is not None:
            self.line.on_free()

    def keepalive_timeout(self) -> None:
        """Cut off a peer that answers no ping: it would not read a farewell either."""
        super().keepalive_timeout()
        self.transport.abort()


def protocols(visitors: Visitors) -> dict[str, Any]:
    """Return the arguments `http` and `ws` for uvicorn's configuration."""
    return {
        "http": type("Http", (_Http,), {"visitors": visitors}),
        "ws": type("Socket", (_Socket,), {"visitors": visitors}),
    }


def _leave(visitors: Visitors, peer: str | None) -> None:
    if peer is not None and not visitors.is_proxy(peer):
        visitors.connections.leave(peer)
