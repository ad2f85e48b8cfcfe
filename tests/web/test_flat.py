"""The start page in a browser that cannot draw in three dimensions: the square as a plan, a list and a text."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.pages import ArPage, open_page

pytestmark = pytest.mark.browser

NO_WEBGL = """
    const real = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return /webgl/.test(kind) ? null : real.call(this, kind, ...rest);
    };
"""


@pytest.fixture
def flat(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The start page, without WebGL."""
    with open_page(browser, locale="tr-TR") as page:
        page.page.add_init_script(NO_WEBGL)
        page.page.goto(showing.url)
        page.ask("agora.ready")
        yield page
        assert page.errors == []


def test_every_monument_is_on_the_plan_and_in_the_list_with_its_text(flat: ArPage) -> None:
    monuments = flat.ask("fetch('/api/site').then((answer) => answer.json()).then(({ monuments }) => monuments)")
    listed = flat.ask(
        "[...document.querySelectorAll('#flat section:first-of-type details')].map((one) => one.textContent)"
    )
    assert len(listed) == len(monuments) > 20
    for text, monument in zip(listed, monuments, strict=True):
        assert text.startswith(monument["names"]["tr"])
        assert monument["captions"]["tr"] in text
    assert flat.ask("document.querySelectorAll('#flat .outline').length") == len(monuments)
    numbers = flat.ask("[...document.querySelectorAll('#flat .number')].map((one) => Number(one.textContent))")
    assert sorted(numbers) == list(range(1, len(monuments) + 1))


def test_a_place_of_the_plan_opens_its_text_and_the_list_marks_the_plan(flat: ArPage) -> None:
    names = flat.ask("[...document.querySelectorAll('#flat .outline title')].map((one) => one.textContent)")
    place = names.index("Bouleuterion (Odeion)")
    flat.ask(
        "(i) => document.querySelectorAll('#flat .outline')[i].dispatchEvent(new MouseEvent('click', { bubbles: true }))",
        place,
    )
    opened = "document.querySelector('#flat details[open] summary')?.textContent"
    flat.until(f"{opened} === 'Bouleuterion (Odeion)'")
    flat.until("document.querySelector('#flat .outline.read title')?.textContent === 'Bouleuterion (Odeion)'")
    assert flat.ask("document.activeElement.textContent") == "Bouleuterion (Odeion)"
    flat.page.keyboard.press("Enter")
    flat.until("document.querySelector('#flat .outline.read') === null")


def test_the_tour_can_be_read_with_what_would_be_seen(flat: ArPage) -> None:
    tour = flat.page.inner_text("#flat section:last-of-type")
    assert "Bazilikanın önünde" in tour
    assert "bakıyorsunuz. Karşınızda, " in tour
    assert not flat.page.is_visible("#tools")
    assert flat.page.is_visible("#flat select.language")
