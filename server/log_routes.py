"""`/api/logs`: recorded walks listed, downloaded, uploaded and deleted. They are personal data: all of it is the operator's."""

import asyncio
import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from fastapi import APIRouter, Depends, HTTPException, Request, Response
from fastapi.responses import FileResponse, JSONResponse
from starlette.requests import ClientDisconnect

from server.access import Access, needs
from server.errors import LogRefused
from server.inspection import inspect
from server.log_store import LogStore

_logger = logging.getLogger(__name__)

#: Uploads at a time: each has a file and, at its end, a process.
MAX_UPLOADS: Final = 2
#: A sender that is silent for so long is given up.
_SILENCE_S: Final = 30.0
_PIECE: Final = 1 << 20
_MAGIC: Final = b"\x89MCAP0\r\n"


def log_routes(logs: Mapping[str, Path], access: Access) -> APIRouter:
    """Return the list of the walks, by name, and the walks themselves."""
    router = APIRouter(dependencies=[Depends(needs(access, "operate"))])

    @router.get("/api/logs")
    def all_logs() -> dict[str, Any]:
        return {"logs": [{"name": name, "bytes": path.stat().st_size} for name, path in logs.items() if path.is_file()]}

    @router.get("/api/logs/{name}")
    def one_log(name: str) -> FileResponse:
        path = logs.get(name)
        if path is None or not path.is_file():
            raise HTTPException(404, "There is no log of that name: see /api/logs for those that there are.")
        return FileResponse(path, media_type="application/octet-stream", filename=path.name)

    return router


def upload_routes(store: LogStore, access: Access, deleted: Callable[[str], None]) -> APIRouter:
    """Return what fills and empties a store; `deleted` is called with the name of a walk that is about to go."""
    router = APIRouter(dependencies=[Depends(needs(access, "operate"))])
    uploads = asyncio.Semaphore(MAX_UPLOADS)

    @router.put("/api/logs/{name}", status_code=201)
    async def upload(name: str, request: Request) -> JSONResponse:
        if uploads.locked():
            return _refusal(name, LogRefused(503, "Other walks are being uploaded: try again in a minute."))
        async with uploads:
            try:
                holds = await _take(store, name, request)
            except LogRefused as exc:
                return _refusal(name, exc)
        size = store[name].stat().st_size
        _logger.info("a walk was uploaded", extra={"log": name, "bytes": size})
        return JSONResponse({"name": name, "bytes": size, **holds}, 201)

    @router.delete("/api/logs/{name}", status_code=204)
    async def delete(name: str) -> Response:
        if name not in store:
            raise HTTPException(404, "There is no log of that name: see /api/logs for those that there are.")
        deleted(name)
        store.delete(name)
        _logger.info("a walk was deleted", extra={"log": name})
        return Response(status_code=204)

    return router


async def _take(store: LogStore, name: str, request: Request) -> dict[str, Any]:
    declared = request.headers.get("content-length")
    if declared is not None and not declared.isdecimal():
        raise LogRefused(400, "Content-Length is no number.")
    store.check_place(name, None if declared is None else int(declared[:20]))
    place = store.new_place()
    try:
        await _write(store, place, request)
        holds = await asyncio.to_thread(inspect, place)
        await asyncio.to_thread(store.admit, place, name)
    finally:
        store.discard(place)
    return holds


async def _write(store: LogStore, place: Path, request: Request) -> None:
    """Bring the body to the disk piece by piece: in memory is never more than one."""
    stream = request.stream()
    size, waiting = 0, bytearray()
    try:
        with place.open("wb") as file:
            while (piece := await asyncio.wait_for(anext(stream, None), _SILENCE_S)) is not None:
                size += len(piece)
                waiting += piece
                if size > store.max_bytes:
                    raise LogRefused(413, f"A walk may have {store.max_bytes} bytes at most.")
                if len(waiting) >= _PIECE:
                    if size == len(waiting):
                        _check_magic(waiting)
                    await asyncio.to_thread(file.write, waiting)
                    waiting = bytearray()
            if size == len(waiting):
                _check_magic(waiting)
            await asyncio.to_thread(file.write, waiting)
    except TimeoutError as exc:
        raise LogRefused(408, f"Nothing came for {_SILENCE_S:.0f} s: send the walk again.") from exc
    except ClientDisconnect as exc:
        raise LogRefused(400, "The sender left before its end.") from exc
    except OSError as exc:
        raise LogRefused(507, f"The walk cannot be kept: {exc.strerror}.") from exc


def _check_magic(begin: bytearray) -> None:
    if not begin.startswith(_MAGIC):
        raise LogRefused(415, "This is not an MCAP file: send a walk that was recorded as a ROS 2 bag in MCAP.")


def _refusal(name: str, refused: LogRefused) -> JSONResponse:
    _logger.warning("an upload was refused", extra={"log": name[:64], "status": refused.status, "why": str(refused)})
    # what is left of the body is not read: the connection ends with the answer
    return JSONResponse({"detail": str(refused)}, refused.status, {"Connection": "close"})
