"""What an operator does with sessions: begin a replay, rename, end."""

import logging
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, HTTPException, Response
from pydantic import BaseModel, ConfigDict, StringConstraints

from server.access import Access, needs
from server.errors import ReplayRefused, ServerFull, UnknownSession
from server.replays import Replays
from server.sessions import ENDED, Sessions
from tracker.errors import InputError
from tracker.estimators import check_name

_logger = logging.getLogger(__name__)

_ENDED = "An operator has ended this walk."


class NewReplay(BaseModel):
    """A walk to be replayed."""

    model_config = ConfigDict(extra="forbid")
    log: Annotated[str, StringConstraints(max_length=64)]
    estimator: Annotated[str, StringConstraints(max_length=64)] | None = None
    anchor: Literal["site", "here"] = "site"
    looping: bool = True


class Renaming(BaseModel):
    """What viewers are to read in the place of a session's name; its address stays."""

    model_config = ConfigDict(extra="forbid")
    title: Annotated[str, StringConstraints(max_length=100, pattern=r"^[^\x00-\x1f\x7f]*$", strip_whitespace=True)]


def session_routes(sessions: Sessions, access: Access, replays: Replays | None) -> APIRouter:
    """Return the routes; without `replays` there is none to begin."""
    router = APIRouter()

    @router.post("/api/sessions", status_code=201, dependencies=[Depends(needs(access, "operate"))])
    async def begin(wanted: NewReplay) -> dict[str, Any]:
        if replays is None:
            raise HTTPException(501, "This server replays no uploaded walks: use `agora serve`.")
        try:
            if wanted.estimator is not None:
                check_name(wanted.estimator)
            name = await replays.start(
                wanted.log, estimator=wanted.estimator, anchor=wanted.anchor, looping=wanted.looping
            )
        except KeyError as exc:
            raise HTTPException(404, "There is no log of that name: see /api/logs for those that there are.") from exc
        except (InputError, ReplayRefused) as exc:
            raise HTTPException(422, str(exc)) from exc
        except ServerFull as exc:
            raise HTTPException(503, str(exc)) from exc
        return sessions.get(name).describe()

    @router.patch("/api/sessions/{name}", dependencies=[Depends(needs(access, "operate", "name"))])
    async def rename(name: str, wanted: Renaming) -> dict[str, Any]:
        try:
            session = sessions.get(name)
        except UnknownSession as exc:
            raise HTTPException(404, str(exc)) from exc
        session.rename(wanted.title)
        _logger.info("a session was renamed", extra={"session": name, "title": wanted.title})
        return session.describe()

    @router.delete("/api/sessions/{name}", status_code=204, dependencies=[Depends(needs(access, "operate", "name"))])
    async def end(name: str) -> Response:
        if name not in sessions:
            raise HTTPException(404, f"There is no session {name[:64]!r}.")
        if replays is not None:
            replays.stop(name, _ENDED)
        if name in sessions:
            sessions.end(name, ENDED, _ENDED)
        _logger.info("a session was ended", extra={"session": name})
        return Response(status_code=204)

    return router
