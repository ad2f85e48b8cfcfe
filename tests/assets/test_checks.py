"""What monuments must be to each other: no overlap but of those that stand on one another."""

from dataclasses import replace
from pathlib import Path

import pytest

from assets.checks import TOUCH_M, check_monuments
from assets.errors import SiteError
from assets.records import Footprint, Monument
from assets.site import Site

FILE = Path("monuments.toml")
SQUARE = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))


@pytest.fixture
def base(site: Site) -> Monument:
    return at(replace(site.monument("pollio"), id="base"), 0.0)


def at(monument: Monument, east_m: float, size: float = 1.0) -> Monument:
    corners = tuple((east_m + size * e, size * n) for e, n in SQUARE)
    return replace(monument, footprint=Footprint(corners, "OSM", "M", 1.0))


def test_neighbours_may_touch(base: Monument) -> None:
    check_monuments(FILE, [base, at(replace(base, id="next"), 10.0 - TOUCH_M)])


def test_an_overlap_is_named_with_both(base: Monument) -> None:
    with pytest.raises(SiteError, match=r"monuments\.toml: 'next\.footprint' overlaps that of 'base' by 50\.0 square"):
        check_monuments(FILE, [base, at(replace(base, id="next"), 5.0)])


def test_what_stands_on_another_overlaps_it(base: Monument) -> None:
    upper = at(replace(base, id="upper", stands_on="base"), 2.0, 0.5)
    check_monuments(FILE, [base, upper, at(replace(base, id="top", stands_on="upper"), 3.0, 0.2)])


def test_what_no_model_shows_together_may_overlap(base: Monument) -> None:
    check_monuments(FILE, [replace(base, epochs=("roman",)), at(replace(base, id="late", epochs=("today",)), 1.0)])
    check_monuments(FILE, [base, at(replace(base, id="lost", epochs=()), 1.0)])


@pytest.mark.parametrize("bearer", ["nothing", "base"])
def test_a_bearer_must_be_another_monument(base: Monument, bearer: str) -> None:
    with pytest.raises(SiteError, match=rf"'base\.stands_on' is '{bearer}', which is no other monument"):
        check_monuments(FILE, [replace(base, stands_on=bearer)])


@pytest.mark.parametrize(
    ("corners", "says"),
    [
        (((0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)), r"is no outline: Self-intersection"),
        (((0.0, 0.0), (5.0, 0.0), (9.0, 0.0)), r"is no outline"),
        (SQUARE[::-1], r"runs clockwise; list the corners counter-clockwise"),
    ],
)
def test_a_footprint_is_an_outline(base: Monument, corners: tuple[tuple[float, float], ...], says: str) -> None:
    with pytest.raises(SiteError, match=rf"'base\.footprint\.value' {says}"):
        check_monuments(FILE, [replace(base, footprint=Footprint(corners, "OSM", "M", 1.0))])
