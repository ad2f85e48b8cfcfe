"""What every request passes first: the Host and Origin checks, and the headers that confine our pages. ASGI, no routes."""

import ipaddress
from collections.abc import Collection
from typing import Final
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from server.refusal import refusal

#: three.js decodes textures from blobs and its mesh decoder is WebAssembly; nothing else but ourselves is ever contacted.
_CONTENT_SECURITY_POLICY = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self' 'wasm-unsafe-eval'",
        "style-src 'self'",
        "img-src 'self' blob: data:",
        "connect-src 'self' blob: data:",
        "worker-src 'self' blob:",
        "object-src 'none'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)
SECURITY_HEADERS = {
    "Content-Security-Policy": _CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "geolocation=(), microphone=(), payment=(), usb=()",
}


#: A browser that came by TLS comes by nothing else for a month: long enough for those who come again, and short enough for a server
#: whose authority is its own, and which somebody may want to run without TLS one day.
_STRICT_TRANSPORT: Final = "max-age=2592000"

#: Methods that change nothing; everything else, and every WebSocket, is for our own pages and for programs.
_READING = ("GET", "HEAD", "OPTIONS")


class Guard:
    """Turns away other hosts' names (DNS rebinding) and other sites' pages, and adds the security headers."""

    def __init__(self, app: ASGIApp, allowed_hosts: Collection[str], any_address: bool = False) -> None:
        """`any_address` lets an IP address pass as a Host: no page of another name can be behind it."""
        self._app, self._any_address = app, any_address
        self._allowed_hosts = frozenset(host.lower() for host in allowed_hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it: 403, before any WebSocket is accepted."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        asked = Headers(scope=scope)
        # by `localhost` everything on this machine goes, at whatever port, and most of it without TLS
        is_strict = scope["scheme"] == "https" and _host_name(asked.get("host", "")) != "localhost"
        fault = self._fault(asked, changes=scope.get("method") not in _READING)
        if scope["type"] == "websocket":
            if fault:
                await WebSocket(scope, receive, send).send_denial_response(PlainTextResponse(fault, 403))
            else:
                await self._app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in SECURITY_HEADERS.items():
                    headers.setdefault(name, value)
                if is_strict:
                    headers.setdefault("Strict-Transport-Security", _STRICT_TRANSPORT)
            await send(message)

        app = refusal(asked, 403, fault) if fault else self._app
        await app(scope, receive, send_with_headers)

    def _fault(self, headers: Headers, *, changes: bool) -> str | None:
        host = headers.get("host", "")
        name = _host_name(host)
        if name is None or not (name in self._allowed_hosts or (self._any_address and _is_address(name))):
            return "This server does not go by that name: use the address that it printed."
        origin = headers.get("origin")
        if changes and origin is not None and origin.lower().partition("://")[2] != host.lower():
            return "Only this server's own pages may connect."
        return None


def _host_name(host: str) -> str | None:
    """Return the name in a Host header without port and brackets; None where it does not parse."""
    try:
        return urlsplit(f"//{host}").hostname
    except ValueError:
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
