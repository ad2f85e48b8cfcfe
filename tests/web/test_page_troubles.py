"""The pages when something is amiss, and that they never ask anybody but their own server."""

import struct
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser, WebSocketRoute

from assets.levels import LEVELS
from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.tampering import Tampering
from tests.web.walk import CORNERS, NAME, make_site, position_of, showing_in, write_log

pytestmark = pytest.mark.browser

PLAIN_FRAME = 12
NAN = struct.pack("<d", float("nan"))


@pytest.fixture
def ar(browser: Browser) -> Iterator[ArPage]:
    """An empty page, without a model: none of these tests looks at the square."""
    with open_page(browser) as page:
        page.page.route("**/models/*", lambda route: route.fulfill(status=404))
        yield page


@pytest.mark.parametrize(
    ("offset", "patch"),
    [(0, b"AGF9"), (4, b"\0\0"), (32, NAN), (292, b"\0\0"), (384, b"\0\0"), (392, b"\0" * 4096)],
    ids=["magic", "header", "pose", "size", "JPEG's start", "JPEG's tables"],
)
def test_a_malformed_frame_is_left_out_and_the_page_goes_on(
    ar: ArPage, showing: Showing, offset: int, patch: bytes
) -> None:
    between = Tampering(ar.page, offset, patch)
    ar.page.goto(f"{showing.url}ar")
    ar.until("globalThis.agora && agora.stats().framesDrawn >= 6")  # more than the server lets go unacknowledged
    assert len(between.patched) >= 4
    ar.until("document.querySelector('#notice').textContent.startsWith('What arrives cannot be read')")
    assert ar.stats()["framesDrawn"] <= len(between.whole)
    assert ar.stats()["mismatchedFrames"] == 0
    assert [error for error in ar.errors if "404" not in error] == []


def test_a_pose_of_another_picture_is_counted_and_not_drawn(ar: ArPage, showing: Showing) -> None:
    Tampering(ar.page, 12, b"\xff\xff\0\0", every=1)
    ar.page.goto(f"{showing.url}ar")
    ar.until("globalThis.agora && agora.stats().framesDrawn >= 2")
    stats = ar.stats()
    assert stats["mismatchedFrames"] == stats["framesDrawn"]
    assert (stats["posesDrawn"], stats["overlay"], stats["lastPoseFrameId"]) == (0, "none", 65535)
    assert ar.ask("agora.project([0, 0, 0])") is None


@pytest.mark.parametrize(
    ("quarter_turns", "top_left", "top_right"),
    [(0, "top left", "top right"), (1, "bottom left", "top left"), (3, "top right", None), (2, None, "bottom left")],
)
def test_a_picture_on_its_side_is_turned_upright(
    ar: ArPage, showing: Showing, quarter_turns: int, top_left: str | None, top_right: str | None
) -> None:
    Tampering(ar.page, 298, bytes([quarter_turns]), every=1)
    ar.page.goto(f"{showing.url}ar")
    ar.until("globalThis.agora && agora.stats().framesDrawn >= 1")
    ar.page.keyboard.press("h")
    shot = cv2.imdecode(np.frombuffer(ar.page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert shot is not None
    left = 0 if quarter_turns % 2 == 0 else 140  # on its side the picture is 360 wide in a window of 640
    expect_corner(shot[10, left + 10, ::-1], top_left)
    expect_corner(shot[10, 639 - left - 10, ::-1], top_right)
    if left:
        assert shot[10, left - 10].max() < 20


def expect_corner(rgb: object, name: str | None) -> None:
    """Check a pixel against a corner's colour, or against the grey of the fourth."""
    pixel = np.asarray(rgb, float)
    if name is None:
        assert np.ptp(pixel) < 12
    else:
        assert np.abs(pixel - CORNERS[name]).max() < 30, (name, pixel)


@pytest.mark.parametrize(
    ("path", "words"), [("replay/tuesday", "no walk named tuesday"), ("ar?session=tuesday", "no walk named tuesday")]
)
def test_a_session_that_is_not_there_is_said_in_a_sentence(ar: ArPage, showing: Showing, path: str, words: str) -> None:
    ar.page.goto(f"{showing.url}{path}")
    ar.until(
        f"document.querySelector('#notice').textContent.includes({words!r})"
    )  # before it perhaps that no model came
    assert ar.page.is_visible("#notice")
    assert not ar.page.is_visible("#bar")
    assert not ar.page.is_visible("#hud")
    assert ar.ask("[agora.pose(), agora.project([0, 0, 0]), agora.stats().lastFrameId]") == [None, None, None]


def test_nobody_walking_is_said_in_a_sentence(ar: ArPage, showing: Showing) -> None:
    ar.page.route("**/api/sessions", lambda route: route.fulfill(json={"sessions": []}))
    ar.page.goto(f"{showing.url}ar")
    ar.until("document.querySelector('#notice').textContent.startsWith('Nobody is walking')")
    ar.page.goto(showing.url)
    ar.until("document.querySelector('#walks-note').textContent.startsWith('No walk')")


def test_a_server_that_has_gone_is_said_in_a_sentence(ar: ArPage, showing: Showing) -> None:
    ar.page.route_web_socket("**/ws/view/**", lambda route: route.close(code=1011))
    ar.page.goto(f"{showing.url}ar")
    ar.until("document.querySelector('#notice').textContent.startsWith('The connection is lost')")


def test_a_connection_that_was_cut_comes_back_by_itself(ar: ArPage, showing: Showing) -> None:
    routes: list[WebSocketRoute] = []

    def join(route: WebSocketRoute) -> None:
        routes.append(route)
        if len(routes) != 2:
            route.connect_to_server()
        else:
            route.close(code=1011)

    ar.page.route_web_socket("**/ws/view/**", join)
    ar.page.goto(f"{showing.url}ar")
    ar.until("globalThis.agora && agora.stats().framesDrawn >= 2")
    routes[0].close(code=1006 + 5)
    ar.until("document.querySelector('#notice').textContent.startsWith('The connection is lost')")
    drawn = ar.stats()["framesDrawn"]
    ar.until(f"agora.stats().framesDrawn >= {drawn + 2}")
    assert len(routes) == 3
    ar.until("!document.querySelector('#notice').textContent.startsWith('The connection is lost')")


def test_a_server_that_ends_and_begins_again_is_found_by_itself(ar: ArPage, tmp_path: Path) -> None:
    write_log(tmp_path / f"{NAME}.mcap")
    site = make_site(tmp_path)
    with showing_in(site) as first:
        ar.page.goto(f"{first.url}ar")
        ar.until("globalThis.agora && agora.stats().framesDrawn >= 2")
        port = urlsplit(first.url).port
    assert port is not None
    ar.until("document.querySelector('#notice').textContent.startsWith('The connection is lost')")
    drawn = ar.stats()["framesDrawn"]
    with showing_in(site, port):
        ar.until(f"agora.stats().framesDrawn >= {drawn + 2}")
        ar.until("!document.querySelector('#notice').textContent.startsWith('The connection is lost')")
        assert ar.stats()["mismatchedFrames"] == 0


def test_graphics_that_are_taken_away_come_back_as_they_were(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as ar:
        ar.page.goto(f"{showing.url}ar?effort=shadows")
        ar.until_drawn()
        ar.pause()
        ar.seek(position_of(PLAIN_FRAME))
        ar.until(f"agora.stats().lastFrameId === {PLAIN_FRAME}")
        before = ar.pixels()
        ar.ask(
            "() => { globalThis.lose = document.querySelector('#view').getContext('webgl2').getExtension('WEBGL_lose_context'); }"
        )
        ar.ask("lose.loseContext()")
        ar.until("document.querySelector('#notice').textContent.startsWith('The browser has stopped drawing')")
        ar.ask("lose.restoreContext()")
        ar.until("document.querySelector('#notice').hidden")
        ar.page.wait_for_timeout(300)
        assert np.abs(ar.pixels().astype(int) - before).mean() < 0.5
        assert before.std() > 10
        ar.page.click("#play")
        ar.until(f"agora.stats().lastFrameId !== {PLAIN_FRAME}")


def test_a_model_that_comes_late_is_shown_when_it_comes(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as ar:
        ar.page.route("**/models/*", lambda route: route.fulfill(status=404))
        ar.page.goto(f"{showing.url}ar")
        ar.until("document.querySelector('#notice').textContent.startsWith('The model of the square could not')")
        ar.page.unroute("**/models/*")
        ar.until("agora.stats().triangles > 0")
        ar.until("document.querySelector('#notice').hidden")


def test_text_that_cannot_be_read_is_said_and_left_out(ar: ArPage, showing: Showing) -> None:
    def join(route: WebSocketRoute) -> None:
        route.connect_to_server()
        route.send('{"type": "state", "session": 7}')
        route.send("no JSON")

    ar.page.route_web_socket("**/ws/view/**", join)
    ar.page.goto(f"{showing.url}ar")
    ar.until("document.querySelector('#notice').textContent.startsWith('What arrives cannot be read')")
    ar.until("agora.stats().framesDrawn >= 2 && agora.session() !== null")
    ar.until("!document.querySelector('#notice').textContent.startsWith('What arrives')")
    assert ar.stats()["triangles"] == 0, "without a model nothing is drawn over the picture: what is drawn is the model"
    assert [error for error in ar.errors if "404" not in error] == []


def test_a_page_that_was_frozen_goes_on_with_the_newest_picture(ar: ArPage, showing: Showing) -> None:
    ar.page.goto(f"{showing.url}ar")
    ar.until("globalThis.agora && agora.stats().framesDrawn >= 2")
    session = ar.page.context.new_cdp_session(ar.page)
    session.send("Page.setWebLifecycleState", {"state": "frozen"})
    ar.page.wait_for_timeout(1500)
    session.send("Page.setWebLifecycleState", {"state": "active"})
    drawn = ar.stats()["framesDrawn"]
    ar.until(f"agora.stats().framesDrawn >= {drawn + 3}")
    assert not ar.ask("document.querySelector('#notice').textContent.startsWith('No pictures')")


def test_a_clock_that_is_wrong_by_an_hour_is_said_and_put_right(ar: ArPage, showing: Showing) -> None:
    ar.page.add_init_script("{ const now = Date.now; Date.now = () => now() - 3600_000; }")
    ar.page.goto(f"{showing.url}ar")
    ar.until("document.querySelector('#toast').textContent.includes('clock is 60 minutes behind')")
    ar.until("globalThis.agora && agora.stats().framesDrawn >= 2")


def test_without_its_model_the_page_still_shows_the_pictures(ar: ArPage, showing: Showing) -> None:
    ar.page.goto(f"{showing.url}replay/{NAME}")
    ar.until("globalThis.agora && agora.stats().framesDrawn > 0")
    ar.until("document.querySelector('#notice').textContent.startsWith('The model of the square could not')")
    ar.ask("agora.ready")


def test_without_webgl_both_pages_say_so(ar: ArPage, showing: Showing) -> None:
    ar.page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    for path in ("ar", ""):
        ar.page.goto(showing.url + path)
        ar.until("document.querySelector('#notice').textContent.includes('WebGL 2')")
        assert ar.ask("[agora.stats(), agora.pose(), agora.project([0, 0, 0])]") == [None, None, None]


def test_every_request_goes_to_the_pages_own_server(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as ar:
        ar.page.goto(showing.url)
        ar.ask("agora.ready")
        ar.until("agora.stats().whole")
        ar.until("document.querySelector('#walks a') !== null")
        assert "OpenStreetMap" in ar.page.inner_text("#credit")
        ar.page.click("#live-open")
        ar.page.click("#walks a")
        ar.until_drawn()
        assert ar.page.url == f"{showing.url}replay/{NAME}"
        assert "ODbL" in ar.page.inner_text("#credit")
        own = (showing.url, showing.url.replace("http", "ws", 1), f"blob:{showing.url}")
        assert [url for url in ar.requests if not url.startswith(own)] == []
        assert any(url.endswith(f"/ws/view/{NAME}") for url in ar.requests)
        for level in LEVELS:
            assert any(f"/models/roman.{level}.glb?v=" in url for url in ar.requests)
        assert ar.errors == []
