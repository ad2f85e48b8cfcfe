"""Figures of the study: what was asked, whom it was measured beside, and the same on recorded walks."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from server.plots.style import BETTER, FAINT, INK, RAW_GPS, SELECTOR_COLOURS, WORSE, house_style, new_figure
from tests.benchmarks.accuracy.goals import BOTH, CAMERA
from tracker.score import Figures

_ROW_IN = 0.21
_RATIOS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
_OURS, _RIVAL = SELECTOR_COLOURS["precise"], RAW_GPS


def goals_figure(goals: Sequence[Figures]) -> Figure:
    """Draw every figure that is asked for as a share of the most that is allowed: left of one is met.

    Args:
        goals: Verdicts with one limit each; bands are left out.
    """
    rows = [row for row in goals if not isinstance(row["at_least"], list)]
    with house_style():
        figure = new_figure(0.7 + _ROW_IN * len(rows))
        axes = figure.subplots()
        axes.axvspan(0.01, 1.0, color=BETTER, alpha=0.06, linewidth=0.0)
        axes.axvline(1.0, color=INK, linewidth=0.9)
        for place, row in enumerate(rows):
            _goal(axes, place, row)
        names = [f"{row['goal']}{' (camera)' if row['estimator'] == CAMERA else ''}" for row in rows]
        axes.set_yticks(range(len(rows)), names)
        axes.set(ylim=(len(rows) - 0.4, -0.6), xlabel="measured, as a share of the most that is allowed")
        _ratio_axis(axes, [row["value"] / row["at_least"] for row in rows])
    return figure


def _goal(axes: Axes, place: int, row: Figures) -> None:
    limit = row["at_least"]
    colour = WORSE if row["met"] == "no" else BETTER
    if row["interval"] is not None:
        axes.plot([end / limit for end in row["interval"]], [place, place], color=colour, linewidth=2.2, alpha=0.45)
    axes.plot(row["value"] / limit, place, "o" if row["met"] != "no" else "D", color=colour, markersize=5.0)
    axes.plot(row["aim"] / limit, place, "|", color=FAINT, markersize=9.0)


def seeds_figure(table: Mapping[str, Sequence[float]], label: str, limit: float | None = None) -> Figure:
    """Draw one figure of every entrant, a dot for each walk and a bar for their median, the best first.

    Args:
        table: Values over walks, by entrant.
        label: Of the axis.
        limit: What is asked of ours.
    """
    order = sorted(table, key=lambda name: float(np.median(table[name])))
    with house_style():
        figure = new_figure(0.8 + 0.26 * len(order))
        axes = figure.subplots()
        for place, name in enumerate(order):
            values = np.array(table[name])
            colour = _OURS if name in BOTH else _RIVAL
            spread = place + np.linspace(-0.22, 0.22, len(values))
            axes.plot(values, spread, "o", color=colour, markersize=3.0, alpha=0.6, markeredgewidth=0.0)
            middle = float(np.median(values))
            axes.plot([middle, middle], [place - 0.34, place + 0.34], color=INK, linewidth=1.8)
        axes.set_yticks(range(len(order)), order)
        axes.set(ylim=(len(order) - 0.4, -0.6), xlabel=label)
        if limit is not None:
            axes.axvline(limit, color=WORSE, linewidth=0.9, linestyle=(0, (4, 2)))
        _ratio_axis(axes, [value for values in table.values() for value in values])
    return figure


def logs_figure(table: Mapping[str, Mapping[str, float]], label: str) -> Figure:
    """Draw one ratio of several entrants on every recorded walk; right of one is worse than the receiver alone.

    Args:
        table: Values by log, then by entrant.
        label: Of the axis.
    """
    names = sorted({name for row in table.values() for name in row}, key=lambda name: (name not in BOTH, name))
    markers = dict(zip(names, "oDs^vP*X<>", strict=False))
    with house_style():
        figure = new_figure(0.9 + 0.3 * len(table))
        axes = figure.subplots()
        axes.axvline(1.0, color=INK, linewidth=0.9)
        for place, row in enumerate(table.values()):
            for name, value in row.items():
                colour = _OURS if name in BOTH else FAINT
                axes.plot(
                    value, place, markers[name], color=colour, markersize=5.5 if name in BOTH else 4.5, alpha=0.85
                )
        for name in names:
            axes.plot([], [], markers[name], color=_OURS if name in BOTH else FAINT, label=name)
        axes.set_yticks(range(len(table)), list(table))
        axes.set(ylim=(len(table) - 0.4, -0.6), xlabel=label)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        _ratio_axis(axes, [value for row in table.values() for value in row.values()])
    return figure


def _ratio_axis(axes: Axes, values: Sequence[float]) -> None:
    """Let an axis of ratios be logarithmic, with ticks that one reads."""
    low, high = min([*values, 0.5]), max([*values, 2.0])
    axes.set_xscale("log")
    axes.set_xlim(0.85 * low, 1.15 * high)
    ticks = [ratio for ratio in _RATIOS if 0.85 * low <= ratio <= 1.15 * high]
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticklabels([f"{tick:g}" for tick in ticks])
