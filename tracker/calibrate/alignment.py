"""Camera against gyroscope: the rotation between them, their clocks, and the focal length, from turns that both have seen.

Several recordings of one rig share rotation and focal length; each has its own clocks and its own bias.

The gyroscope's turns are compared with the pictures', q = R_body_cam p. What does not fit is laid to the gyroscope's side: its
integral over uneven samples errs by far more than the median of a hundred followed points. So its errors pull the focal length,
which is on the side of p, to neither side; errors of p make it longer, but are small. Numpy only.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker import rotations
from tracker.calibrate.gyro_track import GyroTrack
from tracker.calibrate.turns import Turns
from tracker.measurements import Matrix
from tracker.two_view import CAUCHY_SCALE

#: What is known of a gyroscope's bias beforehand.
BIAS_SIGMA_RAD_S = 0.02
#: Errors within this are one event (a near passer-by, a blurred stretch), not independent ones.
_BLOCK_S = 0.5
_STEPS = 25
_DONE = 1e-7
#: A misfit of this size is neither good nor hopeless while the rough place is looked for.
_ROUGH_RAD = 0.003
#: What recordings share comes first, then what each has of its own.
_ROTATION, _FOCAL, _OFFSET, _BIAS = slice(0, 3), 3, 4, slice(5, 8)
_SHARED, _SIZE = 4, 8


@dataclass(frozen=True, eq=False)
class Alignment:
    """How a camera sits and ticks beside a gyroscope, with standard errors."""

    R_body_cam: Matrix
    """(3, 3)."""
    offset_s: float
    """Added to the camera's time: the gyroscope's time of the same moment."""
    bias_rad_s: Matrix
    """(3,) of the gyroscope, body axes."""
    log_focal: float
    """Logarithm of the focal length's ratio to the one that the turns were made with."""
    rotation_rad2: Matrix
    """(3, 3) covariance of the rotation, as a rotation vector in the camera's axes."""
    offset_sigma_s: float
    log_focal_sigma: float
    focal_share: float
    """Of all that the recordings tell of the focal length, 0 to 1; 0 where it was known."""
    residual_rad: float
    """Median of what of a turn remains unexplained."""

    @property
    def rotation_sigmas_rad(self) -> Matrix:
        """(3,) rising: about the axis that is known best, the middle one, and the worst."""
        return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(self.rotation_rad2), 0.0)))


def rough(track: GyroTrack, turns: Turns, offsets_s: Matrix) -> tuple[float, float, Matrix]:
    """Return (misfit, offset_s, R_body_cam) of the best of some time offsets; the misfit is infinite where none can be judged."""
    best = (np.inf, 0.0, np.eye(3))
    for offset_s in offsets_s.tolist():
        known = track.knows(turns.times_s[:, 0] + offset_s, turns.times_s[:, 1] + offset_s)
        if np.count_nonzero(known) < 0.5 * len(known):
            continue
        q = rotations.log(track.between(*(turns.times_s[known] + offset_s).T))
        p, trust = turns.vectors_rad[known], trust_of(turns)[known]
        weights = trust**2
        for _ in range(4):
            R = rotations.nearest_rotation(q, p, weights)
            left = np.linalg.norm(q - p @ R.T, axis=1) * trust
            weights = trust**2 / (1.0 + (left / (3.0 * float(np.median(left)) + 1e-6)) ** 2)
        misfit = float(np.mean(np.log1p((left / _ROUGH_RAD) ** 2)))
        if misfit < best[0]:
            best = (misfit, offset_s, R)
    return best


def trust_of(turns: Turns) -> Matrix:
    """Return (P,) weights of the turns' errors, about 1 and never more: half of the pairs are held to be as good as can be."""
    usual = float(np.median(turns.errors_rad))
    return np.asarray(np.minimum(1.0, usual / np.maximum(turns.errors_rad, 1e-12)))


def align(track: GyroTrack, turns: Turns, R_body_cam: Matrix, offset_s: float) -> Alignment:
    """Return the alignment of one recording, as `align_all`."""
    return align_all([(track, turns)], R_body_cam, [offset_s])[0]


def align_all(
    recordings: Sequence[tuple[GyroTrack, Turns]], R_body_cam: Matrix, offsets_s: Sequence[float]
) -> list[Alignment]:
    """Return the alignments of least reweighted error near a rough one (Gauss-Newton, Cauchy's weights), one for each recording.

    Rotation and focal length are the same in all of them. A turn's weight is by the errors of its own recording. Standard errors
    are the larger of two: by the curvature, and by how much half-second blocks of the recordings disagree.

    Args:
        recordings: The gyroscope's track and the pictures' turns, at least 8, of each.
        R_body_cam: (3, 3) rough.
        offsets_s: Rough, to a tenth of a second or so, of each.
    """
    now = [
        Alignment(R_body_cam, offset_s, np.zeros(3), 0.0, np.zeros((3, 3)), 0.0, 0.0, 0.0, 0.0)
        for offset_s in offsets_s
    ]
    own = [np.r_[:_SHARED, _SHARED + k * (_SIZE - _SHARED) : _SIZE + k * (_SIZE - _SHARED)] for k in range(len(now))]
    free = np.ones(1 + int(own[-1][-1]), np.bool_)
    free[_FOCAL] = any(bool(np.any(turns.by_log_focal_rad)) for _, turns in recordings)
    for _ in range(_STEPS):
        pulls = [_pull(track, turns, at) for (track, turns), at in zip(recordings, now, strict=True)]
        curvature, gradient = np.zeros((len(free), len(free))), np.zeros(len(free))
        for columns, pull in zip(own, pulls, strict=True):
            curvature[np.ix_(columns, columns)] += pull.curvature
            gradient[columns] += pull.gradient
        step = np.zeros(len(free))
        step[free] = -np.linalg.solve(curvature[np.ix_(free, free)], gradient[free])
        now = [_moved(at, step[columns]) for at, columns in zip(now, own, strict=True)]
        if float(np.abs(step).max()) < _DONE:
            break
    inverse = np.zeros_like(curvature)
    inverse[np.ix_(free, free)] = np.linalg.inv(curvature[np.ix_(free, free)])
    scatter = np.zeros_like(curvature)
    for columns, pull in zip(own, pulls, strict=True):
        scatter[np.ix_(columns, columns)] += pull.scatter
    by_blocks = inverse @ scatter @ inverse  # the sandwich estimator
    told = np.array([_told_of_focal(pull.curvature) for pull in pulls]) if free[_FOCAL] else np.zeros(len(now))
    shares = told / max(float(told.sum()), 1e-12)
    return [
        _with_errors(
            at, inverse[np.ix_(columns, columns)], by_blocks[np.ix_(columns, columns)], share, pull.residual_rad
        )
        for at, columns, share, pull in zip(now, own, shares.tolist(), pulls, strict=True)
    ]


@dataclass(frozen=True, eq=False)
class _Pull:
    """How one recording would have its alignment moved, in its own eight unknowns."""

    curvature: Matrix
    """(8, 8)."""
    gradient: Matrix
    """(8,)."""
    scatter: Matrix
    """(8, 8) how blocks of the recording pull in different ways."""
    residual_rad: float


def _pull(track: GyroTrack, turns: Turns, now: Alignment) -> _Pull:
    trust = trust_of(turns)
    prior = np.zeros(_SIZE)
    prior[_BIAS] = BIAS_SIGMA_RAD_S**-2
    left, slopes, known = _misfit(track, turns, now)
    left, slopes = left * trust[:, None], slopes * trust[:, None, None]
    sizes = np.linalg.norm(left, axis=1)
    sigma = max(float(np.median(sizes[known])) / 1.54, 1e-9)  # the median length of three normal numbers is 1.54
    weights = known / (1.0 + (sizes / (CAUCHY_SCALE * 1.54 * sigma)) ** 2) / sigma**2
    weighted = slopes * weights[:, None, None]
    gradients = np.einsum("nik,ni->nk", weighted, left)
    gradient = gradients.sum(axis=0)
    gradient[_BIAS] += now.bias_rad_s * prior[_BIAS]
    _, blocks = np.unique(np.floor(turns.times_s[:, 0] / _BLOCK_S), return_inverse=True)
    pulls = np.zeros((int(blocks.max()) + 1, _SIZE))
    np.add.at(pulls, blocks, gradients)
    curvature = np.einsum("nik,nil->kl", weighted, slopes) + np.diag(prior)
    return _Pull(curvature, gradient, pulls.T @ pulls, float(np.median(sizes[known])))


def _told_of_focal(curvature: Matrix) -> float:
    """Return what a recording tells of the focal length, its own clock and bias found beside it: one over a variance."""
    own = slice(_OFFSET, _SIZE)
    across = curvature[_FOCAL, own]
    return float(curvature[_FOCAL, _FOCAL] - across @ np.linalg.solve(curvature[own, own], across))


def _with_errors(
    now: Alignment, inverse: Matrix, by_blocks: Matrix, focal_share: float, residual_rad: float
) -> Alignment:
    sigmas = np.sqrt(np.maximum(np.diag(by_blocks), np.diag(inverse)))
    rotations_rad2 = by_blocks[_ROTATION, _ROTATION], inverse[_ROTATION, _ROTATION]
    return replace(
        now,
        rotation_rad2=max(rotations_rad2, key=lambda covariance: float(np.linalg.eigvalsh(covariance)[-1])),
        offset_sigma_s=float(sigmas[_OFFSET]),
        log_focal_sigma=float(sigmas[_FOCAL]),
        focal_share=focal_share,
        residual_rad=residual_rad,
    )


def _moved(now: Alignment, step: Matrix) -> Alignment:
    """Return the alignment one step further; a step is kept to what the slopes are good for."""
    turn, shift, scale = np.clip(step[_ROTATION], -0.3, 0.3), np.clip(step[_OFFSET], -0.05, 0.05), step[_FOCAL]
    return replace(
        now,
        R_body_cam=now.R_body_cam @ rotations.matrices(rotations.exp(turn[None]))[0],
        offset_s=now.offset_s + float(shift),
        bias_rad_s=now.bias_rad_s + step[_BIAS],
        log_focal=now.log_focal + float(np.clip(scale, -0.2, 0.2)),
    )


def _misfit(track: GyroTrack, turns: Turns, now: Alignment) -> tuple[Matrix, Matrix, Matrix]:
    """Return (P, 3) misfits q - R p, their (P, 3, 8) slopes, and (P,) for which of them the gyroscope knows."""
    steady = track.without(now.bias_rad_s)

    def gyro(offset_s: float) -> Matrix:
        return rotations.log(steady.between(*(turns.times_s + offset_s).T))

    q = gyro(now.offset_s)
    p = turns.vectors_rad + turns.by_log_focal_rad * now.log_focal
    slopes = np.zeros((len(q), 3, _SIZE))
    for axis in range(3):
        # R exp(d) p = R p + R (d x p)
        slopes[:, :, axis] = -np.cross(np.eye(3)[axis], p) @ now.R_body_cam.T
        slopes[:, axis, _BIAS.start + axis] = -(turns.times_s[:, 1] - turns.times_s[:, 0])
    step_s = 1e-3
    slopes[:, :, _OFFSET] = (gyro(now.offset_s + step_s) - gyro(now.offset_s - step_s)) / (2.0 * step_s)
    slopes[:, :, _FOCAL] = -turns.by_log_focal_rad @ now.R_body_cam.T
    known = track.knows(turns.times_s[:, 0] + now.offset_s - step_s, turns.times_s[:, 1] + now.offset_s + step_s)
    return q - p @ now.R_body_cam.T, slopes, known
