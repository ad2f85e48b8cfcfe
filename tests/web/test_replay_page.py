"""A replay's page in a real browser: all of it by the keyboard, curves and figures of estimators, and a walk in one file."""

from collections.abc import Iterator
from pathlib import Path
from shutil import copy

import numpy as np
import pytest
from playwright.sync_api import Browser, Route

from server.evaluation import evaluate
from server.reviewing.command import export
from server.showing import Showing
from tests.web.pages import ArPage, open_page
from tests.web.walk import CORNERS, NAME, ROOT, SETTINGS, frame_at, make_site, write_log

pytestmark = pytest.mark.browser

LAST = round(SETTINGS.duration_s * SETTINGS.camera_hz) - 1
_QUERY = "?effort=first+paint"


@pytest.fixture(scope="module")
def shared_page(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """One page for many tests: its first drawing in software takes seconds."""
    with open_page(browser) as page:
        page.page.route("**/timeline", with_a_silence)
        page.page.goto(showing.page + _QUERY)
        page.until_drawn()
        page.until("document.querySelectorAll('#charts figure').length > 0")
        yield page


def with_a_silence(route: Route) -> None:
    """Pass the walk's timeline on, in which nothing happens, with a silence of the receiver."""
    answer = route.fetch()
    silence = {"kind": "silence", "sensor": "gps", "from_s": 2.0, "until_s": 3.5}
    route.fulfill(response=answer, json={**answer.json(), "events": [silence]})


@pytest.fixture
def replay(shared_page: ArPage) -> Iterator[ArPage]:
    """The page, paused at the start, without the model's cost, and with the focus nowhere."""
    shared_page.ask("agora.setPast(0)")
    shared_page.ask("document.activeElement.blur()")
    if shared_page.ask("agora.session().playback.playing"):
        shared_page.page.keyboard.press(" ")
        shared_page.until("!agora.session().playback.playing")
    shared_page.page.keyboard.press("Home")
    shared_page.until("agora.stats().lastFrameId === 0 && agora.session().playback.position_s < 0.1")
    shared_page.forget()
    yield shared_page
    assert shared_page.errors == []


def until_frame(replay: ArPage, frame_id: int) -> None:
    replay.until(f"agora.stats().lastFrameId === {frame_id}")


def test_a_whole_replay_by_the_keyboard_alone(replay: ArPage) -> None:
    press = replay.page.keyboard.press
    for frame_id in (1, 2):
        press(".")
        until_frame(replay, frame_id)
    press(",")
    until_frame(replay, 1)
    press("ArrowRight")
    until_frame(replay, frame_at(replay.ask("agora.session().playback.position_s")))
    replay.until("agora.session().playback.position_s > 4.9")
    press("End")
    until_frame(replay, LAST)
    press("Shift+ArrowLeft")
    until_frame(replay, 0)
    press("]")
    replay.until("agora.session().playback.speed === 2")
    press("[")
    replay.until("agora.session().playback.speed === 1")
    was_looping = replay.ask("agora.session().playback.looping")
    press("l")
    replay.until(f"agora.session().playback.looping === {str(not was_looping).lower()}")
    press("l")
    replay.until(f"agora.session().playback.looping === {str(was_looping).lower()}")
    press("?")
    assert replay.page.is_visible("#help")
    press("?")
    assert not replay.page.is_visible("#help")
    press(" ")
    replay.until("agora.session().playback.playing && agora.stats().lastFrameId > 0")


def test_keys_are_left_to_the_control_that_has_the_focus(replay: ArPage) -> None:
    before = replay.ask("agora.session().playback.looping")
    replay.page.focus("#loop")
    replay.page.keyboard.press(" ")
    replay.until(f"agora.session().playback.looping === {str(not before).lower()}")
    assert replay.ask("agora.session().playback.playing") is False
    replay.page.keyboard.press(" ")
    replay.until(f"agora.session().playback.looping === {str(before).lower()}")


def test_the_timeline_has_pictures_and_tells_what_happened(replay: ArPage) -> None:
    replay.until("!document.querySelector('#strip').classList.contains('bare')")
    assert replay.page.inner_text("#happenings").split("\n") == ["GPS: nothing came", "0:02 to 0:03"]
    assert replay.page.locator("#strip-marks [data-kind=silence]").count() == 1
    replay.page.click("#happenings button")
    until_frame(replay, frame_at(2.0))
    replay.until("document.querySelector('#happenings button').ariaCurrent === 'true'")
    replay.page.locator("#seek").fill("3")
    until_frame(replay, frame_at(3.0))


def test_a_click_into_a_curve_goes_there(replay: ArPage) -> None:
    over = replay.page.locator("#charts .u-over").first
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    assert box is not None
    replay.page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    reply = replay.replied("seek")
    assert reply["ok"]
    replay.until("agora.session().playback.position_s > 2 && agora.session().playback.position_s < 4")


def test_two_estimators_side_by_side_are_off_by_what_evaluate_prints(
    replay: ArPage, showing: Showing, tmp_path: Path
) -> None:
    """The walk is too short for the score, which leaves filters twenty seconds to settle: then both say nothing."""
    write_log(tmp_path / f"{NAME}.mcap")
    names = ("gps-imu/cmm", "gps-imu/famm")
    rows = evaluate([tmp_path / f"{NAME}.mcap"], names, None, lambda label, done: None).runs
    for name, row in zip(names, rows, strict=True):
        replay.page.check(f"[data-focus='draw {name}']")
        cells = f"[...document.querySelector(`[data-focus='draw {name}']`).closest('tr').cells].slice(2)"
        replay.until(f"{cells}.length === 4")
        shown = replay.ask(f"{cells}.map(cell => cell.textContent)")
        assert shown[3] == f"{row['filter_error_m']['mean']:.2f}"
        assert (shown[0] == "–") == (row["truth"] is None)
    replay.until("document.querySelectorAll('#charts figure')[0].querySelectorAll('output').length === 1")
    for name in names:
        replay.page.uncheck(f"[data-focus='draw {name}']")


def test_a_recording_that_this_server_has_no_place_for_is_refused_with_the_remedy(
    replay: ArPage, tmp_path: Path
) -> None:
    other = tmp_path / "notes.txt"
    other.write_text("no walk")
    replay.page.set_input_files("#drop-file", other)
    replay.until("document.querySelector('#drop-words').textContent.includes('.mcap')")
    replay.page.click("#drop-close")
    walk = tmp_path / "walk.mcap"
    walk.write_bytes(b"\x89MCAP0\r\n")
    replay.page.set_input_files("#drop-file", walk)
    replay.until("document.querySelector('#drop-words').textContent.includes('agora serve')")
    replay.page.click("#drop-close")
    assert not replay.page.is_visible("#drop")
    replay.errors.clear()  # the browser tells of the refusal, too


@pytest.mark.parametrize("width_px", [390, 800, 1280])
def test_nothing_runs_off_the_page(replay: ArPage, width_px: int) -> None:
    replay.page.set_viewport_size({"width": width_px, "height": 800})
    replay.until(f"document.documentElement.scrollWidth <= {width_px}")
    for control in ("#play", "#step-on", "#loop", "#speed", "#estimator", "#help-open", "#taking-open", "#open"):
        box = replay.page.locator(control).bounding_box()
        assert box is not None, control
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width_px
        assert min(box["width"], box["height"]) >= 44


@pytest.mark.parametrize("pictures", [True, False])
def test_a_walk_in_one_file_plays_without_a_server(browser: Browser, tmp_path: Path, pictures: bool) -> None:
    log, page = tmp_path / f"{NAME}.mcap", tmp_path / "walk.html"
    write_log(log)
    make_site(tmp_path)
    for facts in (ROOT / "assets" / "state_agora").glob("*.toml"):
        copy(facts, tmp_path)
    export(log, page, estimator="truth", pictures=pictures, site=tmp_path)
    with open_page(browser, offline=True) as ar:
        ar.page.goto(page.as_uri() + _QUERY)
        ar.until_drawn()
        ar.page.keyboard.press(" ")
        ar.page.keyboard.press("Home")
        until_frame(ar, 0)
        assert ar.stats()["triangles"] > 0
        ar.page.keyboard.press("End")
        until_frame(ar, LAST)
        ar.ask("agora.setPast(0)")
        ar.page.wait_for_timeout(100)
        corner = ar.pixels()[10, 10]
        is_seen = bool(np.abs(corner.astype(int) - CORNERS["top left"]).max() < 30)
        assert is_seen == pictures
        assert {url.split(":")[0] for url in ar.requests} <= {"file", "blob", "data"}
        assert ar.errors == []
