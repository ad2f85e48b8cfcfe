"""The two WebSockets: `/ws/rig/{session}` pushes, `/ws/view/{session}` watches. Messages go to `sessions.py`; no state here.

Each connection has two tasks, one that reads and one that empties its mailbox; when either ends so does the other.
"""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Final

from fastapi import APIRouter, WebSocket
from starlette.responses import PlainTextResponse
from starlette.websockets import WebSocketDisconnect

from server.auth import Tokens
from server.errors import MalformedMessage, ServerFull, UnknownSession
from server.fanout import Mailbox
from server.messages import Ack, parse_from_viewer
from server.sessions import Session, Sessions

MALFORMED: Final = 1007
TRY_LATER: Final = 1013
#: Close codes of our own, which a page can read where an HTTP status stays hidden from it.
FORBIDDEN: Final = 4403
NO_SESSION: Final = 4404

_Take = Callable[[str | bytes], None]


def socket_routes(sessions: Sessions, rig_tokens: Tokens, viewer_tokens: Tokens | None) -> APIRouter:
    """Return both sockets; without `viewer_tokens` everybody who reaches the server may watch."""
    router = APIRouter()

    @router.websocket("/ws/rig/{name}")
    async def rig(websocket: WebSocket, name: str) -> None:
        if not rig_tokens.allows_header(websocket.headers.get("authorization")):
            await _deny(websocket, 403, "A rig needs a token of this server: see `agora token`.")
            return
        try:
            session = sessions.open(name)
        except (UnknownSession, ServerFull) as exc:
            await _deny(websocket, 404 if isinstance(exc, UnknownSession) else 503, str(exc))
            return
        await websocket.accept()
        await _serve_rig(websocket, session, sessions.now_ns)

    @router.websocket("/ws/view/{name}")
    async def view(websocket: WebSocket, name: str) -> None:
        await websocket.accept()
        if viewer_tokens is not None and not viewer_tokens.allows(websocket.query_params.get("token")):
            await websocket.close(FORBIDDEN, "watching needs a token of this server")
            return
        mailbox = Mailbox()
        try:
            session = sessions.get(name)
            session.join(mailbox)
        except (UnknownSession, ServerFull) as exc:
            code = NO_SESSION if isinstance(exc, UnknownSession) else TRY_LATER
            await websocket.close(code, _reason(str(exc)))
            return
        await _serve_viewer(websocket, session, mailbox)

    return router


async def _serve_rig(websocket: WebSocket, session: Session, now_ns: Callable[[], int]) -> None:
    def take(message: str | bytes) -> None:
        if isinstance(message, str):
            session.take_text(message)
        else:
            session.take_binary(message, now_ns())

    mailbox = Mailbox()
    session.attach_rig(mailbox)
    try:
        await _exchange(websocket, mailbox, take)
    finally:
        session.detach_rig(mailbox)


async def _serve_viewer(websocket: WebSocket, session: Session, mailbox: Mailbox) -> None:
    def take(message: str | bytes) -> None:
        if isinstance(message, bytes):
            raise MalformedMessage("a viewer sends text only")
        parsed = parse_from_viewer(message)
        if isinstance(parsed, Ack):
            mailbox.acknowledge(parsed.frame_id)
        else:
            session.control(mailbox, parsed)

    try:
        await _exchange(websocket, mailbox, take)
    finally:
        session.leave(mailbox)


async def _exchange(websocket: WebSocket, mailbox: Mailbox, take: _Take) -> None:
    """Read and write until the peer leaves, sends what is malformed, or the mailbox is closed."""
    tasks = [asyncio.create_task(_read(websocket, mailbox, take)), asyncio.create_task(_write(websocket, mailbox))]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
    for result in results:
        if isinstance(result, Exception):
            raise result
    if mailbox.closing is not None:
        with suppress(RuntimeError, WebSocketDisconnect):  # the peer may have left meanwhile
            await websocket.close(mailbox.closing[0], _reason(mailbox.closing[1]))


async def _read(websocket: WebSocket, mailbox: Mailbox, take: _Take) -> None:
    while mailbox.closing is None:
        message = await websocket.receive()
        if message["type"] == "websocket.disconnect":
            return
        text = message.get("text")
        try:
            take(message["bytes"] if text is None else text)
        except MalformedMessage as exc:
            mailbox.close(MALFORMED, str(exc))


async def _write(websocket: WebSocket, mailbox: Mailbox) -> None:
    with suppress(WebSocketDisconnect):
        while (message := await mailbox.next()) is not None:
            send: Awaitable[None] = (
                websocket.send_text(message) if isinstance(message, str) else websocket.send_bytes(message)
            )
            await send


async def _deny(websocket: WebSocket, status: int, sentence: str) -> None:
    await websocket.send_denial_response(PlainTextResponse(sentence, status))


def _reason(sentence: str) -> str:
    """Return a close reason: the protocol allows 123 bytes."""
    return sentence.encode(errors="replace")[:123].decode(errors="ignore")
