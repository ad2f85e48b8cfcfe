"""How the camera turned between pictures: matched points of picture pairs, made into rotation vectors by a lens. Numpy only."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker import lens, rotations, two_view
from tracker.geometry import wxyz_from_matrix
from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: Error of a followed corner, pixels (Klt on sharp pictures).
CORNER_SIGMA_PX = 0.3


@dataclass(frozen=True, eq=False)
class PointPair:
    """The same N points in two pictures."""

    t_first_ns: int
    t_second_ns: int
    first_px: Matrix
    """(N, 2)."""
    second_px: Matrix
    """(N, 2)."""


@dataclass(frozen=True, eq=False)
class Turns:
    """How the camera turned between P pairs of moments, which are by the camera's clock."""

    times_s: Matrix
    """(P, 2)."""
    vectors_rad: Matrix
    """(P, 3) rotation vectors that map the second picture's camera coordinates to the first's."""
    by_log_focal_rad: Matrix
    """(P, 3) their change per unit of the focal length's logarithm; zero where the focal length is known."""
    errors_rad: Matrix
    """(P,) what a turn leaves of its points' motion, median: what is near, or moves, makes it large."""

    def chosen(self, chosen: Matrix) -> "Turns":
        """Return those of an index or a mask."""
        return Turns(
            self.times_s[chosen], self.vectors_rad[chosen], self.by_log_focal_rad[chosen], self.errors_rad[chosen]
        )


def times_of(pairs: Sequence[PointPair], t_zero_ns: int) -> Matrix:
    """Return the (P, 2) times of pairs, seconds."""
    return np.array([[pair.t_first_ns - t_zero_ns, pair.t_second_ns - t_zero_ns] for pair in pairs]) * 1e-9


def turns_of(pairs: Sequence[PointPair], t_zero_ns: int, camera: CameraModel, *, focal_is_free: bool) -> Turns:
    """Return the turns that the pairs show, as far as these are turns alone: what is near and moves otherwise has little say."""
    vectors, errors = _vectors(pairs, camera)
    slopes = np.zeros_like(vectors)
    if focal_is_free:
        step = 0.01
        slopes = (_vectors(pairs, with_focal(camera, camera.fx_px * float(np.exp(step))))[0] - vectors) / step
    return Turns(times_of(pairs, t_zero_ns), vectors, slopes, errors)


def with_focal(camera: CameraModel, focal_px: float) -> CameraModel:
    """Return the camera with another focal length, its pixels' shape as it was."""
    ratio = camera.fy_px / camera.fx_px
    return CameraModel(
        camera.width_px,
        camera.height_px,
        focal_px,
        focal_px * ratio,
        camera.cx_px,
        camera.cy_px,
        camera.distortion_model,
        camera.distortion,
    )


def disagreement_px(pairs: Sequence[PointPair], camera: CameraModel) -> float:
    """Return how badly single turns explain the pairs' points, as a robust mean: the less, the better the lens (or the shutter)."""
    sizes = [_errors(pair, camera)[1] * camera.fx_px for pair in pairs]
    return float(np.mean(np.log1p((np.concatenate(sizes) / CORNER_SIGMA_PX) ** 2)))


def _vectors(pairs: Sequence[PointPair], camera: CameraModel) -> tuple[Matrix, Matrix]:
    """Return the pairs' (P, 3) rotation vectors, and (P,) the median of the radians that they leave."""
    fits = [_errors(pair, camera) for pair in pairs]
    vectors = rotations.log(np.array([wxyz_from_matrix(R) for R, _ in fits]))
    return vectors, np.array([float(np.median(left)) for _, left in fits])


def _errors(pair: PointPair, camera: CameraModel) -> tuple[Matrix, Matrix]:
    """Return the pair's rotation, and the (N,) radians that it leaves."""
    first = two_view.bearings(lens.unproject(camera, pair.first_px))
    second = two_view.bearings(lens.unproject(camera, pair.second_px))
    R = two_view.fit_rotation(first, second, CORNER_SIGMA_PX / camera.fx_px)
    return R, two_view.parallax(first, second, R)
