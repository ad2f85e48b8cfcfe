"""Golden pictures of the AR page: the sun at three hours, what hides the model, every style of doubt, both head-mounted displays.

`python -m tests.web.ar_gallery` draws them anew, after they have changed on purpose; somebody then looks at them.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import numpy as np
from playwright.sync_api import Browser, sync_playwright

from assets.gltf import Node, Scene
from assets.prisms import indexed_mesh
from assets.walkable import WHITE
from server.showing import Showing
from tests.ci.machine import find_browser
from tests.conftest import BROWSER_FLAGS
from tests.web.likeness import Picture
from tests.web.pages import ALONE, ArPage, open_page
from tests.web.tampering import Doubting
from tests.web.walk import ROOT, make_walk, position_of, showing_walk

GOLDEN = ROOT / "tests" / "golden" / "ar"
QUALITY = 80
FRAME = 25
_EVENING = "sun=17.8"
PAGES = {
    "sun.morning": "effort=surfaces&sun=6.5",
    "sun.noon": "effort=surfaces&sun=12",
    "sun.evening": f"effort=surfaces&{_EVENING}",
    "hmd": f"effort=surfaces&display=hmd&{_EVENING}",
    "hmd.eyes": f"effort=surfaces&display=hmd&eyes=2&{_EVENING}",
}
"""What each is asked for by."""
STYLES = {"locked": (0.5, 0.5), "ghost": (3.0, 3.0), "guide": (3.0, 20.0)}
"""How unsure the pose is for each style of the overlay: one sigma, m and degrees."""


@dataclass(frozen=True)
class Shot:
    """The page as it was drawn."""

    name: str
    picture: Picture
    """(480, 640, 3), blue green red."""


def wall() -> Scene:
    """Return a wall that stands today, low and near, where the camera of one picture looks."""
    T_site_cam = make_walk().T_site_cam(make_walk().frame_times()[FRAME][0])
    corners_cam_m = np.array([[x, y, 8.0] for x, y in ((-2.0, -0.6), (2.0, -0.6), (2.0, 1.6), (-2.0, 1.6))])
    corners = corners_cam_m @ T_site_cam[:3, :3].T + T_site_cam[:3, 3]
    mesh = indexed_mesh(corners, np.array([[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]))
    return Scene([Node("wall", [mesh], {"role": "occluder"})], {mesh.material: WHITE})


@contextmanager
def showing(folder: Path) -> Iterator[Showing]:
    """Serve the walk, with a wall in the way."""
    with showing_walk(folder, wall()) as showing:
        yield showing


def shots(browser: Browser, url: str) -> Iterator[Shot]:
    """Draw every page."""
    for name, query in PAGES.items():
        with open_page(browser) as ar:
            _settle(ar, f"{url}ar?{query}")
            if name.startswith("hmd"):
                for _ in range(3):
                    ar.page.keyboard.press("x", delay=100)
            yield _shot(ar, name)
    for style, (sigma_m, sigma_deg) in STYLES.items():
        with open_page(browser) as ar:
            doubting = Doubting(ar.page)
            doubting.sigma_m, doubting.sigma_deg = sigma_m, sigma_deg
            _settle(ar, f"{url}ar?effort=surfaces&sun=12")
            ar.until(f"agora.stats().overlay === '{style}'")
            ar.ask("document.querySelector('#wayfinder').style.visibility = 'visible'")
            yield _shot(ar, f"style.{style}")


def _settle(ar: ArPage, url: str) -> None:
    """Open the page at its picture, all of the past shown and nothing else over it."""
    ar.page.goto(url)
    ar.until_drawn()
    ar.until("agora.stats().occluders")
    ar.ask("document.querySelector('#past').value = 100; document.querySelector('#past').oninput()")
    ar.ask(ALONE)
    if ar.ask("agora.session().playback.playing"):
        ar.ask("document.querySelector('#play').click()")
        ar.until("!agora.session().playback.playing")
    ar.seek_to(position_of(FRAME), FRAME)


def _shot(ar: ArPage, name: str) -> Shot:
    ar.until("agora.session().notice === null")
    ar.page.wait_for_timeout(500)
    raw = np.frombuffer(ar.page.screenshot(), np.uint8)
    assert ar.errors == []
    return Shot(name, np.asarray(cv2.imdecode(raw, cv2.IMREAD_COLOR), np.uint8))


def main() -> None:
    """Draw and write everything."""
    executable = find_browser()
    if executable is None:
        raise SystemExit("no browser: make test installs one, or run: apt-get install chromium")
    GOLDEN.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder, showing(Path(folder)) as served, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(BROWSER_FLAGS))
        for shot in shots(browser, served.url):
            data = cv2.imencode(".webp", shot.picture, [cv2.IMWRITE_WEBP_QUALITY, QUALITY])[1]
            (GOLDEN / f"{shot.name}.webp").write_bytes(bytes(data))
        browser.close()


if __name__ == "__main__":
    main()
