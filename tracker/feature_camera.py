"""A camera without pictures: corners of a known world projected, with the faults that following them in pictures has.

For studies over many seeds, where drawing every picture would take days. The front end behind it is the real one. Numpy only.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tracker import lens
from tracker.features import QUALITY, Features, View
from tracker.measurements import Frame, Matrix
from tracker.rig import CameraModel

#: Nearer to the camera's plane than this nothing is projected.
_NEAREST_M = 0.2
#: Rays further outside the picture than this share of its half are out of sight: lens polynomials hold only near it.
_MARGIN = 1.15
#: Streams of chance of one picture, by their use; a walk's sensors take the numbers below.
_FOLLOWING, _FINDING = 6, 7


class Corners(Protocol):
    """Corners of a world that may be seen from a place."""

    @property
    def p_site_m(self) -> Matrix:
        """(N, 3)"""
        ...

    @property
    def strength(self) -> Matrix:
        """(N,) of the picture's corner response, falling."""
        ...

    @property
    def on_rim(self) -> NDArray[np.bool_]:
        """(N,) whether something lies before or behind it near by."""
        ...


class World(Protocol):
    """Where a feature camera looks."""

    def corners(self, p_site_m: Matrix) -> Corners:
        """Return what a camera at (3,) may see, all round."""
        ...


@dataclass(frozen=True)
class Faults:
    """What following a corner from picture to picture does wrong."""

    drift_px: float = 0.04
    """Deviation of each step, each axis, at rest,"""
    drift_share: float = 0.006
    """ and this much more for each pixel that the corner moves."""
    slip_rate: float = 0.01
    """Share of steps that go wrong by far more,"""
    slip_rate_rim: float = 0.03
    """ and of corners on a rim;"""
    slip_px: float = 0.8
    """ by how much: the scale of a Laplace distribution."""
    loss: float = 0.01
    """Share of corners lost with each step at rest,"""
    loss_per_px: float = 0.001
    """ more for each pixel that they move,"""
    loss_rim: float = 0.03
    """ and more on a rim."""
    strength_spread: float = 0.5
    """Deviation of the logarithm of a corner's strength from picture to picture: light, blur and noise choose as well."""


@dataclass(frozen=True)
class FeatureCamera:
    """A `FeatureSource` whose pictures nobody draws. A feature's marks are its corner (x, y, z in site) and 1 on a rim."""

    camera: CameraModel
    world: World
    T_site_cam: Callable[[int], Matrix]
    """The (4, 4) pose of a stamp."""
    seed: int
    faults: Faults = field(default_factory=Faults)

    def look(self, frame: Frame) -> View:
        """Return where the camera is; the frame's picture is not asked for."""
        return View(
            frame.t_ns, frame.frame_id, self.camera.width_px, self.camera.height_px, self.T_site_cam(frame.t_ns)
        )

    def follow(self, before: View, after: View, features: Features) -> tuple[Features, NDArray[np.bool_]]:
        """Carry every feature with its corner, let it drift off a little, and lose some."""
        corners_m, on_rim = features.marks[:, :3], features.marks[:, 3]
        was_px, _ = self._projected(before.content, corners_m)
        is_px, ahead = self._projected(after.content, corners_m)
        rng = np.random.default_rng([self.seed, _FOLLOWING, after.frame_id])
        moved_px = np.linalg.norm(is_px - was_px, axis=1)
        off_px = features.points_px - was_px + self._slipped(rng, moved_px, on_rim)
        there = (is_px + off_px).astype(np.float32)
        good = self._kept(rng, moved_px, on_rim) & ahead & self._inside(there)
        return Features(there[good], features.marks[good]), good

    def detect(self, view: View, kept: Features, wanted: int, apart_px: int) -> Features:
        """Return the strongest corners in sight, in the empty parts of the picture."""
        corners = self.world.corners(view.content[:3, 3])
        points_px, ahead = self._projected(view.content, corners.p_site_m)
        seen = np.flatnonzero(ahead & self._inside(points_px))
        rng = np.random.default_rng([self.seed, _FINDING, view.frame_id])
        strength = corners.strength[seen] * np.exp(self.faults.strength_spread * rng.standard_normal(len(seen)))
        order = np.argsort(-strength, kind="stable")
        order = order[strength[order] > QUALITY * strength.max(initial=0.0)]
        seen = seen[order]
        free = _Free(view.width_px, view.height_px, apart_px)
        for point in kept.points_px.tolist():
            free.take(*point)
        chosen = seen[free.first(points_px[seen], wanted)]
        marks = np.column_stack([corners.p_site_m[chosen], corners.on_rim[chosen]])
        return Features(points_px[chosen].astype(np.float32), marks)

    def _projected(self, T_site_cam: Matrix, points_m: Matrix) -> tuple[Matrix, NDArray[np.bool_]]:
        """Return (N, 2) pixels, and (N,) which points are before the camera and near its picture."""
        seen = (points_m - T_site_cam[:3, 3]) @ T_site_cam[:3, :3]
        xy = seen[:, :2] / np.maximum(seen[:, 2:], _NEAREST_M)
        camera = self.camera
        half = np.array([camera.width_px / camera.fx_px, camera.height_px / camera.fy_px]) / 2.0
        ahead = (seen[:, 2] > _NEAREST_M) & (np.abs(xy) < _MARGIN * half).all(axis=1)
        return lens.project(camera, np.clip(xy, -2.0 * half, 2.0 * half)), np.asarray(ahead)

    def _inside(self, points_px: Matrix | NDArray[np.float32]) -> NDArray[np.bool_]:
        right, bottom = self.camera.width_px - 1, self.camera.height_px - 1
        return np.asarray(((points_px >= 0.0) & (points_px <= (right, bottom))).all(axis=1))

    def _slipped(self, rng: np.random.Generator, moved_px: Matrix, on_rim: Matrix) -> Matrix:
        faults, count = self.faults, len(moved_px)
        sigma_px = faults.drift_px + faults.drift_share * moved_px
        slips = rng.random(count) < np.where(on_rim > 0.0, faults.slip_rate_rim, faults.slip_rate)
        far_px = rng.laplace(0.0, faults.slip_px, (count, 2))
        return np.asarray(sigma_px[:, None] * rng.standard_normal((count, 2)) + slips[:, None] * far_px)

    def _kept(self, rng: np.random.Generator, moved_px: Matrix, on_rim: Matrix) -> NDArray[np.bool_]:
        faults = self.faults
        lost = faults.loss + faults.loss_per_px * moved_px + faults.loss_rim * on_rim
        return np.asarray(rng.random(len(moved_px)) >= lost)


class _Free:
    """The parts of a picture where no feature is yet."""

    def __init__(self, width_px: int, height_px: int, apart_px: int) -> None:
        side = np.arange(-apart_px, apart_px + 1)
        self._disc = side[:, None] ** 2 + side[None] ** 2 <= apart_px**2
        self._apart_px = apart_px
        # a border as wide as the disc, so that no disc is cut
        self._taken = np.zeros((height_px + 2 * apart_px, width_px + 2 * apart_px), np.bool_)

    def take(self, x_px: float, y_px: float) -> None:
        """Let nothing else be near a point of the picture."""
        column, row, size = round(x_px), round(y_px), len(self._disc)
        self._taken[row : row + size, column : column + size] |= self._disc

    def first(self, points_px: Matrix, wanted: int) -> list[int]:
        """Return which of (N, 2) points are free, in their order, at most so many; each takes its place."""
        chosen: list[int] = []
        taken, apart = self._taken, self._apart_px
        for number, (x, y) in enumerate(points_px.tolist()):
            if len(chosen) >= wanted:
                break
            if not taken[round(y) + apart, round(x) + apart]:
                self.take(x, y)
                chosen.append(number)
        return chosen
