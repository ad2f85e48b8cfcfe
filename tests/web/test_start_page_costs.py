"""The State Agora on the start page: what its first picture and every stop of the tour cost, and that its ground is walked on."""

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser

from assets.site import load_site
from server.showing import Showing
from tests.web.gallery import showing_site
from tests.web.pages import ArPage, open_page
from tests.web.walk import ROOT

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SITE = load_site(ROOT / "assets" / "state_agora")
STOPS = (SITE.default_view, *SITE.tour)
MOST_CALLS, MOST_TRIANGLES, MOST_BYTES = 120, 250_000, 3_000_000
"""What a phone draws, and what may come before there is a picture."""


@pytest.fixture(scope="module")
def agora(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Showing]:
    """The State Agora as it is built."""
    with showing_site(tmp_path_factory.mktemp("agora")) as showing:
        yield showing


@pytest.fixture(scope="module")
def page(browser: Browser, agora: Showing) -> Iterator[ArPage]:
    """Its start page, with nobody walking, at its first picture, where what came until then was counted."""
    with open_page(browser, locale="en-GB", service_workers="block") as page:
        came: list[int] = []
        cdp = page.page.context.new_cdp_session(page.page)
        cdp.send("Network.enable")
        cdp.on("Network.dataReceived", lambda event: came.append(event["dataLength"]))
        page.page.goto(f"{agora.url}?walkers=0", wait_until="commit")
        page.until("globalThis.agora !== undefined")
        page.ask("agora.ready")
        page.ask("bytes => { globalThis.cameFirst = bytes; }", sum(came))
        page.settle()
        yield page
        assert page.errors == []


def test_little_comes_before_the_first_picture(page: ArPage) -> None:
    assert 1_000_000 < page.ask("cameFirst") < MOST_BYTES


@pytest.mark.parametrize("past", [1, 0])
def test_every_stop_of_the_tour_costs_what_a_phone_draws(page: ArPage, past: int) -> None:
    for stop in STOPS:
        page.go(f"view={stop.id}&past={past}")
        stats = page.stats()
        assert stats["model"] == ("roman" if past else "today")
        assert 0 < stats["drawCalls"] <= MOST_CALLS, stop.id
        assert 1000 < stats["triangles"] <= MOST_TRIANGLES, stop.id


def test_one_walks_on_the_ground_and_not_into_a_wall(page: ArPage) -> None:
    page.go("view=long_axis&past=1")
    before = np.array(page.ask("agora.pose().T_site_cam")).reshape(4, 4)
    page.page.keyboard.down("w")
    page.until(
        f"Math.hypot(agora.pose().T_site_cam[3] - {before[0, 3]}, agora.pose().T_site_cam[7] - {before[1, 3]}) > 2"
    )
    page.page.keyboard.up("w")
    page.settle()
    after = np.array(page.ask("agora.pose().T_site_cam")).reshape(4, 4)
    assert np.dot(after[:2, 3] - before[:2, 3], before[:2, 2]) > 1.9  # the way it looked
    assert after[2, 3] == pytest.approx(SITE.eye_height_m, abs=0.3)
    assert page.stats()["way"] == "walk"
