"""The head-mounted display: nothing but the picture, and everything by one button or by looking."""

import struct
from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.tampering import Tampering

pytestmark = pytest.mark.browser

POSE = 32
"""Where it begins in a frame message."""
SHORT_MS, LONG_MS = 120, 900
APART_RAD = np.radians(16.0)
"""Between two things of the menu that hangs in the world (`gaze.ts`)."""
_GRANT = """() => {
    globalThis.asked = [];
    navigator.wakeLock.request = async (kind) => { asked.push(kind); return {}; };
    Element.prototype.requestFullscreen = async function () { asked.push("full screen"); };
}"""
_MENU = (
    "[...document.querySelectorAll('.eye')].map((eye) => [...eye.querySelectorAll('li')].map((row) => row.textContent))"
)
_AT = "document.querySelector('.eye [aria-current=true]')?.textContent"


@pytest.fixture
def ar(browser: Browser) -> Iterator[ArPage]:
    """An empty page; what it asks of the display is noted."""
    with open_page(browser) as page:
        page.page.add_init_script(f"({_GRANT})()")
        yield page
        assert page.errors == []


def looking(heading_rad: float, pitch_rad: float) -> bytes:
    """Return `T_site_cam` of a camera in the middle of the square, as a message holds it."""
    flat = np.cos(pitch_rad)
    ahead = np.array([flat * np.sin(heading_rad), flat * np.cos(heading_rad), np.sin(pitch_rad)])
    right = np.array([np.cos(heading_rad), -np.sin(heading_rad), 0.0])
    T = np.eye(4)
    T[:3, :3] = np.column_stack([right, np.cross(ahead, right), ahead])
    T[2, 3] = 1.65
    return struct.pack("<16d", *T.ravel())


def press(ar: ArPage, held_ms: int, key: str = "Enter") -> None:
    """Press the one button."""
    ar.page.keyboard.press(key, delay=held_ms)


@pytest.mark.parametrize("eyes", [1, 2])
def test_one_button_does_everything(ar: ArPage, showing: Showing, eyes: int) -> None:
    ar.page.goto(f"{showing.url}ar?display=hmd&eyes={eyes}")
    ar.until_drawn()
    assert not any(ar.page.is_visible(panel) for panel in ("header", "#hud", "#bar", "#past-control", "#look"))
    assert ar.page.is_visible("#credit")
    assert ar.ask(_MENU) == [[]] * eyes
    press(ar, SHORT_MS)
    ar.until(f"{_AT} === 'Today'")
    (menu, *others) = ar.ask(_MENU)
    assert menu[:3] == ["Today", "Sun", "How sure"]
    assert menu[-1] == "Leave"
    assert others == [menu] * (eyes - 1)
    press(ar, LONG_MS)
    ar.until("document.querySelector('#past').value === '0'")
    ar.until(f"{_MENU}[0].length === 0")
    ar.page.mouse.click(300, 200, delay=SHORT_MS)
    ar.until(f"{_AT} === 'AD 150'")
    for thing in ("Sun", "How sure", "Pause", "Leave", "AD 150", "Sun"):
        press(ar, SHORT_MS, "PageDown")
        ar.until(f"{_AT} === '{thing}'")
    press(ar, LONG_MS)
    ar.until("document.querySelector('.says').textContent.startsWith('The sun at this hour')")
    assert ar.page.input_value("#sun") == "ancient"
    assert set(ar.ask("asked")) == {"screen", "full screen"}


def test_a_look_at_the_feet_and_at_a_thing_chooses_it(ar: ArPage, showing: Showing) -> None:
    between = Tampering(ar.page, POSE, looking(1.0, -1.0), every=1)
    ar.page.goto(f"{showing.url}ar?display=hmd")
    ar.until_drawn()
    ar.until("document.querySelector('.reticle') !== null && !document.querySelector('.reticle').hidden")
    ar.page.wait_for_timeout(1700)
    between.patch = looking(1.0, 0.0)
    ar.until(f"{_MENU}[0].length === 5 && {_AT} === 'How sure'")
    between.patch = looking(1.0 - 2 * APART_RAD, 0.0)
    ar.until(f"{_AT} === 'Today'")
    ar.until("document.querySelector('#past').value === '0'")
    ar.until(f"{_MENU}[0].length === 0")


def test_an_address_that_asks_for_nonsense_is_a_display_all_the_same(ar: ArPage, showing: Showing) -> None:
    ar.page.goto(f"{showing.url}ar?display=hmd&eyes=seven&ipd=-9e99")
    ar.until_drawn()
    assert len(ar.ask(_MENU)) == 1


def test_what_is_amiss_is_said_before_the_eyes(ar: ArPage, showing: Showing) -> None:
    ar.page.route("**/models/*", lambda route: route.fulfill(status=404))
    ar.page.goto(f"{showing.url}ar?display=hmd&eyes=2")
    ar.until("globalThis.agora && agora.stats().framesDrawn > 0")
    said = "[...document.querySelectorAll('.says')].map((one) => one.textContent)"
    ar.until(f"{said}.every((text) => text.startsWith('The model of the square could not'))")
    ar.errors.clear()
