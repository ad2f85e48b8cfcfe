"""Golden pictures: the tour looks as it looked when somebody last looked at it, and costs what a phone can draw.

After a change that is meant to be seen: `make gallery`, and look at docs/gallery.md.
"""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from assets.site import load_site
from tests.web.gallery import GALLERY, GOLDEN, VIEWS, Shot, gallery, shots, showing_site
from tests.web.likeness import LEAST_LIKENESS, MOST_DIFFERENCE, Picture, difference, kept, likeness
from tests.web.walk import ROOT

pytestmark = [pytest.mark.browser, pytest.mark.slow]

NAMES = [f"{model}.{view}" for model, views in VIEWS.items() for view in views]


@pytest.fixture(scope="module")
def drawn(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Shot]]:
    """Every view as this machine draws it now."""
    with showing_site(tmp_path_factory.mktemp("gallery")) as showing:
        yield {shot.name: shot for shot in shots(browser, showing.url)}


def golden(name: str) -> Picture:
    """Return the picture that is kept."""
    return kept(GOLDEN / f"{name}.webp", "make gallery")


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
