"""The same entrants on recorded walks: real ones, and some of a simulator that shares nothing with the project's own."""

from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path

import numpy as np

from server.paper.cases import ROOT, sources_key
from server.paper.digits import write_figures
from server.paper.tasks import Task, content_key, progress_bar, run_tasks
from server.paper.turn import closing_deg
from tests.benchmarks.accuracy.entrants import PAPER_MODELS, PERIOD_NS, RAW, rivals
from tests.benchmarks.accuracy.figures import ATTITUDE_ONLY
from tests.benchmarks.accuracy.goals import BOTH, GPS_IMU
from tests.benchmarks.accuracy.log_goals import summary
from tests.benchmarks.accuracy.raw import held_fixes
from tests.benchmarks.accuracy.study import FOLDER, HERE, RIVALS, is_wanted, kind_of
from tests.benchmarks.accuracy.told import RECORDED, TOLD
from tracker import score
from tracker.estimators import SENSORS, Settings, missing_sensors
from tracker.evaluate import Run, figures, log_origin, run
from tracker.geodesy import SiteFrame
from tracker.log import Log
from tracker.measurements import Frame, GpsFix, Measurement, TruePose
from tracker.score import Figures, Vector

DATA = ROOT.parent / "shared" / "data"
PAPER = tuple(f"{sensors}/{model}" for sensors in SENSORS for model in PAPER_MODELS)
#: A full turn on the spot, whose first and last picture show the same.
FULL_TURN = "transformflow-1606"
#: Poses of pictures are asked for so much later there: who begins late is asked of the first picture all the same.
CLOSING_WAIT_S = 0.95
NEEDS_FIXES = (RAW, "gtsam/batch", "gtsam/fixed-lag", "filterpy/imm")
_SOURCES = ("logs", "entrants", "raw", "told")


def logs(
    path: Path,
    data: Path = DATA,
    jobs: int = 1,
    *,
    wanted: Sequence[str] = (),
    settings: Settings | None = None,
    folder: Path = FOLDER,
) -> Figures:
    """Run every log of a folder, or read what is kept of it; write and return all rows and verdicts.

    Args:
        path: The JSON file that is written.
        data: Where `*.mcap` are.
        jobs: Processes.
        wanted: Entrants by name, or by a part of it between slashes; none for all.
        settings: Of the precise filter; None for the defaults.
        folder: Where results are kept.
    """
    tasks = [
        Task(
            f"log-{log.stem}-{entrant.replace('/', '-')}-{key_of(log, entrant, settings)}",
            log_case,
            (log, entrant, settings),
        )
        for log in sorted(data.glob("*.mcap"))
        for entrant in entrants(Log.open(log), wanted)
    ]
    rows: list[Figures] = []
    if tasks:
        with progress_bar("logs") as bar:
            rows = run_tasks(tasks, key="1", jobs=jobs, folder=folder, done=bar)
    found: Figures = {"summary": summary(rows), "rows": rows}
    write_figures(path, found)
    return found


def entrants(log: Log, wanted: Sequence[str] = ()) -> list[str]:
    """Return who can run on a log."""
    ours = [name for name in (*BOTH, *PAPER) if missing_sensors(name, log.info, log.rig) is None]
    others = [name for name in (RAW, *RIVALS) if log.info.counts["gps"] or name not in NEEDS_FIXES]
    told = (TOLD,) if log.name in RECORDED else ()
    return [name for name in (*ours, *told, *others) if is_wanted(name, wanted)]


def key_of(log: Path, entrant: str, settings: Settings | None) -> str:
    """Return a name for all that a result depends on."""
    kind = kind_of(entrant)
    files = [HERE / f"{name}.py" for name in _SOURCES]
    files += (ROOT / "tracker" / "precise").glob("*.py") if entrant not in PAPER else ()
    files += (HERE / "rivals").glob("*.py") if entrant in RIVALS else ()
    content = sha256(log.read_bytes()).hexdigest()
    return content_key(files, sources_key("turn"), content, settings if kind == "precise" else None)


def log_case(path: Path, entrant: str, settings: Settings | None) -> Figures:
    """Return one row."""
    log = Log.open(path)
    row: Figures = {"log": log.name, "estimator": entrant, "failed": None}
    try:
        if entrant == TOLD:
            result = run(log, GPS_IMU, RECORDED[log.name])
        else:
            result = _rival(log, entrant) if entrant in (RAW, *RIVALS) else run(log, entrant, settings)
    except RuntimeError as error:  # GTSAM's, where a log does not determine its graph; ours raises none
        if entrant not in RIVALS:
            raise
        return row | {"failed": " ".join(str(error).split())[:100]}
    usual = figures(result)
    row |= raw_error(result) | _against_truth(usual, entrant) | _course(result)
    turns = log.name == FULL_TURN and entrant not in (RAW, *RIVALS)
    row["closing_deg"] = closing_deg(log, entrant, CLOSING_WAIT_S) if turns else None
    return row


def _rival(log: Log, name: str) -> Run:
    info, origin = log.info, log_origin(log)
    result = Run(log.name, name, info.t_start_ns, info.duration_s, origin, info.truth_origin)
    told: list[Measurement] = []
    for measurement in log.messages(camera=False):
        if isinstance(measurement, TruePose):
            result.truth.append(measurement)
        elif not isinstance(measurement, Frame):
            told.append(measurement)
    result.fixes = [m for m in told if isinstance(m, GpsFix) and m.valid]
    ticks_ns = range(info.t_start_ns + PERIOD_NS, info.t_end_ns, PERIOD_NS)
    result.poses = (held_fixes if name == RAW else rivals()[name])(told, origin, log.rig, ticks_ns)
    return result


def raw_error(result: Run) -> Figures:
    """Return the receiver's own error at the stamps of its fixes, with and without its mean; None without truth or receiver."""
    nothing = {"raw_m": None, "raw_debiased_m": None, "raw_furthest_m": None}
    if not result.fixes or not score.known_parts(result.truth).position:
        return nothing
    site = SiteFrame(result.origin)
    t_ns = np.array([fix.t_ns for fix in result.fixes], np.int64)
    p = np.array([site.site_from_geodetic(f.lat_deg, f.lon_deg, f.h_ellipsoid_m) for f in result.fixes])
    truth, known = score.true_track(result.truth, site.T_from(result.truth_origin or result.origin), t_ns)
    error = (p - truth.p_m)[known & (t_ns - result.t_start_ns >= score.SETTLING_S * 1e9)]
    if not len(error):
        return nothing
    return {
        "raw_m": score.ate_rmse_m(error),
        "raw_debiased_m": score.ate_rmse_m(error - error.mean(axis=0)),
        "raw_furthest_m": float(np.hypot(error[:, 0], error[:, 1]).max()),
    }


def _against_truth(usual: Figures, entrant: str) -> Figures:
    truth = usual["truth"] or {}
    attitude_only, position_only = entrant in ATTITUDE_ONLY, entrant == RAW
    places = {"ate_m": "ate_rmse_m", "debiased_m": "ate_debiased_rmse_m", "height_m": "height_rmse_m"}
    places |= {"jitter_m": "jitter_rms_m", "nees_position": "nees_per_dim"}
    headings = {"heading_deg": "heading_rmse_deg", "nees_heading": "nees_heading"}
    return {
        **{name: None if attitude_only else truth.get(key) for name, key in places.items()},
        **{name: None if attitude_only or position_only else truth.get(key) for name, key in headings.items()},
        "tilt_deg": None if position_only else truth.get("tilt_rmse_deg"),
    }


def _course(result: Run) -> Figures:
    """When poses begin, what share of the rest has them, and how far the furthest is off, horizontally."""
    found: Figures = {"first_pose_s": None, "covered": 0.0, "furthest_m": None, "finite": _are_finite(result)}
    if not result.poses:
        return found
    found["first_pose_s"] = first_s = (result.poses[0].t_ns - result.t_start_ns) * 1e-9
    found["covered"] = len(result.poses) / max(1.0, (result.duration_s - first_s) * score.RATE_HZ)
    if score.known_parts(result.truth).position and result.estimator not in ATTITUDE_ONLY:
        track = score.track(result.poses)
        T_site_map = SiteFrame(result.origin).T_from(result.truth_origin or result.origin)
        truth, known = score.true_track(result.truth, T_site_map, track.t_ns)
        use = known & (track.t_ns - result.t_start_ns >= score.SETTLING_S * 1e9)
        error: Vector = (track.p_m - truth.p_m)[use]
        found["furthest_m"] = float(np.hypot(error[:, 0], error[:, 1]).max()) if len(error) else None
    return found


def _are_finite(result: Run) -> bool:
    track = score.track(result.poses)
    return all(bool(np.all(np.isfinite(values))) for values in (track.p_m, track.wxyz, track.cov))
