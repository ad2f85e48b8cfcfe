"""The AR page looks as it looked when somebody last looked at it: at three hours, in every style of doubt, on both displays.

After a change that is meant to be seen: `python -m tests.web.ar_gallery`, and look at tests/golden/ar.
"""

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser

from tests.web.ar_gallery import GOLDEN, PAGES, STYLES, Shot, shots, showing
from tests.web.likeness import LEAST_LIKENESS, MOST_DIFFERENCE, Picture, difference, kept, likeness

pytestmark = pytest.mark.browser

SEEN = 2.0
"""Of 255: another hour of the sun changes a picture by more than this in the mean."""


@pytest.fixture(scope="module")
def drawn(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Shot]]:
    """Every page as this machine draws it now."""
    with showing(tmp_path_factory.mktemp("ar")) as served:
        yield {shot.name: shot for shot in shots(browser, served.url)}


def golden(name: str) -> Picture:
    """Return the picture that is kept."""
    return kept(GOLDEN / f"{name}.webp", "python -m tests.web.ar_gallery")


@pytest.mark.parametrize("name", [*PAGES, *(f"style.{style}" for style in STYLES)])
def test_the_page_looks_as_it_did(drawn: dict[str, Shot], name: str) -> None:
    now, before = drawn[name].picture, golden(name)
    assert now.shape == before.shape
    assert difference(now, before) < MOST_DIFFERENCE
    assert likeness(now, before) > LEAST_LIKENESS


def test_every_hour_has_its_own_light() -> None:
    hours = [golden(name) for name in PAGES if name.startswith("sun.")]
    assert len(hours) == 3
    for i, hour in enumerate(hours):
        for other in hours[i + 1 :]:
            assert difference(hour, other) > SEEN


def test_every_style_is_told_from_the_others() -> None:
    locked, ghost, guide = (golden(f"style.{style}") for style in STYLES)
    assert difference(locked, ghost) > SEEN
    assert difference(ghost, guide) > SEEN
    assert difference(locked, guide) > SEEN


def test_both_eyes_see_the_same_picture_but_for_their_distance() -> None:
    both = golden("hmd.eyes")
    left, right = both[:, :320], both[:, 320:]
    assert likeness(np.ascontiguousarray(left), np.ascontiguousarray(right)) > LEAST_LIKENESS
    assert difference(np.ascontiguousarray(left), np.ascontiguousarray(right)) < MOST_DIFFERENCE
    assert likeness(both, golden("hmd")) < LEAST_LIKENESS
