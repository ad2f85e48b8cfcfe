"""Paths over the plan of the place, coloured by the motion model: the paper's figures of real and estimated paths."""

import itertools
from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from server.plots.plan import Plan, draw_plan
from server.plots.style import (
    MODEL_COLOURS,
    RAW_GPS,
    TRUTH,
    house_style,
    model_handles,
    model_width,
    new_figure,
)
from server.plots.trace import Names, Trace
from tracker.estimator import NO_MOTION_MODEL

_LEAST_M = 12.0
"""A path is shown in a square no narrower: who stands still must not look like one who walks."""


def path_figure(traces: Sequence[Trace], plan: Plan = ()) -> Figure:
    """Draw the truth, where there is one, then each estimate, all in the same frame.

    Args:
        traces: Of one log, in the order of the panels. The paper's figure has four below the truth: GPS and IMU, and with the
            camera, first under the constant and then under the fuzzy motion model.
        plan: Outlines of what stands there.
    """
    rows = 1 + -(-len(traces) // 2)
    (left, right), (bottom, top) = _window(traces)
    height_in = min(9.4, rows * (3.2 * (top - bottom) / (right - left) + 0.3) + 0.35)
    with house_style():
        figure = new_figure(height_in)
        grid = figure.subplots(rows, 2, sharex=True, sharey=True)
        _known(grid[0, 0], traces[0])
        panels = [grid[0, 0], *grid[1:].ravel()[: len(traces)]]
        for panel, trace, letter in zip(panels[1:], traces, "bcdefgh", strict=False):
            _path(panel, trace, f"({letter}) {trace.estimator}")
        for panel in panels:
            draw_plan(panel, plan)
            panel.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        for panel in {grid[0, 1], *grid.ravel()} - set(panels):
            panel.set_axis_off()
        for panel in grid[:, 0]:
            panel.set_ylabel("north, m")
        for panel in panels[-2:]:
            panel.set_xlabel("east, m")
            panel.tick_params(labelbottom=True)
        models = {str(name) for trace in traces for name in np.unique(trace.model)}
        grid[0, 1].legend(handles=model_handles(models, 0.7), loc="center", ncols=3, title="motion model")
    return figure


def path_caption(traces: Sequence[Trace]) -> str:
    """Say what each panel is, how far each path strays, and which model made most of it."""
    first = traces[0]
    parts = [
        f"({letter}) {trace.estimator}{_strays(trace)}, {_most_used(trace)}"
        for letter, trace in zip("bcdefgh", traces, strict=False)
    ]
    begin = "Real and estimated paths of" if first.has_truth else "Estimated paths of"
    known = (
        "(a) Ground truth, and the receiver's own fixes as dots" if first.has_truth else "(a) The receiver's own fixes"
    )
    return f"{begin} {first.log}. Colour and width tell the motion model. {known}; " + "; ".join(parts) + "."


def _strays(trace: Trace) -> str:
    error = trace.error_m[trace.scored]
    return f", {np.sqrt(np.mean(error**2)):.2f} m RMS from the truth" if len(error) else ""


def _most_used(trace: Trace) -> str:
    models, whole = (trace.update_model, "its updates") if len(trace.update_model) else (trace.model, "the time")
    names, counts = np.unique(models[models != NO_MOTION_MODEL], return_counts=True)
    if len(names) == 0:
        return "no motion model"
    best = int(np.argmax(counts))
    return f"{names[best]} in {100.0 * counts[best] / counts.sum():.0f} % of {whole}"


def runs_of(model: Names) -> Iterator[tuple[str, slice]]:
    """Yield stretches of one model; each reaches to the first sample of the next, so that lines join."""
    edges = [0, *(np.flatnonzero(model[1:] != model[:-1]) + 1).tolist(), len(model)]
    for start, stop in itertools.pairwise(edges):
        if stop > start:
            yield str(model[start]), slice(start, min(stop + 1, len(model)))


def _known(axes: Axes, trace: Trace) -> None:
    axes.plot(*trace.fix_site_m[:, :2].T, ".", color=RAW_GPS, markersize=2.0, linewidth=0.0)
    axes.plot(*trace.truth_p_site_m[:, :2].T, color=TRUTH, linewidth=1.2)
    axes.set_title("(a) Ground truth and GPS fixes" if trace.has_truth else "(a) GPS fixes")


def _path(axes: Axes, trace: Trace, title: str) -> None:
    axes.plot(*trace.truth_p_site_m[:, :2].T, color=RAW_GPS, linewidth=0.7)
    for model, part in runs_of(trace.model):
        axes.plot(
            *trace.p_site_m[part, :2].T,
            color=MODEL_COLOURS.get(model, TRUTH),
            linewidth=model_width(model, 0.6),
            solid_capstyle="butt",
        )
    axes.set_title(title)


def _window(traces: Sequence[Trace]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the limits east and north that hold every path, with a margin; landscape rather than a narrow strip."""
    points = np.vstack([part[:, :2] for t in traces for part in (t.p_site_m, t.truth_p_site_m, t.fix_site_m)])
    points = points[np.all(np.isfinite(points), axis=1)]
    if len(points) == 0:
        points = np.zeros((1, 2))
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = (low + high) / 2.0, np.maximum((high - low) * 1.06, _LEAST_M)
    size = np.maximum(size, [size[1], 0.45 * size[0]])
    (left, bottom), (right, top) = middle - size / 2.0, middle + size / 2.0
    return (float(left), float(right)), (float(bottom), float(top))
