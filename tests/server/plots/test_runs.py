"""Figures of runs: what is drawn is what was measured, and the captions carry the numbers."""

from dataclasses import replace

import numpy as np
import pytest

from assets.site import load_site
from server.cli import SITE
from server.plots.angles import angle_caption, angle_figure
from server.plots.covariance import covariance_caption, covariance_figure
from server.plots.innovations import innovation_caption, innovation_figure
from server.plots.paths import path_caption, path_figure, runs_of
from server.plots.plan import plan_of
from server.plots.style import MODEL_COLOURS, drawn
from server.plots.trace import Array
from tests.server.plots.traces import trace, without_truth, without_updates
from tracker.estimator import NO_MOTION_MODEL, Origin
from tracker.simulate import AGORA_ORIGIN

FIVE = [trace(name) for name in ("gps-imu/cmm", "camera-gps-imu/cmm", "gps-imu/famm", "camera-gps-imu/famm")]


def test_stretches_join_and_cover_all() -> None:
    parts = list(runs_of(np.array(["P0R0", "P0R0", "P1R1", "P0R0"])))
    assert parts == [("P0R0", slice(0, 3)), ("P1R1", slice(2, 4)), ("P0R0", slice(3, 4))]
    assert list(runs_of(np.array([], dtype=np.str_))) == []


def test_five_ways() -> None:
    """The paper's five panels in its order, each stretch in its model's colour, all in one window."""
    figure = path_figure(FIVE)
    titles = [axes.get_title(loc="left") for axes in figure.axes if axes.axison]
    assert [title[:3] for title in titles] == ["(a)", "(b)", "(c)", "(d)", "(e)"]
    axes = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("(d)"))
    assert [line.get_color() for line in axes.lines[1:]] == [MODEL_COLOURS["P0R0"], MODEL_COLOURS["P1R1"]]
    assert len({tuple(axes.get_xlim()) for axes in figure.axes if axes.axison}) == 1
    assert "(d) gps-imu/famm, 2.00 m RMS from the truth, P1R1 in 75 % of its updates" in path_caption(FIVE)


def test_a_filter_without_the_papers_updates_is_told_by_the_time() -> None:
    precise = without_updates(trace("gps-imu/precise"))
    assert "(b) gps-imu/precise, 2.00 m RMS from the truth, P1R1 in 75 % of the time." in path_caption([precise])
    truth = replace(precise, estimator="truth", model=np.full(len(precise.model), NO_MOTION_MODEL))
    assert path_caption([truth]).endswith("no motion model.")


def test_who_stands_still_looks_still() -> None:
    """A path of centimetres is not blown up to fill the panel."""
    still = trace(n=2)
    left, right = path_figure([still]).axes[0].get_xlim()
    assert right - left >= 12.0


def test_a_plan_lies_about_the_logs_own_origin() -> None:
    """The same building, seen from an origin 10 m further south, lies 10 m further north; from Ankara there is none."""
    site = load_site(SITE)
    here = plan_of(site, AGORA_ORIGIN)
    south = Origin(AGORA_ORIGIN.lat_deg - 10.0 / 110_990.0, AGORA_ORIGIN.lon_deg, AGORA_ORIGIN.h_ellipsoid_m)
    moved = plan_of(site, south)
    assert len(here) > 10
    assert (moved[0] - here[0])[:, 1] == pytest.approx(10.0, abs=0.02)
    assert plan_of(site, Origin(39.93, 32.86, 900.0)) == ()
    assert len(path_figure(FIVE, here).axes[0].patches) == len(here)


def test_orientation_in_a_window() -> None:
    """Only what lies in it is drawn; the error's row shows the three degrees; the caption speaks of the whole."""
    figure = angle_figure(FIVE[2:], (10.0, 20.0))
    error = figure.axes[6]
    times = np.concatenate([np.asarray(line.get_xdata(), float) for line in error.lines[1:]])
    values = np.concatenate([np.asarray(line.get_ydata(), float) for line in error.lines[1:]])
    assert (times.min(), times.max()) == (10.0, 20.0)
    assert values == pytest.approx(3.0)
    assert "RMS error 0.0, 0.0 and 3.0 degrees" in angle_caption(FIVE[2:], (10.0, 20.0))


def test_covariance_of_the_whole_state() -> None:
    sigmas = [("one", FIVE[0].state_covariance), ("twice", 2.0 * FIVE[0].state_covariance)]
    figure = covariance_figure(sigmas)
    image: Array = np.ma.asarray(figure.axes[1].images[0].get_array()).filled(np.nan)
    assert np.diag(image) == pytest.approx(np.diag(sigmas[1][1]))
    assert np.isnan(image[0, 1])
    assert "(b) twice: P × 2, V × 2, R × 2, Ω × 2" in covariance_caption("walk", sigmas)


def test_the_filter_error_and_its_dashed_mean() -> None:
    figure = innovation_figure(FIVE)
    dashed = [line for line in figure.axes[0].lines if line.get_linestyle() == "--"]
    assert [line.get_ydata()[0] for line in dashed] == pytest.approx([0.5, 0.5])  # type: ignore[index]
    assert "gps-imu/cmm 0.500 m" in innovation_caption(FIVE)


def test_all_of_it_without_truth() -> None:
    """No panel for an error that nobody knows, and no claim of it in the captions."""
    blind = [without_truth(known) for known in FIVE]
    assert len(angle_figure(blind[:1]).axes) == 3
    assert len(innovation_figure(blind).axes) == 2
    texts = path_caption(blind) + angle_caption(blind) + innovation_caption(blind)
    assert "truth" not in texts.lower()
    assert drawn(path_figure(blind), "paths", "", "png").data.startswith(b"\x89PNG")
