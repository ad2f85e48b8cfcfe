"""The start page: the square to move through and to look at, a guide, and the tools beside it."""

import re
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from playwright.sync_api import Browser, Route

from server.showing import Showing
from tests.web.pages import SIZE_PX, ArPage, Pixels, open_page

pytestmark = pytest.mark.browser

PAVING_M = 0.0
"""Height of the plain square's own volume."""
BARE = "bare => document.body.classList.toggle('bare', bare)"


@pytest.fixture
def home(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The start page, everything in."""
    with open_page(browser, locale="en-GB", permissions=["clipboard-read", "clipboard-write"]) as page:
        page.page.goto(f"{showing.url}?walkers=0")
        page.settle()
        yield page
        assert page.errors == []


def picture(page: ArPage) -> Pixels:
    """Return what is drawn, without the panels, red first."""
    page.ask(BARE, True)
    page.settle()
    shot = decoded(page.page.screenshot())
    page.ask(BARE, False)
    return shot


def decoded(data: bytes) -> Pixels:
    """Return a PNG's pixels, red first."""
    shot = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    assert shot is not None
    return np.asarray(shot[..., ::-1], np.uint8)


def difference(a: Pixels, b: Pixels) -> float:
    """Return how much two pictures differ, levels of 256."""
    return float(np.abs(a.astype(float) - b).mean())


def place_of(page: ArPage) -> tuple[float, float, float]:
    """Return where the eye is, site frame."""
    T = page.ask("agora.pose().T_site_cam")
    return T[3], T[7], T[11]


@pytest.mark.parametrize("address", ["", "ar", "replay/walk"])
def test_before_any_script_a_page_shows_what_is_coming_without_a_word_of_another_language(
    browser: Browser, showing: Showing, address: str
) -> None:
    with open_page(browser, java_script_enabled=False) as page:
        page.page.goto(f"{showing.url}{address}")
        assert page.page.locator("#arrival svg").is_visible()
        words = re.findall(r"[^\W\d]+", page.page.inner_text("body"))
        assert {word.lower() for word in words} == {"agora"}


def test_until_the_first_picture_a_page_says_that_it_comes_and_how_far_it_is(
    browser: Browser, showing: Showing
) -> None:
    held: list[Route] = []
    with open_page(browser, locale="tr-TR", service_workers="block") as page:
        page.page.route("**/*.glb*", lambda route: held.append(route))
        page.page.goto(f"{showing.url}?walkers=0")
        page.until("document.querySelector('#arrival-bar').value > 0")
        assert page.page.inner_text("#arrival p") == "Meydan yolda …"
        for route in held:
            route.continue_()
        page.page.unroute("**/*.glb*")
        page.settle()
        assert page.page.locator("#arrival").is_hidden()
        assert page.ask("document.querySelector('#arrival-bar').value") == pytest.approx(0.8)


def test_one_material_of_one_level_is_one_draw_call(home: ArPage) -> None:
    stats = home.ask("agora.stats()")
    assert 0 < stats["drawCalls"] <= 3 * 3 + 1  # three materials at three levels, and the sky
    assert stats["triangles"] > 500


def test_an_address_shows_a_stop_of_the_tour_and_the_plain_one_the_whole_square(home: ArPage) -> None:
    above = picture(home)
    home.go("view=temple")
    assert difference(picture(home), above) > 10.0
    home.go("")
    assert difference(picture(home), above) < 2.0


def test_the_guide_flies_from_stop_to_stop_and_tells_of_them_by_keyboard_alone(home: ArPage) -> None:
    home.page.focus("#tour-open")
    home.page.keyboard.press("Enter")
    assert home.page.inner_text("#tour-number").startswith("1 of ")
    first = home.page.inner_text("#tour-text")
    assert "Welcome" in first
    home.page.focus("#tour-play")
    home.page.keyboard.press("Enter")
    assert home.page.get_attribute("#tour-play", "aria-label") == "Play the tour"
    home.settle()
    before = place_of(home)
    home.page.keyboard.press("Tab")
    home.page.keyboard.press("Enter")
    assert home.page.inner_text("#tour-number").startswith("2 of ")
    assert home.page.inner_text("#tour-text") != first
    home.settle()
    assert np.linalg.norm(np.subtract(place_of(home), before)) > 20.0
    home.page.focus("#tour-end")
    home.page.keyboard.press("Enter")
    assert not home.page.is_visible("#tour")


def test_the_tint_is_told_in_words_and_seen(home: ArPage) -> None:
    assert not home.page.is_visible("#legend")
    home.page.click("#evidence")
    legend = home.page.inner_text("#legend").splitlines()
    assert [line.partition(":")[0].lower() for line in legend] == ["attested", "inferred", "hypothetical"]
    tinted = picture(home).astype(int)
    yellow = (tinted[..., 0] > tinted[..., 2] + 60) & (tinted[..., 1] > tinted[..., 2] + 40)
    assert yellow.mean() > 0.005
    assert magenta(tinted) > 0.02
    home.page.click("#evidence")
    assert magenta(picture(home).astype(int)) < 0.001


def magenta(pixels: Pixels) -> float:
    """Return the share of magenta."""
    return float(((pixels[..., 0] > pixels[..., 1] + 40) & (pixels[..., 2] > pixels[..., 1] + 20)).mean())


def test_a_question_in_the_address_can_ask_for_view_and_tint(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}?walkers=0&evidence=1&view=basilica")
        page.settle()
        assert page.page.get_attribute("#evidence", "aria-pressed") == "true"
        assert place_of(page)[:2] == pytest.approx((-18.0, -16.0))
        assert page.page.is_visible("#legend")


def test_a_click_on_a_building_tells_of_it_and_offers_what_scholars_disagree_on(home: ArPage) -> None:
    home.go("view=memmius")
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
    home.page.keyboard.press("Escape")
    assert not home.page.is_visible("#card")


def test_a_building_is_found_by_some_letters_of_its_name_and_flown_to(home: ArPage) -> None:
    before = place_of(home)
    home.page.click("[data-opens=places]")
    home.page.fill("#places-find", "MEMM")
    names = home.ask("[...document.querySelectorAll('#places-list button')].map((one) => one.firstChild.data)")
    assert len(names) == 1
    home.page.keyboard.press("Enter")
    home.settle()
    assert home.page.inner_text("#card-name") == names[0]
    assert not home.page.is_visible("#places")
    assert np.linalg.norm(np.subtract(place_of(home), before)) > 50.0


def test_the_light_follows_the_hour(home: ArPage) -> None:
    day = picture(home)
    home.page.click("[data-opens=light]")
    home.page.locator("#hour").fill("19.75")
    assert home.page.inner_text("#hour-words") == "19:45"
    home.page.keyboard.press("Escape")
    evening = picture(home)
    assert evening.mean() < 0.8 * day.mean()


def test_the_tape_measures_between_two_clicks(home: ArPage) -> None:
    home.go("view=square")
    width, height = SIZE_PX
    home.page.keyboard.press("m")
    points = [(share * width, 0.65 * height) for share in (0.45, 0.55)]
    for point in points:
        home.page.mouse.click(*point)
    told = home.page.inner_text("#toast")
    far, level, high = (float(number) for number in re.findall(r"(\d+\.\d\d) m", told))
    T = np.reshape(home.ask("agora.pose().T_site_cam"), (4, 4))
    focal_px = height / 2.0 / np.tan(np.radians(46.7 / 2.0))
    rays = [T[:3, :3] @ np.array([x - width / 2.0, y - height / 2.0, focal_px]) for x, y in points]
    a, b = (T[:3, 3] + ray * (PAVING_M - T[2, 3]) / ray[2] for ray in rays)
    assert far == pytest.approx(np.linalg.norm(b - a), rel=0.02)
    assert np.hypot(level, high) == pytest.approx(far, abs=0.02)
    assert home.page.inner_text("#marks").strip() == f"{far:.2f} m"
    home.page.keyboard.press("m")
    assert not home.page.is_visible("#toast")


def test_a_link_opened_anew_shows_the_same_and_a_picture_is_saved(
    home: ArPage, browser: Browser, tmp_path: Path
) -> None:
    home.go("at=-20,-30,12&look=20,-15&way=fly&evidence=1&hour=16.5")
    home.page.click("#share-link")
    link = home.ask("navigator.clipboard.readText()")
    assert link == home.ask("location.href")
    seen = picture(home)
    with open_page(browser, locale="en-GB") as page:
        page.page.goto(link.replace("#", "?walkers=0#"))
        page.settle()
        assert page.ask("agora.pose().T_site_cam") == pytest.approx(home.ask("agora.pose().T_site_cam"), abs=1e-3)
        for figure in ("drawCalls", "triangles", "model", "way"):
            assert page.stats()[figure] == home.stats()[figure], figure
        assert difference(picture(page), seen) < 1.0
    with home.page.expect_download() as download:
        home.page.click("#photograph")
    download.value.save_as(tmp_path / "view.png")
    saved = decoded((tmp_path / "view.png").read_bytes())
    assert saved.shape == seen.shape
    assert difference(saved, seen) < 3.0  # it is signed


def test_a_site_without_today_or_ground_offers_neither(home: ArPage) -> None:
    assert not home.page.is_visible("#epochs")
    assert home.page.is_disabled("[data-way=walk]")


def test_a_model_that_does_not_come_is_said_in_a_sentence(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}?walkers=0&model=today")
        page.until("document.querySelector('#notice').textContent.startsWith('The model of the square could not')")


def test_a_finer_level_that_does_not_come_leaves_the_coarse_one(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.route("**/models/roman.0.glb*", lambda route: route.fulfill(status=404))
        page.page.goto(f"{showing.url}?walkers=0")
        page.settle()
        assert page.ask("agora.stats().triangles") > 500
        assert not page.page.is_visible("#notice")
