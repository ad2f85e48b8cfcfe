"""What the sweep found: how many cells FAMM wins as its thresholds move, and at what price."""

from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from server.plots.style import INK, PAPER, WORSE, house_style, new_figure
from tracker.score import Figures

_DARK = 0.55
"""From this share of the colour scale on, white letters read better than black ones."""


def crossings(breakpoints: Sequence[float]) -> tuple[float, float]:
    """Return where Low meets Medium, and Medium meets High, of a membership's three breakpoints: all that a rule sees of it."""
    low, medium, high = breakpoints
    return (low + medium) / 2.0, (medium + high) / 2.0


def sensitivity_figure(variants: Sequence[Figures], default: Figures, cells: int) -> Figure:
    """Draw the cells that FAMM wins over a grid of both memberships' crossings, and the jitter that a position grid costs.

    Args:
        variants: Rows of the sweep.
        default: The row of the shipped settings, framed where the grid has it.
        cells: How many cells there are to win.
    """
    positions, rotations = (_grid(variants, factor) for factor in ("position", "rotation"))
    panels = (
        ("(a) filter error:\ncells won", "position_m", [(r, r["wins"] / cells, f"{r['wins']}") for r in positions]),
        (
            "(b) tremble\nagainst CMM's",
            "position_m",
            [(r, _heat(r["step_ratio_mean"]), f"{r['step_ratio_mean']:.2f}") for r in positions],
        ),
        (
            "(c) rotational error:\ncells won",
            "rotation_rad",
            [(r, r["rotation_wins"] / cells, f"{r['rotation_wins']}") for r in rotations],
        ),
    )
    with house_style():
        figure = new_figure(3.9)
        for axes, (title, key, marks) in zip(figure.subplots(1, len(panels)), panels, strict=True):
            _map(axes, key, marks, crossings(default[key]))
            axes.set_title(title)
            unit = "m" if key == "position_m" else "rad"
            axes.set(xlabel=f"Medium meets High, {unit}", ylabel=f"Low meets Medium, {unit}")
    return figure


def _map(axes: Axes, key: str, marks: Sequence[tuple[Figures, float, str]], default: tuple[float, float]) -> None:
    """Draw one square for each row: darker for a larger share of the scale, its number in it, the default's framed."""
    places = [tuple(round(place, 6) for place in crossings(row[key])) for row, _, _ in marks]
    lows, highs = sorted({low for low, _ in places}), sorted({high for _, high in places})
    colours = matplotlib.colormaps["Blues"]
    for (low, high), (_, share, text) in zip(places, marks, strict=True):
        x, y = highs.index(high), lows.index(low)
        axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1.0, 1.0, facecolor=colours(0.9 * share), edgecolor=PAPER))
        axes.text(x, y, text, ha="center", va="center", fontsize=7.0, color=PAPER if share > _DARK else INK)
        if np.allclose((low, high), default):
            axes.add_patch(Rectangle((x - 0.46, y - 0.46), 0.92, 0.92, fill=False, edgecolor=WORSE, linewidth=1.6))
    axes.set(xlim=(-0.5, len(highs) - 0.5), ylim=(-0.5, len(lows) - 0.5))
    axes.set_xticks(range(len(highs)), [f"{high:g}" for high in highs])
    axes.set_yticks(range(len(lows)), [f"{low:g}" for low in lows])
    axes.tick_params(length=0)
    axes.grid(visible=False)


def sensitivity_caption(variants: Sequence[Figures], default: Figures, cells: int) -> str:
    """Say what the defaults win, and what the best do."""
    positions, rotations = (_grid(variants, factor) for factor in ("position", "rotation"))
    most = max(row["wins"] for row in positions)
    least = min(row["wins"] for row in positions)
    turns = max(row["rotation_wins"] for row in rotations)
    return (
        "The sweep over the memberships, by where their functions cross. (a) In how many of "
        f"{cells} cells FAMM's filter error is below CMM's; (b) the root mean square step of FAMM's error from one update to the "
        "next as a multiple of CMM's, which a visitor sees as trembling; (c) as (a), for the rotational filter error and its own "
        f"thresholds. The shipped defaults (framed where the grid holds them) win {default['wins']}; on this grid it is {least} to "
        f"{most}, and up to {turns} in rotation (the defaults: {default['rotation_wins']})."
    )


def _grid(variants: Sequence[Figures], factor: str) -> list[Figures]:
    return [row for row in variants if row["factor"] == factor]


def _heat(ratio: float) -> float:
    """Return a ratio's place on the colour scale: 1 is light, 2 and more are dark."""
    return float(np.clip(ratio - 1.0, 0.0, 1.0))
