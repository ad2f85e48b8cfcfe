"""Recorded walks with other receivers: the same truth and inertial samples, the receiver's error drawn anew as it was drawn once.

The position of these recordings was simulated on the truth. Its error lasts for a minute and the walk for two, so that of one draw
it is the draw's doing as much as the filter's whether the filter is nearer than the receiver; of sixteen it is the filter's.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from server.paper.digits import write_figures
from server.paper.tasks import Task, content_key, progress_bar, run_tasks
from tests.benchmarks.accuracy.goals import GPS_IMU, interval
from tests.benchmarks.accuracy.logs import DATA, key_of, raw_error
from tests.benchmarks.accuracy.study import FOLDER, is_wanted
from tracker import score
from tracker.estimators import Settings
from tracker.evaluate import Run, figures, follow, log_origin, make_pipeline
from tracker.geodesy import SiteFrame
from tracker.log import Log
from tracker.measurements import GpsFix, Matrix, Measurement, TruePose
from tracker.score import Figures

LOGS = ("walk0827-a", "tumvi-room1")
ESTIMATORS = (GPS_IMU, "gps-imu/famm")
DRAWS = tuple(range(1, 17))
#: Of the recordings' own receiver: how long its error lasts, how large it is on each axis, and its white noise.
TIME_S, SIZE_M, WHITE_M = 60.0, np.array([1.6, 1.6, 3.0]), 0.4
_STREAM = 61


def draws(
    path: Path,
    data: Path = DATA,
    jobs: int = 1,
    *,
    wanted: Sequence[str] = (),
    settings: Settings | None = None,
    folder: Path = FOLDER,
    seeds: Sequence[int] = DRAWS,
    logs: Sequence[str] = LOGS,
) -> list[Figures]:
    """Run every draw, or read what is kept of it; write and return all rows.

    Args:
        path: The JSON file that is written.
        data: Where the recordings are; those that are missing are left out.
        jobs: Processes.
        wanted: Entrants by name, or by a part of it between slashes; none for all.
        settings: Of the precise filter; None for the defaults.
        folder: Where results are kept.
        seeds: Of the draws.
        logs: Names of recordings.
    """
    tasks = [
        Task(
            f"draw-{seed}-{name}-{entrant.replace('/', '-')}-{_key(data / f'{name}.mcap', entrant, settings)}",
            draw_case,
            (data / f"{name}.mcap", entrant, seed, settings),
        )
        for name in logs
        if (data / f"{name}.mcap").is_file()
        for entrant in ESTIMATORS
        if is_wanted(entrant, wanted)
        for seed in seeds
    ]
    rows: list[Figures] = []
    if tasks:
        with progress_bar("draws") as bar:
            rows = run_tasks(tasks, key="1", jobs=jobs, folder=folder, done=bar)
    write_figures(path, {"rows": rows})
    return rows


def draw_case(path: Path, entrant: str, seed: int, settings: Settings | None) -> Figures:
    """Return the row of one draw."""
    log = Log.open(path)
    info, origin = log.info, log_origin(log)
    result = Run(log.name, entrant, info.t_start_ns, info.duration_s, origin, info.truth_origin)
    follow(make_pipeline(entrant, log, origin, settings), received(log, seed), result)
    truth = figures(result)["truth"] or {}
    ours = {"ate_m": truth["ate_rmse_m"], "debiased_m": truth["ate_debiased_rmse_m"]}
    return {"log": log.name, "estimator": entrant, "seed": seed} | ours | raw_error(result)


def received(log: Log, seed: int) -> list[Measurement]:
    """Return all but the pictures of a log, its fixes off the truth by another draw of the same error, in order of arrival."""
    told = list(log.messages(camera=False))
    origin = log_origin(log)
    site, fixes = SiteFrame(origin), [m for m in told if isinstance(m, GpsFix) and m.valid]
    t_ns = np.array([fix.t_ns for fix in fixes], np.int64)
    truth = [m for m in told if isinstance(m, TruePose)]
    track, known = score.true_track(truth, site.T_from(log.info.truth_origin or origin), t_ns)
    cov = tuple(np.diag(SIZE_M**2 + WHITE_M**2).ravel().tolist())
    moved = []
    for fix, p_m, is_known in zip(fixes, track.p_m + errors_m(t_ns, seed), known.tolist(), strict=True):
        if is_known:
            x, y, z = p_m.tolist()
            lat_deg, lon_deg, h_m = site.geodetic_from_site((x, y, z))
            moved.append(replace(fix, lat_deg=lat_deg, lon_deg=lon_deg, h_ellipsoid_m=h_m, cov_enu_m2=cov))
    others = [m for m in told if not isinstance(m, GpsFix)]
    return sorted([*others, *moved], key=lambda m: m.t_recv_ns)


def errors_m(
    t_ns: NDArray[np.int64], seed: int, time_s: float = TIME_S, size_m: Matrix = SIZE_M, white_m: float = WHITE_M
) -> Matrix:
    """Return (N, 3) errors of fixes at rising times: a first-order Gauss-Markov process and white noise."""
    rng = np.random.default_rng([seed, _STREAM])
    found, slow, before_ns = [], rng.normal(size=3) * size_m, int(t_ns[0])
    for now_ns in t_ns.tolist():
        keep = np.exp((before_ns - now_ns) * 1e-9 / time_s)
        slow = keep * slow + np.sqrt(1.0 - keep**2) * rng.normal(size=3) * size_m
        found.append(slow + white_m * rng.normal(size=3))
        before_ns = now_ns
    return np.array(found)


def medians(rows: Sequence[Figures]) -> list[Figures]:
    """Return a row for each log and entrant: ratios to the receiver's own error over all draws."""
    found = []
    for log, entrant in dict.fromkeys((row["log"], row["estimator"]) for row in rows):
        own = [row for row in rows if (row["log"], row["estimator"]) == (log, entrant)]
        ratios = [row["ate_m"] / row["raw_m"] for row in own]
        debiased = [row["debiased_m"] / row["raw_debiased_m"] for row in own]
        found.append(
            {
                "log": log,
                "estimator": entrant,
                "draws": len(own),
                "ratio": float(np.median(ratios)),
                "interval": interval(ratios, np.median),
                "nearer": sum(ratio <= 1.0 for ratio in ratios),
                "debiased_ratio": float(np.median(debiased)),
            }
        )
    return found


def _key(log: Path, entrant: str, settings: Settings | None) -> str:
    return content_key([Path(__file__)], key_of(log, entrant, settings))
