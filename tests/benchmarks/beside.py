"""How old a live walker's pose is when five start pages draw it, and how far off: `python -m tests.benchmarks.beside --whole`.

A rig in a process of its own tells thirty poses a second to a server on loopback; five windows of 640 x 480 in one Chromium show
it in a square of plain volumes, or with `--whole` in the State Agora as it is built, whose finer levels still come in meanwhile.
Rig and pages read the same clock, UTC of this machine: an age is what has passed from the moment that is shown until the page has
handed the picture over; a place is compared with where the rig was at that moment.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from math import dist
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep, time_ns
from typing import Any, Final

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from assets.site import load_site
from server.local import LocalServer
from server.wire import encode_pose
from tests.benchmarks.ar_page import RENDERERS, SIZE_PX
from tests.ci.machine import find_browser
from tests.web.strolling import NAME, POSE_HZ, place_at, pose_at
from tests.web.walk import make_site

ROOT: Final = Path(__file__).parents[2]
PAGES: Final = 5
AGE_TARGET_MS: Final = 100.0
OFF_TARGET_M: Final = 0.05
SETTLING_S: Final = 5.0
_BEGIN: Final = """() => {
    globalThis.ages = [];
    let last = null;
    const look = () => {
        const [walker] = agora.walkers();
        if (walker && walker.t_ns !== last)
            ages.push([
                performance.timeOrigin + performance.now() - walker.t_ns / 1e6, agora.stats().poseAgeMs,
                walker.t_ns, ...walker.place_site_m,
            ]);
        last = walker?.t_ns;
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
}"""


@dataclass(frozen=True)
class Beside:
    """What was measured, over all pages."""

    renderer: str
    age_p50_ms: float
    age_p95_ms: float
    told_p95_ms: float
    """What the pages themselves say of it."""
    off_p95_m: float
    off_most_m: float
    """Of the walker as drawn from where the rig was."""
    pictures_hz: float
    """Of the slowest page."""
    opened_s: float
    """Until all pages, one after the other, drew the walker."""


def measure(seconds: float = 15.0, *, whole: bool = False) -> Beside | None:
    """Return how old poses are; None without a browser."""
    executable = find_browser()
    if executable is None:
        return None
    with (
        TemporaryDirectory() as folder,
        LocalServer(
            load_site(ROOT / "assets" / "state_agora") if whole else make_site(Path(folder)),
            port=0,
            web=ROOT / "web" / "dist",
        ) as server,
        _rig(server),
        sync_playwright() as playwright,
    ):
        for renderer, flags in RENDERERS.items():
            browser = playwright.chromium.launch(executable_path=executable, args=list(flags))
            try:
                if _draws(browser):
                    return _measured(browser, server.url, renderer, seconds)
            finally:
                browser.close()
    return None


@contextmanager
def _rig(server: LocalServer) -> Iterator[None]:
    command = [sys.executable, "-m", "tests.benchmarks.beside", "--rig", server.rig_url(NAME), server.rig_token(NAME)]
    rig = subprocess.Popen(command, cwd=ROOT, stdin=subprocess.PIPE)
    try:
        yield
    finally:
        rig.kill()
        rig.communicate()


def _draws(browser: Browser) -> bool:
    """Whether this browser has WebGL 2."""
    page = browser.new_page()
    try:
        return bool(page.evaluate("document.createElement('canvas').getContext('webgl2') !== null"))
    finally:
        page.close()


def _measured(browser: Browser, url: str, renderer: str, seconds: float) -> Beside:
    began_s = monotonic()
    pages = [_page(browser, url) for _ in range(PAGES)]
    opened_s = monotonic() - began_s
    sleep(SETTLING_S)
    for page in pages:
        page.evaluate(_BEGIN)
    began_s = monotonic()
    pages[0].wait_for_timeout(1000.0 * seconds)
    taken: list[list[list[float]]] = [page.evaluate("ages") for page in pages]
    passed_s = monotonic() - began_s
    ages = np.array([age for one in taken for age in one])
    p50_ms, p95_ms = np.percentile(ages[:, 0], (50.0, 95.0))
    told_ms = float(np.percentile(ages[:, 1], 95.0))
    off_m = [dist(place_m, place_at(t_ns)) for _, _, t_ns, *place_m in ages.tolist()]
    return Beside(
        renderer,
        float(p50_ms),
        float(p95_ms),
        told_ms,
        float(np.percentile(off_m, 95.0)),
        max(off_m),
        min(map(len, taken)) / passed_s,
        opened_s,
    )


def _page(browser: Browser, url: str) -> Page:
    width, height = SIZE_PX
    page = browser.new_context(viewport={"width": width, "height": height}).new_page()
    page.goto(url, wait_until="commit")
    while not page.evaluate("globalThis.agora?.stats()?.posesDrawn > 3"):
        page.wait_for_timeout(100)
    return page


def rows_of(beside: Beside) -> list[tuple[str, float, str, str, float]]:
    """Return name, value, unit, what it is beside, and the ratio to that, of each row of `make bench`."""
    name = f"{PAGES} pages beside a live walk, {beside.renderer}, {os.cpu_count()} cores"
    off_cm, most_cm = 100.0 * beside.off_p95_m, 100.0 * OFF_TARGET_M
    return [
        (
            f"{name}: pose age, p95",
            beside.age_p95_ms,
            "ms",
            f"target {AGE_TARGET_MS:g}",
            beside.age_p95_ms / AGE_TARGET_MS,
        ),
        (f"{name}: avatar off, p95", off_cm, "cm", f"target {most_cm:g}", off_cm / most_cm),
    ]


def _push(url: str, token: str) -> None:
    from websockets.sync.client import connect

    bearer = {"Authorization": f"Bearer {token}"}
    with connect(url, additional_headers=bearer, compression=None, proxy=None) as rig:
        rig.send(json.dumps({"type": "state", "session": {"kind": "live", "estimator": "camera-gps-imu/famm"}}))
        began_s, seq = monotonic(), 0
        while True:
            sleep(max(0.0, began_s + seq / POSE_HZ - monotonic()))
            rig.send(encode_pose(pose_at(time_ns(), seq)))
            seq += 1


def main() -> None:
    """Play the rig, or measure and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rig", nargs=2, help=argparse.SUPPRESS)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--whole", action="store_true")
    options = parser.parse_args()
    if options.rig:
        _push(*options.rig)
        return
    found: Any = measure(options.seconds, whole=options.whole)
    sys.stdout.write(json.dumps(None if found is None else asdict(found)) + "\n")


if __name__ == "__main__":
    main()
