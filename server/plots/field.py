"""A magnetometer's readings before and after calibration, and which directions were seen."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from server.plots.style import BETTER, FAINT, INK, RAW_GPS, WORSE, Picture, drawn, house_style, new_figure
from tracker.calibrate.magnetometer import MagFit, sphere_points
from tracker.measurements import MagSample

_PLANES = ((0, 1, "x", "y"), (0, 2, "x", "z"), (1, 2, "y", "z"))
_MOST_POINTS = 2500


def field_pictures(fit: MagFit, samples: Sequence[MagSample]) -> Sequence[Picture]:
    """Return the figures of a magnetometer."""
    return [
        drawn(
            ball_figure(fit, samples),
            "field",
            "The magnetic field in the sensor's axes, before and after. Grey, as the sensor says it, about its own middle (cross); "
            f"blue, calibrated, about zero. The circle is a field of {fit.strength_t * 1e6:.1f} µT: readings that fill it evenly "
            "have no iron left.",
        ),
        drawn(
            direction_figure(fit),
            "directions",
            f"Which directions the field came from, in the sensor's axes: {fit.coverage:.0%} of all. Each dot is a reading; an "
            "orange ring is a part of the sphere that none fell into. Equal areas of the map are equal parts of the sphere.",
        ),
    ]


def ball_figure(fit: MagFit, samples: Sequence[MagSample]) -> Figure:
    """Draw three views of the readings, raw and calibrated."""
    step = max(1, len(samples) // _MOST_POINTS)
    raw = np.array([sample.field_body_t for sample in samples])[::step] * 1e6
    offset = fit.hard_iron_t * 1e6
    fixed = (raw - offset) @ fit.soft_iron.T
    radius = fit.strength_t * 1e6
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    with house_style():
        figure = new_figure(2.5)
        for axes, (a, b, name_a, name_b) in zip(figure.subplots(1, 3), _PLANES, strict=True):
            axes.plot(raw[:, a], raw[:, b], ".", color=RAW_GPS, markersize=1.4)
            axes.plot(fixed[:, a], fixed[:, b], ".", color=BETTER, markersize=1.4)
            axes.plot(radius * np.cos(turn), radius * np.sin(turn), color=INK, linewidth=0.9)
            axes.plot([offset[a]], [offset[b]], "x", color=WORSE, markersize=7, markeredgewidth=1.6)
            axes.set_aspect("equal")
            axes.set_xlabel(f"{name_a}, µT")
            axes.set_ylabel(f"{name_b}, µT")
    return figure


def direction_figure(fit: MagFit) -> Figure:
    """Draw the directions on a map of the sphere (cylindrical, equal areas)."""
    step = max(1, len(fit.directions) // _MOST_POINTS)
    points = sphere_points()
    counts = np.bincount(np.argmax(fit.directions @ points.T, axis=1), minlength=len(points))
    with house_style():
        figure = new_figure(2.9)
        axes = figure.subplots()
        some = fit.directions[::step]
        axes.plot(np.degrees(np.arctan2(some[:, 1], some[:, 0])), some[:, 2], ".", color=BETTER, markersize=1.6)
        missed = points[counts == 0]
        axes.plot(
            np.degrees(np.arctan2(missed[:, 1], missed[:, 0])),
            missed[:, 2],
            "o",
            color=WORSE,
            markersize=9,
            fillstyle="none",
        )
        axes.set_xlim(-180, 180)
        axes.set_ylim(-1.02, 1.02)
        axes.set_xticks(range(-180, 181, 45))
        axes.set_yticks([-1.0, -0.5, 0.0, 0.5, 1.0], ["-z", "-30°", "0", "30°", "+z"])
        axes.set_xlabel("about z, degrees from x to y")
        axes.tick_params(colors=INK)
        axes.spines[:].set(color=FAINT)
    return figure
