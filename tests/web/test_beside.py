"""Beside a walker: drawn where its rig says it is, followed, looked out of, and in the company of others."""

import json
from collections.abc import Iterator
from math import dist
from pathlib import Path
from time import monotonic
from typing import Any

import pytest
from playwright.sync_api import Browser
from websockets.sync.client import connect
from websockets.sync.connection import Connection

from server.local import LocalServer
from tests.web.pages import PATIENCE_S, ArPage, open_page
from tests.web.strolling import ESTIMATOR, EYES_M, MOTION_MODEL, NAME, place_at, serving_square, standing_at, strolling

pytestmark = pytest.mark.browser

_SAMPLE = """(count) => new Promise((resolve) => {
    const seen = [];
    const look = () => {
        const [walker] = agora.walkers();
        if (walker && walker.t_ns !== seen.at(-1)?.t_ns) seen.push({ ...walker, drawn: agora.stats().posesDrawn });
        if (seen.length >= count) resolve(seen);
        else requestAnimationFrame(look);
    };
    look();
})"""
"""Walkers of one picture after the other."""
_ROUNDS = 4


@pytest.fixture(scope="module")
def square(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LocalServer]:
    """A server where somebody walks."""
    with serving_square(tmp_path_factory.mktemp("square")) as server, strolling(server):
        yield server


@pytest.fixture(scope="module")
def page(browser: Browser, square: LocalServer) -> Iterator[ArPage]:
    """The start page with the walker in it."""
    with open_page(browser, locale="en-GB", reduced_motion="reduce") as page:
        page.page.goto(square.url)
        page.until("globalThis.agora?.walkers().length === 1")
        page.ask("agora.ready")
        page.page.click("#beside summary")  # on a small screen it is folded at first
        yield page
        assert page.errors == []


def test_a_walker_is_drawn_within_five_centimetres_of_the_told_poses(page: ArPage) -> None:
    """In fifteen pictures one after the other. Where this machine lets a pose come late meanwhile, in the next fifteen."""
    page.ask(_SAMPLE, 5)  # the clocks have met
    for _ in range(_ROUNDS):
        seen = page.ask(_SAMPLE, 15)
        times = [walker["t_ns"] for walker in seen]
        assert times == sorted(times)
        drawn = [walker["drawn"] for walker in seen]
        assert drawn == sorted(set(drawn))
        off_m = [dist(walker["place_site_m"], place_at(walker["t_ns"])) for walker in seen]
        if max(off_m) < 0.05:
            return
    pytest.fail(f"the walker is drawn {max(off_m):.3f} m from where it was told to be")


def test_the_page_says_what_it_draws(page: ArPage) -> None:
    stats = page.stats()
    assert (stats["estimator"], stats["motionModel"], stats["walkers"]) == (ESTIMATOR, MOTION_MODEL, 1)
    assert stats["poseAgeMs"] >= 0.0
    assert stats["posesDrawn"] > 0
    page.until("document.querySelector('#beside').innerText.includes('known within 0.5 m')")
    assert NAME in page.page.inner_text("#beside")


def test_a_walker_is_followed_until_one_goes_by_oneself(page: ArPage) -> None:
    press(page, "Follow")
    page.until(f"{_AWAY_M} < 7")
    seen_m = [page.ask(f"async () => {{ await ({_SAMPLE})(2); return {_AWAY_M}; }}") for _ in range(10)]
    assert 5.0 < min(seen_m) <= max(seen_m) < 6.0  # no wall stands behind the walker here
    press(page, "Leave")
    page.until("document.querySelector('#beside [data-on=true]') === null")
    page.until(f"{_AWAY_M} > 7")


def test_one_looks_out_of_a_walkers_eyes(page: ArPage) -> None:
    press(page, "Their eyes")
    page.until(f"{_AWAY_M} < 0.001")
    T, wxyz = page.ask("[agora.pose().T_site_cam, agora.walkers()[0].wxyz_site_body]")
    w, _, _, z = wxyz
    assert (T[2], T[6]) == pytest.approx((w * w - z * z, 2.0 * w * z), abs=1e-3), "it looks where the walker looks"
    assert T[11] == pytest.approx(EYES_M, abs=0.01)
    page.page.focus("#view")
    page.page.keyboard.down("w")  # who goes by themselves is let go
    page.until("document.querySelector('#beside [data-on=true]') === null")
    page.page.keyboard.up("w")


def test_those_who_watch_see_each_other(page: ArPage, square: LocalServer) -> None:
    eye = {"place_site_m": [1.0, -6.0, 1.7], "heading_rad": 0.0, "pitch_rad": 0.0}
    with other(square) as watching:
        watching.send(json.dumps({"type": "look", "eye": eye}))
        page.until("document.querySelector('#beside').innerText.includes('2 people are watching')")
        page.until("agora.stats().seen === 1")
        mine = page.ask("agora.pose().T_site_cam")
        place = [mine[3], mine[7], mine[11]]
        company_with(watching, lambda seen: any(dist(one["eye"]["place_site_m"], place) < 0.1 for one in seen))
        page.page.uncheck("#beside input")
        company_with(watching, lambda seen: [one["eye"] for one in seen] == [eye])
        page.page.check("#beside input")
    page.until("agora.stats().seen === 0")


def test_who_stops_walking_is_gone(browser: Browser, square: LocalServer) -> None:
    with open_page(browser) as page:
        with strolling(square, "second"):
            page.page.goto(square.url)
            page.until("globalThis.agora?.walkers().length === 2")
        page.until("agora.walkers().length === 1")
        assert page.ask("agora.walkers()[0].name") == NAME


def test_the_page_is_at_its_finest_beside_who_stands(browser: Browser, tmp_path: Path) -> None:
    """Also without a graphics card, and also as who follows: poses that tremble are not drawn, each for itself."""
    with serving_square(tmp_path) as server, strolling(server, told=standing_at), open_page(browser) as page:
        page.page.goto(f"{server.url}")
        page.until("globalThis.agora?.walkers().length === 1")
        page.page.click("#beside summary")
        press(page, "Follow")
        page.until("agora.stats().fineness === 1 && agora.stats().whole && agora.stats().posesDrawn > 30")
        before = page.stats()
        page.until(f"agora.stats().posesDrawn > {before['posesDrawn'] + 30}")
        after = page.stats()
        assert after["fineness"] == 1.0
        assert after["framesDrawn"] < before["framesDrawn"] + 10


def test_the_page_is_at_its_finest_beside_who_walks(page: ArPage) -> None:
    """What stands still is kept, and only who moves is drawn anew."""
    page.until("agora.stats().fineness === 1 && agora.stats().whole")
    before = page.stats()["posesDrawn"]
    page.until(f"agora.stats().posesDrawn > {before + 30}")
    stats = page.stats()
    assert (stats["fineness"], stats["whole"]) == (1.0, True)


_AWAY_M = """(() => {
    const T = agora.pose().T_site_cam;
    const [e, n, u] = agora.walkers()[0].place_site_m;
    return Math.hypot(T[3] - e, T[7] - n, T[11] - u);
})()"""
"""How far the camera is from the walker."""


def press(page: ArPage, label: str) -> None:
    """Press one of the walker's buttons."""
    page.page.click(f"#beside button:text-is('{label}')")


def other(square: LocalServer) -> Connection:
    """Watch as somebody else."""
    url = square.url.replace("http", "ws", 1) + f"ws/view/{NAME}?pictures=none"
    return connect(url, compression=None, proxy=None, close_timeout=0.5)


def company_with(watching: Connection, holds: Any) -> None:
    """Wait until those who are seen are as wanted."""
    deadline = monotonic() + PATIENCE_S
    seen: Any = None
    while monotonic() < deadline:
        message = watching.recv(PATIENCE_S)
        if isinstance(message, str) and (told := json.loads(message))["type"] == "company":
            seen = told["seen"]
            if holds(seen):
                return
    raise AssertionError(f"waited in vain; seen were {seen}")
