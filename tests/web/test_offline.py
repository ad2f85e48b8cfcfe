"""Without a network, after one visit: the start page as it was, the AR page as far as it goes, and no mixture of two builds."""

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from server.replay import ReplaySettings
from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.walk import NAME, WEB, make_site, write_log
from tracker.log import Log

pytestmark = pytest.mark.browser

KEPT = "document.querySelector('.kept')?.hidden === false"


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    """A copy of the pages that a test may change."""
    return shutil.copytree(WEB, tmp_path / "dist")


@pytest.fixture
def showing(tmp_path: Path, bundle: Path) -> Iterator[Showing]:
    """A server of those pages."""
    write_log(tmp_path / f"{NAME}.mcap")
    settings = ReplaySettings(estimator="truth", looping=True)
    log = Log.open(tmp_path / f"{NAME}.mcap")
    with Showing(make_site(tmp_path), log, settings, port=0, web=bundle) as showing:
        yield showing


@pytest.fixture
def visit(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The start page, visited once, and kept."""
    with open_page(browser, service_workers="allow", locale="en-GB") as page:
        page.page.goto(showing.url)
        page.ask("agora.ready")
        page.until(KEPT)
        page.forget()
        yield page


def kept(page: Page) -> list[str]:
    """Return the paths of all that is kept."""
    read = """async () => {
        const caches_ = await Promise.all((await caches.keys()).map((name) => caches.open(name)));
        const requests = await Promise.all(caches_.map((cache) => cache.keys()));
        return requests.flat().map(({ url }) => new URL(url).pathname);
    }"""
    paths: list[str] = page.evaluate(read)
    return paths


def test_the_square_is_there_without_a_network(visit: ArPage, showing: Showing) -> None:
    triangles = visit.ask("agora.stats().triangles")
    visit.page.context.set_offline(True)
    visit.page.reload()
    visit.ask("agora.ready")
    visit.until("agora.stats()?.whole")
    assert visit.ask("agora.stats().triangles") >= triangles > 0
    assert visit.page.inner_text("h1") == "State Agora of Ephesus"
    visit.page.goto(f"{showing.url}?lang=tr")
    visit.ask("agora.ready")
    assert visit.page.inner_text("h1") == "Efes Devlet Agorası"


def test_the_ar_page_says_that_nobody_walks(visit: ArPage, showing: Showing) -> None:
    visit.page.context.set_offline(True)
    visit.page.goto(f"{showing.url}ar")
    visit.until("document.querySelector('#notice').textContent.startsWith('Nobody is walking')")


def test_all_of_the_build_and_of_the_site_is_kept(visit: ArPage, bundle: Path) -> None:
    paths = kept(visit.page)
    assert len(paths) == len(set(paths))
    files = {f"/{path.relative_to(bundle).as_posix()}" for path in bundle.rglob("*") if path.is_file()}
    assert files - {"/worker.js", "/.complete"} <= set(paths)
    assert {"/api/site", "/models/roman.0.glb", "/models/roman.2.glb"} <= set(paths)


def test_a_build_with_a_file_of_another_one_is_not_kept(visit: ArPage, showing: Showing, bundle: Path) -> None:
    before = sorted(kept(visit.page))
    (bundle / "ar.html").write_text("<p>of the next build</p>", encoding="utf-8")
    worker = bundle / "worker.js"
    worker.write_text(worker.read_text(encoding="utf-8") + "\n// the next build's", encoding="utf-8")
    visit.ask("navigator.serviceWorker.getRegistration().then((kept) => kept.update()).catch(() => null)")
    visit.until(
        "navigator.serviceWorker.getRegistration().then(({ installing, waiting }) => installing === null && waiting === null)"
    )
    assert sorted(kept(visit.page)) == before
    visit.page.context.set_offline(True)
    visit.page.goto(f"{showing.url}ar")
    assert "next build" not in visit.page.content()


def test_with_a_network_the_servers_own_page_is_shown(visit: ArPage, showing: Showing, bundle: Path) -> None:
    (bundle / "index.html").write_text("<p>of the next build</p>", encoding="utf-8")
    visit.page.goto(showing.url)
    assert "next build" in visit.page.content()


def test_the_manifest_names_icons_that_are_there(browser: Browser, showing: Showing) -> None:
    with open_page(browser) as page:
        page.page.goto(showing.url)
        address = page.page.get_attribute("link[rel=manifest]", "href")
        assert address is not None
        manifest = page.ask("url => fetch(url).then((answer) => answer.json())", address)
        assert (manifest["start_url"], manifest["display"]) == ("/", "standalone")
        sizes = {icon["sizes"] for icon in manifest["icons"]}
        assert {"192x192", "512x512"} <= sizes
        for icon in manifest["icons"]:
            answer = page.page.request.get(showing.url.rstrip("/") + icon["src"])
            assert answer.ok
            assert re.match(icon["type"].replace("+", r"\+"), answer.headers["content-type"])
