"""The start page on a thin line: its first picture and how long it keeps the browser's thread; and its memory over minutes.

`python -m tests.benchmarks.home_page --minutes 10` goes from stop to stop of the tour for as long and tells what is kept in memory.
Chromium draws in software, so that a graphics card only makes it better; the State Agora is shown as it is built.
"""

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

from playwright.sync_api import CDPSession, ViewportSize, sync_playwright
from rich.console import Console

from assets.site import load_site
from tests.ci.machine import find_browser
from tests.conftest import BROWSER_FLAGS
from tests.web.gallery import showing_site
from tests.web.pages import ArPage
from tests.web.walk import ROOT

SIZE_PX, SMALL_PX = (1280, 720), (320, 180)
"""Memory hardly depends on the size, but how many rounds fit into a minute does."""
LINE_BYTES_S, LATENCY_MS = 10e6 / 8.0, 20.0
"""10 Mbit/s, and the way to a server in the same town."""
FIRST_PICTURE_MS, FIRST_PICTURE_BYTES, LONG_TASK_MS = 4000.0, 3_000_000, 200.0
GROWTH_MB = 5.0
"""What a browser's heap may differ by between two equal moments."""
_WATCH = """() => {
    globalThis.longTasks = [];
    new PerformanceObserver(list => longTasks.push(...list.getEntries().map(e => [e.startTime, e.duration])))
        .observe({ type: "longtask", buffered: true });
}"""
_FIRST = "() => agora.ready.then(() => performance.now())"


@dataclass(frozen=True)
class Opened:
    """What was measured of one visit."""

    first_picture_ms: float
    first_picture_bytes: int
    """All that had come by then, as it came over the line."""
    longest_task_ms: float
    """After the first picture: while the finer model comes in, and while one moves."""


@dataclass(frozen=True)
class Kept:
    """What the page holds after a round of the tour in both models."""

    t_s: float
    heap_mb: float
    geometries: int
    textures: int


def measure() -> list[Opened]:
    """Open the page once; empty without a browser."""
    with _visit(SIZE_PX) as visit:
        return [] if visit is None else [_opened(visit)]


def keep(minutes: float) -> Iterator[Kept]:
    """Go round the tour for so long; a value after each round."""
    with _visit(SMALL_PX) as visit:
        if visit is not None:
            yield from _rounds(visit, minutes * 60.0)


@contextmanager
def _visit(size_px: tuple[int, int]) -> Iterator["_Visit | None"]:
    """A page that was not opened yet; None without a browser."""
    executable = find_browser()
    if executable is None:
        yield None
        return
    with TemporaryDirectory() as folder, showing_site(Path(folder)) as showing, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(BROWSER_FLAGS))
        try:
            # no service worker: it keeps the whole site once there is a picture, which is another thing to measure
            viewport: ViewportSize = {"width": size_px[0], "height": size_px[1]}
            context = browser.new_context(viewport=viewport, service_workers="block")
            page = context.new_page()
            yield _Visit(ArPage(page), context.new_cdp_session(page), showing.url)
        finally:
            browser.close()


class _Visit:
    """A page that was not opened yet, on a thin line."""

    def __init__(self, page: ArPage, cdp: CDPSession, url: str) -> None:
        self.page, self.cdp, self.url = page, cdp, url
        self.bytes = 0
        cdp.send("Network.enable")
        cdp.send("HeapProfiler.enable")
        cdp.on("Network.dataReceived", self._count)

    def _count(self, event: dict[str, Any]) -> None:
        self.bytes += event["dataLength"]


def _opened(visit: _Visit) -> Opened:
    page = visit.page
    visit.cdp.send(
        "Network.emulateNetworkConditions",
        {"offline": False, "latency": LATENCY_MS, "downloadThroughput": LINE_BYTES_S, "uploadThroughput": LINE_BYTES_S},
    )
    page.page.goto(f"{visit.url}?walkers=0", wait_until="commit")
    page.until("globalThis.agora !== undefined")
    page.ask(_WATCH)
    first_ms = page.ask(_FIRST)
    came = visit.bytes
    page.settle()
    page.page.keyboard.press("2")
    page.settle()
    page.page.keyboard.down("w")
    page.page.wait_for_timeout(3000)
    page.page.keyboard.up("w")
    page.settle()
    tasks = [duration for start, duration in page.ask("longTasks") if start > first_ms]
    return Opened(first_ms, came, max(tasks, default=0.0))


def _rounds(visit: _Visit, seconds: float) -> Iterator[Kept]:
    site = load_site(ROOT / "assets" / "state_agora")
    stops = [view.id for view in (site.default_view, *site.tour)]
    page, began_s = visit.page, monotonic()
    page.page.goto(f"{visit.url}?walkers=0")
    page.settle()
    for past in cycle((1, 0)):
        for i, stop in enumerate(stops):
            page.go(f"view={stop}&past={past}&evidence={i % 2}&hour={8 + i}")
        if past == 1:
            continue
        visit.cdp.send("HeapProfiler.collectGarbage")
        heap = visit.cdp.send("Runtime.getHeapUsage")["usedSize"]
        stats = page.stats()
        yield Kept(monotonic() - began_s, heap / 1e6, stats["geometries"], stats["textures"])
        if monotonic() - began_s > seconds:
            return


def main() -> int:
    """Go round for the minutes that are asked for; 0 where memory was flat."""
    parser = argparse.ArgumentParser("python -m tests.benchmarks.home_page", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    console, kept = Console(), []
    for one in keep(parser.parse_args().minutes):
        kept.append(one)
        console.print(
            f"{one.t_s:.0f} s: heap {one.heap_mb:.1f} MB, {one.geometries} geometries, {one.textures} textures"
        )
    if len(kept) < 2:
        return 1
    # the first round loads what all others use
    growth_mb = kept[-1].heap_mb - kept[0].heap_mb
    console.print(f"growth after the first round {growth_mb:.1f} MB, at most {GROWTH_MB:g}")
    return 0 if growth_mb <= GROWTH_MB and kept[-1].textures <= kept[0].textures else 1


if __name__ == "__main__":
    sys.exit(main())
