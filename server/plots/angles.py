"""Orientation over time, coloured by the motion model: the paper's figures of estimated rotations."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from server.plots.paths import runs_of
from server.plots.style import MODEL_COLOURS, RAW_GPS, TRUTH, house_style, model_handles, model_width, new_figure
from server.plots.trace import Array, Trace

_NAMES = ("roll", "pitch", "yaw")


def angle_figure(traces: Sequence[Trace], window_s: tuple[float, float] | None = None) -> Figure:
    """Draw roll, pitch and yaw of each trace (of one log) in its own column, the truth in grey behind, and the yaw's error.

    Args:
        traces: One or two.
        window_s: From and to when; None for all of it.
    """
    error = any(np.any(np.isfinite(trace.turn_error_rad)) for trace in traces)
    with house_style():
        figure = new_figure(4.2 + 1.0 * error)
        grid = figure.subplots(3 + error, len(traces), squeeze=False, sharex=True, sharey="row")
        for column, whole in enumerate(traces):
            trace = _cut(whole, window_s)
            for row in range(3):
                _angle(grid[row, column], trace, row)
            if error:
                grid[3, column].axhline(0.0, color=RAW_GPS, linewidth=2.2)
                _coloured(grid[3, column], trace, np.degrees(trace.turn_error_rad[:, 2]))
            grid[0, column].set_title(f"({'abcdefgh'[column]}) {trace.estimator}")
            grid[-1, column].set_xlabel("time, s")
        for row, name in enumerate((*_NAMES, "yaw error")[: 3 + error]):
            grid[row, 0].set_ylabel(f"{name}, °")
        models = {str(name) for trace in traces for name in np.unique(_cut(trace, window_s).model)}
        handles = model_handles(models, 0.7)
        if handles:
            figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), columnspacing=1.2)
    return figure


def angle_caption(traces: Sequence[Trace], window_s: tuple[float, float] | None = None) -> str:
    """Say how far the angles are from the truth, over the whole walk."""
    parts = [f"({letter}) {trace.estimator}{_errors(trace)}" for letter, trace in zip("abcdefgh", traces, strict=False)]
    behind = "; the truth is grey" if np.any(np.isfinite(traces[0].truth_rpy_rad)) else ""
    when = f"from {window_s[0]:.0f} to {window_s[1]:.0f} s" if window_s else "over time"
    return (
        f"Orientation of {traces[0].log} {when}. Colour and width tell the motion model{behind}. "
        + "; ".join(parts)
        + "."
    )


def _errors(trace: Trace) -> str:
    error = trace.turn_error_rad[trace.scored]
    if not np.any(np.isfinite(error)):
        return ""
    roll, pitch, yaw = np.degrees(np.sqrt(np.nanmean(error**2, axis=0)))
    return f", RMS error {roll:.1f}, {pitch:.1f} and {yaw:.1f} degrees in roll, pitch and yaw over the whole walk"


def _cut(trace: Trace, window_s: tuple[float, float] | None) -> Trace:
    if window_s is None:
        return trace
    inside = (trace.t_s >= window_s[0]) & (trace.t_s <= window_s[1])
    arrays = ("t_s", "p_site_m", "rpy_rad", "model", "truth_p_site_m", "truth_rpy_rad")
    return replace(trace, **{name: getattr(trace, name)[inside] for name in arrays})


def _angle(axes: Axes, trace: Trace, row: int) -> None:
    if row == 2:
        # the truth is unwrapped, and the estimate laid on the turn nearest to it: an error of 1 degree looks like one
        truth = _unwrapped(trace.truth_rpy_rad[:, row])
        angle = _unwrapped(trace.rpy_rad[:, row])
        if np.any(np.isfinite(truth)):
            angle = angle - 2.0 * np.pi * np.round(np.nanmedian(angle - truth) / (2.0 * np.pi))
    else:
        truth, angle = trace.truth_rpy_rad[:, row], trace.rpy_rad[:, row]
    axes.plot(trace.t_s, np.degrees(truth), color=RAW_GPS, linewidth=2.2)
    _coloured(axes, trace, np.degrees(angle))


def _coloured(axes: Axes, trace: Trace, values: Array) -> None:
    for model, part in runs_of(trace.model):
        axes.plot(
            trace.t_s[part],
            values[part],
            color=MODEL_COLOURS.get(model, TRUTH),
            linewidth=model_width(model, 0.5),
            solid_capstyle="butt",
        )


def _unwrapped(angle_rad: Array) -> Array:
    out = angle_rad.copy()
    known = np.isfinite(out)
    out[known] = np.unwrap(out[known])
    return out
