"""The start page: the square to turn about, to stand in, and to ask how well it is known."""

import re
from collections.abc import Iterator

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.pages import SIZE_PX, ArPage, Pixels, open_page

pytestmark = pytest.mark.browser

EMPTY = """() => {
    for (const panel of document.querySelectorAll("header, footer")) panel.style.visibility = "hidden";
}"""


@pytest.fixture
def home(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The start page, everything in."""
    with open_page(browser, locale="en-GB") as page:
        page.page.goto(showing.url)
        settle(page)
        yield page
        assert page.errors == []


def settle(page: ArPage) -> None:
    """Wait until all that was asked for is drawn."""
    page.ask("agora.ready")
    page.until("agora.stats().whole")


def picture(page: ArPage) -> Pixels:
    """Return what is drawn, without the panels, red first."""
    page.ask(EMPTY)
    settle(page)
    shot = cv2.imdecode(np.frombuffer(page.page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert shot is not None
    return np.asarray(shot[..., ::-1], np.uint8)


def stand(page: ArPage, view: str) -> None:
    """Go to a stop of the tour."""
    page.ask("id => { const tour = document.querySelector('#tour'); tour.value = id; tour.onchange(); }", view)
    settle(page)


def test_one_material_of_one_level_is_one_draw_call(home: ArPage) -> None:
    stats = home.ask("agora.stats()")
    assert 0 < stats["drawCalls"] <= 3 * 3 + 1  # three materials at three levels, and the sky
    assert stats["triangles"] > 500


def test_a_stop_of_the_tour_is_another_view_with_its_words(home: ArPage) -> None:
    above = picture(home)
    stand(home, "temple")
    assert np.abs(picture(home).astype(float) - above).mean() > 10.0
    assert "temple" in home.ask("document.querySelector('#guide').textContent").lower()
    stand(home, "")
    assert np.abs(picture(home).astype(float) - above).mean() < 2.0


def test_the_tint_is_told_in_words_and_seen(home: ArPage) -> None:
    assert not home.page.is_visible("#legend")
    home.page.check("#evidence")
    legend = home.page.inner_text("#legend").splitlines()
    assert [line.partition(":")[0].lower() for line in legend] == ["attested", "inferred", "hypothetical"]
    tinted = picture(home).astype(int)
    yellow = (tinted[..., 0] > tinted[..., 2] + 60) & (tinted[..., 1] > tinted[..., 2] + 40)
    magenta = (tinted[..., 0] > tinted[..., 1] + 40) & (tinted[..., 2] > tinted[..., 1] + 20)
    assert yellow.mean() > 0.005
    assert magenta.mean() > 0.02
    home.ask("() => { const box = document.querySelector('#evidence'); box.checked = false; box.onchange(); }")
    plain = picture(home).astype(int)
    magenta = (plain[..., 0] > plain[..., 1] + 40) & (plain[..., 2] > plain[..., 1] + 20)
    assert magenta.mean() < 0.001


def test_the_address_can_ask_for_view_and_tint(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}?evidence=1&view=basilica")
        settle(page)
        assert page.page.is_checked("#evidence")
        assert page.page.input_value("#tour") == "basilica"
        assert page.page.is_visible("#legend")


def test_a_click_on_a_building_tells_of_it_and_offers_what_scholars_disagree_on(home: ArPage) -> None:
    stand(home, "memmius")
    home.ask(EMPTY)
    width, height = SIZE_PX
    assert not home.page.is_visible("#card")
    home.page.mouse.click(width / 2, 0.45 * height)
    assert "Memmius" in home.page.inner_text("#card-name")
    assert len(home.page.inner_text("#card-caption")) > 40
    assert re.match(r"(The \w+: )?(Attested|Inferred|Hypothetical): ", home.page.inner_text("#card-evidence"))
    assert "Memmius" in home.page.inner_text("#card-source") or "Forschungen" in home.page.inner_text("#card-source")
    options = home.ask("[...document.querySelector('#variant').options].map((option) => option.value)")
    now = home.page.input_value("#variant")
    assert now in options
    assert len(options) >= 2
    before = picture(home)
    home.page.select_option("#variant", next(option for option in options if option != now))
    changed = np.abs(picture(home).astype(float) - before).max(axis=-1) > 30.0
    assert changed.mean() > 0.02
    home.page.click("#card-close")
    assert not home.page.is_visible("#card")


def test_a_site_without_today_offers_no_choice_of_time(home: ArPage) -> None:
    assert not home.page.is_visible("#models")


def test_a_model_that_does_not_come_is_said_in_a_sentence(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}?model=today")
        page.until("document.querySelector('#notice').textContent.startsWith('The model of the square could not')")


def test_a_finer_level_that_does_not_come_leaves_the_coarse_one(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.route("**/models/roman.0.glb", lambda route: route.fulfill(status=404))
        page.page.goto(showing.url)
        settle(page)
        assert page.ask("agora.stats().triangles") > 500
        assert not page.page.is_visible("#notice")
