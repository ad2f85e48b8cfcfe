"""The page that shows what is covered, in a real browser and without one."""

from time import monotonic

import httpx
import numpy as np
from playwright.sync_api import Browser, Page

from server.calibrating.lens_run import Collection
from server.calibrating.page import coverage_app
from server.web_server import WebServer
from tests.tracker.calibrate.board_video import BoardVideo, shown_around
from tests.tracker.calibrate.board_walk import CAMERA
from tracker.calibrate.board import Board
from tracker.measurements import Frame
from tracker.pictures import ArrayPicture, EncodedPicture


def collected(count: int) -> Collection:
    video = BoardVideo(CAMERA, seed=2)
    collection = Collection(video.board)
    for i, (R, p) in enumerate(shown_around(video, count)):
        collection.step(video.frame(i * 1_000_000_000, R, p, i))
    return collection


def test_hints_lead_from_nothing_to_enough() -> None:
    collection = Collection(Board())
    assert "Show the board" in collection.hint()
    blank = ArrayPicture(np.full((480, 640, 3), 90, np.uint8))
    collection.step(Frame(0, 0, 0, blank))
    collection.step(Frame(1, 1, 1, EncodedPicture(b"broken")))
    assert collection.state()["pictures"] == 1
    assert collection.state()["board_seen"] is False
    some = collected(8)
    assert "Bring the board to the " in some.hint()
    assert 0.1 < some.coverage < 0.85
    many = collected(80)
    assert many.is_enough()
    assert many.hint() == "That is enough."


def until(page: Page, expression: str) -> None:
    """Wait until an expression is true; the page's own rules forbid Playwright's way of asking."""
    deadline = monotonic() + 60.0
    while not page.evaluate(expression):
        assert monotonic() < deadline, expression
        page.wait_for_timeout(50)


def test_the_page_shows_picture_coverage_and_what_to_do(browser: Browser) -> None:
    collection = collected(12)
    with WebServer(coverage_app(collection)) as server:
        page = browser.new_page()
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda m: errors.append(m.text) if m.type == "error" else None)
        page.goto(server.url)
        until(page, "document.getElementById('picture').naturalWidth === 640")
        until(page, "document.querySelectorAll('#grid i').length === 48")
        assert page.inner_text("#hint") == collection.hint()
        assert page.inner_text("#views-text") == f"{len(collection.places)} of 40"
        collection.finished = True
        until(page, "document.getElementById('hint').textContent.startsWith('Done: the lens is known')")
        assert not errors
        page.close()


def test_strangers_are_turned_away_and_nothing_is_kept() -> None:
    with WebServer(coverage_app(Collection(Board()))) as server, httpx.Client(base_url=server.url) as client:
        assert client.get("/state.json").headers["content-security-policy"]
        assert client.get("/picture.jpg").status_code == 204
        assert client.get("/", headers={"host": "evil.example"}).status_code == 403
        assert client.get("/").headers["cache-control"] == "no-store"
        for path in ("/", "/calibrate.js", "/calibrate.css"):
            assert "http" not in client.get(path).text
