"""Camera against gyroscope: the same turns as both saw them, and what is left."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from server.plots.style import BETTER, INK, WORSE, Picture, drawn, house_style, new_figure
from tracker import rotations
from tracker.calibrate.camera_mount import CameraMount

_AXES = ("forward (roll)", "left (nod)", "up (pan)")


def mount_pictures(mounts: Mapping[str, CameraMount]) -> Sequence[Picture]:
    """Return the figure of each recording's mount; of several, with the recording's name."""
    return [
        drawn(
            turning_figure(mount),
            f"turning-{number}" if number > 1 else "turning",
            f"{f'{name}: the' if len(mounts) > 1 else 'The'} rig's turning as gyroscope and camera saw it, about the body's axes. "
            f"The pictures' times are moved by {mount.alignment.offset_s * 1e3:+.1f} ms and their turns into the body's axes, as "
            f"found; where both lie on each other the calibration fits. Below each, what is left: "
            f"{np.degrees(mount.alignment.residual_rad):.3f} degrees a turn, median.",
        )
        for number, (name, mount) in enumerate(mounts.items(), 1)
    ]


def turning_figure(mount: CameraMount) -> Figure:
    """Draw rates about three axes over time, from the gyroscope as a line and from the pictures as dots."""
    alignment, turns = mount.alignment, mount.turns
    times_s = turns.times_s + alignment.offset_s
    spans_s = (times_s[:, 1] - times_s[:, 0])[:, None]
    steady = mount.track.without(alignment.bias_rad_s)
    seen = np.degrees(turns.vectors_rad @ alignment.R_body_cam.T / spans_s)
    felt = np.degrees(rotations.log(steady.between(*times_s.T)) / spans_s)
    middle = times_s.mean(axis=1)
    begin, end = float(times_s.min()), float(times_s.max())
    shown = (steady.times_s >= begin) & (steady.times_s <= end)
    with house_style():
        figure = new_figure(6.6)
        grid = figure.subplots(6, 1, sharex=True, height_ratios=[3, 1] * 3)
        for k, name in enumerate(_AXES):
            above, below = grid[2 * k], grid[2 * k + 1]
            above.plot(
                steady.times_s[shown],
                np.degrees(steady.rates_rad_s[shown, k]),
                color=INK,
                linewidth=0.7,
                label="gyroscope",
            )
            above.plot(middle, seen[:, k], "o", color=WORSE, markersize=2.2, label="camera")
            above.set_ylabel("deg/s")
            above.set_title(name)
            left = felt[:, k] - seen[:, k]
            below.axhline(0.0, color=INK, linewidth=0.6)
            below.plot(middle, left, ".", color=BETTER, markersize=2.5)
            reach = max(0.5, float(np.percentile(np.abs(left), 97)) * 1.4)
            below.set_ylim(-reach, reach)
            below.set_ylabel("left")
        grid[0].legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2)
        grid[-1].set_xlabel("seconds")
    return figure
