"""How long the AR page takes from the arrival of a message to its last pixel, and how many pictures a second it draws.

Chromium draws in software, by Mesa's llvmpipe where the machine has it, else by its own SwiftShader: no graphics card helps.
The demo's walk is played at its own pace by the program itself, in a window of 640 x 480; camera and lens are the walk's.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

from playwright.sync_api import Browser, Page, sync_playwright

from assets.site import load_site
from server.replay import ReplaySettings
from server.showing import Showing
from tests.ci.machine import find_browser
from tests.conftest import BROWSER_FLAGS
from tracker.log import Log

ROOT = Path(__file__).parents[2]
SIZE_PX = (640, 480)
_OWN = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
RENDERERS = {
    "llvmpipe": (*(flag for flag in BROWSER_FLAGS if flag not in _OWN), "--use-angle=gl-egl", "--ignore-gpu-blocklist"),
    "SwiftShader": BROWSER_FLAGS,
}
FIRST = "first paint"
SETTLING_S, TIMED = 20.0, 100
"""How long the quality has to settle, and how many pictures are then timed."""
_DRAWN = "globalThis.agora?.stats()?.framesDrawn > 3 && agora.session() !== null"


@dataclass(frozen=True)
class Drawn:
    """What was measured of one page."""

    renderer: str
    effort: str
    """The level that was chosen, or asked for."""
    triangles: int
    shadows_and_occluders: bool
    p50_ms: float
    p95_ms: float
    pictures_hz: float


def measure(log_path: Path) -> list[Drawn]:
    """Return the page as adaptive quality has it, with shadows, and at the first paint; empty without a browser."""
    executable = find_browser()
    if executable is None:
        return []
    site = load_site(ROOT / "assets" / "state_agora")
    settings = ReplaySettings(estimator="truth", looping=True)
    with (
        Showing(site, Log.open(log_path), settings, port=0, web=ROOT / "web" / "dist") as showing,
        sync_playwright() as playwright,
    ):
        for renderer, flags in RENDERERS.items():
            browser = playwright.chromium.launch(executable_path=executable, args=list(flags))
            try:
                with _page(browser) as page:
                    if _draws(page, showing.url):
                        return [
                            _measured(page, showing.url, renderer, effort, seconds)
                            for effort, seconds in ((None, SETTLING_S), ("shadows", 3.0), (FIRST, 3.0))
                        ]
            finally:
                browser.close()
    return []


@contextmanager
def _page(browser: Browser) -> Iterator[Page]:
    width, height = SIZE_PX
    context = browser.new_context(viewport={"width": width, "height": height})
    try:
        yield context.new_page()
    finally:
        context.close()


def _draws(page: Page, url: str) -> bool:
    """Whether this browser has WebGL 2 by these flags."""
    page.goto(url)
    return bool(page.evaluate("document.createElement('canvas').getContext('webgl2') !== null"))


def _measured(page: Page, url: str, renderer: str, effort: str | None, settling_s: float) -> Drawn:
    page.goto(f"{url}ar" + ("" if effort is None else f"?effort={effort.replace(' ', '+')}"))
    while not page.evaluate(_DRAWN):
        page.wait_for_timeout(50)
    page.evaluate("agora.ready")
    page.wait_for_timeout(1000 * settling_s)
    before = page.evaluate("agora.stats().framesDrawn")
    began_s = monotonic()
    times_ms = sorted(page.evaluate("count => agora.time(count)", TIMED))
    passed_s = monotonic() - began_s
    stats = page.evaluate("agora.stats()")
    return Drawn(
        renderer,
        stats["effort"],
        stats["triangles"],
        bool(stats["occluders"]) and stats["effort"] not in (FIRST, "occluders"),
        times_ms[len(times_ms) // 2],
        times_ms[int(0.95 * len(times_ms))],
        (stats["framesDrawn"] - before) / passed_s,
    )
