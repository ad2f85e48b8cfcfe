"""The pages in a real browser: picture and pose belong together, and the rig does what the bar asks for."""

import json
from collections.abc import Iterator
from typing import Any
from urllib.request import urlopen

import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.walk import BROKEN_FRAME, frame_at, position_of

pytestmark = pytest.mark.browser

_STATS = {
    *("framesDrawn", "posesDrawn", "mismatchedFrames", "lastFrameId", "lastPoseFrameId", "poseAgeMs"),
    *("motionModel", "estimator", "overlay", "drawCalls", "triangles", "occluders"),
    *("effort", "drawMs", "sun", "gain", "position_s"),
}
_SAMPLE = """(count) => new Promise((resolve) => {
    const seen = [];
    const look = () => {
        const stats = agora.stats();
        if (stats.framesDrawn !== seen.at(-1)?.framesDrawn) seen.push({ ...stats, pose: agora.pose()?.frameId ?? null });
        if (seen.length >= count) resolve(seen);
        else requestAnimationFrame(look);
    };
    look();
})"""


@pytest.fixture(scope="module")
def shared_page(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """One AR page for many tests: its first drawing in software takes seconds."""
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}ar")
        page.until_drawn()
        yield page


@pytest.fixture
def ar(shared_page: ArPage) -> Iterator[ArPage]:
    """The page, playing, without the model's cost; the replay goes on as it was for the next test."""
    shared_page.ask("agora.setPast(0)")
    shared_page.forget()
    yield shared_page
    _restore(shared_page)


def _restore(ar: ArPage) -> None:
    """Leave the replay as every test finds it: playing, at its own pace, by the truth."""
    session = ar.ask("agora.session()")
    if session["estimator"] != "truth":
        ar.page.select_option("#estimator", "truth")
        ar.until("agora.session().estimator === 'truth'")
    if session["playback"]["speed"] != 1:
        ar.page.select_option("#speed", "1")
        ar.until("agora.session().playback.speed === 1")
    if not ar.ask("agora.session().playback.playing"):
        ar.page.click("#play")
        ar.until("agora.session().playback.playing")


def session_of(showing: Showing) -> dict[str, Any]:
    """Return the one session as the server describes it."""
    with urlopen(f"{showing.url}api/sessions") as answer:
        (session,) = json.load(answer)["sessions"]
    return dict(session)


def test_every_picture_is_drawn_with_its_own_pose(ar: ArPage) -> None:
    seen = ar.ask(_SAMPLE, 25)
    ar.ask("agora.setPast(1)")
    with_model = ar.ask(_SAMPLE, 6)
    assert all(stats["triangles"] > 0 for stats in with_model)
    for stats in seen + with_model:
        assert stats["lastFrameId"] == stats["lastPoseFrameId"] == stats["pose"]
        assert stats["mismatchedFrames"] == 0
        assert stats["posesDrawn"] - seen[0]["posesDrawn"] == stats["framesDrawn"] - seen[0]["framesDrawn"]
        assert (stats["overlay"], stats["estimator"]) == ("locked", "truth")
    assert len({stats["lastFrameId"] for stats in seen}) > 15
    assert ar.errors == []


def test_the_support_interface_cannot_be_changed(ar: ArPage) -> None:
    assert ar.ask("Object.isFrozen(agora) && !Object.getOwnPropertyDescriptor(globalThis, 'agora').writable")
    assert set(ar.stats()) == _STATS
    assert len(ar.ask("agora.pose().T_site_cam")) == 16
    assert len(ar.ask("agora.pose().cov")) == 36


def test_pause_and_play_reach_the_rig(ar: ArPage, showing: Showing) -> None:
    ar.pause()
    assert ar.replied("pause")["ok"]
    assert session_of(showing)["playback"]["playing"] is False
    ar.until("document.querySelector('#rate').textContent === 'paused'")
    assert ar.page.get_attribute("#play", "aria-label") == "Play"
    ar.page.locator("#seek").press("Home")
    ar.until("agora.stats().lastFrameId === 0")
    ar.page.locator("#seek").press(" ")
    assert ar.replied("play")["ok"]
    ar.until("agora.session().playback.playing && agora.stats().lastFrameId > 0")
    assert session_of(showing)["playback"]["playing"] is True


def test_a_seek_shows_the_picture_of_that_place(ar: ArPage, showing: Showing) -> None:
    ar.pause()
    for position_s in (4.0, 1.5):
        ar.seek(position_s)
        ar.until(f"agora.stats().lastFrameId === {frame_at(position_s)}")
        assert session_of(showing)["playback"]["position_s"] == pytest.approx(position_s)
    assert ar.replied("seek", 2)["did_seek"] is True
    ar.page.locator("#seek").press("Home")
    ar.until("agora.stats().lastFrameId === 0")
    assert ar.page.inner_text("#clock") == "0:00"
    start_s = ar.ask("agora.session().playback.position_s")
    ar.page.locator("#seek").press("ArrowRight")
    ar.until(f"agora.stats().lastFrameId === {frame_at(start_s + 5.0)}")
    ar.until("document.querySelector('#seek').ariaValueText?.startsWith('0:05 of ')")


def test_speed_and_estimator_reach_the_rig(ar: ArPage, showing: Showing) -> None:
    ar.page.select_option("#speed", "2")
    assert ar.replied("speed")["ok"]
    assert session_of(showing)["playback"]["speed"] == 2.0
    ar.until("agora.session().playback.speed === 2")
    ar.page.locator("#play").press("ArrowDown")
    assert ar.replied("speed", 2)["ok"]
    assert session_of(showing)["playback"]["speed"] == 1.0
    ar.page.select_option("#estimator", "gps-imu/cmm")
    assert ar.replied("estimator")["ok"]
    assert session_of(showing)["estimator"] == "gps-imu/cmm"
    ar.until("agora.session().estimator === 'gps-imu/cmm'")
    assert ar.page.input_value("#estimator") == "gps-imu/cmm"


def test_a_refusal_is_shown_in_the_rigs_words(ar: ArPage) -> None:
    # in one go: the page sets the walk's own end again with each message of its session
    ar.ask("(() => { seek.max = '99'; seek.value = '98'; seek.dispatchEvent(new Event('change')); })()")
    reply = ar.replied("seek")
    assert not reply["ok"]
    ar.until("!document.querySelector('#toast').hidden")
    assert ar.page.inner_text("#toast") == reply["error"]


def test_a_picture_that_does_not_decode_is_left_out(ar: ArPage) -> None:
    ar.pause()
    ar.seek(position_of(BROKEN_FRAME - 1))
    ar.until(f"agora.stats().lastFrameId === {BROKEN_FRAME - 1}")
    ar.forget()
    ar.seek(position_of(BROKEN_FRAME))
    ar.until_acknowledged(BROKEN_FRAME)
    assert ar.stats()["lastFrameId"] == BROKEN_FRAME - 1
    ar.seek(position_of(BROKEN_FRAME + 1))
    ar.until(f"agora.stats().lastFrameId === {BROKEN_FRAME + 1}")
    assert ar.errors == []


def test_the_panels_can_be_hidden_but_not_the_credit(ar: ArPage) -> None:
    ar.page.click("#hide")
    assert not ar.page.is_visible("#bar")
    assert ar.page.is_visible("#credit")
    ar.page.mouse.click(320, 200)
    assert ar.page.is_visible("#bar")
    assert "OpenStreetMap" in ar.page.inner_text("#credit")
    assert "ODbL" in ar.page.inner_text("#credit")
