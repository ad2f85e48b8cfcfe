"""Golden pictures of every page, in its states, themes and languages, without what is drawn in three dimensions: see `visiting`.

`make gallery` takes them anew, after they have changed on purpose; somebody then looks at them. With names of pages of the table
(`python -m tests.web.page_gallery start ar`) it takes those alone.
"""

import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime
from pathlib import Path
from shutil import copy
from tempfile import TemporaryDirectory

import cv2
from playwright.sync_api import sync_playwright

from server.access import Access
from server.calibrating.lens_run import Collection
from server.calibrating.page import coverage_app
from server.grants import Grant
from server.installing import Installer
from server.local_authority import LocalAuthority
from server.reviewing.command import export
from server.web_server import WebServer
from tests.ci.machine import find_browser
from tests.conftest import BROWSER_FLAGS
from tests.server.serving import serving
from tests.tracker.calibrate.board_video import BoardVideo, shown_around
from tests.tracker.calibrate.board_walk import CAMERA
from tests.web.visiting import LANGUAGES, Shot, table, visit
from tests.web.walk import NAME, ROOT, showing_walk

GOLDEN = ROOT / "tests" / "golden" / "pages"
_QUALITY = 60
_VIEWS = 8
"""Of the board: enough for some of the picture to be covered, and not for all of it."""


@contextmanager
def served(folder: Path) -> Iterator[Mapping[str, str]]:
    """Serve all that the table names, and give their addresses: `walk`, `file`, `plain`, `certificate` and `calibrate`."""
    for name in ("walk", "plain", "certificate"):
        (folder / name).mkdir()
    with ExitStack() as stack:
        walk = stack.enter_context(showing_walk(folder / "walk"))
        page = folder / "walk" / "walk.html"
        for facts in (ROOT / "assets" / "state_agora").glob("*.toml"):
            copy(facts, folder / "walk")
        export(folder / "walk" / f"{NAME}.mcap", page, estimator="truth", pictures=False, site=folder / "walk")
        access = Access.with_secret(bytes(32), Grant("viewer"))
        plain = stack.enter_context(serving(folder / "plain", access=access))
        authority = LocalAuthority(folder / "certificate", ["localhost", "127.0.0.1"], datetime.now(UTC))
        installer = Installer(authority, "127.0.0.1", 0, ["127.0.0.1"])
        certificate = stack.enter_context(installer.server)
        calibrate = stack.enter_context(WebServer(coverage_app(_collection())))
        yield {
            "walk": walk.url,
            "file": page.as_uri(),
            "plain": plain.url,
            "certificate": certificate.url,
            "calibrate": calibrate.url,
        }


def _collection() -> Collection:
    """Return what a camera has seen of the board so far."""
    video = BoardVideo(CAMERA, seed=2)
    collection = Collection(video.board)
    for index, (R, p) in enumerate(shown_around(video, _VIEWS)):
        collection.step(video.frame(index * 1_000_000_000, R, p, index))
    return collection


def write(shot: Shot) -> None:
    """Keep a picture as the golden one."""
    data = cv2.imencode(".webp", shot.picture, [cv2.IMWRITE_WEBP_QUALITY, _QUALITY])[1]
    (GOLDEN / f"{shot.name}.webp").write_bytes(bytes(data))


def main(names: list[str]) -> None:
    """Take and write them all, or those of some pages."""
    executable = find_browser()
    if executable is None:
        raise SystemExit("no browser: make test installs one, or run: apt-get install chromium")
    kinds = table()[1]
    GOLDEN.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder, served(Path(folder)) as urls, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(BROWSER_FLAGS))
        for name in names or kinds:
            for old in GOLDEN.glob(f"{name}.*.webp"):
                old.unlink()
            for language in LANGUAGES:
                for shot in visit(browser, urls[kinds[name].server], kinds[name], language).shots:
                    write(shot)
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:])
