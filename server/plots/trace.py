"""A run reduced to what figures draw: a few arrays, five samples a second."""

from dataclasses import astuple, dataclass, fields
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracker import score
from tracker.estimator import Origin
from tracker.evaluate import Run
from tracker.geodesy import SiteFrame
from tracker.geometry import rpy_from_wxyz

Array = NDArray[np.float64]
Names = NDArray[np.str_]

RATE_HZ = 5.0


@dataclass(frozen=True, eq=False)
class Trace:
    """What one estimator made of one log. Times are seconds from the log's start, positions metres in site."""

    log: str
    estimator: str
    origin: Origin
    """Where the site frame is laid."""
    t_s: Array
    """(n,)"""
    p_site_m: Array
    """(n, 3)"""
    rpy_rad: Array
    """(n, 3): roll, pitch, yaw of the body in site."""
    model: Names
    """(n,): the motion model in force."""
    truth_p_site_m: Array
    """(n, 3), NaN where truth is not known; so are the angles."""
    truth_rpy_rad: Array
    update_t_s: Array
    """(m,): the filter's updates, with their innovations' sizes."""
    update_m: Array
    update_rad: Array
    update_model: Names
    """(m,): the model that made each prediction."""
    fix_t_s: Array
    """(k,)"""
    fix_site_m: Array
    """(k, 3)"""
    state_covariance: Array
    """(12, 12), the mean over the run; empty where the estimator has none."""

    @property
    def selector(self) -> str:
        """`famm` of `camera-gps-imu/famm`."""
        return self.estimator.rpartition("/")[2]

    @property
    def sensors(self) -> str:
        """`camera-gps-imu` of `camera-gps-imu/famm`; empty for the truth."""
        return self.estimator.rpartition("/")[0]

    @property
    def has_truth(self) -> bool:
        """Whether the position's truth is known anywhere."""
        return bool(np.any(np.isfinite(self.truth_p_site_m)))

    @property
    def error_m(self) -> Array:
        """Return the horizontal distance from the truth, (n,), NaN where that is unknown."""
        return np.asarray(np.hypot(*(self.p_site_m - self.truth_p_site_m)[:, :2].T), float)

    @property
    def turn_error_rad(self) -> Array:
        """Return the errors of roll, pitch and yaw by the shorter way round, (n, 3), NaN where the truth is unknown."""
        return np.asarray(np.angle(np.exp(1j * (self.rpy_rad - self.truth_rpy_rad))), float)

    @property
    def scored(self) -> NDArray[np.bool_]:
        """Where the score counts: past the start, in which filters settle, and where the truth is known."""
        return (self.t_s >= score.SETTLING_S) & np.isfinite(self.error_m)

    def save(self, path: Path) -> None:
        """Write all of it as one compressed .npz."""
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part.npz")
        arrays: dict[str, Any] = {field.name: np.asarray(getattr(self, field.name)) for field in fields(self)}
        arrays["origin"] = np.array(astuple(self.origin))
        np.savez_compressed(part, **arrays)
        part.replace(path)

    @classmethod
    def load(cls, path: Path) -> "Trace":
        """Read what `save` wrote."""
        with np.load(path, allow_pickle=False) as file:
            arrays = {field.name: file[field.name] for field in fields(cls)}
        log, estimator, origin = (arrays.pop(name) for name in ("log", "estimator", "origin"))
        return cls(str(log), str(estimator), Origin(*origin.tolist()), **arrays)


def trace_of(run: Run) -> Trace:
    """Reduce a run; its truth is laid under the poses as the score does it."""
    step = max(1, round(score.RATE_HZ / RATE_HZ))
    poses = run.poses[::step]
    track = score.track(poses)
    truth_p, truth_rpy = np.full((len(poses), 3), np.nan), np.full((len(poses), 3), np.nan)
    site = SiteFrame(run.origin)
    if run.truth and poses:
        known_parts = score.known_parts(run.truth)
        truth, known = score.true_track(run.truth, site.T_from(run.truth_origin or run.origin), track.t_ns)
        if known_parts.position and len(truth.t_ns):
            truth_p[known] = truth.p_m[known]
        if known_parts.tilt and known_parts.heading and len(truth.t_ns):
            truth_rpy[known] = _rpy(truth.wxyz[known])
    fixes = [site.site_from_geodetic(f.lat_deg, f.lon_deg, f.h_ellipsoid_m) for f in run.fixes]
    return Trace(
        log=run.log,
        estimator=run.estimator,
        origin=run.origin,
        t_s=_seconds(run, [pose.t_ns for pose in poses]),
        p_site_m=track.p_m,
        rpy_rad=_rpy(track.wxyz),
        model=np.array([pose.motion_model for pose in poses], dtype=np.str_),
        truth_p_site_m=truth_p,
        truth_rpy_rad=truth_rpy,
        update_t_s=_seconds(run, [i.t_ns for i in run.innovations]),
        update_m=np.array([hypot(*i.position_m) for i in run.innovations]),
        update_rad=np.array([hypot(*i.rotation_rad) for i in run.innovations]),
        update_model=np.array([i.motion_model for i in run.innovations], dtype=np.str_),
        fix_t_s=_seconds(run, [fix.t_ns for fix in run.fixes]),
        fix_site_m=np.array(fixes, float).reshape(-1, 3),
        state_covariance=run.state_covariance if run.state_covariance is not None else np.zeros((0, 0)),
    )


def _seconds(run: Run, t_ns: list[int]) -> Array:
    return np.array([t - run.t_start_ns for t in t_ns], float) * 1e-9


def _rpy(wxyz: Array) -> Array:
    return np.array([rpy_from_wxyz((w, x, y, z)) for w, x, y, z in wxyz.tolist()], float).reshape(-1, 3)
