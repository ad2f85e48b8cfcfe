"""`/api/replays/{session}/…`: what a replay's page shows beside the pictures, and the walk as one page to take away."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Annotated, Any, Final

from fastapi import APIRouter, Depends, HTTPException, Query, Response

from server.access import Access, needs
from server.errors import LogRefused, UnknownSession
from server.grants import Grant
from server.reviewing.exported import Exporter
from server.reviewing.jobs import MEDIA_TYPES, CourseJob, Job, PackJob, ThumbnailsJob, TimelineJob
from server.reviewing.pack import unpacked
from server.reviewing.page_size import DEFAULT_MB, LARGEST_MB, SMALLEST_MB
from server.reviewing.reviews import Reviews
from server.session import Session
from server.sessions import Sessions
from tracker.errors import InputError
from tracker.estimators import check_name

#: The walk of a name may be another one tomorrow.
_ALWAYS_ASK: Final = {"Cache-Control": "no-cache"}
_NO_REPLAY: Final = "No recorded walk is played under that name: see /api/sessions for those that there are."
_NOT_SHARED: Final = "The walker does not share the camera's pictures."


def review_routes(
    sessions: Sessions,
    access: Access,
    reviews: Reviews,
    exporter: Exporter,
    log_of: Callable[[str], Path | None],
) -> APIRouter:
    """Return the routes.

    Args:
        sessions: Of this server.
        access: Who may do what.
        reviews: Works the answers out.
        exporter: Makes pages to take away.
        log_of: Returns the recording that a session plays; None where it plays none.
    """

    @asynccontextmanager
    async def closing(app: object) -> AsyncIterator[None]:
        yield
        reviews.close()

    router = APIRouter(prefix="/api/replays/{name}", lifespan=closing)
    watches, operates = needs(access, "watch", "name"), needs(access, "operate", "name")

    def walk_of(name: str) -> tuple[Session, str]:
        path = log_of(name)
        try:
            session = sessions.get(name)
        except UnknownSession as exc:
            raise HTTPException(404, _NO_REPLAY) from exc
        if path is None:
            raise HTTPException(404, _NO_REPLAY)
        return session, str(path)

    async def answer(job: Job) -> Response:
        try:
            return Response(await reviews.answer(job), media_type=MEDIA_TYPES[type(job)], headers=_ALWAYS_ASK)
        except LogRefused as exc:
            raise HTTPException(exc.status, str(exc)) from exc

    @router.get("/timeline", dependencies=[Depends(watches)])
    async def timeline(name: str) -> Response:
        return await answer(TimelineJob(walk_of(name)[1]))

    @router.get("/thumbnails")
    async def thumbnails(name: str, grant: Annotated[Grant, Depends(watches)]) -> Response:
        session, path = walk_of(name)
        if not (session.sharing or grant.allows("see", name)):
            raise HTTPException(403, _NOT_SHARED)
        return await answer(ThumbnailsJob(path))

    @router.get("/course", dependencies=[Depends(watches)])
    async def course(name: str, estimator: Annotated[str, Query(max_length=64)]) -> Response:
        _, path = walk_of(name)
        try:
            check_name(estimator)
        except InputError as exc:
            raise HTTPException(422, str(exc)) from exc
        return await answer(CourseJob(path, estimator))

    @router.get("/page")
    async def page(
        name: str,
        grant: Annotated[Grant, Depends(operates)],
        pictures: bool = True,
        max_mb: Annotated[int, Query(ge=SMALLEST_MB, le=LARGEST_MB)] = DEFAULT_MB,
    ) -> Response:
        session, path = walk_of(name)
        if pictures and not (session.sharing or grant.allows("see", name)):
            raise HTTPException(403, _NOT_SHARED)
        facts: dict[str, Any] = session.describe()
        try:
            job = PackJob(
                log=path,
                site=str(exporter.site_folder),
                estimator=facts["estimator"] or None,
                anchor=facts["anchor"],
                pictures=pictures,
                max_bytes=exporter.left_for_frames(max_mb),
            )
            html = await exported(reviews, exporter, name, job)
        except LogRefused as exc:
            raise HTTPException(exc.status, str(exc)) from exc
        disposition = {"Content-Disposition": f'attachment; filename="{name}.html"'}
        return Response(html, media_type="text/html", headers=_ALWAYS_ASK | disposition)

    return router


async def exported(reviews: Reviews, exporter: Exporter, name: str, job: PackJob) -> str:
    """Return a walk as one page; `LogRefused` where it cannot be one."""
    pack = await reviews.answer(job)
    timeline = await reviews.answer(TimelineJob(job.log))
    estimator = unpacked(pack)[0].estimator
    course = await _if_any(reviews, CourseJob(job.log, estimator))
    thumbnails = await _if_any(reviews, ThumbnailsJob(job.log)) if job.pictures else None
    return await asyncio.to_thread(exporter.page, name, pack, timeline, course, thumbnails)


async def _if_any(reviews: Reviews, job: Job) -> bytes | None:
    """Return what makes a page richer; None where a walk has no such thing."""
    try:
        return await reviews.answer(job)
    except LogRefused:
        return None
