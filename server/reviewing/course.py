"""One estimator over a whole walk, as curves to look at and as the figures that `agora evaluate` prints. Pure.

Curves are in the frame in which walks are scored (`tracker.evaluate.log_origin`) and where no ground is known, as there.
"""

from collections.abc import Sequence
from math import degrees, isfinite, sqrt
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from server.plots.trace import RATE_HZ, Trace, trace_of
from tracker import score
from tracker.estimator import NO_MOTION_MODEL
from tracker.evaluate import Run, figures, run
from tracker.log import Log
from tracker.measurements import Matrix


class Course(msgspec.Struct, frozen=True):
    """What an estimator made of a walk. Times are seconds from its start; curves have a value for each of `t_s`, or null."""

    estimator: str
    figures: dict[str, Any]
    """A run of `agora evaluate --json`."""
    t_s: list[float]
    e_m: list[float]
    n_m: list[float]
    true_e_m: list[float | None]
    true_n_m: list[float | None]
    heading_deg: list[float | None]
    """Clockwise from north, unwrapped; null while nobody knows."""
    sigma_m: list[float]
    """Of the position on the ground: the larger half-axis of its ellipse."""
    sigma_heading_deg: list[float]
    error_m: list[float | None]
    """On the ground, against truth."""
    heading_error_deg: list[float | None]
    innovation_s: list[float]
    """When the filter was updated."""
    innovation_m: list[float]
    """How far the measured position was from the predicted one."""
    innovation_deg: list[float]
    models: list[tuple[float, str]]
    """From when on which motion model was in force."""


def course_of(log: Log, estimator: str) -> Course:
    """Run an estimator over a walk.

    Raises:
        UnknownEstimator, MissingSensor: See `tracker.evaluate.make_pipeline`.
    """
    return drawn(run(log, estimator))


def drawn(result: Run) -> Course:
    """Return a run as curves."""
    trace = trace_of(result)
    poses = result.poses[:: max(1, round(score.RATE_HZ / RATE_HZ))]
    is_known = np.array([pose.heading_known for pose in poses], bool)
    heading_deg = 90.0 - np.degrees(np.unwrap(trace.rpy_rad[:, 2]))
    return Course(
        estimator=result.estimator,
        figures=figures(result),
        t_s=_rounded(trace.t_s, 3),
        e_m=_rounded(trace.p_site_m[:, 0], 3),
        n_m=_rounded(trace.p_site_m[:, 1], 3),
        true_e_m=_known(trace.truth_p_site_m[:, 0], 3),
        true_n_m=_known(trace.truth_p_site_m[:, 1], 3),
        heading_deg=_known(np.where(is_known, heading_deg, np.nan), 2),
        sigma_m=_rounded([_sigma_m(pose.cov) for pose in poses], 3),
        sigma_heading_deg=_rounded([_sigma_heading_deg(pose.cov) for pose in poses], 3),
        error_m=_known(trace.error_m, 3),
        heading_error_deg=_known(np.degrees(trace.turn_error_rad[:, 2]), 3),
        innovation_s=_rounded(trace.update_t_s, 3),
        innovation_m=_rounded(trace.update_m, 4),
        innovation_deg=_rounded(np.degrees(trace.update_rad), 3),
        models=_models(trace),
    )


def _models(trace: Trace) -> list[tuple[float, str]]:
    changes: list[tuple[float, str]] = []
    for t_s, model in zip(trace.t_s.tolist(), trace.model.tolist(), strict=True):
        if model != NO_MOTION_MODEL and (not changes or changes[-1][1] != model):
            changes.append((round(t_s, 3), model))
    return changes


def _sigma_m(cov: Matrix) -> float:
    """Return the larger half-axis of the position's ellipse."""
    return sqrt(max(0.0, float(np.linalg.eigvalsh(cov[:2, :2])[1])))


def _sigma_heading_deg(cov: Matrix) -> float:
    return degrees(sqrt(max(0.0, float(cov[5, 5]))))


def _rounded(values: Sequence[float] | NDArray[np.float64], decimals: int) -> list[float]:
    return [round(float(value), decimals) for value in values]


def _known(values: Sequence[float] | NDArray[np.float64], decimals: int) -> list[float | None]:
    return [round(float(value), decimals) if isfinite(value) else None for value in values]
