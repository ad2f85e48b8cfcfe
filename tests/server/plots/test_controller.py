"""The controller's figures show the rules and memberships that the tracker uses."""

import numpy as np
import pytest
from matplotlib.patches import Rectangle

from server.plots.controller import membership_caption, membership_figure, output_figure, rule_caption, rule_figure
from tracker.fuzzy import LEVELS, MOTION_MODELS, RULES, Membership


def test_memberships_are_drawn_through_their_breakpoints() -> None:
    """Three lines an axis, whose values at any place are the degrees there."""
    position = Membership(0.5, 1.5, 3.0)
    axes = membership_figure(position).axes[0]
    for y in np.linspace(0.0, 3.5, 15):
        drawn = [np.interp(y, line.get_xdata(), line.get_ydata()) for line in axes.lines[:3]]  # type: ignore[arg-type]
        assert drawn == pytest.approx(position.degrees(y))


def test_the_caption_says_where_the_controller_changes_its_mind() -> None:
    assert "at 2.00 and 4.50 m" in membership_caption(Membership(1.0, 3.0, 6.0))


def test_every_rule_has_its_cell() -> None:
    """81 cells, each with the name of what follows, and the frames of those that keep the model."""
    axes = rule_figure().axes[0]
    cells = {(text.get_position()[0], text.get_position()[1]): text.get_text() for text in axes.texts}
    columns = [(y_p, y_r) for y_p in LEVELS for y_r in LEVELS]
    for row, model in enumerate(MOTION_MODELS):
        for column, (y_p, y_r) in enumerate(columns):
            assert cells[column + 0.5, row + 0.52] == str(RULES[y_p, y_r, model])
    frames = [patch for patch in axes.patches if isinstance(patch, Rectangle) and not patch.get_fill()]
    kept = sum(following == model for (_, _, model), following in RULES.items())
    assert len(frames) == kept
    assert f"the {kept} rules that keep" in rule_caption()


def test_nine_singletons() -> None:
    labels = [label.get_text() for label in output_figure().axes[0].get_xticklabels()]
    assert labels == [str(model) for model in MOTION_MODELS]
