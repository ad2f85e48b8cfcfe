"""Without a network, after one visit: the start page as it was, the AR page as far as it goes, and no mixture of two builds."""

import re
import shutil
from base64 import b64encode
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from time import monotonic

import pytest
from playwright.sync_api import Browser

from server.replay import ReplaySettings
from server.showing import Showing
from tests.web.pages import PATIENCE_S, ArPage, open_page
from tests.web.walk import NAME, WEB, make_site, write_log
from tracker.log import Log

pytestmark = pytest.mark.browser

KEPT = "document.querySelector('.kept')?.hidden === false"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the server has everything."""
    return tmp_path_factory.mktemp("offline")


@pytest.fixture(scope="module")
def showing(folder: Path) -> Iterator[Showing]:
    """A server whose pages a test may change."""
    shutil.copytree(WEB, folder / "dist")
    write_log(folder / f"{NAME}.mcap")
    settings = ReplaySettings(estimator="truth", looping=True)
    log = Log.open(folder / f"{NAME}.mcap")
    with Showing(make_site(folder), log, settings, port=0, web=folder / "dist") as showing:
        yield showing


@pytest.fixture(scope="module")
def visited(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The start page, visited once, and kept."""
    with open_page(browser, service_workers="allow", locale="en-GB") as page:
        page.page.goto(showing.url)
        page.ask("agora.ready")
        page.until(KEPT)
        yield page


@pytest.fixture
def bundle(folder: Path, showing: Showing) -> Iterator[Path]:
    """The server's pages, put back after the test."""
    yield folder / "dist"
    shutil.copytree(WEB, folder / "dist", dirs_exist_ok=True)


@pytest.fixture
def visit(visited: ArPage, showing: Showing) -> Iterator[ArPage]:
    """The visitor, come back, with a network; at a file of the server's that costs nothing to show."""
    visited.page.context.set_offline(False)
    visited.page.goto(f"{showing.url}icon.svg")
    yield visited
    visited.page.context.set_offline(False)


def kept(page: ArPage) -> list[str]:
    """Return the paths of all that is kept."""
    read = """async () => {
        const found = await Promise.all((await caches.keys()).map((name) => caches.open(name)));
        const requests = await Promise.all(found.map((cache) => cache.keys()));
        return requests.flat().map(({ url }) => new URL(url).pathname);
    }"""
    paths: list[str] = page.ask(read)
    return paths


def test_the_square_is_there_without_a_network(visit: ArPage, showing: Showing) -> None:
    visit.page.context.set_offline(True)
    visit.page.goto(f"{showing.url}?lang=tr")
    visit.ask("agora.ready")
    visit.until("agora.stats()?.triangles > 500")
    assert visit.page.inner_text("h1") == "Efes Devlet Agorası"
    visit.page.goto(f"{showing.url}ar?lang=en")
    visit.until("document.querySelector('#notice').textContent.startsWith('Nobody is walking')")


def test_all_of_the_build_and_of_the_site_is_kept(visit: ArPage, bundle: Path) -> None:
    paths = kept(visit)
    assert len(paths) == len(set(paths))
    files = {f"/{path.relative_to(bundle).as_posix()}" for path in bundle.rglob("*") if path.is_file()}
    # of a walk that is saved as one file the server alone has need
    assert files - {"/worker.js", "/.complete", "/exported.js", "/exported.css"} <= set(paths)
    assert {"/api/site", "/models/roman.0.glb", "/models/roman.2.glb"} <= set(paths)


def test_a_build_with_a_file_of_another_one_is_not_kept(visit: ArPage, showing: Showing, bundle: Path) -> None:
    before = sorted(kept(visit))
    (bundle / "ar.html").write_text("<p>of the next build</p>", encoding="utf-8")
    worker = (bundle / "worker.js").read_text(encoding="utf-8")
    (bundle / "worker.js").write_text(worker + "\n// the next build's", encoding="utf-8")
    visit.ask("navigator.serviceWorker.getRegistration().then((kept) => kept.update()).catch(() => null)")
    visit.until(
        "navigator.serviceWorker.getRegistration().then(({ installing, waiting }) => installing === null && waiting === null)"
    )
    assert sorted(kept(visit)) == before
    visit.page.context.set_offline(True)
    visit.page.goto(f"{showing.url}ar")
    assert "next build" not in visit.page.content()


def test_with_a_network_the_servers_own_page_is_shown(visit: ArPage, showing: Showing, bundle: Path) -> None:
    (bundle / "index.html").write_text("<p>of the next build</p>", encoding="utf-8")
    visit.page.goto(showing.url)
    assert "next build" in visit.page.content()


def test_the_manifest_names_icons_that_are_there(visit: ArPage, showing: Showing) -> None:
    get = visit.page.request.get
    address = re.search(r'<link rel="manifest" href="/([^"]*)"', get(showing.url).text())
    assert address is not None
    manifest = get(showing.url + address[1]).json()
    assert (manifest["start_url"], manifest["display"]) == ("/", "standalone")
    assert {"192x192", "512x512"} <= {icon["sizes"] for icon in manifest["icons"]}
    for icon in manifest["icons"]:
        answer = get(showing.url.rstrip("/") + icon["src"])
        assert (answer.ok, answer.headers["content-type"]) == (True, icon["type"])


def test_a_whole_new_build_takes_the_place_of_the_old_one_when_no_page_of_it_is_open(
    visit: ArPage, showing: Showing, bundle: Path
) -> None:
    old = (bundle / "index.html").read_bytes()
    (bundle / "index.html").write_text("<p>of the next build</p>", encoding="utf-8")
    worker = (bundle / "worker.js").read_text(encoding="utf-8")
    worker = worker.replace(integrity(old), integrity((bundle / "index.html").read_bytes()))
    worker = re.sub(r'KEPT_VERSION="\w+"', 'KEPT_VERSION="next"', worker)
    (bundle / "worker.js").write_text(worker, encoding="utf-8")
    visit.ask("navigator.serviceWorker.getRegistration().then((kept) => kept.update()).then(() => null)")
    visit.until("navigator.serviceWorker.getRegistration().then(({ waiting }) => waiting !== null)")
    deadline = monotonic() + PATIENCE_S
    while visit.ask("caches.keys().then((names) => names.sort().join())") != "agora-build-next,agora-site":
        assert monotonic() < deadline, "the next build never took the place of the old one"
        visit.page.goto("about:blank")  # no page of the old one is open, as soon as the browser has put the last away
        visit.page.wait_for_timeout(200)
        visit.page.goto(f"{showing.url}icon.svg")
    visit.page.context.set_offline(True)
    visit.page.goto(showing.url)
    assert "next build" in visit.page.content()


def integrity(data: bytes) -> str:
    """Return a file's hash as a browser checks it."""
    return f"sha256-{b64encode(sha256(data).digest()).decode()}"
