"""One log through one estimator, as live: every message when it arrived, a pose fifty times a second, and the score of it."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from math import hypot
from time import perf_counter_ns

import numpy as np
from numpy.typing import NDArray

from tracker import score
from tracker.assembly import assemble
from tracker.errors import MalformedInput, MissingSensor
from tracker.estimator import NO_MOTION_MODEL, Estimator, Innovation, Origin, Pose
from tracker.estimators import Settings, missing_sensors
from tracker.geodesy import SiteFrame
from tracker.log import RECORDING, Log
from tracker.measurements import Frame, GpsFix, ImuSample, Matrix, Measurement, Outcome, TruePose, VisualMotion
from tracker.paper import PaperEstimator
from tracker.pipeline import Pipeline
from tracker.precise.ground import EyeHeight
from tracker.precise.memory import Memory, from_toml
from tracker.score import Figures

_PERIOD_NS = round(1e9 / score.RATE_HZ)


@dataclass
class Run:
    """What came out of one run."""

    log: str
    estimator: str
    t_start_ns: int
    duration_s: float
    origin: Origin
    truth_origin: Origin | None
    poses: list[Pose] = field(default_factory=list)
    truth: list[TruePose] = field(default_factory=list)
    fixes: list[GpsFix] = field(default_factory=list)
    innovations: list[Innovation] = field(default_factory=list)
    latencies_ns: dict[str, list[int]] = field(default_factory=lambda: {"imu": [], "vision": []})
    counts: Counter[str] = field(default_factory=Counter)
    rejected: Counter[str] = field(default_factory=Counter)
    skipped: Counter[str] = field(default_factory=Counter)
    vision_estimates: int = 0
    state_covariance: Matrix | None = None
    """(12, 12), the paper's Sigma in its order (P, V, R, Omega): the mean over the run, sampled once a second."""
    wall_s: float = 0.0


def log_origin(log: Log) -> Origin:
    """Return where a log is scored: its truth's origin, else its first fix, else half way to the pole, of mean gravity."""
    info = log.info
    if info.truth_origin is not None:
        return info.truth_origin
    if info.first_fix is not None:
        return Origin(info.first_fix.lat_deg, info.first_fix.lon_deg, info.first_fix.h_ellipsoid_m)
    return Origin(45.0, 0.0, 0.0)


def make_pipeline(
    name: str,
    log: Log,
    origin: Origin,
    settings: Settings | None = None,
    eyes_z_m: EyeHeight | None = None,
    *,
    look_again: bool = False,
) -> Pipeline:
    """Return a new pipeline for a log.

    Args:
        name: One of `ESTIMATORS`.
        log: An opened log.
        origin: Where the site frame is laid.
        settings: None for the defaults.
        eyes_z_m: Height of the rig in that frame where it stands on the ground; None where no ground is known.
        look_again: Where the log holds what the live front end had made of its pictures: look at them anew nevertheless.

    Raises:
        UnknownEstimator: No estimator has that name.
        MissingSensor: The log lacks what it needs.
    """
    missing = missing_sensors(name, log.info, log.rig)
    if missing:
        raise MissingSensor(f"{log.name} cannot run {name}: it has {missing}.")
    return assemble(
        name,
        origin=origin,
        rig=log.rig,
        date_ns=log.info.date_ns,
        truth_origin=log.info.truth_origin,
        settings=settings,
        eyes_z_m=eyes_z_m,
        looks=look_again or not log.info.counts["motions"],
        memory=_memory_of(log),
    )


def _memory_of(log: Log) -> Memory | None:
    """Return what the rig of a recording had remembered when it started: a replay without it would give other poses."""
    text = log.metadata.get(RECORDING, {}).get("memory", "")
    try:
        return from_toml(text) if text else None
    except MalformedInput:
        return None


def run(
    log: Log,
    name: str,
    settings: Settings | None = None,
    progress: Callable[[float], None] = lambda done: None,
    origin: Origin | None = None,
    eyes_z_m: EyeHeight | None = None,
    *,
    look_again: bool = False,
) -> Run:
    """Run a log through an estimator.

    Args:
        log: An opened log.
        name: One of `ESTIMATORS`.
        settings: None for the defaults.
        progress: Called now and then with the share of the log that is done.
        origin: Where the site frame is laid; None for the log's own (`log_origin`).
        eyes_z_m, look_again: See `make_pipeline`.

    Raises:
        UnknownEstimator, MissingSensor: See `make_pipeline`.
    """
    origin = origin or log_origin(log)
    pipeline = make_pipeline(name, log, origin, settings, eyes_z_m, look_again=look_again)
    info = log.info
    result = Run(log.name, name, info.t_start_ns, info.duration_s, origin, info.truth_origin)
    follow(pipeline, log.messages(camera=pipeline.estimator.uses_camera), result, progress)
    result.skipped = log.skipped
    return result


def follow(
    pipeline: Pipeline,
    measurements: Iterable[Measurement],
    result: Run,
    progress: Callable[[float], None] = lambda done: None,
) -> None:
    """Feed measurements, in order of arrival, and write into `result` what comes out."""
    began_ns = perf_counter_ns()
    sigmas: list[Matrix] = []
    for due_ns, measurement in ticks(measurements, result.t_start_ns):
        if measurement is None:
            pose = pipeline.predict(due_ns)
            if pose is not None:
                result.poses.append(pose)
            if (due_ns - result.t_start_ns) % 1_000_000_000 < _PERIOD_NS:
                progress((due_ns - result.t_start_ns) * 1e-9 / max(result.duration_s, 1e-9))
                sigmas += _state_covariance(pipeline.estimator)
            continue
        feed(pipeline, measurement, result)
    result.wall_s = (perf_counter_ns() - began_ns) * 1e-9
    result.innovations += pipeline.innovations()
    result.rejected = pipeline.rejected
    result.state_covariance = np.mean(sigmas, axis=0) if sigmas else None


def _state_covariance(estimator: Estimator) -> list[Matrix]:
    Sigma = estimator.state_covariance() if isinstance(estimator, PaperEstimator) else None
    return [] if Sigma is None else [Sigma]


def ticks(messages: Iterable[Measurement], start_ns: int) -> Iterator[tuple[int, Measurement | None]]:
    """Yield the messages, and between them (t, None) every 20 ms, after all that had arrived by t."""
    due_ns = start_ns + _PERIOD_NS
    for measurement in messages:
        while measurement.t_recv_ns > due_ns:
            yield due_ns, None
            due_ns += _PERIOD_NS
        yield measurement.t_recv_ns, measurement


def feed(pipeline: Pipeline, measurement: Measurement, result: Run) -> None:
    """Step one measurement, and note in `result` what it was and how long it took."""
    if isinstance(measurement, TruePose):
        result.truth.append(measurement)
        if pipeline.estimator.name == "truth":
            pipeline.step(measurement)
        return
    began_ns = perf_counter_ns()
    outcome = pipeline.step(measurement)
    took_ns = perf_counter_ns() - began_ns
    match measurement:
        case ImuSample():
            result.counts["imu"] += 1
            if outcome is not Outcome.IGNORED:
                result.latencies_ns["imu"].append(took_ns)
        case GpsFix():
            result.counts["gps"] += 1
            if measurement.valid:
                result.fixes.append(measurement)
        case VisualMotion():
            result.vision_estimates += outcome in (Outcome.USED, Outcome.WAITING)
        case Frame():
            result.counts["frames"] += 1
            if outcome is not Outcome.IGNORED:
                result.latencies_ns["vision"].append(took_ns)
                result.vision_estimates += outcome in (Outcome.USED, Outcome.WAITING)


def figures(result: Run) -> Figures:
    """Return a run as `agora evaluate --json` writes it."""
    estimate = score.track(result.poses)
    return {
        "log": result.log,
        "estimator": result.estimator,
        "updates": len(result.innovations),
        "duration_s": result.duration_s,
        "realtime_factor": result.duration_s / result.wall_s if result.wall_s else None,
        "filter_error_m": _spread([hypot(*i.position_m) for i in result.innovations]),
        "filter_error_rad": _spread([hypot(*i.rotation_rad) for i in result.innovations]),
        "truth": _against_truth(result, estimate),
        "gps": _raw_gps(result),
        "latency_ms": _latency(result),
        "vision_rate_hz": result.vision_estimates / result.duration_s if result.latencies_ns["vision"] else None,
        "motion_model_share": _shares(
            [i.motion_model for i in result.innovations] or [pose.motion_model for pose in result.poses]
        ),
        "counts": {
            **{name: result.counts[name] for name in ("imu", "gps", "frames")},
            "rejected": dict(result.rejected),
            "skipped": dict(result.skipped),
        },
    }


def _against_truth(result: Run, estimate: score.Track) -> Figures | None:
    if not result.truth or not result.poses:
        return None
    truth, known = score.true_track(result.truth, _T_site_map(result), estimate.t_ns)
    use = known & (estimate.t_ns - result.t_start_ns >= score.SETTLING_S * 1e9)
    if not np.any(use):
        return None
    return score.truth_figures(estimate.at(use), truth.at(use), score.known_parts(result.truth))


def _T_site_map(result: Run) -> score.Vector:
    return SiteFrame(result.origin).T_from(result.truth_origin or result.origin)


def _raw_gps(result: Run) -> Figures | None:
    """Return the receiver's own error: at the stamps of its fixes, and with each fix held until the next arrives."""
    if not result.truth or not result.fixes:
        return None
    site = SiteFrame(result.origin)
    p = np.array([site.site_from_geodetic(f.lat_deg, f.lon_deg, f.h_ellipsoid_m) for f in result.fixes])
    t = np.array([f.t_ns for f in result.fixes], np.int64)
    arrived = np.array([f.t_recv_ns for f in result.fixes], np.int64)
    ticks = np.arange(int(arrived[0]), int(arrived[-1]), _PERIOD_NS, dtype=np.int64)
    held = np.searchsorted(arrived, ticks, side="right") - 1
    return {
        "ate_rmse_m": _gps_rmse(result, t, p),
        "held_ate_rmse_m": _gps_rmse(result, ticks, p[held]),
    }


def _gps_rmse(result: Run, t_ns: NDArray[np.int64], p_m: score.Vector) -> float | None:
    truth, known = score.true_track(result.truth, _T_site_map(result), t_ns)
    use = known & (t_ns - result.t_start_ns >= score.SETTLING_S * 1e9)
    return score.ate_rmse_m(p_m[use] - truth.p_m[use]) if np.any(use) else None


def _spread(values: list[float]) -> Figures | None:
    return {"mean": float(np.mean(values)), "std": float(np.std(values))} if values else None


def _latency(result: Run) -> Figures:
    imu, vision = (np.array(result.latencies_ns[name]) * 1e-6 for name in ("imu", "vision"))
    return {
        "imu_to_pose_p50": float(np.percentile(imu, 50)) if len(imu) else None,
        "imu_to_pose_p99": float(np.percentile(imu, 99)) if len(imu) else None,
        "vision_p50": float(np.percentile(vision, 50)) if len(vision) else None,
        "vision_p95": float(np.percentile(vision, 95)) if len(vision) else None,
    }


def _shares(models: list[str]) -> dict[str, float]:
    counts = Counter(model for model in models if model != NO_MOTION_MODEL)
    return {model: count / counts.total() for model, count in sorted(counts.items())}
