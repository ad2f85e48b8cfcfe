"""An inertial unit at rest: what it said over time, and how its noise averages out (Allan's deviation)."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from server.plots.style import FAINT, INK, Picture, drawn, house_style, new_figure
from server.plots.trace import Array
from tracker.calibrate.rest import RestFit
from tracker.measurements import ImuSample, Matrix

_COLOURS = ("#1f5fa8", "#d9660a", "#4d9a6a")
_AXES = ("x", "y", "z")
#: Averages over longer than this share of the rest are too few to be drawn.
_LONGEST_SHARE = 0.12


def rest_pictures(fit: RestFit, samples: Sequence[ImuSample], R_body_imu: Matrix) -> Sequence[Picture]:
    """Return the figure of a rest."""
    return [
        drawn(
            rest_figure(fit, samples, R_body_imu),
            "rest",
            f"The inertial unit over {fit.duration_s:.0f} s. Left, half-second means about the median of all: a level line is a "
            "rig that lay still and a bias that stayed. Right, Allan's deviation: how far means over a time differ from the next; "
            "white noise falls along the dotted lines, and where a curve turns up the bias wanders.",
        )
    ]


def allan(values: Array, period_s: float) -> tuple[Array, Array]:
    """Return times and (T, 3) Allan deviations, overlapping, of (N, 3) values.

    Reference:
        IEEE Std 952-1997, annex C.
    """
    n = len(values)
    sizes = np.unique(np.geomspace(1, max(2, int(n * _LONGEST_SHARE)), 40).astype(int))
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    deviations = []
    for m in sizes.tolist():
        means = (sums[m:] - sums[:-m]) / m
        deviations.append(np.sqrt(0.5 * np.mean((means[m:] - means[:-m]) ** 2, axis=0)))
    return sizes * period_s, np.array(deviations)


def rest_figure(fit: RestFit, samples: Sequence[ImuSample], R_body_imu: Matrix) -> Figure:
    """Draw means over time and Allan deviations, gyroscope above, accelerometer below."""
    t_s = np.array([(sample.t_ns - samples[0].t_ns) * 1e-9 for sample in samples])
    gyro = np.degrees(np.array([sample.gyro_rad_s for sample in samples]) @ R_body_imu)
    accel = np.array([sample.accel_m_s2 for sample in samples]) @ R_body_imu
    rows = (
        ("gyroscope", gyro, "deg/s", np.degrees(fit.gyro_noise_rad_s_sqrt_hz)),
        ("accelerometer", accel, "m/s²", fit.accel_noise_m_s2_sqrt_hz),
    )
    with house_style():
        figure = new_figure(4.6)
        grid = figure.subplots(2, 2)
        for (name, values, unit, noise), (left, right) in zip(rows, grid, strict=True):
            _over_time(left, t_s, values, f"{name}, half-second means", unit)
            times, deviations = allan(values, 1.0 / fit.rate_hz)
            for k in range(3):
                right.loglog(times, deviations[:, k], color=_COLOURS[k], linewidth=1.3, label=_AXES[k])
                right.loglog(times, noise[k] / np.sqrt(times), ":", color=_COLOURS[k], linewidth=0.9)
            right.set_title(f"{name}, Allan's deviation")
            right.set_xlabel("averaged over, s")
            right.set_ylabel(unit)
        grid[0, 1].legend(loc="lower left", ncols=3)
    return figure


def _over_time(axes: Axes, t_s: Array, values: Array, title: str, unit: str) -> None:
    block = np.floor(t_s / 0.5).astype(int)
    count = np.bincount(block)
    seen = count > 0
    for k in range(3):
        means = np.bincount(block, weights=values[:, k])[seen] / count[seen]
        axes.plot(np.flatnonzero(seen) * 0.5, means - np.median(means), color=_COLOURS[k], linewidth=1.0)
    axes.axhline(0.0, color=FAINT, linewidth=0.6)
    axes.set_title(title, color=INK)
    axes.set_xlabel("s")
    axes.set_ylabel(f"{unit}, about the median")
