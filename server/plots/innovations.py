"""The filter error over time with its mean dashed: the paper's figures "Filter errors", and the error against truth below."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from server.plots.style import FAINT, SELECTOR_COLOURS, SELECTOR_DASHES, house_style, new_figure
from server.plots.trace import Trace

_WINDOW_S = 10.0


def innovation_figure(traces: Sequence[Trace]) -> Figure:
    """Draw the filter error of each trace (of one log), and beneath it what the paper lacks: the distance from the truth.

    Faint is each update, strong their mean over ten seconds, dashed the mean of the whole.
    """
    has_truth = traces[0].has_truth
    groups = list(dict.fromkeys(trace.sensors for trace in traces))
    with house_style():
        figure = new_figure(2.35 if not has_truth else 4.0)
        grid = figure.subplots(1 + has_truth, len(groups), squeeze=False, sharex=True, sharey="row")
        for column, sensors in enumerate(groups):
            members = [trace for trace in traces if trace.sensors == sensors]
            for trace in members:
                _errors(grid[0, column], trace)
                if has_truth:
                    _truth(grid[1, column], trace)
            grid[0, column].set_title(f"({'abcdefgh'[column]}) {sensors}")
            grid[0, column].legend(loc="upper right", ncols=2)
            grid[-1, column].set_xlabel("time, s")
        top = max(float(np.percentile(trace.update_m, 99.0)) for trace in traces)
        grid[0, 0].set(ylabel="filter error, m", ylim=(0.0, 1.35 * top))
        if has_truth:
            grid[1, 0].set_ylabel("error against truth, m")
            grid[1, 0].set_ylim(bottom=0.0)
    return figure


def innovation_caption(traces: Sequence[Trace]) -> str:
    """Give the means that are dashed."""
    parts = [f"{trace.estimator} {np.mean(trace.update_m):.3f} m" for trace in traces]
    below = (
        " Below, what the paper does not show: the horizontal distance from the truth, which a small filter error does not promise."
        if traces[0].has_truth
        else ""
    )
    return (
        f"Filter error of {traces[0].log}: how far each measured position was from the predicted one. Faint is every update, "
        "strong the mean of ten seconds, dashed the mean of all: " + ", ".join(parts) + f".{below}"
    )


def _errors(axes: Axes, trace: Trace) -> None:
    colour = SELECTOR_COLOURS.get(trace.selector, FAINT)
    axes.plot(trace.update_t_s, trace.update_m, color=colour, linewidth=0.35, alpha=0.35)
    period_s = float(np.median(np.diff(trace.update_t_s))) if len(trace.update_t_s) > 1 else 1.0
    width = min(max(1, round(_WINDOW_S / period_s)), len(trace.update_m))
    smooth = np.convolve(trace.update_m, np.full(width, 1.0 / width), mode="valid")
    axes.plot(
        trace.update_t_s[width // 2 : width // 2 + len(smooth)],
        smooth,
        color=colour,
        linewidth=1.5,
        label=trace.selector.upper(),
    )
    axes.axhline(float(np.mean(trace.update_m)), color=colour, linestyle="--", linewidth=1.0)


def _truth(axes: Axes, trace: Trace) -> None:
    colour = SELECTOR_COLOURS.get(trace.selector, FAINT)
    axes.plot(trace.t_s, trace.error_m, color=colour, linestyle=SELECTOR_DASHES.get(trace.selector, "-"), linewidth=1.0)
