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
    """What following a corner from picture to picture does wrong.

    Measured on 3,000 drawn pictures (datasets 2 and 4, seed 1, two minutes each): every feature was lifted by the depth of
    its pixel and compared with where the lens throws that point later. `python -m server.feature_measure` compares the result.
    """

    drift_px: float = 0.09
    """Deviation of each step, each axis;"""
    still_px: float = 0.3
    """ in proportion less where a corner moves less than this, since the same picture drifts nowhere,"""
    drift_per_px: float = 0.0016
    """ and more for each pixel that it moves"""
    fast_px: float = 20.0
    """ beyond so many, because it is blurred."""
    drift_spread: float = 0.4
    """Deviation of the logarithm of that from corner to corner and step to step."""
    kept_share: float = 0.91
    """Of the drift so far; the rest goes with every step, for most of it is where pixels happen to lie on the corner."""
    slide: float = 0.025
    """What two outlines make goes with neither: so far, per pixel of parallax, in the median of corners on a rim
    (in drawn pictures mostly along the epipolar line, here any way),"""
    slide_spread: float = 1.4
    """ and the deviation of its logarithm."""
    slip_rate: float = 0.001
    """Share of steps that go wrong by far more;"""
    slip_rate_per_px: float = 0.0002
    """ more for each pixel beyond the fast ones;"""
    slip_px: float = 1.5
    """ by how much: the scale of a Laplace distribution."""
    loss_at_px: float = 145.0
    """A corner that moves so far between two pictures is lost, and one that moves a share of it with this power of that:"""
    loss_power: float = 2.5
    border_px: float = 8.0
    """Half the window that is followed:"""
    border_loss: float = 0.1
    """ so many of those whose window leaves the picture are lost."""
    strength_spread: float = 0.2
    """Deviation of the logarithm of a corner's strength from picture to picture: light, blur and noise choose as well.

    Corners themselves vary by 0.4; more than this prefers ground near by, where corners are many and equally strong.
    """


@dataclass(frozen=True)
class FeatureCamera:
    """A `FeatureSource` whose pictures nobody draws. A feature's marks are its corner (x, y, z in site), and how it slides off."""

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
        corners_m, slides = features.marks[:, :3], features.marks[:, 3:]
        was_px, _ = self._projected(before.content, corners_m)
        is_px, ahead = self._projected(after.content, corners_m)
        rng = np.random.default_rng([self.seed, _FOLLOWING, after.frame_id])
        moved_px = np.linalg.norm(is_px - was_px, axis=1)
        kept = 1.0 - (1.0 - self.faults.kept_share) * self._share_of_drift(moved_px)
        off_px = kept[:, None] * (features.points_px - was_px) + self._drift(rng, moved_px)
        off_px += self._parallax_px(before.content, after.content, corners_m)[:, None] * slides
        there = (is_px + off_px).astype(np.float32)
        good = ahead & self._inside(there) & (rng.random(len(there)) >= self._loss(moved_px, there))
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
        slides = self._slides(rng, len(chosen)) * corners.on_rim[chosen][:, None]
        marks = np.column_stack([corners.p_site_m[chosen], slides])
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

    def _share_of_drift(self, moved_px: Matrix) -> Matrix:
        still_px = self.faults.still_px
        return np.asarray(np.minimum(1.0, moved_px / still_px)) if still_px > 0.0 else np.ones_like(moved_px)

    def _drift(self, rng: np.random.Generator, moved_px: Matrix) -> Matrix:
        """Return (N, 2) pixels by which following goes astray in one step."""
        faults, count = self.faults, len(moved_px)
        fast_px = np.maximum(moved_px - faults.fast_px, 0.0)
        sigma_px = faults.drift_px * self._share_of_drift(moved_px) + faults.drift_per_px * fast_px
        sigma_px = sigma_px * np.exp(faults.drift_spread * rng.standard_normal(count))
        slips = (
            rng.random(count) < faults.slip_rate * self._share_of_drift(moved_px) + faults.slip_rate_per_px * fast_px
        )
        far_px = rng.laplace(0.0, faults.slip_px, (count, 2))
        return np.asarray(sigma_px[:, None] * rng.standard_normal((count, 2)) + slips[:, None] * far_px)

    def _slides(self, rng: np.random.Generator, count: int) -> Matrix:
        """Return (N, 2) how far a feature slides off its corner per pixel of parallax."""
        angle_rad = rng.uniform(0.0, 2.0 * np.pi, count)
        size = self.faults.slide * np.exp(self.faults.slide_spread * rng.standard_normal(count))
        return np.asarray(size[:, None] * np.column_stack([np.cos(angle_rad), np.sin(angle_rad)]))

    def _parallax_px(self, before: Matrix, after: Matrix, corners_m: Matrix) -> Matrix:
        """Return (N,) how far the camera's step is as seen from each corner, in pixels."""
        step_m = float(np.linalg.norm(after[:3, 3] - before[:3, 3]))
        distance_m = np.linalg.norm(corners_m - after[:3, 3], axis=1)
        return np.asarray(self.camera.fx_px * step_m / np.maximum(distance_m, _NEAREST_M))

    def _loss(self, moved_px: Matrix, there_px: NDArray[np.float32]) -> Matrix:
        """Return (N,) the chance of each to be lost."""
        faults = self.faults
        limit = np.array([self.camera.width_px - 1, self.camera.height_px - 1]) - faults.border_px
        at_border = ((there_px < faults.border_px) | (there_px > limit)).any(axis=1)
        fast = (moved_px / faults.loss_at_px) ** faults.loss_power if faults.loss_at_px > 0.0 else 0.0
        return np.asarray(fast + faults.border_loss * at_border)


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
