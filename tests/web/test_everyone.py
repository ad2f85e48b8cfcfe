"""Every page for everyone, in its states, themes and languages: what axe-core finds, and what a finger would miss."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.test_flat import NO_WEBGL
from tests.web.walk import NAME, ROOT

pytestmark = pytest.mark.browser

AXE = ROOT / "web" / "node_modules" / "axe-core" / "axe.min.js"
LANGUAGES = ("en-GB", "tr-TR")
THEMES = ("plain", "glare")
FIND = """() => axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) =>
    violations.filter(({ impact }) => impact === "serious" || impact === "critical").map(({ id, nodes }) =>
        `${id}: ${nodes.map(({ html, failureSummary }) => html.slice(0, 160) + " " + failureSummary).join(" | ")}`))"""


SMALL = """() => [...document.querySelectorAll("button, select, a[href], summary, input, textarea")]
    .filter((one) => one.checkVisibility({ visibilityProperty: true }) && !one.matches(".unseen, .skip, p a"))
    .map((one) => [one, (/checkbox|radio/.test(one.type) && one.closest("label")) || one])
    .map(([one, target]) => [one.id || one.className || one.tagName, target.getBoundingClientRect()])
    .filter(([, { width, height }]) => Math.min(width, height) < 43.5)
    .map(([name, { width, height }]) => `${name}: ${width} x ${height}`)"""
"""Controls that a finger would miss; links within a sentence may be as high as it is (WCAG 2.5.5)."""


@dataclass(frozen=True)
class Kind:
    """A page, when it is there, and what opens and closes its states: JavaScript that is run one after the other."""

    path: str
    is_there: str
    states: tuple[str, ...]
    has_webgl: bool = True


def click(selector: str) -> str:
    """Return JavaScript that clicks on something."""
    return f"() => document.querySelector({selector!r}).click()"


KINDS = {
    "start": Kind(
        "",
        "globalThis.agora?.stats()?.triangles > 0",
        (
            "null",
            click("[data-opens=places]"),
            click("[data-opens=light]"),
            click("[data-opens=live]"),
            click("[data-opens=help]"),
            click("#evidence"),
            click("#tour-open"),
            click("#beside summary"),
            click("#beside li button"),
        ),
    ),
    "plan": Kind("", "document.querySelector('#flat') !== null", ("null", click("#flat summary")), has_webgl=False),
    "ar": Kind(
        "ar",
        "globalThis.agora?.stats()?.framesDrawn > 0",
        ("null", click("#more"), click("#look summary"), click("#describe"), click("#align")),
    ),
    "replay": Kind(
        f"replay/{NAME}",
        "globalThis.agora?.stats()?.framesDrawn > 0",
        ("null", click("#help-open"), click("#help-close"), click("#taking-open")),
    ),
}


@pytest.fixture(params=[f"{name} {language}" for name in KINDS for language in LANGUAGES])
def shown(request: pytest.FixtureRequest, browser: Browser, showing: Showing) -> Iterator[tuple[Kind, ArPage]]:
    """A page in a language, as it is when everything is there."""
    name, language = str(request.param).split()
    kind = KINDS[name]
    with open_page(browser, locale=language) as page:
        if not kind.has_webgl:
            page.page.add_init_script(NO_WEBGL)
        page.page.goto(showing.url + kind.path)
        page.until(kind.is_there)
        page.ask(AXE.read_text(encoding="utf-8") + "; null")
        assert page.ask("document.documentElement.lang") == language[:2]
        yield kind, page


def findings(page: ArPage) -> list[Any]:
    """Return what is serious or critical."""
    found: list[Any] = page.ask(FIND)
    return found


def test_nothing_serious_stands_in_anybodys_way(shown: tuple[Kind, ArPage]) -> None:
    kind, page = shown
    found = {}
    for state in kind.states:
        page.ask(state)
        found[state, "targets"] = page.ask(SMALL)
        for theme in THEMES:
            page.ask("theme => { document.documentElement.dataset.theme = theme; }", theme)
            found[state, theme] = findings(page)
    assert {where: what for where, what in found.items() if what} == {}
