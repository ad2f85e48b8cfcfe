"""The view in words on the start page, beside what shapely sees from the same places."""

import re
from math import atan, degrees, radians, tan

import numpy as np
import pytest
from playwright.sync_api import Browser

from assets.facts import list_monuments
from assets.site import load_site
from server.showing import Showing
from tests.web.pages import SIZE_PX, open_page
from tests.web.test_golden_description import seen_from
from tests.web.walk import ROOT

pytestmark = pytest.mark.browser

VIEWS = 20
FIELD_DEG = 46.7
"""From top to bottom."""
POINTS = ("north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west")
SIDES = {"Ahead": "ahead", "To the left": "left", "To the right": "right"}


def test_what_is_told_is_what_shapely_sees(browser: Browser, showing: Showing) -> None:
    solids = list_monuments(load_site(ROOT / "assets" / "state_agora"))
    names = {solid["name"]: solid["id"] for solid in solids}
    half_deg = int(degrees(atan(tan(radians(FIELD_DEG / 2)) * SIZE_PX[0] / SIZE_PX[1])))
    rng = np.random.default_rng(77)
    with open_page(browser, locale="en-GB") as page:
        page.page.goto(f"{showing.url}?walkers=0")
        page.until("globalThis.agora?.stats()?.triangles > 0")
        for _ in range(VIEWS):
            east, north, heading = rng.uniform(-120.0, 50.0), rng.uniform(-40.0, 60.0), rng.uniform(0.0, 360.0)
            page.ask(f"void (location.hash = 'at={east:.2f},{north:.2f},40&look={heading:.2f},0&way=fly')")
            page.until(f"Math.abs(agora.pose().T_site_cam[3] - {east:.2f}) < 0.02")
            pose = page.ask("agora.pose().T_site_cam")
            page.page.keyboard.press("v")
            words = page.page.inner_text("#description")
            assert words.startswith(f"You face {POINTS[round(heading / 45.0) % 8]}.")
            told = re.findall(r"(Ahead|To the left|To the right), ([\d,]+) metres? away: ([^.]+)\.", words)
            expected = seen_from(solids, [pose[3], pose[7], pose[11]], heading, half_deg)["sights"]
            assert [(SIDES[side], names[name]) for side, _, name in told] == [(s["side"], s["id"]) for s in expected], (
                words
            )
            for (_, far, _), sight in zip(told, expected, strict=True):
                assert abs(float(far.replace(",", "")) - sight["distance_m"]) < 1.0
