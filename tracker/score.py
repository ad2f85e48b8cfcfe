"""Estimated poses against ground truth, as the evaluation's JSON names them; no alignment, horizontal unless said otherwise.

A figure for which there is no truth is None, never zero.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from math import radians, tan
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tracker import rotations
from tracker.estimator import Pose
from tracker.measurements import Matrix, TruePose

Vector: TypeAlias = NDArray[np.float64]
Figures: TypeAlias = dict[str, Any]

#: The start is left out: filters settle, and a rig is calibrated at rest.
SETTLING_S = 20.0
RATE_HZ = 50.0
#: Truth is interpolated across this much and no more; the slowest truth that we score is 4 Hz.
LONGEST_GAP_S = 0.6
RPE_S = 10.0
JITTER_HZ = 1.0
#: The view of `registration_px`: 1280 px wide, 60 degrees.
FOCAL_PX = 640.0 / tan(radians(30.0))
#: Where the true point is behind the estimated camera: off by more than any picture.
OFF_SCREEN_PX = 10_000.0


@dataclass(frozen=True)
class Track:
    """A trajectory as arrays of n rows."""

    t_ns: NDArray[np.int64]
    p_m: Vector
    """(n, 3)"""
    wxyz: Vector
    """(n, 4)"""
    cov: Vector
    """(n, 6, 6)"""

    def at(self, rows: NDArray[np.bool_]) -> "Track":
        """Return some of the rows."""
        return Track(self.t_ns[rows], self.p_m[rows], self.wxyz[rows], self.cov[rows])


@dataclass(frozen=True)
class Known:
    """Which parts of the ground truth mean something."""

    position: bool
    height: bool
    tilt: bool
    heading: bool


def track(poses: Sequence[Pose]) -> Track:
    """Return poses as arrays."""
    return Track(
        np.array([pose.t_ns for pose in poses], np.int64),
        np.array([pose.p_site_m for pose in poses], float).reshape(-1, 3),
        np.array([pose.wxyz_site_body for pose in poses], float).reshape(-1, 4),
        np.array([pose.cov for pose in poses], float).reshape(-1, 6, 6),
    )


def true_track(
    poses: Sequence[TruePose], T_site_map: Matrix, t_ns: NDArray[np.int64]
) -> tuple[Track, NDArray[np.bool_]]:
    """Return ground truth at t_ns, (n,), in site, and where it is known: between two poses that are not too far apart."""
    times = np.array([pose.t_ns for pose in poses], np.int64)
    order = np.argsort(times, kind="stable")
    times = times[order]
    p_map = np.array([pose.p_map_body_m for pose in poses], float)[order]
    q_map = np.array([pose.wxyz_map_body for pose in poses], float)[order]
    if len(times) < 2:
        return track([]), np.zeros(len(t_ns), bool)
    after = np.clip(np.searchsorted(times, t_ns), 1, len(times) - 1)
    before = after - 1
    gap_ns = times[after] - times[before]
    f = ((t_ns - times[before]) / np.maximum(gap_ns, 1))[:, None]
    known = (f[:, 0] >= 0.0) & (f[:, 0] <= 1.0) & (gap_ns <= LONGEST_GAP_S * 1e9)
    p = p_map[before] + f * (p_map[after] - p_map[before])
    q = between(q_map[before], q_map[after], f)
    p_site = p @ T_site_map[:3, :3].T + T_site_map[:3, 3]
    return Track(t_ns, p_site, q, np.zeros((len(t_ns), 6, 6))), known


def between(before: Vector, after: Vector, share: Vector) -> Vector:
    """Return (n, 4) quaternions a share, (n, 1), of the way between neighbours so close that the chord is the arc."""
    sign = np.where(np.sum(before * after, axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    q = before + share * (sign * after - before)
    return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))


def known_parts(poses: Sequence[TruePose]) -> Known:
    """Return what the whole of the truth knows."""
    return Known(
        *(
            bool(poses) and all(getattr(pose, name) for pose in poses)
            for name in ("position_known", "height_known", "tilt_known", "heading_known")
        )
    )


def truth_figures(estimate: Track, truth: Track, known: Known) -> Figures | None:
    """Return the figures against truth; both tracks have the same n rows, those where truth is known."""
    if not known.position or len(estimate.t_ns) == 0:
        return None
    error = estimate.p_m - truth.p_m
    turn = turns(estimate.wxyz, truth.wxyz)
    heading, tilt = heading_rad(turn), tilt_rad(turn)
    full = 2.0 * np.arccos(np.clip(turn[:, 0], 0.0, 1.0))
    has_all = known.height and known.tilt and known.heading
    attitude = known.tilt and known.heading
    return {
        "ate_rmse_m": ate_rmse_m(error),
        "ate_debiased_rmse_m": ate_rmse_m(error - error.mean(axis=0)),
        "height_rmse_m": _rms(error[:, 2]) if known.height else None,
        "rpe_10s_m": rpe_m(estimate.t_ns, error),
        "heading_rmse_deg": float(np.degrees(_rms(heading))) if known.heading else None,
        "tilt_rmse_deg": float(np.degrees(_rms(tilt))) if known.tilt else None,
        "orientation_rmse_deg": float(np.degrees(_rms(full))) if attitude else None,
        "jitter_rms_m": _jitter(estimate.t_ns, error if known.height else error[:, :2]),
        "jitter_rms_deg": _degrees(_jitter(estimate.t_ns, 2.0 * turn[:, 1:])) if attitude else None,
        "nees_per_dim": _nees(error[:, :2], estimate.cov[:, :2, :2]),
        "nees_heading": _nees(heading[:, None], estimate.cov[:, 5:6, 5:6]) if known.heading else None,
        "registration_px": registration_px(estimate, truth) if has_all else None,
    }


def turns(wxyz: Vector, wxyz_true: Vector) -> Vector:
    """Return the (n, 4) rotations in site that take true attitudes to others, the shorter way round."""
    turn = rotations.multiply(wxyz, rotations.conjugate(wxyz_true))
    return np.asarray(turn * np.where(turn[:, :1] < 0.0, -1.0, 1.0))


def heading_rad(turn: Vector) -> Vector:
    """Return the part about the vertical, (n,), of (n, 4) rotations."""
    return np.asarray(2.0 * np.arctan2(turn[:, 3], turn[:, 0]))


def tilt_rad(turn: Vector) -> Vector:
    """Return how far the vertical leans, (n,), in (n, 4) rotations."""
    return np.asarray(2.0 * np.arccos(np.clip(np.hypot(turn[:, 0], turn[:, 3]), 0.0, 1.0)))


def ate_rmse_m(error_m: Vector) -> float:
    """Return the horizontal root mean square of errors (n, 2 or 3)."""
    return _rms(np.hypot(error_m[:, 0], error_m[:, 1]))


def rpe_m(t_ns: NDArray[np.int64], error_m: Vector, apart_s: float = RPE_S) -> float | None:
    """Return the RMS of the horizontal error of displacements over a time; None where the track is shorter."""
    later = np.searchsorted(t_ns, t_ns + round((apart_s - 0.5 / RATE_HZ) * 1e9))
    inside = later < len(t_ns)
    first, later = np.flatnonzero(inside), later[inside]
    exact = np.abs(t_ns[later] - t_ns[first] - apart_s * 1e9) < 1e9 / RATE_HZ
    if not np.any(exact):
        return None
    return ate_rmse_m(error_m[later[exact]] - error_m[first[exact]])


def registration_px(estimate: Track, truth: Track) -> Figures:
    """Return how far off points ahead of the true camera are drawn."""
    R_true, R_estimate = rotations.matrices(truth.wxyz), rotations.matrices(estimate.wxyz)
    figures: Figures = {}
    for distance_m in (20.0, 50.0):
        point = truth.p_m + distance_m * R_true[:, :, 0]
        x, y, z = np.einsum("nji,nj->ni", R_estimate, point - estimate.p_m).T
        ahead = x > 0.1
        depth = np.where(ahead, x, 1.0)
        px = np.where(ahead, FOCAL_PX * np.hypot(y, z) / depth, OFF_SCREEN_PX)
        px = np.minimum(px, OFF_SCREEN_PX)
        figures[f"at_{distance_m:g}m"] = {"median": float(np.median(px)), "p95": float(np.percentile(px, 95))}
    return figures


def _rms(values: Vector) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _degrees(value_rad: float | None) -> float | None:
    return None if value_rad is None else float(np.degrees(value_rad))


def _nees(error: Vector, cov: Vector) -> float | None:
    """Return the NEES per dimension; None for an estimator that tells no covariance (all zero)."""
    if not np.any(cov):
        return None
    solved = np.linalg.solve(cov, error[:, :, None])[:, :, 0]
    return float(np.mean(np.sum(error * solved, axis=1)) / error.shape[1])


def _segments(t_ns: NDArray[np.int64]) -> list[slice]:
    """Return the stretches without gaps that are long enough to tell 1 Hz."""
    breaks = np.flatnonzero(np.diff(t_ns) > 1.5e9 / RATE_HZ) + 1
    edges = [0, *breaks.tolist(), len(t_ns)]
    least = round(4.0 * RATE_HZ / JITTER_HZ)
    return [slice(a, b) for a, b in itertools.pairwise(edges) if b - a >= least]


def fast_part(t_ns: NDArray[np.int64], error: Vector) -> tuple[Vector, NDArray[np.bool_]]:
    """Return the part of an error, (n, d), above 1 Hz, and where it can be told, (n,): in stretches without gaps."""
    fast, told = np.zeros_like(error), np.zeros(len(error), bool)
    for segment in _segments(t_ns):
        part = error[segment]
        ramp = np.linspace(0.0, 1.0, len(part))[:, None]
        part = part - (part[0] + ramp * (part[-1] - part[0]))  # a step between the ends would ring at every frequency
        spectrum = np.fft.rfft(part, axis=0)
        spectrum[np.fft.rfftfreq(len(part), 1.0 / RATE_HZ) < JITTER_HZ] = 0.0
        fast[segment], told[segment] = np.fft.irfft(spectrum, len(part), axis=0), True
    return fast, told


def _jitter(t_ns: NDArray[np.int64], error: Vector) -> float | None:
    """Return the RMS length of the part of an error, (n, d), above 1 Hz."""
    fast, told = fast_part(t_ns, error)
    return float(np.sqrt(np.sum(np.square(fast)) / np.sum(told))) if np.any(told) else None
