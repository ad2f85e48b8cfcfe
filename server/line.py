"""The way to one receiver of a WebSocket, past ASGI, whose `send` is a coroutine: a task that wakes for each viewer and pose costs
more than the sending. For one event loop, no locks.
"""

from asyncio import Transport
from collections.abc import Callable
from functools import lru_cache
from typing import Final

from starlette.types import Scope
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import Frame, Opcode

_EXTENSION: Final = "agora.line"


class SocketLine:
    """A `fanout.Line` over a WebSocket that uvicorn has accepted."""

    def __init__(self, protocol: WebSocketsSansIOProtocol) -> None:
        self._protocol, self._transport = protocol, protocol.transport
        self.on_free: Callable[[], None] = _nothing
        # what does not go at once counts as waiting: a pose must not queue behind another
        _hold_nothing(self._transport)

    def free(self) -> bool:
        """Whether all that was sent before has gone."""
        protocol = self._protocol
        return (
            protocol.writable.is_set()
            and protocol.handshake_complete
            and not protocol.close_sent
            and not self._transport.is_closing()
        )

    def send(self, message: str | bytes) -> None:
        """Send a message; never waits."""
        self._transport.write(_framed(message))

    def cut(self) -> None:
        """End the connection without a farewell; what waits to be sent is dropped."""
        self._transport.abort()


def offer_line(scope: Scope, line: SocketLine) -> None:
    """Put a line where the route of a WebSocket finds it."""
    scope["extensions"][_EXTENSION] = line


def line_of(scope: Scope) -> SocketLine:
    """Return the line of the WebSocket that a route serves."""
    line = scope["extensions"][_EXTENSION]
    assert isinstance(line, SocketLine), "only `web_server.WebServer` serves these routes"
    return line


def _hold_nothing(transport: Transport) -> None:
    # by TLS, asyncio takes a buffer that is as full as its limit for too full: an empty one must not be
    transport.set_write_buffer_limits(high=1, low=0)
    beneath = getattr(getattr(transport, "_ssl_protocol", None), "_transport", None)
    if beneath is not None:  # else 64 kB would wait there, unseen
        beneath.set_write_buffer_limits(high=0)


@lru_cache(maxsize=4, typed=True)
def _framed(message: str | bytes) -> bytes:
    """Return a message as it travels: made once for all who get the same, who get it one right after the other."""
    opcode, data = (Opcode.TEXT, message.encode()) if isinstance(message, str) else (Opcode.BINARY, message)
    return Frame(opcode, data).serialize(mask=False)


def _nothing() -> None:
    pass
