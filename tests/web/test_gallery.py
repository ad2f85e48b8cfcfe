"""Golden pictures: the tour looks as it looked when somebody last looked at it, and costs what a phone can draw.

After a change that is meant to be seen: `make gallery`, and look at docs/gallery.md.
"""

from collections.abc import Iterator

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from assets.site import load_site
from tests.web.gallery import GALLERY, GOLDEN, VIEWS, Picture, Shot, gallery, shots, showing_site
from tests.web.walk import ROOT

pytestmark = [pytest.mark.browser, pytest.mark.slow]

NAMES = [f"{model}.{view}" for model, views in VIEWS.items() for view in views]
MOST_DIFFERENCE = 8.0
"""Mean, of 255, once both pictures are small and blurred: another version of the software renderer stays far below."""
LEAST_LIKENESS = 0.85
"""Of local structure, 1 for the same."""


@pytest.fixture(scope="module")
def drawn(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Shot]]:
    """Every view as this machine draws it now."""
    with showing_site(tmp_path_factory.mktemp("gallery")) as showing:
        yield {shot.name: shot for shot in shots(browser, showing.url)}


def golden(name: str) -> Picture:
    """Return the picture that is kept."""
    picture = cv2.imread(str(GOLDEN / f"{name}.webp"), cv2.IMREAD_COLOR)
    assert picture is not None, f"there is no golden picture of {name}: make gallery"
    return np.asarray(picture, np.uint8)


def small(picture: Picture) -> NDArray[np.float64]:
    """Return a picture at a quarter of its size, blurred: edges that moved by a pixel are the same."""
    quarter = cv2.resize(picture, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.GaussianBlur(quarter, (0, 0), 1.5), np.float64)


def difference(a: Picture, b: Picture) -> float:
    """Return the mean difference of two pictures, 0 to 255."""
    return float(np.abs(small(a) - small(b)).mean())


def likeness(a: Picture, b: Picture) -> float:
    """Return the mean structural similarity (Wang et al. 2004) of two pictures' greys."""

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(cv2.GaussianBlur(values, (0, 0), 3.0), np.float64)

    x, y = (small(picture).mean(axis=2) for picture in (a, b))
    mx, my = mean(x), mean(y)
    vx, vy, cxy = mean(x * x) - mx * mx, mean(y * y) - my * my, mean(x * y) - mx * my
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    return float(((2 * mx * my + c1) * (2 * cxy + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2))).mean())


@pytest.mark.parametrize("name", [*NAMES, *(f"{name}.evidence" for name in NAMES)])
def test_the_tour_looks_as_it_did(drawn: dict[str, Shot], name: str) -> None:
    now, before = drawn[name].picture, golden(name)
    assert now.shape == before.shape
    assert difference(now, before) < MOST_DIFFERENCE
    assert likeness(now, before) > LEAST_LIKENESS


def test_another_view_does_not_pass_for_this_one() -> None:
    for i, name in enumerate(NAMES):
        for other in NAMES[i + 1 :]:
            a, b = golden(name), golden(other)
            assert difference(a, b) > MOST_DIFFERENCE or likeness(a, b) < LEAST_LIKENESS, (name, other)


@pytest.mark.parametrize("name", NAMES)
def test_the_tint_is_seen(drawn: dict[str, Shot], name: str) -> None:
    assert difference(drawn[name].picture, drawn[f"{name}.evidence"].picture) > MOST_DIFFERENCE


def test_no_view_costs_more_than_a_phone_draws(drawn: dict[str, Shot]) -> None:
    for name, shot in drawn.items():
        assert 0 < shot.stats["drawCalls"] <= 120, name
        assert 1000 < shot.stats["triangles"] <= 250_000, name


def test_the_gallery_shows_all_of_them_and_they_are_small() -> None:
    assert GALLERY.read_text(encoding="utf-8") == gallery(load_site(ROOT / "assets" / "state_agora"))
    files = sorted(GOLDEN.iterdir())
    assert [file.name for file in files] == sorted(f"{name}{s}.webp" for name in NAMES for s in ("", ".evidence"))
    assert sum(file.stat().st_size for file in files) < 2_000_000
