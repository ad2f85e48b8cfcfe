"""Pages, models and the HTTP interface. Reads sessions, changes nothing."""

from asyncio import all_tasks
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Final

from fastapi import APIRouter, Depends, HTTPException, Request, Response
from fastapi.responses import FileResponse, JSONResponse, PlainTextResponse
from starlette.staticfiles import StaticFiles

from server.access import Access, known, needs
from server.cluster.relay import Relay
from server.grants import Grant
from server.metrics import Metrics
from server.session import Session
from server.sessions import NAME, Sessions
from server.wire import VERSION

#: Frames flow where the newest is at most this old.
_FRAME_FRESH_NS: Final = 5_000_000_000
#: Pages name their scripts by content hash, so a page itself must always be asked for anew.
_ALWAYS_ASK: Final = {"Cache-Control": "no-cache"}
_NOT_BUILT: Final = "The web pages are not built yet: run `make setup`."


class Bundle(StaticFiles):
    """The built pages' scripts and styles; a folder that is not there (yet) has no files, which is no fault of the server's."""

    async def check_config(self) -> None:
        """Skip the base's check that the folder exists."""


def page_routes(web_folder: Path, models_folder: Path) -> APIRouter:
    """Return the pages and the models."""
    router = APIRouter(include_in_schema=False)
    models = Bundle(directory=models_folder, check_dir=False)

    def page(file_name: str) -> Response:
        path = web_folder / file_name
        if not path.is_file():
            return PlainTextResponse(_NOT_BUILT, 503)
        return FileResponse(path, media_type="text/html", headers=_ALWAYS_ASK)

    @router.get("/")
    def index() -> Response:
        return page("index.html")

    @router.get("/ar")
    def ar() -> Response:
        return page("ar.html")

    @router.get("/replay/{name}")
    def replay(name: str) -> Response:
        return page("replay.html")

    @router.get("/models/{name}.glb")
    async def model(name: str, request: Request) -> Response:
        if not NAME.fullmatch(name):
            raise HTTPException(404)
        response = await models.get_response(f"{name}.glb", request.scope)
        response.headers["Content-Type"] = "model/gltf-binary"
        response.headers.update(_ALWAYS_ASK)
        return response

    return router


def api_routes(
    sessions: Sessions,
    site: Mapping[str, Any],
    web_folder: Path,
    access: Access,
    *,
    alone: bool = False,
    relay: Relay | None = None,
) -> APIRouter:
    """Return the JSON interface, health, readiness and metrics; `alone` is a server that is well without any walk."""
    router, page = APIRouter(), Metrics(sessions, relay)

    @router.get("/api/version")
    async def program_version() -> dict[str, Any]:
        return {"name": "agora", "version": version("agora"), "wire": VERSION}

    @router.get("/api/site")
    async def site_facts() -> dict[str, Any]:
        return dict(site)

    @router.get("/api/sessions")
    async def all_sessions(grant: Annotated[Grant, Depends(known(access))]) -> dict[str, Any]:
        return {"sessions": [session.describe() for session in sessions if grant.allows("watch", session.name)]}

    @router.get("/health")
    async def health(request: Request) -> JSONResponse:
        report = [_health(session, sessions.now_ns()) for session in sessions]
        # A replay that somebody has paused is well, too.
        ok = alone or any(entry["connected"] and (entry["frames_flow"] or not entry["playing"]) for entry in report)
        # whoever is asked only whether all is well need not know who walks where
        told = {"ok": ok, "sessions": report} if access.allows(request.headers, "operate") else {"ok": ok}
        return JSONResponse(told, 200 if ok else 503)

    @router.get("/ready")
    async def ready() -> JSONResponse:
        reason = None
        if not (web_folder / "ar.html").is_file():
            reason = _NOT_BUILT
        elif sessions.stopping:
            reason = "The server is being stopped."
        elif relay is not None and not relay.ready:
            reason = "The other servers are not reached yet."
        return JSONResponse({"ok": reason is None, "reason": reason}, 503 if reason else 200)

    @router.get("/metrics", dependencies=[Depends(needs(access, "operate"))])
    async def metrics() -> Response:
        return Response(page.page(len(all_tasks())), media_type=page.content_type)

    return router


def _health(session: Session, now_ns: int) -> dict[str, Any]:
    age_ns = None if session.t_frame_ns is None else now_ns - session.t_frame_ns
    return {
        "name": session.name,
        "connected": session.connected,
        "here": not session.elsewhere,
        "playing": session.playing,
        "frame_age_s": None if age_ns is None else age_ns * 1e-9,
        "frames_flow": age_ns is not None and age_ns <= _FRAME_FRESH_NS,
        "sensors": session.describe()["health"],
    }
