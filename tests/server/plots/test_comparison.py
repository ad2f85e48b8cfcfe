"""Figures over seeds: what is drawn is the comparison, and the captions count it."""

import numpy as np
import pytest

from server.plots.comparison import (
    camera_caption,
    camera_figure,
    change_percent,
    paired_caption,
    paired_figure,
    rivals_caption,
    rivals_figure,
)
from server.plots.drift import drift_caption, drift_figure
from server.plots.style import BETTER, WORSE
from tracker.score import Figures


def _row(dataset: int, sensors: str, difference: float, half: float, metric: str = "filter_error_m") -> Figures:
    return {
        "dataset": dataset,
        "sensors": sensors,
        "model": "famm",
        "metric": metric,
        "n": 16,
        "theirs_mean": 2.0,
        "difference_mean": difference,
        "interval_t": [difference - half, difference + half],
        "ratio_median": 1.0 + difference / 2.0,
    }


ROWS = [_row(1, "gps-imu", -0.2, 0.1), _row(2, "gps-imu", -0.1, 0.2), _row(3, "camera-gps-imu", 1.0, 0.1)]


def test_a_change_is_a_share_of_what_it_is_compared_with() -> None:
    assert change_percent(ROWS[0]) == pytest.approx((-10.0, -15.0, -5.0))


def test_better_and_worse_sure_and_unsure() -> None:
    """Blue to the left and orange to the right of zero, hollow where the interval holds it; crosses are the paper's."""
    figure = paired_figure(ROWS, {(1, "gps-imu"): 7.0})
    dots = [line for axes in figure.axes for line in axes.lines if line.get_marker() == "o"]
    assert [dot.get_color() for dot in dots] == [BETTER, BETTER, WORSE]
    assert [dot.get_markerfacecolor() for dot in dots] == [BETTER, "white", WORSE]
    crosses = [line for axes in figure.axes for line in axes.lines if line.get_marker() == "x"]
    assert [np.ravel(cross.get_xdata())[0] for cross in crosses] == [7.0]
    caption = paired_caption(ROWS)
    assert "lower in 2 of 3 cells, in 1 of them" in caption
    assert "higher beyond doubt in 1" in caption


def test_the_camera_by_its_moving_cells() -> None:
    """The stationary dataset is drawn but not counted."""
    rows = [_row(1, "", -0.2, 0.1, "ate_m"), _row(2, "", 0.2, 0.1, "ate_m"), _row(3, "", 0.2, 0.1, "ate_m")]
    points = [line for line in camera_figure(rows).axes[0].lines if line.get_label() == "FAMM"]
    assert np.asarray(points[0].get_xdata()).tolist() == pytest.approx([0.9, 1.1, 1.1])
    assert "ATE is smaller in 1 of 2 (worse by more than 2 % in 1)" in camera_caption(rows)


def test_rivals_have_a_line_each_and_their_medians() -> None:
    rows = [
        {**_row(dataset, sensors, 0.2, 0.1, metric), "model": model}
        for dataset in (1, 2)
        for sensors in ("gps-imu", "camera-gps-imu")
        for metric in ("filter_error_m", "ate_m", "jitter_m")
        for model in ("famm", "imm")
    ]
    labels = [label.get_text() for label in rivals_figure(rows).axes[0].get_yticklabels()]
    assert labels == ["FAMM", "IMM"]
    assert "IMM 1.100 / 1.100 / 1.100" in rivals_caption(rows)


def test_drift_by_every_way_that_was_measured() -> None:
    seeds = [{"raw": 8.0, "both": 0.2}, {"raw": 6.0, "both": 0.4}]
    axes = drift_figure(seeds, 0.5).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["raw samples", "both, as in the paper"]
    bars = [np.ravel(line.get_xdata())[0] for line in axes.lines if line.get_marker() == "|"]
    assert bars == pytest.approx([7.0, 0.3])
    assert "raw samples 7.000, both, as in the paper 0.300. The paper prints 0.5" in drift_caption(seeds, 0.5)
