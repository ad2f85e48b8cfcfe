"""What a replay's page asks of the server: who may have it, worked out in a process of its own, and once."""

import asyncio
from collections.abc import Iterator
from pathlib import Path
from time import monotonic_ns

import httpx
import pytest

from server.access import Access
from server.errors import LogRefused
from server.options import SITE
from server.reviewing.jobs import CourseJob, Job, TimelineJob
from server.reviewing.reviews import Reviews
from server.sessions import Sessions
from server.web_server import WebServer
from tests.server.serving import ACCESS, serving, token
from tests.walks import write_walk


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Five seconds with pictures."""
    return write_walk(tmp_path_factory.mktemp("logs") / "wall.mcap", 5.0, pictures=True)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory, log: Path) -> Iterator[WebServer]:
    """A server that asks for tokens and replays the walk, its rig still on its way; and a walk that nobody recorded."""
    sessions = Sessions(monotonic_ns)
    sessions.open("wall").expect({"kind": "replay", "log": "wall"})
    sessions.open("live").expect({"kind": "live"})
    access = Access(ACCESS.signer, ACCESS.codes)
    folder = tmp_path_factory.mktemp("server")
    with serving(folder, access=access, sessions=sessions, logs={"wall": log}, site_folder=SITE) as served:
        yield served


def ask(server: WebServer, what: str, shown: str | None) -> httpx.Response:
    headers = {} if shown is None else {"Authorization": f"Bearer {shown}"}
    with httpx.Client(trust_env=False, timeout=120.0, headers=headers) as client:
        return client.get(f"{server.url}api/replays/{what}")


def test_who_watches_has_events_and_curves_but_no_pictures_and_no_recording(server: WebServer) -> None:
    watching = token("viewer", "wall")
    timeline = ask(server, "wall/timeline", watching)
    assert timeline.headers["content-type"] == "application/json"
    assert len(timeline.json()["pictures_s"]) == 60
    assert ask(server, "wall/course?estimator=truth", watching).json()["figures"]["estimator"] == "truth"
    assert ask(server, "wall/thumbnails", watching).status_code == 403
    assert ask(server, "wall/page", watching).status_code == 403


def test_the_walker_has_the_pictures(server: WebServer) -> None:
    answer = ask(server, "wall/thumbnails", token("rig", "wall"))
    assert answer.headers["content-type"] == "image/jpeg"
    assert answer.content.startswith(b"\xff\xd8")


@pytest.mark.parametrize("what", ["timeline", "thumbnails", "course?estimator=truth", "page"])
def test_nobody_else_has_anything(server: WebServer, what: str) -> None:
    assert ask(server, f"wall/{what}", None).status_code == 401
    assert ask(server, f"wall/{what}", token("viewer", "live")).status_code == 403


@pytest.mark.parametrize(
    ("what", "status", "words"),
    [
        ("nobody/timeline", 404, "No recorded walk"),
        ("live/timeline", 404, "No recorded walk"),
        ("wall/course?estimator=kalman", 422, "choose one of"),
        ("wall/course", 422, ""),
        ("wall/page?max_mb=1", 422, ""),
        ("wall/page?pictures=true", 403, "does not share"),
    ],
)
def test_what_cannot_be_had_is_refused_with_the_reason(server: WebServer, what: str, status: int, words: str) -> None:
    answer = ask(server, what, token("operator"))
    assert answer.status_code == status
    assert words in str(answer.json()["detail"])


def test_an_answer_is_worked_out_once_and_anew_for_another_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Job] = []

    def worked_out(job: Job) -> bytes:
        asked.append(job)
        return b"{}"

    async def ask_all() -> None:
        assert await reviews.answer(job) == b"{}"
        await reviews.answer(job)
        await reviews.answer(CourseJob(str(path), "truth"))
        assert len(asked) == 2
        path.write_bytes(b"another")
        await reviews.answer(job)
        assert len(asked) == 3

    reviews = Reviews(10**9)
    monkeypatch.setattr(reviews, "_ask", worked_out)
    path = tmp_path / "walk.mcap"
    path.write_bytes(b"1")
    job = TimelineJob(str(path))
    asyncio.run(ask_all())


def test_a_file_that_is_no_walk_is_refused_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "no.mcap"
    path.write_bytes(b"nothing of a walk")
    with pytest.raises(LogRefused, match="The walk is not an MCAP file") as refused:
        asyncio.run(Reviews(2 * 10**9).answer(TimelineJob(str(path))))
    assert refused.value.status == 422
