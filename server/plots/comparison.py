"""Figures of what holds over seeds: paired differences with their intervals, and ratios to what is compared with."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from server.plots.style import BETTER, FAINT, INK, SELECTOR_COLOURS, WORSE, house_style, new_figure
from tracker.score import Figures

_SENSORS = ("gps-imu", "camera-gps-imu")
#: Markers that differ without colour, one a dataset.
_MARKERS = {1: "o", 2: "s", 3: "D", 4: "^", 5: "v"}
#: Ratios worth a tick, the worthiest first, and how far apart they stand at least, as a share of the axis.
_RATIOS = (1.0, 10.0, 0.1, 2.0, 0.5, 5.0, 0.2, 3.0, 0.3, 1.5, 0.7, 1.2, 0.8, 1.1, 0.9)
_APART = 0.11
#: A ratio within this of one is a draw: what the project's own goal allows the camera.
_DRAW = 0.02


def change_percent(row: Figures) -> tuple[float, float, float]:
    """Return a paired comparison's mean difference and its 95 % interval in per cent of what is compared with."""
    scale = 100.0 / row["theirs_mean"]
    low, high = row["interval_t"]
    return row["difference_mean"] * scale, low * scale, high * scale


def paired_figure(rows: Sequence[Figures], printed: Mapping[tuple[int, str], float]) -> Figure:
    """Draw the ten cells of the paper's two tables: what FAMM changes in the filter error, and what the paper printed.

    Args:
        rows: Paired comparisons of one metric, one for each dataset and sensors.
        printed: The paper's own change in per cent, by dataset and sensors.
    """
    with house_style():
        figure = new_figure(2.5)
        grid = figure.subplots(1, 2, sharey=True)
        for axes, sensors, letter in zip(grid, _SENSORS, "ab", strict=True):
            for row in (row for row in rows if row["sensors"] == sensors):
                _interval(axes, row)
            for (dataset, which), change in printed.items():
                if which == sensors:
                    axes.plot(change, dataset + 0.27, "x", color=FAINT, markersize=5.0)
            axes.axvline(0.0, color=INK, linewidth=0.8)
            axes.set_title(f"({letter}) {sensors}")
            axes.set(xlabel="FAMM's filter error against CMM's, %", ylim=(5.6, 0.4), yticks=range(1, 6))
            axes.set_xscale("symlog", linthresh=10.0)
            ticks = [-50, -10, -5, 0, 5, 10, 100]
            axes.set_xticks(ticks, [f"{tick:+d}" if tick else "0" for tick in ticks])
            axes.set_xlim(-80.0, max(250.0, *(1.3 * change_percent(row)[0] for row in rows)))
        grid[0].set_ylabel("dataset")
    return figure


def _interval(axes: Axes, row: Figures) -> None:
    mean, low, high = change_percent(row)
    colour = BETTER if mean < 0.0 else WORSE
    sure = low > 0.0 or high < 0.0
    axes.plot([low, high], [row["dataset"]] * 2, color=colour, linewidth=2.2, solid_capstyle="butt")
    axes.plot(mean, row["dataset"], "o", color=colour, markersize=6.0, markerfacecolor=colour if sure else "white")


def paired_caption(rows: Sequence[Figures]) -> str:
    """Count the cells that FAMM wins."""
    lower = sum(row["difference_mean"] < 0.0 for row in rows)
    surely = sum(row["interval_t"][1] < 0.0 for row in rows)
    higher = sum(row["interval_t"][0] > 0.0 for row in rows)
    seeds = max((row["n"] for row in rows), default=0)
    return (
        f"What FAMM changes in the filter error, paired over {seeds} seeds a dataset. Dots are the mean difference in per cent of "
        "CMM's error, bars its 95 % interval, hollow where that holds zero; crosses are what the paper printed for its one "
        f"recording of each. FAMM's error is lower in {lower} of {len(rows)} cells, in {surely} of them with an interval that "
        f"excludes zero, and higher beyond doubt in {higher}. The axis is logarithmic beyond ten per cent."
    )


def camera_figure(rows: Sequence[Figures]) -> Figure:
    """Draw what the camera changes: the median ratio over seeds, with it to without it, of four figures."""
    metrics = (
        ("ate_m", "ATE"),
        ("rpe_10s_m", "RPE over 10 s"),
        ("jitter_m", "jitter"),
        ("filter_error_m", "filter error"),
    )
    with house_style():
        figure = new_figure(2.5)
        grid = figure.subplots(1, len(metrics), sharey=True)
        for axes, (metric, name), letter in zip(grid, metrics, "abcd", strict=True):
            for place, model in enumerate(("cmm", "famm")):
                found = [row for row in rows if row["metric"] == metric and row["model"] == model]
                axes.plot(
                    [row["ratio_median"] for row in found],
                    [row["dataset"] + 0.24 * place - 0.12 for row in found],
                    "os"[place],
                    color=SELECTOR_COLOURS[model],
                    markersize=5.5,
                    linewidth=0.0,
                    label=model.upper(),
                )
            axes.axvspan(1.0 - _DRAW, 1.0 + _DRAW, color="#e4e7ea", zorder=0.2)
            axes.axvline(1.0, color=INK, linewidth=0.8)
            axes.set(title=f"({letter}) {name}", ylim=(5.6, 0.4), yticks=range(1, 6))
            axes.margins(x=0.15)
        grid[0].set_ylabel("dataset")
        grid[-1].legend(loc="center")
        figure.supxlabel("with the camera / without it", fontsize=8.5)
    return figure


def camera_caption(rows: Sequence[Figures]) -> str:
    """Count the moving cells that the camera wins."""
    moving = [row for row in rows if row["dataset"] != 3 and row["model"] in ("cmm", "famm")]
    parts = []
    for metric, name in (("ate_m", "ATE"), ("rpe_10s_m", "RPE"), ("filter_error_m", "the filter error")):
        found = [row["ratio_median"] for row in moving if row["metric"] == metric]
        better = sum(ratio < 1.0 for ratio in found)
        worse = sum(ratio > 1.0 + _DRAW for ratio in found)
        if found:
            parts.append(f"{name} is smaller in {better} of {len(found)} (worse by more than 2 % in {worse})")
    return (
        "What the camera changes, as the median ratio over seeds; left of the line the camera helps, the band is two per cent. "
        "Of the moving cells (dataset 3 stands still), " + ", ".join(parts) + "."
    )


def rivals_figure(rows: Sequence[Figures]) -> Figure:
    """Draw each rival's filter error, error against truth and jitter as ratios to CMM's, one marker a dataset."""
    metrics = (("filter_error_m", "filter error"), ("ate_m", "ATE"), ("jitter_m", "jitter"))
    models = [model for model in SELECTOR_COLOURS if any(row["model"] == model for row in rows)]
    with house_style():
        figure = new_figure(0.9 + 0.42 * 2 * max(len(models), 1))
        grid = figure.subplots(2, len(metrics), sharey=True, sharex="col")
        for line, sensors in enumerate(_SENSORS):
            for axes, (metric, name) in zip(grid[line], metrics, strict=True):
                for row in rows:
                    if row["metric"] == metric and row["sensors"] == sensors:
                        _mark(axes, row, models.index(row["model"]))
                axes.axvline(1.0, color=INK, linewidth=0.8)
                axes.set_yticks(range(len(models)), [model.upper() for model in models])
                axes.set_ylim(len(models) - 0.4, -0.6)
                axes.margins(x=0.12)
                if line == 0:
                    axes.set_title(name)
            grid[line, 0].set_ylabel(sensors)
        for axes in grid[1]:
            _ratio_scale(axes)
            axes.set_xlabel("median ratio to CMM")
        handles = [
            axes.plot([], [], marker, color=FAINT, markersize=5.0, linewidth=0.0, label=f"dataset {dataset}")[0]
            for dataset, marker in _MARKERS.items()
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=5)
    return figure


def _ratio_scale(axes: Axes) -> None:
    """Show ratios by their logarithm, with numbers that a reader multiplies by, and no more of them than there is room for."""
    axes.set_xscale("log")
    low, high = np.log(axes.get_xlim())
    ticks: list[float] = []
    for tick in _RATIOS:
        place = float(np.log(tick))
        if low <= place <= high and all(abs(place - np.log(other)) > _APART * (high - low) for other in ticks):
            ticks.append(tick)
    axes.xaxis.set_major_locator(FixedLocator(sorted(ticks)))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_minor_locator(NullLocator())


def _mark(axes: Axes, row: Figures, place: int) -> None:
    axes.plot(
        row["ratio_median"],
        place + 0.12 * (row["dataset"] - 3),
        _MARKERS[row["dataset"]],
        color=SELECTOR_COLOURS[row["model"]],
        markersize=5.0,
    )


def rivals_caption(rows: Sequence[Figures]) -> str:
    """Give each rival's median over all cells."""
    parts = []
    for model in dict.fromkeys(row["model"] for row in rows):
        ratios = [_median(rows, model, metric) for metric in ("filter_error_m", "ate_m", "jitter_m")]
        parts.append(f"{model.upper()} {' / '.join(f'{ratio:.3f}' for ratio in ratios)}")
    return (
        "The rivals against the constant model, as median ratios over seeds; left of the line is better. Over all cells, the "
        "medians of filter error / ATE / jitter are " + "; ".join(parts) + "."
    )


def _median(rows: Iterable[Figures], model: str, metric: str) -> float:
    return float(np.median([r["ratio_median"] for r in rows if r["model"] == model and r["metric"] == metric]))
