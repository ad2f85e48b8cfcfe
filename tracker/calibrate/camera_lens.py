"""`agora calibrate camera`: focal length, centre and distortion from views of a board, and how far these are to be believed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker import lens
from tracker.calibrate.board import Board, BoardView
from tracker.calibrate.board_views import coverage, motions_px, varied
from tracker.errors import InputError
from tracker.measurements import Matrix
from tracker.rig import CameraModel, DistortionModel

LEAST_VIEWS = 10
LEAST_COVERAGE = 0.6
#: Of a corner seen again: above this something is wrong (a bent board, a lens of another kind, blur).
LARGEST_RMS_PX = 1.0
#: Standard error of the focal length, as its share.
LARGEST_FOCAL_SIGMA = 0.004
#: A board that is always parallel to the picture tells no focal length, whatever the standard error says: so many views must be
#: slanted by so much.
LEAST_SLANT_RAD = np.radians(12.0)
LEAST_SLANTED = 6
#: Corners further off than so many times the usual are mistaken ones.
_OUTLIER = 5.0
_CHECKS = 40

Progress = Callable[[str], None]

#: Coefficients beyond the first two radial and the tangential ones must pay for themselves.
_MODELS: tuple[tuple[DistortionModel, int, int], ...] = (
    ("plumb_bob", cv2.CALIB_FIX_K3, 4),
    ("plumb_bob", 0, 5),
    ("rational_polynomial", cv2.CALIB_RATIONAL_MODEL, 8),
    ("equidistant", 0, 4),
)


@dataclass(frozen=True, eq=False)
class LensFit:
    """A lens, and how good it is."""

    camera: CameraModel
    rms_px: float
    """Of corners in views that were not used, where there are at least five such; else of those that were."""
    is_checked: bool
    """Whether rms_px is of other views."""
    focal_sigma_px: float
    views: tuple[BoardView, ...]
    """Those that it rests on."""
    errors_px: tuple[Matrix, ...]
    """Of each view's corners, (N, 2): seen minus expected."""
    slants_rad: Matrix
    """(V,) between the board and the picture's plane."""

    @property
    def coverage(self) -> float:
        """Share of the picture that corners were seen in."""
        return coverage(self.views)

    @property
    def verdict(self) -> str:
        """How good that is, in words."""
        if self.rms_px < 0.25:
            return "excellent"
        return "good" if self.rms_px < 0.5 else "usable"


def fit_lens(views: Sequence[BoardView], board: Board, progress: Progress = lambda what: None) -> LensFit:
    """Return the lens of a camera that has looked at a board.

    Args:
        views: In order of time; all of one size.
        board: What was looked at.
        progress: Told what is done next.

    Raises:
        InputError: The views are too few, too alike or leave too much of the picture out, or the result is poor; with the remedy.
    """
    if len({view.size_px for view in views}) > 1:
        raise InputError("The pictures have different sizes: calibrate with pictures of one size.")
    progress("choosing views")
    chosen = varied(views, board.corners_m)
    if len(chosen) < LEAST_VIEWS:
        raise InputError(
            f"The board was seen in {len(chosen)} different ways, expected at least {LEAST_VIEWS}: "
            "show it near and far, in every corner of the picture, and slanted to each side."
        )
    used = [views[i] for i in sorted(chosen)]
    fits = []
    for model, flags, coefficients in _MODELS:
        progress(f"fitting {model.replace('_', ' ')}, {coefficients} coefficients")
        fit = _fit(used, board, model, flags)
        if fit is not None:
            fits.append((_cost(fit, coefficients), fit, flags))
    if not fits:
        raise InputError("No lens explains these views: is the board flat, and is it the one that was printed?")
    progress("checking on other views")
    _, fit, flags = min(fits, key=lambda item: item[0])
    best = _checked(_halved(fit, board, flags), views, set(chosen), board)
    _judge(best)
    return best


def _judge(fit: LensFit) -> None:
    """Refuse a poor fit."""
    share = fit.focal_sigma_px / fit.camera.fx_px
    if fit.coverage < LEAST_COVERAGE:
        raise InputError(
            f"The board was seen in only {fit.coverage:.0%} of the picture, expected at least {LEAST_COVERAGE:.0%}: "
            "bring it to the edges and corners of the picture, where the lens bends most; a part of the board is enough."
        )
    if fit.rms_px > LARGEST_RMS_PX:
        raise InputError(
            f"A corner seen again is off by {fit.rms_px:.2f} pixels, expected less than {LARGEST_RMS_PX:g}: "
            "glue the board to something flat, hold it still, and give it more light."
        )
    slanted = int(np.count_nonzero(fit.slants_rad > LEAST_SLANT_RAD))
    if slanted < LEAST_SLANTED:
        raise InputError(
            f"The board was slanted in {slanted} views, expected at least {LEAST_SLANTED}: "
            "slant the board more, by 30 degrees to each side and up and down; else nothing tells the focal length."
        )
    if share > LARGEST_FOCAL_SIGMA:
        raise InputError(
            f"The focal length is uncertain by {share:.1%}, expected less than {LARGEST_FOCAL_SIGMA:.1%}: "
            "slant the board more, by 30 degrees and beyond to each side, and bring it nearer."
        )


def _halved(fit: LensFit, board: Board, flags: int) -> LensFit:
    """Return the fit with a standard error of its focal length that is at least what its two halves of views differ by."""
    halves = [_solve(fit.views[k::2], board, fit.camera.distortion_model, flags) for k in (0, 1)]
    focals = [half[0].fx_px for half in halves if half is not None]
    # of two halves' mean the standard error is half of what they differ by
    spread_px = 0.5 * abs(focals[0] - focals[1]) if len(focals) == 2 else np.inf
    return replace(fit, focal_sigma_px=max(fit.focal_sigma_px, float(spread_px)))


def _cost(fit: LensFit, coefficients: int) -> float:
    """Return Bayes' information criterion: what a model leaves, and what its coefficients cost. A robust scale, as ever."""
    errors = np.concatenate(fit.errors_px)
    n = errors.size
    scale = 1.4826 * float(np.median(np.abs(errors)))
    spent = float(np.sum(np.log1p((errors / (2.0 * scale)) ** 2)))
    return float(n * np.log(scale) + spent + coefficients * np.log(n))


# -- one model --------------------------------------------------------------------------------------------------------


def _fit(views: Sequence[BoardView], board: Board, model: DistortionModel, flags: int) -> LensFit | None:
    """Return a model's fit, twice: the second time without the corners that the first shows to be mistaken."""
    kept = list(views)
    for is_last in (False, True):
        found = _solve(kept, board, model, flags)
        if found is None:
            return None
        camera, focal_sigma_px, poses = found
        errors = [_errors(camera, view, board, pose) for view, pose in zip(kept, poses, strict=True)]
        sizes = [np.linalg.norm(error, axis=1) for error in errors]
        limit = _OUTLIER * float(np.median(np.concatenate(sizes)))
        good = [size <= max(limit, 0.5) for size in sizes]
        if is_last or all(np.all(one) for one in good):
            break
        kept = [view.chosen(one) for view, one in zip(kept, good, strict=True) if np.count_nonzero(one) >= 8]
        if len(kept) < LEAST_VIEWS:
            return None
    rms = float(np.sqrt(np.mean(np.concatenate(sizes) ** 2)))
    slants = np.array([_slant_rad(turn) for turn, _ in poses])
    return LensFit(camera, rms, False, focal_sigma_px, tuple(kept), tuple(errors), slants)


def _slant_rad(turn: Matrix) -> float:
    """Return the angle between a board and the picture's plane."""
    return float(np.arccos(min(1.0, abs(float(np.asarray(cv2.Rodrigues(turn)[0])[2, 2])))))


def _solve(
    views: Sequence[BoardView], board: Board, model: DistortionModel, flags: int
) -> tuple[CameraModel, float, list[tuple[Matrix, Matrix]]] | None:
    """Return camera, the standard error of its focal length, and each view's (rotation vector, translation)."""
    size = views[0].size_px
    objects = [board.corners_m[view.numbers].astype(np.float32) for view in views]
    points = [view.points_px.astype(np.float32) for view in views]
    try:
        if model == "equidistant":
            return _solve_fisheye(size, objects, points)
        nothing = np.zeros(0)
        _, K, distortion, turns, shifts, sigmas, _, _ = cv2.calibrateCameraExtended(
            objects, points, size, np.eye(3), nothing, flags=flags
        )
    except cv2.error:
        return None
    count = 8 if model == "rational_polynomial" else 5
    camera = _camera(size, np.asarray(K, np.float64), model, np.asarray(distortion, np.float64).ravel()[:count])
    poses = [
        (np.asarray(r, np.float64).ravel(), np.asarray(t, np.float64).ravel())
        for r, t in zip(turns, shifts, strict=True)
    ]
    return camera, float(np.asarray(sigmas).ravel()[0]), poses


def _solve_fisheye(
    size: tuple[int, int], objects: list[NDArray[np.float32]], points: list[NDArray[np.float32]]
) -> tuple[CameraModel, float, list[tuple[Matrix, Matrix]]] | None:
    flags = cv2.CALIB_RECOMPUTE_EXTRINSIC | cv2.CALIB_FIX_SKEW
    _, K, distortion, turns, shifts = cv2.fisheye.calibrate(
        [o.reshape(-1, 1, 3).astype(np.float64) for o in objects],
        [p.reshape(-1, 1, 2).astype(np.float64) for p in points],
        size,
        np.eye(3),
        np.zeros((4, 1)),
        flags=flags,
        criteria=(cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 60, 1e-9),
    )
    camera = _camera(size, np.asarray(K, np.float64), "equidistant", np.asarray(distortion, np.float64).ravel())
    poses = [
        (np.asarray(r, np.float64).ravel(), np.asarray(t, np.float64).ravel())
        for r, t in zip(turns, shifts, strict=True)
    ]
    # OpenCV gives no standard error for this model; a tenth of a percent is what two hundred corners usually leave
    return camera, 1e-3 * camera.fx_px, poses


def _camera(size: tuple[int, int], K: Matrix, model: DistortionModel, coefficients: Matrix) -> CameraModel:
    return CameraModel(
        size[0],
        size[1],
        float(K[0, 0]),
        float(K[1, 1]),
        float(K[0, 2]),
        float(K[1, 2]),
        model,
        tuple(float(value) for value in coefficients),
    )


def _errors(camera: CameraModel, view: BoardView, board: Board, pose: tuple[Matrix, Matrix]) -> Matrix:
    """Return (N, 2) seen minus expected, by our own lens: what is written to the file is what the tracker will use."""
    R, _ = cv2.Rodrigues(pose[0])
    points = board.corners_m[view.numbers] @ np.asarray(R).T + pose[1]
    return np.asarray(view.points_px - lens.project(camera, points[:, :2] / points[:, 2:]))


# -- other views ------------------------------------------------------------------------------------------------------


def board_pose(camera: CameraModel, view: BoardView, board: Board) -> tuple[Matrix, Matrix] | None:
    """Return (R_cam_board, p_cam_board_m) of a calibrated camera's view; None where there is no sensible one."""
    rays = lens.unproject(camera, view.points_px)
    objects = board.corners_m[view.numbers]
    try:
        done, turn, shift = cv2.solvePnP(objects, rays, np.eye(3), np.zeros(4), flags=cv2.SOLVEPNP_IPPE)
        if not done:
            return None
        turn, shift = cv2.solvePnPRefineLM(objects, rays, np.eye(3), np.zeros(4), turn, shift)
    except cv2.error:
        return None
    R, _ = cv2.Rodrigues(turn)
    p = np.asarray(shift, np.float64).ravel()
    return (np.asarray(R, np.float64), p) if np.all(np.isfinite(p)) and p[2] > 0.0 else None


def _checked(fit: LensFit, views: Sequence[BoardView], used: set[int], board: Board) -> LensFit:
    """Return the fit with its error on views that it has not seen."""
    others = [i for i in np.argsort(motions_px(views), kind="stable").tolist() if i not in used][:_CHECKS]
    sizes = []
    for i in others:
        pose = board_pose(fit.camera, views[i], board)
        if pose is None:
            continue
        turn, _ = cv2.Rodrigues(pose[0])
        sizes.append(
            np.linalg.norm(
                _errors(fit.camera, views[i], board, (np.asarray(turn, np.float64).ravel(), pose[1])), axis=1
            )
        )
    if len(sizes) < 5:
        return fit
    all_sizes = np.concatenate(sizes)
    # a mistaken corner now and then is the detector's, not the lens's
    all_sizes = all_sizes[all_sizes <= max(_OUTLIER * float(np.median(all_sizes)), 0.5)]
    return replace(fit, rms_px=float(np.sqrt(np.mean(all_sizes**2))), is_checked=True)
