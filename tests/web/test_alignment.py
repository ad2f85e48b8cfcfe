"""Alignment through the page: a compass that is 15 degrees off, three landmarks tapped, and what the next minute looks like."""

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.compass_walk import LANDMARKS, REST_S, TAPS_S, TURNING_S, CompassWalk, point_of, showing_compass_walk
from tests.web.pages import ArPage, open_page
from tracker.geometry import wrap_rad
from tracker.measurements import Matrix

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FINGER_PX = np.array([[2.0, -1.0], [-2.0, 1.5], [1.0, 2.0]])
"""By how much each tap misses."""
FAR_M = 50.0


def said(ar: ArPage) -> int:
    """Return how often the rig was asked to align so far."""
    return len([message for message in ar.sent if message.get("action") == "align"])


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Showing, CompassWalk]]:
    """The walk on a server."""
    with showing_compass_walk(tmp_path_factory.mktemp("aligned")) as shown:
        yield shown


@pytest.fixture(scope="module")
def walk(shown: tuple[Showing, CompassWalk]) -> CompassWalk:
    """Its truth."""
    return shown[1]


@pytest.fixture(scope="module")
def ar(browser: Browser, shown: tuple[Showing, CompassWalk]) -> Iterator[ArPage]:
    """The page, paused, aligning, without the model's cost."""
    with open_page(browser) as page:
        page.page.goto(f"{shown[0].url}ar")
        page.until_drawn()
        page.ask("agora.setPast(0)")
        page.pause()
        yield page


def go_to(ar: ArPage, position_s: float) -> int:
    """Go to a place of the walk; return the picture that is drawn there."""
    ar.seek(position_s)
    before = int(position_s * 10.0) - 1
    # a place further on shows its picture first, and its pose when it is found
    ar.until(
        f"Math.abs(agora.stats().lastFrameId - {before}) <= 1 && agora.pose()?.frameId === agora.stats().lastFrameId"
    )
    frame_id: int = ar.stats()["lastFrameId"]
    return frame_id


def pose(ar: ArPage) -> Matrix:
    """Return the pose of the picture that is drawn, (4, 4)."""
    return np.array(ar.ask("agora.pose().T_site_cam")).reshape(4, 4)


def heading_off_rad(ar: ArPage, walk: CompassWalk, frame_id: int) -> float:
    """Return by how much the page's heading is off."""
    ahead, truth = pose(ar)[:2, 2], walk.T_site_cam(frame_id)[:2, 2]
    return wrap_rad(float(np.arctan2(ahead[1], ahead[0]) - np.arctan2(truth[1], truth[0])))


def lateral_off_m(ar: ArPage, walk: CompassWalk, frame_id: int) -> float:
    """Return how far aside a corner 50 m ahead is drawn, where it stands."""
    corner = walk.T_site_cam(frame_id) @ (0.0, 0.0, FAR_M, 1.0)
    x, _, z, _ = np.linalg.inv(pose(ar)) @ corner
    return float(FAR_M * x / z)


def tap(ar: ArPage, walk: CompassWalk, which: int) -> int:
    """Point out a landmark as a visitor does, a little beside it; return the picture that it was done in."""
    frame_id = go_to(ar, TAPS_S[which])
    x, y = walk.pixel_of(point_of(LANDMARKS[which]), frame_id) + FINGER_PX[which] + 0.5
    asked = said(ar)
    ar.page.mouse.click(float(x), float(y))
    ar.page.locator(f"[data-landmark={LANDMARKS[which]}]").evaluate("(button) => button.click()")
    assert ar.replied("align", asked + 1)["ok"]
    return frame_id


def test_three_taps_put_a_compass_right_for_a_minute(ar: ArPage, walk: CompassWalk) -> None:
    """And after the first one the landmark stays under the finger while the visitor turns about on the spot."""
    before = go_to(ar, TAPS_S[0])
    assert abs(heading_off_rad(ar, walk, before)) > np.radians(8.0)
    assert ar.stats()["overlay"] == "guide"

    ar.page.click("#align")
    tap(ar, walk, 0)
    for position_s in np.linspace(*TURNING_S, 9):
        frame_id = go_to(ar, float(position_s))
        drawn_px = ar.ask("(point) => agora.project(point)", list(point_of(LANDMARKS[0])))
        off_px = np.linalg.norm(drawn_px - walk.pixel_of(point_of(LANDMARKS[0]), frame_id))
        assert off_px < 10.0, f"at {position_s:.1f} s"

    tap(ar, walk, 1)
    tap(ar, walk, 2)
    headings, aside = [], []
    for position_s in np.linspace(*REST_S, 16):
        frame_id = go_to(ar, float(position_s))
        headings.append(heading_off_rad(ar, walk, frame_id))
        aside.append(lateral_off_m(ar, walk, frame_id))
    assert np.degrees(np.sqrt(np.mean(np.square(headings)))) < 1.0
    assert np.max(np.abs(aside)) < 1.0
    assert ar.stats()["overlay"] == "locked"
    assert ar.errors == []


def test_what_is_taken_back_was_never_said(ar: ArPage, walk: CompassWalk) -> None:
    """Three times: then the compass is as wrong as it was, and there is nothing left to take back."""
    go_to(ar, TAPS_S[2] + 1.0)
    for count in range(4):
        asked = said(ar)
        ar.page.click("#take-back")
        reply = ar.replied("align", asked + 1)
        assert reply["ok"] == (count < 3)
    assert "within a minute" in reply["error"]
    frame_id = go_to(ar, TAPS_S[2] + 2.0)
    assert abs(heading_off_rad(ar, walk, frame_id)) > np.radians(5.0)
