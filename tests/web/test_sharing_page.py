"""A browser on a server that asks for tokens: it enters once, and the walker's switch says who sees the picture."""

from collections.abc import Iterator
from pathlib import Path

import cv2
import httpx
import numpy as np
import pytest
from playwright.sync_api import Browser

from server.access import Access
from server.app import create_app
from server.options import WEB
from server.push import RigLink
from server.web_server import WebServer
from server.wire import encode_frame
from tests.server.serving import token, until
from tests.server.wire_examples import example_frame
from tests.web.pages import ArPage, open_page

pytestmark = pytest.mark.browser

MARK = "document.querySelector('#sharing:not([hidden])')?.textContent ?? ''"


@pytest.fixture
def server(tmp_path: Path) -> Iterator[WebServer]:
    access = Access.with_secret(bytes(32))
    with WebServer(create_app(web_folder=WEB, models_folder=tmp_path, site={}, access=access)) as running:
        yield running


@pytest.fixture
def link(server: WebServer) -> Iterator[RigLink]:
    """A rig with an orange picture."""
    jpeg = cv2.imencode(".jpg", np.full((480, 640, 3), (0, 128, 255), np.uint8))[1].tobytes()
    with RigLink(server.rig_url("walk"), token("rig", "walk"), lambda request: pytest.fail("not the walk's")) as rig:
        until(lambda: rig.connected)
        rig.send_state({"kind": "live"})
        rig.send_frame(encode_frame(example_frame(1), jpeg))
        yield rig


@pytest.fixture
def walker(browser: Browser) -> Iterator[ArPage]:
    with open_page(browser) as page:
        yield page


@pytest.fixture
def guest(browser: Browser) -> Iterator[ArPage]:
    with open_page(browser) as page:
        yield page


def enter(page: ArPage, server: WebServer, shown: str) -> None:
    """Open the one-time address that a token's owner gets."""
    bearer = {"Authorization": f"Bearer {shown}"}
    path = httpx.post(f"{server.url}api/codes", headers=bearer, trust_env=False).json()["path"]
    page.page.goto(server.url.rstrip("/") + path)


def colour_of(page: ArPage) -> list[int]:
    colour: list[int] = page.ask("Array.from(agora.readPixels(320, 240, 1, 1)).slice(0, 3)")
    return colour


def test_the_walker_sees_the_picture_and_others_while_it_is_shared(
    server: WebServer, link: RigLink, walker: ArPage, guest: ArPage
) -> None:
    enter(walker, server, token("rig", "walk"))
    enter(guest, server, token("viewer", "walk"))
    for page in (walker, guest):
        assert page.page.url == f"{server.url}ar?session=walk", "the code is gone from the address"
        assert page.ask("document.cookie") == "", "no script reads the cookie"
        page.until("globalThis.agora?.stats().framesDrawn >= 1")
    assert colour_of(walker)[0] > 200
    assert max(colour_of(guest)) - min(colour_of(guest)) < 5, "an empty picture is grey"
    guest.until(f"{MARK}.includes('private')")
    assert not guest.page.is_visible("#share")
    walker.page.click("#share")
    guest.until(f"{MARK}.includes('Everybody')")
    guest.until("Array.from(agora.readPixels(320, 240, 1, 1))[0] > 200")
    walker.until(f"{MARK}.includes('Everybody')")
    walker.page.click("#share")
    guest.until("Array.from(agora.readPixels(320, 240, 1, 1))[0] < 120")


def test_a_page_without_a_token_says_how_to_enter(server: WebServer, guest: ArPage) -> None:
    guest.page.goto(f"{server.url}ar?session=walk")
    guest.until("document.body.innerText.includes('/enter')")
    guest.page.goto(server.url)
    guest.page.press("#live-open", "Enter")
    guest.page.press("#enter a", "Enter")  # there is no model here, and the notice of that is in the way of a click
    guest.page.fill("#token", token("viewer"))
    guest.page.click("button")
    guest.page.wait_for_url(server.url)
    guest.until("document.querySelector('#enter').hidden")
    assert [error for error in guest.errors if "Content Security Policy" in error or "Content-Security" in error] == []
