"""A calibrated lens: where the board was seen, how far corners are off, and how the lens bends the picture."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from server.plots.style import BETTER, FAINT, INK, WORSE, Picture, drawn, house_style, new_figure
from tracker import lens
from tracker.calibrate.camera_lens import LensFit
from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: Errors are drawn so many times too long.
_LONGER = 60.0


def lens_pictures(fit: LensFit) -> Sequence[Picture]:
    """Return the figures of a lens."""
    errors = np.concatenate(fit.errors_px)
    worst = float(np.percentile(np.linalg.norm(errors, axis=1), 95))
    points, straight = _grid(fit.camera)
    bend = float(np.linalg.norm(points - straight, axis=1).max())
    return [
        drawn(
            corner_figure(fit),
            "corners",
            f"Where the board was seen, and how far its corners are from where the lens puts them. {len(fit.views)} views; a "
            f"stroke is the error, {_LONGER:.0f} times too long; 95 % are shorter than {worst:.2f} px. Strokes that point the same "
            "way in a region mean a lens that the formula does not fit; empty regions are guessed.",
        ),
        drawn(
            bend_figure(fit.camera),
            "lens",
            f"How the lens bends the picture. Arrows lead from where a lens that does not bend would put a point to where this one "
            f"does, at most {bend:.0f} px; the cross is the optical axis.",
        ),
    ]


def corner_figure(fit: LensFit) -> Figure:
    """Draw the corners of all views and their errors."""
    camera = fit.camera
    with house_style():
        figure = new_figure(5.2)
        axes = figure.subplots()
        for view, errors in zip(fit.views, fit.errors_px, strict=True):
            start = view.points_px
            axes.quiver(
                start[:, 0],
                start[:, 1],
                errors[:, 0] * _LONGER,
                errors[:, 1] * _LONGER,
                angles="xy",
                scale_units="xy",
                scale=1.0,
                width=0.0011,
                headwidth=1.0,
                headlength=0.0,
                headaxislength=0.0,
                color=BETTER,
            )
            axes.plot(start[:, 0], start[:, 1], ".", color=INK, markersize=1.2, alpha=0.5)
        _picture_axes(axes, camera)
        axes.set_title(f"corners and {_LONGER:.0f} times their errors")
    return figure


def bend_figure(camera: CameraModel) -> Figure:
    """Draw the distortion as arrows over the picture."""
    points, straight = _grid(camera)
    bent = points - straight
    with house_style():
        figure = new_figure(5.2)
        axes = figure.subplots()
        axes.quiver(
            straight[:, 0],
            straight[:, 1],
            bent[:, 0],
            bent[:, 1],
            np.linalg.norm(bent, axis=1),
            angles="xy",
            scale_units="xy",
            scale=1.0,
            width=0.003,
            cmap="viridis_r",
        )
        axes.plot([camera.cx_px], [camera.cy_px], "+", color=WORSE, markersize=12, markeredgewidth=1.5)
        _picture_axes(axes, camera)
        axes.set_title("from a straight lens to this one, pixels as they are")
    return figure


def _grid(camera: CameraModel) -> tuple[Matrix, Matrix]:
    """Return (N, 2) pixels of this lens, and (N, 2) where a straight one with the same focal length has the same rays."""
    u, v = np.meshgrid(np.linspace(0, camera.width_px - 1, 17), np.linspace(0, camera.height_px - 1, 13))
    points = np.column_stack([u.ravel(), v.ravel()])
    plain = CameraModel(camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px)
    return points, lens.project(plain, lens.unproject(camera, points))


def _picture_axes(axes: Axes, camera: CameraModel) -> None:
    margin = 0.06 * camera.width_px
    axes.set_xlim(-margin, camera.width_px + margin)
    axes.set_ylim(camera.height_px + margin, -margin)
    axes.set_aspect("equal")
    edge_x = [0, camera.width_px, camera.width_px, 0, 0]
    edge_y = [0, 0, camera.height_px, camera.height_px, 0]
    axes.plot(edge_x, edge_y, color=FAINT, linewidth=1.0)
    axes.set_xlabel("px")
    axes.set_ylabel("px")
