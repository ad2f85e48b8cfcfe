"""Figures of the fuzzy controller itself: its memberships, its outputs and its rules."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from server.plots.style import FAINT, INK, MODEL_COLOURS, PAPER, house_style, new_figure
from tracker.fuzzy import (
    LEVELS,
    MOTION_MODELS,
    POSITION_MEMBERSHIP_M,
    ROTATION_MEMBERSHIP_RAD,
    RULES,
    Membership,
)

_LEVEL_LOOKS = {"Low": ("#33383d", "-"), "Medium": ("#2f7fd0", "--"), "High": ("#d9660a", "-.")}


def membership_figure(
    position: Membership = POSITION_MEMBERSHIP_M, rotation: Membership = ROTATION_MEMBERSHIP_RAD
) -> Figure:
    """Draw the input membership functions: the paper's figure "Input membership functions"."""
    with house_style():
        figure = new_figure(2.3)
        left, right = figure.subplots(1, 2, sharey=True)
        _memberships(left, position, "(a) Positional innovation", "m")
        _memberships(right, rotation, "(b) Rotational innovation", "rad")
        left.set_ylabel("degree of membership")
    return figure


def membership_caption(
    position: Membership = POSITION_MEMBERSHIP_M, rotation: Membership = ROTATION_MEMBERSHIP_RAD
) -> str:
    """Say at which innovations the strongest level changes."""
    (p_1, p_2), (r_1, r_2) = _crossings(position), _crossings(rotation)
    return (
        "Input membership functions for the positional and the rotational innovation. "
        "The rule that fires most strongly wins, so the controller changes its mind where two functions cross: "
        f"at {p_1:.2f} and {p_2:.2f} m, and at {r_1:.3f} and {r_2:.3f} rad "
        f"({np.degrees(r_1):.1f} and {np.degrees(r_2):.1f} degrees)."
    )


def _crossings(membership: Membership) -> tuple[float, float]:
    return (membership.low + membership.medium) / 2.0, (membership.medium + membership.high) / 2.0


def _memberships(axes: Axes, membership: Membership, title: str, unit: str) -> None:
    end = membership.high * 1.25
    x = np.unique([0.0, membership.low, membership.medium, membership.high, end])
    degrees = np.array([membership.degrees(value) for value in x])
    places = (membership.low / 2.0, membership.medium, (membership.high + end) / 2.0)
    for level, column, place in zip(LEVELS, degrees.T, places, strict=True):
        colour, dash = _LEVEL_LOOKS[level]
        axes.plot(x, column, color=colour, linestyle=dash, linewidth=1.8)
        axes.text(place, 1.04, level, color=colour, ha="center", va="bottom")
    for crossing in _crossings(membership):
        axes.axvline(crossing, color=FAINT, linewidth=0.7, linestyle=":")
    axes.set(title=f"{title}\n", xlabel=f"size of the innovation, {unit}", xlim=(0.0, end), ylim=(0.0, 1.02))


def output_figure() -> Figure:
    """Draw the output's singletons, in the colours that every path is drawn in: the paper's "Output membership function"."""
    with house_style():
        figure = new_figure(1.7)
        axes = figure.subplots()
        for place, model in enumerate(map(str, MOTION_MODELS)):
            axes.vlines(place, 0.0, 1.0, color=MODEL_COLOURS[model], linewidth=2.0 + 3.0 * int(model[1]))
            axes.plot(place, 1.0, "o", color=MODEL_COLOURS[model], markersize=7.0)
        axes.set(ylabel="degree", ylim=(0.0, 1.15), xlim=(-0.6, 8.6), yticks=(0.0, 1.0))
        axes.set_xticks(range(9), [str(model) for model in MOTION_MODELS])
        axes.grid(visible=False)
    return figure


OUTPUT_CAPTION = (
    "Output membership function: nine singletons, one for each motion model. "
    "Grey rests (P0), blue walks on with its velocity (P1), orange with twice its velocity (P2); dark holds the head still (R0), "
    "light turns it on at twice its rate (R2). Paths below are drawn in these colours, and thicker from P0 to P2, "
    "so that they can be told apart in print without colour."
)


def rule_figure() -> Figure:
    """Draw all 81 rules: rows are the present model, columns the two levels, a cell the model that follows."""
    with house_style():
        figure = new_figure(3.6)
        axes = figure.subplots()
        columns = [(y_p, y_r) for y_p in LEVELS for y_r in LEVELS]
        for row, model in enumerate(MOTION_MODELS):
            for column, (y_p, y_r) in enumerate(columns):
                _rule(axes, column, row, str(RULES[y_p, y_r, model]), kept=RULES[y_p, y_r, model] == model)
        axes.set(xlim=(0, 9), ylim=(9, 0), ylabel="present model")
        axes.set_xticks(np.arange(9) + 0.5, [y_r for _, y_r in columns])
        axes.set_yticks(np.arange(9) + 0.5, [str(model) for model in MOTION_MODELS])
        axes.set_xlabel("rotational innovation, within each positional one")
        axes.xaxis.set_label_position("bottom")
        for place, level in enumerate(LEVELS):
            axes.text(3 * place + 1.5, -0.25, f"positional innovation {level}", ha="center", va="bottom")
            axes.axvline(3 * place, color=INK, linewidth=1.2)
        axes.tick_params(length=0)
        axes.grid(visible=False)
        axes.spines[:].set_visible(False)
    return figure


def rule_caption() -> str:
    """Count what the rules do."""
    kept = sum(following == model for (_, _, model), following in RULES.items())
    return (
        "The 81 rules as one look-up table: each cell is the model that follows. "
        f"Framed: the {kept} rules that keep the present model. The paper prints the 54 rules of R0 and R2 rows; "
        "the 27 of the R1 rows follow from them, because each index moves by its own innovation alone."
    )


def _rule(axes: Axes, column: int, row: int, following: str, *, kept: bool) -> None:
    colour = MODEL_COLOURS[following]
    axes.add_patch(Rectangle((column + 0.03, row + 0.05), 0.94, 0.9, facecolor=colour, linewidth=0.0))
    if kept:
        axes.add_patch(
            Rectangle((column + 0.1, row + 0.14), 0.8, 0.72, fill=False, edgecolor=_text_on(colour), linewidth=0.9)
        )
    axes.text(column + 0.5, row + 0.52, following, color=_text_on(colour), ha="center", va="center", fontsize=7.5)


def _text_on(colour: str) -> str:
    """Return ink or paper, whichever reads better on a colour."""
    red, green, blue = (int(colour[place : place + 2], 16) for place in (1, 3, 5))
    return PAPER if 0.299 * red + 0.587 * green + 0.114 * blue < 140.0 else INK
