"""Pictures of the tour as a browser draws it, plain and in the colours of the evidence: golden ones, and `docs/gallery.md` of them.

`make gallery` draws them anew, after the models have changed on purpose and somebody has looked at what they look like now.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import Browser, sync_playwright

from assets.site import Site, load_site
from server.replay import ReplaySettings
from server.showing import Showing
from tests.ci.machine import find_browser
from tests.conftest import BROWSER_FLAGS
from tests.web.pages import ALONE, ArPage
from tests.web.walk import ROOT, WEB, write_log
from tracker.log import Log

Picture = NDArray[np.uint8]
SIZE_PX = (640, 360)
GOLDEN = ROOT / "tests" / "golden" / "views"
GALLERY = ROOT / "docs" / "gallery.md"
QUALITY = 70
VIEWS = {
    "roman": ("square", "long_axis", "basilica", "bouleuterion", "prytaneion", "memmius", "temple"),
    "today": ("square", "basilica", "bouleuterion", "prytaneion", "temple"),
}
"""Twelve places of the tour, by model."""
TITLES = {"roman": "About AD 150", "today": "Today"}


@dataclass(frozen=True)
class Shot:
    """A view as it was drawn."""

    name: str
    picture: Picture
    """(360, 640, 3), blue green red."""
    stats: dict[str, Any]
    """What the page says that it cost."""


@contextmanager
def showing_site(folder: Path) -> Iterator[Showing]:
    """Serve the State Agora as it is built, with a walk of no importance."""
    write_log(folder / "walk.mcap")
    site = load_site(ROOT / "assets" / "state_agora")
    settings = ReplaySettings(estimator="truth", looping=True)
    with Showing(site, Log.open(folder / "walk.mcap"), settings, port=0, web=WEB) as showing:
        yield showing


def shots(browser: Browser, url: str) -> Iterator[Shot]:
    """Draw every view, plain and tinted."""
    width, height = SIZE_PX
    context = browser.new_context(viewport={"width": width, "height": height}, locale="en-GB")
    page = ArPage(context.new_page())
    for model, views in VIEWS.items():
        page.page.goto(f"{url}?walkers=0&model={model}")
        page.ask("agora.ready")
        page.ask(ALONE)
        for view in views:
            for suffix in ("", ".evidence"):
                page.go(f"view={view}" + ("&evidence=1" if suffix else ""))
                raw = np.frombuffer(page.page.screenshot(), np.uint8)
                picture = np.asarray(cv2.imdecode(raw, cv2.IMREAD_COLOR), np.uint8)
                yield Shot(f"{model}.{view}{suffix}", picture, page.stats())
    assert page.errors == []
    context.close()


def write(shot: Shot) -> None:
    """Keep a picture as the golden one."""
    GOLDEN.mkdir(parents=True, exist_ok=True)
    data = cv2.imencode(".webp", shot.picture, [cv2.IMWRITE_WEBP_QUALITY, QUALITY])[1]
    (GOLDEN / f"{shot.name}.webp").write_bytes(bytes(data))


def gallery(site: Site) -> str:
    """Return the page that shows the golden pictures."""
    places = {view.id: view.name["en"] for view in (site.default_view, *site.tour)}
    lines = [
        "# Gallery",
        "",
        "The tour as the start page draws it; `make gallery` draws these pictures anew, and the tests compare with them.",
        "On the right the same views in the colours of the evidence:",
        "**blue** is attested, **magenta** inferred, **yellow** hypothetical.",
    ]
    for model, views in VIEWS.items():
        lines += ["", f"## {TITLES[model]}", "", "| | | by evidence |", "| --- | --- | --- |"]
        for view in views:
            pictures = [
                f"![](../{(GOLDEN / f'{model}.{view}{s}.webp').relative_to(ROOT).as_posix()})"
                for s in ("", ".evidence")
            ]
            lines.append(f"| {places[view]} | {pictures[0]} | {pictures[1]} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Draw and write everything."""
    executable = find_browser()
    if executable is None:
        raise SystemExit("no browser: make test installs one, or run: apt-get install chromium")
    with TemporaryDirectory() as folder, showing_site(Path(folder)) as showing, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(BROWSER_FLAGS))
        for old in GOLDEN.glob("*.webp"):
            old.unlink()
        for shot in shots(browser, showing.url):
            write(shot)
        browser.close()
    GALLERY.write_text(gallery(load_site(ROOT / "assets" / "state_agora")), encoding="utf-8")


if __name__ == "__main__":
    main()
