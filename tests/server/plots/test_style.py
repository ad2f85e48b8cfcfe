"""The house style: nine models that differ without colour, and files that are the same bytes every time."""

import itertools

import matplotlib as mpl
import pytest

from server.plots.controller import membership_caption, membership_figure
from server.plots.style import MODEL_COLOURS, SELECTOR_COLOURS, Kind, drawn, house_style, model_handles, model_width
from tracker.estimators import SELECTORS
from tracker.fuzzy import MOTION_MODELS


def _lightness(colour: str) -> float:
    """Return CIE L*, 0 to 100, of #rrggbb."""
    linear = [
        value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
        for value in (int(colour[place : place + 2], 16) / 255.0 for place in (1, 3, 5))
    ]
    y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    return 116.0 * y ** (1.0 / 3.0) - 16.0 if y > 0.008856 else 903.3 * y


def test_models_of_one_width_differ_in_lightness() -> None:
    """In greyscale the width tells P and the lightness R: two models of one width are at least 15 of 100 apart."""
    for i in "012":
        shades = [_lightness(MODEL_COLOURS[f"P{i}R{j}"]) for j in "012"]
        assert all(after - before > 15.0 for before, after in itertools.pairwise(shades)), shades
    widths = [model_width(f"P{i}R0") for i in "012"]
    assert all(after > 1.5 * before for before, after in itertools.pairwise(widths)), widths


def test_every_model_and_every_rival_has_a_colour() -> None:
    assert {str(model) for model in MOTION_MODELS} | {"-"} == set(MODEL_COLOURS)
    assert set(SELECTORS) <= set(SELECTOR_COLOURS)
    assert [handle.get_label() for handle in model_handles({"P2R1", "P0R0"})] == ["P0R0", "P2R1"]


@pytest.mark.parametrize("kind", ["svg", "png"])
def test_the_same_figure_is_the_same_bytes(kind: Kind) -> None:
    first, second = (drawn(membership_figure(), "memberships", membership_caption(), kind) for _ in range(2))
    assert first.data == second.data
    assert b"<dc:date>" not in first.data
    assert first.alt == "Input membership functions for the positional and the rotational innovation"


def test_the_machines_own_settings_do_not_show() -> None:
    with mpl.rc_context({"font.size": 30.0, "lines.linewidth": 9.0}):
        loud = drawn(membership_figure(), "memberships", "").data
        assert mpl.rcParams["font.size"] == 30.0
    assert loud == drawn(membership_figure(), "memberships", "").data
    with house_style():
        assert mpl.rcParams["font.size"] < 12.0
