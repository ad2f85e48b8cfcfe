"""The sweep's maps: a square for each variant at its crossings, with its number, and the default's framed."""

import pytest
from matplotlib.patches import Rectangle

from server.plots.sensitivity import crossings, sensitivity_caption, sensitivity_figure
from tracker.score import Figures


def _variant(factor: str, position_m: list[float], wins: int, step: float = 1.1) -> Figures:
    return {
        "factor": factor,
        "position_m": position_m,
        "rotation_rad": [0.05, 0.15, 0.4],
        "wins": wins,
        "rotation_wins": 9,
        "step_ratio_mean": step,
    }


DEFAULT = _variant("default", [0.5, 1.5, 3.0], 8)
VARIANTS = [
    DEFAULT,
    _variant("position", [0.5, 1.5, 3.0], 8),
    _variant("position", [0.25, 0.75, 3.75], 10, step=1.43),
    _variant("rotation", [0.5, 1.5, 3.0], 8),
]


def test_crossings() -> None:
    assert crossings([0.5, 1.5, 3.0]) == (1.0, 2.25)


def test_every_variant_stands_at_its_crossings() -> None:
    axes = sensitivity_figure(VARIANTS, DEFAULT, 10).axes[0]
    lows = [float(label.get_text()) for label in axes.get_yticklabels()]
    highs = [float(label.get_text()) for label in axes.get_xticklabels()]
    found = {(lows[int(t.get_position()[1])], highs[int(t.get_position()[0])]): t.get_text() for t in axes.texts}
    assert found == {(1.0, 2.25): "8", (0.5, 2.25): "10"}
    frames = [patch for patch in axes.patches if isinstance(patch, Rectangle) and not patch.get_fill()]
    assert [(frame.get_x() + 0.46, frame.get_y() + 0.46) for frame in frames] == [
        pytest.approx((highs.index(2.25), lows.index(1.0)))
    ]


def test_the_price_is_beside_it() -> None:
    figure = sensitivity_figure(VARIANTS, DEFAULT, 10)
    assert sorted(text.get_text() for text in figure.axes[1].texts) == ["1.10", "1.43"]
    caption = sensitivity_caption(VARIANTS, DEFAULT, 10)
    assert "win 8; on this grid it is 8 to 10, and up to 9 in rotation (the defaults: 9)" in caption
