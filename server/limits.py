"""How much one address may ask of the server: connections, requests, bodies. For one event loop; no I/O of its own."""

import ipaddress
from collections import OrderedDict
from collections.abc import Callable
from typing import Final

from msgspec import Struct
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from server.refusal import refusal

#: More addresses than this are not remembered: those that were silent longest are forgotten.
_MAX_ADDRESSES: Final = 10_000
_TOO_MANY: Final = "Too many requests from your address: wait a little."


class Limits(Struct, frozen=True, kw_only=True):
    """The figures. A school class behind one address fits well within them."""

    requests_per_s: float = 100.0
    """Of one address, in the long run: pages, files and attempts to connect."""
    burst: float = 1000.0
    """So many at once."""
    connections: int = 256
    """Of one address at a time."""
    header_s: float = 10.0
    """A request's head must have arrived by then."""
    body_bytes: int = 64 * 1024
    """Of a request; routes that take more say so."""
    proxies: frozenset[str] = frozenset({"127.0.0.1", "::1"})
    """Addresses whose own connections are not counted: a proxy's are everybody's. It says whose by `X-Forwarded-For`."""


class Bucket:
    """Fills at a rate up to its size; `take` says whether there is one left."""

    def __init__(self, rate_per_s: float, size: float, now_s: float) -> None:
        self._rate_per_s, self._size = rate_per_s, size
        self._left, self._t_s = size, now_s

    def take(self, now_s: float) -> bool:
        """Take one, if there is one."""
        self._left = min(self._size, self._left + (now_s - self._t_s) * self._rate_per_s)
        self._t_s = now_s
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True


class Places:
    """How many of something each address has open."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._open: dict[str, int] = {}

    def enter(self, address: str) -> bool:
        """Count one more; False, and not counted, where the address has too many."""
        key = network_of(address)
        if self._open.get(key, 0) >= self._most:
            return False
        self._open[key] = self._open.get(key, 0) + 1
        return True

    def leave(self, address: str) -> None:
        """Forget one that was counted."""
        key = network_of(address)
        self._open[key] -= 1
        if not self._open[key]:
            del self._open[key]


class Visitors:
    """What each address has asked for lately, and what it has open."""

    def __init__(self, limits: Limits, now_s: Callable[[], float]) -> None:
        """`now_s` is any clock that does not jump."""
        self.limits = limits
        self.connections, self.sockets = Places(limits.connections), Places(limits.connections)
        self._now_s = now_s
        self._buckets: OrderedDict[str, Bucket] = OrderedDict()

    def may_ask(self, address: str) -> bool:
        """Whether an address may ask once more."""
        key, now_s = network_of(address), self._now_s()
        bucket = self._buckets.pop(key, None) or Bucket(self.limits.requests_per_s, self.limits.burst, now_s)
        self._buckets[key] = bucket  # the newest last
        if len(self._buckets) > _MAX_ADDRESSES:
            self._buckets.popitem(last=False)
        return bucket.take(now_s)

    def admit(self, peer: str) -> bool:
        """Whether a new connection of a peer is let in; it then has a place in `connections`, if it is no proxy's."""
        return self.is_proxy(peer) or (self.may_ask(peer) and self.connections.enter(peer))

    def is_proxy(self, peer: str) -> bool:
        """Whether a peer's connections are not counted."""
        return peer in self.limits.proxies


def network_of(address: str) -> str:
    """Return what one subscriber has: an IPv4 address, or the /64 of an IPv6 address."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    if isinstance(parsed, ipaddress.IPv6Address):
        if parsed.ipv4_mapped is not None:
            return str(parsed.ipv4_mapped)
        return str(ipaddress.ip_network((int(parsed), 64), strict=False).network_address)
    return str(parsed)


class Throttle:
    """ASGI: 429 for an address that asks too often, 413 for a body that is too large."""

    def __init__(
        self, app: ASGIApp, visitors: Visitors, large_bodies: Callable[[Scope], bool] = lambda scope: False
    ) -> None:
        """`large_bodies` says which requests' bodies their route limits itself."""
        self._app, self._visitors, self._large_bodies = app, visitors, large_bodies

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        address = scope["client"][0] if scope.get("client") else ""
        if not self._visitors.may_ask(address):
            await _refuse(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._one_socket(address, scope, receive, send)
        elif self._large_bodies(scope):
            await self._app(scope, receive, send)
        else:
            await self._with_small_body(scope, receive, send)

    async def _one_socket(self, address: str, scope: Scope, receive: Receive, send: Send) -> None:
        if not self._visitors.sockets.enter(address):
            await _refuse(scope, receive, send)
            return
        try:
            await self._app(scope, receive, send)
        finally:
            self._visitors.sockets.leave(address)

    async def _with_small_body(self, scope: Scope, receive: Receive, send: Send) -> None:
        most = self._visitors.limits.body_bytes
        declared = Headers(scope=scope).get("content-length", "0")
        if not declared.isdecimal() or int(declared[:20]) > most:
            await _too_large(most)(scope, receive, send)
            return
        taken, answered = 0, False

        async def receive_little() -> Message:
            nonlocal taken
            message = await receive()
            taken += len(message.get("body", b""))
            if taken > most:
                raise _TooLarge
            return message

        async def note_answer(message: Message) -> None:
            nonlocal answered
            answered = True
            await send(message)

        try:
            await self._app(scope, receive_little, note_answer)
        except _TooLarge:
            if not answered:
                await _too_large(most)(scope, receive, send)


async def _refuse(scope: Scope, receive: Receive, send: Send) -> None:
    later = {"Retry-After": "1"}
    if scope["type"] == "websocket":
        await WebSocket(scope, receive, send).send_denial_response(PlainTextResponse(_TOO_MANY, 429, later))
        return
    response = refusal(Headers(scope=scope), 429, _TOO_MANY)
    response.headers.update(later)
    await response(scope, receive, send)


class _TooLarge(Exception):
    """A body that said nothing of its size has grown too large."""


def _too_large(most: int) -> PlainTextResponse:
    # what is left of the body is not read: the connection ends with the answer
    return PlainTextResponse(f"Expected a body of at most {most} bytes.", 413, {"Connection": "close"})
