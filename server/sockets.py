"""The two WebSockets: `/ws/rig/{session}` pushes, `/ws/view/{session}` watches. Messages go to `sessions.py`; no state here.

Each connection has a task that reads; its mailbox is sent by whoever puts something in.
"""

import asyncio
import logging
from collections.abc import Callable
from time import monotonic
from typing import Final

from fastapi import APIRouter, WebSocket
from starlette.responses import PlainTextResponse
from starlette.websockets import WebSocketDisconnect

from server.access import Access
from server.errors import MalformedMessage, ServerFull, TokenRefused, UnknownSession
from server.fanout import Mailbox
from server.grants import Grant
from server.limits import Bucket
from server.line import SocketLine, line_of
from server.messages import Ack, ControlReply, Look, encode, parse_from_viewer
from server.session import Session
from server.sessions import Sessions
from server.wire import SUBPROTOCOL

_logger = logging.getLogger(__name__)

MALFORMED: Final = 1007
#: "Policy violation", RFC 6455.
TOO_MUCH: Final = 1008
TRY_LATER: Final = 1013
#: Close codes of our own, which a page can read where an HTTP status stays hidden from it.
FORBIDDEN: Final = 4403
NO_SESSION: Final = 4404
OTHER_VERSION: Final = 4406

#: Messages of one connection in the long run, and for how long it may send more than that: acknowledgements come at the rate of
#: pictures, a rig's messages at that of pictures, poses and changes of state.
_VIEWER_HZ: Final = 200.0
_RIG_HZ: Final = 1000.0
_BURST_S: Final = 5.0
_FAREWELL_S: Final = 2.0
_ONLY_WATCHES: Final = "Only the walker and operators control a walk; this token watches."
_NOT_YOURS: Final = "Only the walker can share the camera's picture."
_OTHER_VERSION: Final = f"This server speaks {SUBPROTOCOL} alone: take the same version on both sides."
_EXPIRED: Final = "The token that let you in has expired."

#: What `/metrics` counts as refused, by close code.
_REASONS: Final = {MALFORMED: "malformed", TOO_MUCH: "too_much", TRY_LATER: "too_slow", FORBIDDEN: "expired"}
_STATUS_REASONS: Final = {401: "token", 403: "token", 404: "no_session", 406: "version", 503: "full"}

_Take = Callable[[str | bytes], None]


def socket_routes(sessions: Sessions, access: Access) -> APIRouter:
    """Return both sockets."""
    router, refused = APIRouter(), sessions.traffic.refused

    async def deny(websocket: WebSocket, status: int, sentence: str) -> None:
        refused[_STATUS_REASONS[status]] += 1
        await websocket.send_denial_response(PlainTextResponse(sentence, status))

    async def close(websocket: WebSocket, code: int, reason: str, sentence: str) -> None:
        refused[reason] += 1
        await websocket.close(code, _reason(sentence))

    def tell(event: str, name: str, mailbox: Mailbox) -> None:
        code, why = mailbox.closing or (None, "it left")
        if code in _REASONS:
            refused[_REASONS[code]] += 1
        _logger.info(event, extra={"session": name, "why": why, "code": code})

    @router.websocket("/ws/rig/{name}")
    async def rig(websocket: WebSocket, name: str) -> None:
        try:
            grant = access.rig_of(websocket.headers)
        except TokenRefused as exc:
            await deny(websocket, 401, str(exc))
            return
        if not grant.allows("publish", name):
            await deny(websocket, 403, "This token is not a rig's of this session: see `agora token rig`.")
            return
        if not _speaks(websocket):
            await deny(websocket, 406, _OTHER_VERSION)
            return
        try:
            session = sessions.open(name)
        except (UnknownSession, ServerFull) as exc:
            await deny(websocket, 404 if isinstance(exc, UnknownSession) else 503, str(exc))
            return
        await _accept(websocket)
        mailbox = Mailbox()
        _logger.info("a rig came", extra={"session": name})
        try:
            await _serve_rig(websocket, session, mailbox, access.left_s(grant), sessions.now_ns)
        finally:
            tell("a rig left", name, mailbox)

    @router.websocket("/ws/view/{name}")
    async def view(websocket: WebSocket, name: str) -> None:
        await _accept(websocket)
        if not _speaks(websocket):
            await close(websocket, OTHER_VERSION, "version", _OTHER_VERSION)
            return
        try:
            grant = access.grant_of(websocket.headers)
        except TokenRefused as exc:
            await close(websocket, FORBIDDEN, "token", str(exc))
            return
        if not grant.allows("watch", name):
            await close(websocket, FORBIDDEN, "token", "This token is for another session.")
            return
        mailbox = Mailbox()
        mailbox.role = grant.role
        mailbox.frames_wanted = 1 if websocket.query_params.get("pictures") == "none" else None
        try:
            session = sessions.get(name)
            session.join(mailbox)
        except (UnknownSession, ServerFull) as exc:
            code, reason = (NO_SESSION, "no_session") if isinstance(exc, UnknownSession) else (TRY_LATER, "full")
            await close(websocket, code, reason, str(exc))
            return
        _logger.info("a viewer came", extra={"session": name, "role": grant.role, "viewers": len(session.viewers)})
        try:
            await _serve_viewer(websocket, session, mailbox, grant, access.left_s(grant), sessions.now_ns)
        finally:
            tell("a viewer left", name, mailbox)

    return router


async def _serve_rig(
    websocket: WebSocket, session: Session, mailbox: Mailbox, left_s: float | None, now_ns: Callable[[], int]
) -> None:
    def take(message: str | bytes) -> None:
        if isinstance(message, str):
            session.take_text(message)
        else:
            session.take_binary(message, now_ns())

    session.attach_rig(mailbox)
    try:
        await _exchange(websocket, mailbox, take, left_s, _RIG_HZ)
    finally:
        session.detach_rig(mailbox)


async def _serve_viewer(
    websocket: WebSocket,
    session: Session,
    mailbox: Mailbox,
    grant: Grant,
    left_s: float | None,
    now_ns: Callable[[], int],
) -> None:
    def take(message: str | bytes) -> None:
        if isinstance(message, bytes):
            raise MalformedMessage("a viewer sends text only")
        parsed = parse_from_viewer(message)
        if isinstance(parsed, Ack):
            mailbox.acknowledge(parsed.frame_id)
        elif isinstance(parsed, Look):
            session.look(mailbox, parsed, now_ns())
        elif not grant.allows("control", session.name):
            mailbox.put_text(encode(ControlReply(parsed.request_id, ok=False, error=_ONLY_WATCHES)))
        elif parsed.action == "share" and not grant.allows("see", session.name):
            mailbox.put_text(encode(ControlReply(parsed.request_id, ok=False, error=_NOT_YOURS)))
        else:
            session.control(mailbox, parsed)

    try:
        await _exchange(websocket, mailbox, take, left_s, _VIEWER_HZ)
    finally:
        session.leave(mailbox)


async def _exchange(websocket: WebSocket, mailbox: Mailbox, take: _Take, left_s: float | None, most_hz: float) -> None:
    """Read and write until the peer leaves, sends what is malformed or too much, its time is over, or the mailbox is closed."""
    loop, line = asyncio.get_running_loop(), line_of(websocket.scope)
    end = None if left_s is None else loop.call_later(left_s, mailbox.close, FORBIDDEN, _EXPIRED)
    mailbox.open(line)
    tasks = [
        asyncio.create_task(_read(websocket, mailbox, take, most_hz)),
        asyncio.create_task(mailbox.closed()),
    ]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        if end is not None:
            end.cancel()
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
    for result in results:
        if isinstance(result, Exception):
            raise result
    if mailbox.closing is not None:
        await _hang_up(websocket, line, *mailbox.closing)


async def _hang_up(websocket: WebSocket, line: SocketLine, code: int, why: str) -> None:
    """Say why and close; a peer that reads nothing does not hear it, and must not hold its place for that."""
    try:
        async with asyncio.timeout(_FAREWELL_S):
            await websocket.close(code, _reason(why))
    except (RuntimeError, WebSocketDisconnect):  # the peer may have left meanwhile
        pass
    except TimeoutError:
        line.cut()


async def _read(websocket: WebSocket, mailbox: Mailbox, take: _Take, most_hz: float) -> None:
    bucket = Bucket(most_hz, _BURST_S * most_hz, monotonic())
    while mailbox.closing is None:
        message = await websocket.receive()
        if message["type"] == "websocket.disconnect":
            return
        if not bucket.take(monotonic()):
            mailbox.close(TOO_MUCH, "too many messages")
            return
        text = message.get("text")
        try:
            take(message["bytes"] if text is None else text)
        except MalformedMessage as exc:
            mailbox.close(MALFORMED, str(exc))


def _speaks(websocket: WebSocket) -> bool:
    """Whether the peer knows our version of the wire format; one that names none is taken at its word, message by message."""
    offered = websocket.scope["subprotocols"]
    return not offered or SUBPROTOCOL in offered


async def _accept(websocket: WebSocket) -> None:
    await websocket.accept(SUBPROTOCOL if SUBPROTOCOL in websocket.scope["subprotocols"] else None)


def _reason(sentence: str) -> str:
    """Return a close reason: the protocol allows 123 bytes."""
    return sentence.encode(errors="replace")[:123].decode(errors="ignore")
