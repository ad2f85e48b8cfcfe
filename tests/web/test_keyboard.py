"""The pages by keyboard alone: everything is reached, what has the focus is seen, and a landmark and a place can be pointed out."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.walk import NAME

pytestmark = pytest.mark.browser

MOST_TABS = 80
REACHABLE = """() => [...document.querySelectorAll("a[href], button, select, input, summary, canvas, svg, [tabindex]")]
    .filter((one) => one.tabIndex >= 0 && !one.disabled && !one.closest("[inert]")
        && (one.type !== "radio" || one.checked)
        && one.checkVisibility({ visibilityProperty: true }))
    .map((one) => one.id || one.className.baseVal || one.className || one.tagName)"""
FOCUSED = """() => {
    const one = document.activeElement;
    const { outlineStyle, outlineWidth } = getComputedStyle(one);
    const isSeen = outlineStyle !== "none" && parseFloat(outlineWidth) >= 2;
    return one === document.body ? null : [one.id || one.className.baseVal || one.className || one.tagName, isSeen];
}"""


@pytest.fixture
def ar(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The AR page, paused."""
    with open_page(browser, locale="en-GB") as page:
        page.page.goto(f"{showing.url}ar")
        page.until_drawn()
        if page.ask("agora.session().playback.playing"):
            page.pause()
        yield page


@pytest.mark.parametrize(
    ("path", "is_there"),
    [
        ("", "agora.stats()?.triangles > 0"),
        ("ar", "agora.stats()?.framesDrawn > 0"),
        (f"replay/{NAME}", "agora.stats()?.framesDrawn > 0"),
    ],
    ids=["start", "ar", "replay"],
)
def test_tab_reaches_everything_and_what_has_the_focus_is_seen(
    browser: Browser, showing: Showing, path: str, is_there: str
) -> None:
    with open_page(browser, locale="en-GB") as page:
        page.page.goto(showing.url + path)
        page.until(f"globalThis.agora && {is_there}")
        reached: list[str] = []
        for _ in range(MOST_TABS):
            page.page.keyboard.press("Tab")
            focused = page.ask(FOCUSED)
            if focused is None:
                break
            name, is_seen = focused
            assert is_seen, f"{name} has the focus, and nobody sees it"
            reached.append(name)
        assert reached[0] == "skip"
        assert set(page.ask(REACHABLE)) - set(reached) == set()


def test_a_landmark_is_pointed_out_by_keys(ar: ArPage) -> None:
    keys = ar.page.keyboard
    keys.press("a")
    assert ar.ask("document.activeElement.id") == "view"
    assert ar.page.get_attribute("#view", "role") == "application"
    for key in ("ArrowRight", "Shift+ArrowUp", "ArrowLeft"):
        keys.press(key)
    mark = ar.ask("(({ left, top }) => [parseFloat(left), parseFloat(top)])(document.querySelector('#mark').style)")
    assert mark == [320.0, 240.0 - 48.0]
    keys.press("Enter")
    landmark = ar.ask("document.activeElement.dataset.landmark")
    assert landmark
    keys.press("Enter")
    ar.replied("align")
    tap = next(message["value"] for message in ar.sent if message.get("action") == "align")
    assert tap["kind"] == "tap"
    assert abs(tap["place_px"][0] - 320.0) < 2.0
    assert abs(tap["place_px"][1] - 192.0) < 2.0
    keys.press("Escape")
    assert ar.page.get_attribute("#view", "role") == "img"
    assert not ar.page.is_visible("#aligning")


def test_ones_place_is_shown_on_the_plan_by_keys(ar: ArPage) -> None:
    ar.page.keyboard.press("a")
    ar.page.focus("#here")
    ar.page.keyboard.press("Enter")
    ar.page.focus("#stand svg")
    ar.page.keyboard.press("ArrowUp")
    ar.page.keyboard.press("Enter")
    ar.replied("align")
    here = next(message["value"] for message in ar.sent if message.get("action") == "align")
    place = ar.ask("agora.pose().T_site_cam")
    assert here["kind"] == "here"
    assert here["e_m"] == pytest.approx(place[3], abs=0.01)
    assert here["n_m"] == pytest.approx(place[7] + 90.0 / 40.0, abs=0.01)
