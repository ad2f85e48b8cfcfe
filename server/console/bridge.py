"""`/console`: viser's page, and its socket carried on to the console's process, for operators alone."""

import asyncio
import logging
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from fastapi import APIRouter, Depends, Request, WebSocket
from fastapi.responses import FileResponse, PlainTextResponse
from starlette.responses import Response
from starlette.websockets import WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from server.access import Access, needs
from server.console.hosting import ConsoleHost
from server.errors import ConsoleUnavailable, TokenRefused
from server.grants import Grant
from server.refusal import refusal

_logger = logging.getLogger(__name__)

_NOT_HERE: Final = "The operator's console is not running."
#: viser's page unpacks itself: it writes its script and its styles into itself, and runs a worker from a blob. It still reaches
#: nobody but us. One of its parts would have `eval`, which nothing of ours needs: the sorting of Gaussian splats.
_CONTENT_SECURITY_POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:",
        "style-src 'unsafe-inline'",
        "img-src 'self' blob: data:",
        "font-src data:",
        "connect-src 'self' blob: data:",
        "worker-src blob: data:",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
)
_HEADERS: Final = {"Content-Security-Policy": _CONTENT_SECURITY_POLICY, "Cache-Control": "no-cache"}
_EXPIRED: Final = 4403
_TRY_LATER: Final = 1013


def console_routes(host: ConsoleHost | None, access: Access) -> APIRouter:
    """Return the page and its socket; without a host there is no console."""
    router = APIRouter(include_in_schema=False)

    @router.get("/console", dependencies=[Depends(needs(access, "operate"))])
    async def page(request: Request) -> Response:
        path = _page()
        if host is None or path is None:
            return refusal(request.headers, 404, _NOT_HERE)
        try:
            await host.open()  # while the browser unpacks the page, its socket's other end is there already
        except ConsoleUnavailable as exc:
            return PlainTextResponse(f"The operator's console does not start: {exc}", 503)
        return FileResponse(path, media_type="text/html", headers=_HEADERS)

    @router.websocket("/console")
    async def socket(websocket: WebSocket) -> None:
        grant = _operator(websocket, access)
        if grant is None or host is None:
            await websocket.send_denial_response(PlainTextResponse(_NOT_HERE, 404 if grant else 403))
            return
        host.enter()
        try:
            address, secret = await host.open()
            await _carry(websocket, address, secret, access.left_s(grant))
        except (ConsoleUnavailable, OSError, WebSocketException) as exc:
            _logger.warning("the console cannot be reached", extra={"why": str(exc)})
            with suppress(RuntimeError, WebSocketDisconnect):
                await websocket.close(_TRY_LATER)
        finally:
            host.leave()

    return router


def _operator(websocket: WebSocket, access: Access) -> Grant | None:
    try:
        grant = access.grant_of(websocket.headers)
    except TokenRefused:
        return None
    return grant if grant.allows("operate") else None


def _page() -> Path | None:
    """Return viser's page; viser itself, which takes a second, is not imported for it."""
    spec = find_spec("viser")
    if spec is None or spec.origin is None:
        return None
    path = Path(spec.origin).parent / "client" / "build" / "index.html"
    return path if path.is_file() else None


async def _carry(websocket: WebSocket, address: str, secret: str, left_s: float | None) -> None:
    """Carry messages both ways until either side ends, or the operator's time does."""
    offered = [Subprotocol(name) for name in websocket.scope["subprotocols"]]
    async with connect(
        address,
        additional_headers={"Authorization": f"Bearer {secret}"},
        subprotocols=offered or None,
        compression=None,
        proxy=None,
        max_size=None,
    ) as console:
        await websocket.accept(console.subprotocol)
        tasks = [asyncio.create_task(_up(websocket, console)), asyncio.create_task(_down(websocket, console))]
        try:
            done, _ = await asyncio.wait(tasks, timeout=left_s, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        with suppress(RuntimeError, WebSocketDisconnect):
            await websocket.close(1000 if done else _EXPIRED)


async def _up(websocket: WebSocket, console: ClientConnection) -> None:
    with suppress(ConnectionClosed):
        while (message := await websocket.receive())["type"] != "websocket.disconnect":
            text = message.get("text")
            await console.send(message["bytes"] if text is None else text)


async def _down(websocket: WebSocket, console: ClientConnection) -> None:
    with suppress(ConnectionClosed, WebSocketDisconnect, RuntimeError):
        async for message in console:
            await (websocket.send_text(message) if isinstance(message, str) else websocket.send_bytes(message))
