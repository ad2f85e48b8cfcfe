"""Visits the pages of a table in each of their states, and brings home what they look like, say, and put in people's way.

What is drawn in three dimensions has pictures of its own (see `gallery` and `ar_gallery`); here it is left out, so that a picture
is of the interface alone. Letters are those of one font on every machine.
"""

import re
import tomllib
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Final, cast

import cv2
import matplotlib as mpl
import numpy as np
from playwright.sync_api import Browser, Route

from tests.web.likeness import Picture
from tests.web.pages import ArPage
from tests.web.telling import Telling, Walk
from tests.web.test_flat import NO_WEBGL
from tests.web.walk import ROOT

TABLE: Final = ROOT / "tests" / "golden" / "pages.toml"
LANGUAGES: Final = {"en": "en-GB", "tr": "tr-TR"}
THEMES: Final = ("plain", "glare")
SIZES_PX: Final = {"wide": (1280, 800), "narrow": (390, 844)}
#: Wide pictures are kept at half their size: what they show is layout and colour, and the narrow ones can be read.
_KEPT_AT: Final = {"wide": 0.5, "narrow": 0.75}

_AXE: Final = ROOT / "web" / "node_modules" / "axe-core" / "axe.min.js"
_FIND: Final = """() => axe.run(document, { resultTypes: ["violations"] }).then(({ violations }) =>
    violations.filter(({ impact }) => impact === "serious" || impact === "critical").map(({ id, nodes }) =>
        `${id}: ${nodes.map(({ html, failureSummary }) => html.slice(0, 160) + " " + failureSummary).join(" | ")}`))"""
_SMALL: Final = """() => [...document.querySelectorAll("button, select, a[href], summary, input, textarea")]
    .filter((one) => one.checkVisibility({ visibilityProperty: true }) && !one.matches(".unseen, .skip, p a"))
    .map((one) => [one, (/checkbox|radio/.test(one.type) && one.closest("label")) || one])
    .map(([one, target]) => [one.id || one.className || one.tagName, target.getBoundingClientRect()])
    .filter(([, { width, height }]) => Math.min(width, height) < 43.5)
    .map(([name, { width, height }]) => `${name}: ${width} x ${height}`)"""
"""Controls that a finger would miss; links within a sentence may be as high as it is (WCAG 2.5.5)."""
_CUT: Final = """() => {
    const apart = "#walk, .unseen, .skip, .wide, svg, #strip, .eye";
    const seen = (one) => one.checkVisibility({ visibilityProperty: true }) && !one.closest(apart);
    const texts = "button, select, summary, h1, h2, h3, dt, dd, label, li, p, a, strong, th, td";
    return [...document.querySelectorAll(texts)].filter(seen).flatMap((one) => {
        const { left, right } = one.getBoundingClientRect();
        const panel = one.closest(".panel, dialog")?.getBoundingClientRect() ?? { left: 0, right: innerWidth };
        const isCut = getComputedStyle(one).overflowX !== "visible" && one.scrollWidth > one.clientWidth + 1;
        if (!isCut && left >= panel.left - 1 && right <= Math.min(innerWidth, panel.right) + 1) return [];
        return [`${one.id || one.className || one.tagName} does not fit: ${one.textContent.trim().slice(0, 60)}`];
    });
}"""
"""What does not fit: a text that is cut off, or that runs out of its panel or off the page. Only the name of a walk may be cut."""
_SAID: Final = """(same) => {
    const said = new Set();
    const seen = (one) => one.checkVisibility({ visibilityProperty: true }) && !one.closest(same);
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
        const { parentElement, data } = walk.currentNode;
        if (!parentElement.closest("script, style") && seen(parentElement)) said.add(data.replace(/\\s+/g, " ").trim());
    }
    for (const one of document.querySelectorAll("[title], [aria-label], [alt], [placeholder], [aria-valuetext]"))
        if (seen(one))
            for (const name of ["title", "aria-label", "alt", "placeholder", "aria-valuetext"])
                if (one.hasAttribute(name)) said.add(one.getAttribute(name).trim());
    return [...said, ...(document.querySelector("#walk") ? [] : [document.title])];
}"""
_DRESS: Final = """({ fonts, hidden }) => Promise.all(Object.entries(fonts).map(([weight, data]) =>
    new FontFace("golden", Uint8Array.from(atob(data), (c) => c.charCodeAt(0)), { weight }).load()
        .then((face) => document.fonts.add(face))
)).then(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(`* { font-family: golden !important; } canvas#view { opacity: 0; }
        .panel { backdrop-filter: none !important; box-shadow: none !important }
        ${hidden.length ? hidden.join(",") : "none"} { visibility: hidden !important; }`);
    document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
})"""
_UNDRAWN: Final = """for (const side of ["width", "height"]) {
    const { get, set } = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side);
    const small = function (px) { set.call(this, this.id === "view" ? Math.min(px, 16) : px); };
    Object.defineProperty(HTMLCanvasElement.prototype, side, { get, set: small, configurable: true });
}
for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced", "drawRangeElements"])
    WebGL2RenderingContext.prototype[name] = () => undefined;
const extension = WebGL2RenderingContext.prototype.getExtension;
WebGL2RenderingContext.prototype.getExtension = function (name) {
    return name === "WEBGL_multi_draw" ? null : extension.call(this, name);
};
"""
"""Nothing is drawn in three dimensions: it is not looked at, and in software it takes longer than everything else."""
_DRAWN: Final = """() => new Promise((resolve) =>
    requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(resolve))))"""
"""What follows the page's size has been drawn in it: curves, the strip of a replay."""
_HOLD: Final = """() => { const now = performance.now(); let late = 0;
    performance.now = () => now + 1000 * late;
    globalThis.late = (seconds) => { late += seconds; };
}"""
"""Time stands still for a page, but for what it is told: nothing grows old while its picture is taken."""


@dataclass(frozen=True)
class State:
    """What brings a page into a state; see the table's head."""

    name: str
    click: Sequence[str] = ()
    keys: Sequence[str] = ()
    run: str = ""
    session: Mapping[str, Any] = field(default_factory=dict)
    doubt: Sequence[float] | None = None
    pose: float | None = None
    late_s: float = 0.0
    close: int | None = None
    seek_s: float | None = None
    until: str = ""
    narrow: bool = True


@dataclass(frozen=True)
class Kind:
    """A page of the table."""

    name: str
    path: str
    there: str
    states: Sequence[State]
    server: str = "walk"
    """Which of the servers has it."""
    sessions: Sequence[str] | None = None
    refused: int | None = None
    without: Sequence[str] = ()
    alike: bool = False
    has_webgl: bool = True
    hidden: Sequence[str] = ()
    same: Sequence[str] = ()


@dataclass(frozen=True)
class Shot:
    """A page in one state, theme and width."""

    name: str
    picture: Picture
    """Blue green red, as small as it is kept."""


@dataclass
class Visit:
    """What was found on a page in one language."""

    shots: list[Shot] = field(default_factory=list)
    findings: dict[str, list[str]] = field(default_factory=dict)
    """By state: what axe-core calls serious or critical, what a finger misses, what does not fit."""
    said: dict[str, list[str]] = field(default_factory=dict)
    """By state: every text that is seen or read out."""


@cache
def table() -> tuple[dict[str, Walk], dict[str, Kind]]:
    """Return the walks and the pages of the table, by name."""
    with TABLE.open("rb") as file:
        read = tomllib.load(file)
    kinds = [Kind(**{**page, "states": [State(**state) for state in page["states"]]}) for page in read["pages"]]
    return read["walks"], {kind.name: kind for kind in kinds}


def visit(browser: Browser, url: str, kind: Kind, language: str) -> Visit:
    """Go through the states of a page in a language."""
    width, height = SIZES_PX["wide"]
    context = browser.new_context(
        viewport={"width": width, "height": height},
        locale=LANGUAGES[language],
        reduced_motion="reduce",
        service_workers="block",  # whether a page is kept already is a matter of time
    )
    try:
        page = ArPage(context.new_page())
        telling = _open(page, url, kind)
        found = Visit()
        for state in kind.states:
            _enter(page, telling, state)
            _look(page, kind, state, language, found)
        return found
    finally:
        context.close()


def _open(page: ArPage, url: str, kind: Kind) -> Telling | None:
    page.page.add_init_script(_UNDRAWN)
    if not kind.has_webgl:
        page.page.add_init_script(NO_WEBGL)
    for pattern in kind.without:
        page.page.route(pattern, lambda route: route.abort())
    if kind.alike:
        page.page.route("**/course?*", _by_truth)
    telling = None
    if kind.sessions is not None:
        walks = table()[0]
        telling = Telling(page.page, [walks[name] for name in kind.sessions], kind.refused)
    page.page.goto(url + kind.path)
    page.until(kind.there)
    page.ask(_AXE.read_text(encoding="utf-8") + "; null")
    page.ask(_DRESS, {"fonts": _fonts(), "hidden": list(kind.hidden)})
    page.ask(_HOLD)
    return telling


def _by_truth(route: Route) -> None:
    route.fulfill(response=route.fetch(url=re.sub("estimator=[^&]*", "estimator=truth", route.request.url)))


def _enter(page: ArPage, telling: Telling | None, state: State) -> None:
    if telling is not None:
        if state.session:
            telling.news(state.session)
        if state.doubt is not None:
            telling.picture(state.doubt)
        if state.pose is not None:
            telling.pose(state.pose)
        if state.close is not None:
            telling.end(state.close)
    if state.run:
        page.ask(state.run if "=>" in state.run[:20] else f"() => {{ {state.run}; }}")
    for selector in state.click:
        page.ask("(selector) => document.querySelector(selector).click()", selector)
    for key in state.keys:
        page.page.keyboard.press(key)
    if state.late_s:
        page.ask("(seconds) => late(seconds)", state.late_s)
    if state.seek_s is not None:
        page.seek(state.seek_s)
    if state.until:
        page.until(state.until)


def _look(page: ArPage, kind: Kind, state: State, language: str, found: Visit) -> None:
    name = f"{kind.name}.{state.name}"
    found.said[name] = cast(
        "list[str]", page.ask(_SAID, ", ".join(["[lang]:not(html)", "#credit", "#walk", ".brand", *kind.same]))
    )
    amiss: list[str] = []
    for size, (width, height) in SIZES_PX.items():
        if size == "narrow" and not state.narrow:
            continue
        page.page.set_viewport_size({"width": width, "height": height})
        page.ask(_DRAWN)
        amiss += [f"{size}: {what}" for script in (_SMALL, _CUT) for what in page.ask(script)]
        last = "narrow" if state.narrow else "wide"
        for theme in THEMES if size == last else THEMES[:1]:
            page.page.emulate_media(contrast="more" if theme == "glare" else "no-preference")
            page.until(f"(document.documentElement.dataset.theme ?? '{theme}') === '{theme}'")
            found.shots.append(Shot(f"{name}.{language}.{theme}.{size}", _picture(page, size)))
            if size == last:
                amiss += [f"{theme}: {what}" for what in page.ask(_FIND)]
        page.page.emulate_media(contrast="no-preference")
    page.page.set_viewport_size(dict(zip(("width", "height"), SIZES_PX["wide"], strict=True)))  # type: ignore[arg-type]
    found.findings[f"{name}.{language}"] = amiss


def _picture(page: ArPage, size: str) -> Picture:
    raw = cv2.imdecode(np.frombuffer(page.page.screenshot(animations="disabled"), np.uint8), cv2.IMREAD_COLOR)
    assert raw is not None
    scale = _KEPT_AT[size]
    return np.asarray(cv2.resize(raw, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)


@cache
def _fonts() -> dict[str, str]:
    """Return the letters of every picture, by weight: those that come with matplotlib."""
    folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
    files = {"400": "DejaVuSans.ttf", "700": "DejaVuSans-Bold.ttf"}
    return {weight: b64encode((folder / name).read_bytes()).decode() for weight, name in files.items()}


def visits(browser: Browser, urls: Mapping[str, str], names: Sequence[str]) -> Iterator[tuple[str, str, Visit]]:
    """Visit pages in every language."""
    kinds = table()[1]
    for name in names:
        for language in LANGUAGES:
            yield name, language, visit(browser, urls[kinds[name].server], kinds[name], language)
