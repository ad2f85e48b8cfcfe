"""Corners of a model that a visitor's camera could track: found in pictures drawn all round, and lifted by their depths.

A visitor sees them as from the middle of the square of ground that he stands on. Each square is drawn when somebody first
stands on it, and kept in a folder for ever after.
"""

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.kept import kept_arrays
from assets.render import Picture, Renderer
from assets.scene import Scene

VERSION = 1
"""Of what is found: another must not use kept squares."""
CELL_M = 2.0
"""Side of a square: he stands at most 1.4 m from where it was drawn."""
VIEWS, FOCAL_PX = 8, 520.0
"""Pictures all round, as fine as the webcam's."""
WIDTH_PX, HEIGHT_PX = 432, 1040
"""45 degrees from the middle up and down; 45 in all to the sides."""
CORNERS, QUALITY, APART_PX, BLOCK_PX = 1500, 0.0005, 6, 5
"""Many more, weaker and closer than a camera tracks: it chooses."""
RIM_PX = 8
"""Half the window by which a feature is followed: what lies at another depth within it takes the feature along."""
RIM_SHARE = 0.15
HELD = 64
"""Squares in memory."""


@dataclass(frozen=True, eq=False)
class Corners:
    """Corners, the strongest first."""

    p_site_m: Array
    """(N, 3)"""
    strength: Array
    """(N,) smaller eigenvalue of the picture's gradients about the corner, as OpenCV scales it."""
    on_rim: NDArray[np.bool_]
    """(N,) whether something lies before or behind it near by."""


class CornerAtlas:
    """The corners of one model. Belongs to the thread that made it; several processes may share its folder."""

    def __init__(
        self,
        scene: Callable[[], Scene],
        key: str,
        ground_z_m: Callable[[Array, Array], Array],
        eye_height_m: float,
        folder: Path,
    ) -> None:
        """Prepare an atlas.

        Args:
            scene: The model; asked for only where a square is not kept.
            key: What names the model's content.
            ground_z_m: Heights of the ground for (n,) east and (n,) north.
            eye_height_m: Of the camera over the ground.
            folder: Where squares are kept.
        """
        self._scene, self._ground_z_m, self._eye_height_m = scene, ground_z_m, eye_height_m
        self.key = f"{key}-{VERSION}"
        """What tells it from other atlases."""
        self._folder = folder / self.key
        self._held: OrderedDict[tuple[int, int], Corners] = OrderedDict()
        self._renderer: Renderer | None = None

    def __enter__(self) -> "CornerAtlas":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the graphics memory back."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None

    def corners(self, p_site_m: Array) -> Corners:
        """Return what a camera at (3,) may see.

        Raises:
            GraphicsMissing: The square is not kept, and there is no off-screen OpenGL to draw it.
        """
        square = (round(float(p_site_m[0]) / CELL_M), round(float(p_site_m[1]) / CELL_M))
        if square not in self._held:
            self._held[square] = self._corners(square)
            if len(self._held) > HELD:
                self._held.popitem(last=False)
        self._held.move_to_end(square)
        return self._held[square]

    def _corners(self, square: tuple[int, int]) -> Corners:
        east, north = square
        path = self._folder / f"{east}_{north}.npz"
        found = kept_arrays(path, lambda: self._found(CELL_M * east, CELL_M * north))
        return Corners(
            found["p_site_m"].astype(np.float64), found["strength"].astype(np.float64), found["on_rim"].astype(np.bool_)
        )

    def _found(self, e_m: float, n_m: float) -> dict[str, NDArray[np.generic]]:
        ground_m = float(self._ground_z_m(np.array([e_m]), np.array([n_m]))[0])
        eye_m = np.array([e_m, n_m, ground_m + self._eye_height_m])
        if self._renderer is None:
            self._renderer = Renderer(self._scene(), WIDTH_PX, HEIGHT_PX)
        views = []
        for number in range(VIEWS):
            pose = looking(eye_m, number * 2.0 * np.pi / VIEWS)
            picture, depth_m = self._renderer.seen(pose, FOCAL_PX, FOCAL_PX, *_centre())
            views.append(lifted(picture, depth_m, pose))
        points, strength, on_rim = (np.concatenate(parts) for parts in zip(*views, strict=True))
        order = np.argsort(-strength, kind="stable")
        return {
            "p_site_m": points[order].astype(np.float32),
            "strength": strength[order].astype(np.float32),
            "on_rim": on_rim[order],
        }


def looking(eye_m: Array, yaw_rad: float) -> Array:
    """Return the (4, 4) pose of a level camera."""
    cos, sin = np.cos(yaw_rad), np.sin(yaw_rad)
    pose = np.eye(4)
    pose[:3, :3] = np.array([[sin, 0.0, cos], [-cos, 0.0, sin], [0.0, -1.0, 0.0]])
    pose[:3, 3] = eye_m
    return pose


def lifted(picture: Picture, depth_m: Array, T_site_cam: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return the corners of a picture in the site frame (N, 3), their strengths (N,) and whether they lie on a rim (N,).

    Args:
        picture: (height, width, 3)
        depth_m: (height, width) along the line of sight, infinite for the sky.
        T_site_cam: (4, 4)
    """
    gray = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    found = cv2.goodFeaturesToTrack(gray, CORNERS, QUALITY, APART_PX, blockSize=BLOCK_PX)
    places = np.zeros((0, 2)) if found is None else found.reshape(-1, 2)
    column, row = np.round(places).astype(np.int64).T
    # a corner on an outline belongs to what is before: of the pixels beside it the nearest
    near, own = _least(depth_m, 1)[row, column], depth_m[row, column]
    near = np.where(_is_rim(near, own), near, own)
    solid = np.isfinite(near)
    column, row, near = column[solid], row[solid], near[solid]
    least, most = _least(depth_m, RIM_PX)[row, column], -_least(-depth_m, RIM_PX)[row, column]
    cx, cy = _centre()
    points_cam = np.column_stack([(column - cx) / FOCAL_PX * near, (row - cy) / FOCAL_PX * near, near])
    strength = cv2.cornerMinEigenVal(gray, BLOCK_PX, ksize=3)[row, column]
    on_rim = _is_rim(least, most)
    return points_cam @ T_site_cam[:3, :3].T + T_site_cam[:3, 3], strength.astype(np.float64), on_rim


def _is_rim(least_m: Array, most_m: Array) -> NDArray[np.bool_]:
    return np.asarray(most_m > (1.0 + RIM_SHARE) * least_m)


def _least(depth_m: Array, around_px: int) -> Array:
    """Return the smallest depth in a square about each pixel."""
    kernel = np.ones((2 * around_px + 1, 2 * around_px + 1), np.uint8)
    return np.asarray(cv2.erode(depth_m.astype(np.float32), kernel), np.float64)


def _centre() -> tuple[float, float]:
    return (WIDTH_PX - 1) / 2.0, (HEIGHT_PX - 1) / 2.0
