"""A picture through the walker's lens as a centred pinhole would have taken it: the only camera that viser knows. Pure."""

from functools import lru_cache
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.lens import project, unproject
from tracker.measurements import Matrix
from tracker.rig import CameraModel

Picture = NDArray[np.uint8]
_HEIGHT_PX: Final = 540
_MOST_WIDE: Final = 3.0
#: Tangent of half the widest field of view: a pinhole that shows more shows mostly its edges.
_WIDEST: Final = 1.43
#: Beyond the picture's edges by this share the lens is not asked: its polynomial may bend back into the picture.
_MARGIN: Final = 1.02


def fov_of(camera: CameraModel, quarter_turns: int) -> float:
    """Return the vertical field of view, rad, that holds all of the upright picture from top to bottom."""
    return 2.0 * float(np.arctan(_half_height(camera, quarter_turns)))


def upright(T_site_cam: Matrix, quarter_turns: int) -> Matrix:
    """Return the camera turned so that its picture, turned clockwise so many quarters, stands upright; (4, 4)."""
    T = np.array(T_site_cam)
    T[:3, :3] = T[:3, :3] @ _turn(quarter_turns)
    return T


def seen_by_pinhole(picture: Picture, camera: CameraModel, quarter_turns: int, aspect: float) -> Picture:
    """Return what a pinhole of `fov_of` sees of a picture on a canvas of that shape, black where the picture ends.

    Args:
        picture: (h, w, 3), as stored, of any size: it stands for the camera's whole picture.
        camera: The lens.
        quarter_turns: Clockwise, that make the stored picture upright.
        aspect: Width over height of the canvas.
    """
    columns, rows = _map(camera, quarter_turns % 4, round(min(max(aspect, 1.0 / _MOST_WIDE), _MOST_WIDE), 2))
    height_px, width_px = picture.shape[:2]
    sx, sy = width_px / camera.width_px, height_px / camera.height_px
    found = cv2.remap(
        picture,
        ((columns + 0.5) * sx - 0.5).astype(np.float32),
        ((rows + 0.5) * sy - 0.5).astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_CONSTANT,
    )
    return np.asarray(found, dtype=np.uint8)


@lru_cache(maxsize=8)
def _map(camera: CameraModel, quarter_turns: int, aspect: float) -> tuple[Matrix, Matrix]:
    """Return for each pixel of the canvas its column and row in the stored picture; -2 where the picture has none."""
    height_px, width_px = _HEIGHT_PX, round(_HEIGHT_PX * aspect)
    scale = 2.0 * _half_height(camera, quarter_turns) / height_px
    x = (np.arange(width_px) - (width_px - 1) / 2.0) * scale
    y = (np.arange(height_px) - (height_px - 1) / 2.0) * scale
    rays = np.stack([*np.meshgrid(x, y)], axis=-1).reshape(-1, 2) @ _turn(quarter_turns)[:2, :2].T
    pixels = project(camera, rays)
    border = _border(camera)
    outside = (np.abs(rays - border.mean(axis=0)) > _MARGIN * np.ptp(border, axis=0) / 2.0).any(axis=1)
    pixels[outside] = -2.0
    return pixels[:, 0].reshape(height_px, width_px), pixels[:, 1].reshape(height_px, width_px)


def _half_height(camera: CameraModel, quarter_turns: int) -> float:
    """Return the tangent of half the field of view: of the edge that is furthest from the axis, but no fisheye's."""
    return min(_WIDEST, float(np.abs(_border(camera)[:, 1 if quarter_turns % 2 == 0 else 0]).max()))


def _border(camera: CameraModel) -> Matrix:
    """Return rays, (n, 2), of points all along the picture's edges."""
    along = np.linspace(0.0, 1.0, 33)
    x, y = along * (camera.width_px - 1), along * (camera.height_px - 1)
    edges = [np.stack([x, np.full_like(x, e)], 1) for e in (0, camera.height_px - 1)]
    edges += [np.stack([np.full_like(y, e), y], 1) for e in (0, camera.width_px - 1)]
    return unproject(camera, np.concatenate(edges))


def _turn(quarter_turns: int) -> Matrix:
    """Return the axes of the upright camera in the stored one's, (3, 3): right and down of the upright picture."""
    cos, sin = ((1, 0), (0, -1), (-1, 0), (0, 1))[quarter_turns % 4]
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
