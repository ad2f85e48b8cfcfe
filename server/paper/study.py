"""The study over seeds: five datasets, with and without the camera, every motion model, all on the same measurements."""

from collections import Counter, defaultdict
from collections.abc import Iterable
from functools import partial
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np

from server.paper.cases import DATASETS, Case, Seen, runs_of, see, sources_key
from server.paper.digits import write_figures
from server.paper.statistics import summary
from server.paper.tasks import FOLDER, Task, progress_bar, run_tasks
from tracker.choreography import DATASET_UPDATES
from tracker.evaluate import Run, figures
from tracker.fuzzy import MODEL_BY_NAME, FuzzyController, rule_name
from tracker.score import Figures

#: Not those of the sweep, which has chosen the defaults.
SEEDS = tuple(range(1, 17))
#: Whose Sigma is drawn, and whose rules are counted.
WITH_SIGMA = ("cmm", "famm")
WITH_RULES = ("famm",)
#: Figures of a run that say how fast this machine is, or what the study has no pictures for.
_LEFT_OUT = ("log", "estimator", "latency_ms", "realtime_factor", "vision_rate_hz", "counts")
#: A loop is closed from here (the visitor still stands where the walk begins) to the end.
LOOP_FROM_S = 10.0


def study(path: Path, seeds: Iterable[int] = SEEDS, jobs: int = 1, folder: Path = FOLDER) -> None:
    """Run every case, or read what is kept of it, and write all rows with what they mean together."""
    seeds = tuple(seeds)
    tasks = [
        Task(f"study-{case.name}", study_case, (case.dataset, case.seed))
        for case in sorted((Case(dataset, seed) for dataset in DATASETS for seed in seeds), key=_cost, reverse=True)
    ]
    with progress_bar("study") as bar:
        results = run_tasks(tasks, key=sources_key("study"), jobs=jobs, folder=folder, done=bar)
    rows = sorted((row for rows in results for row in rows), key=_order)
    sigmas = mean_sigmas(rows)
    for row in rows:
        row.pop("state_covariance", None)
    write_figures(path, {"seeds": list(seeds), "summary": summary(rows), "sigma": sigmas, "rows": rows})


def study_case(dataset: int, seed: int) -> list[Figures]:
    """Return one case's rows: sensors x motion models."""
    case = Case(dataset, seed)
    seen = see(case)
    return [row_of(case, run, seen) for runs, _ in runs_of(case, seen) for run in runs]


def row_of(case: Case, run: Run, seen: Seen) -> Figures:
    """Return a run as a row: `tracker.evaluate.figures`, and what only a study asks for."""
    sensors, model = run.estimator.rsplit("/", 1)
    row: Figures = {"dataset": case.dataset, "seed": case.seed, "sensors": sensors, "model": model}
    row |= {key: value for key, value in figures(run).items() if key not in _LEFT_OUT}
    truth = row["truth"]
    row["nees_position"] = truth["nees_per_dim"] if truth else None
    row["loop_closure_m"] = loop_closure_m(run) if case.dataset == 5 else None
    if sensors.startswith("camera"):
        row["camera"] = camera_figures(seen)
    if model in WITH_RULES:
        row["rules_fired"] = rules_fired(run)
    if model in WITH_SIGMA and run.state_covariance is not None:
        row["state_covariance"] = run.state_covariance.tolist()
    return row


def rules_fired(run: Run) -> dict[str, int]:
    """Return how often each rule was the strongest, most often first."""
    controller = FuzzyController()
    fired = Counter(
        rule_name(controller.rule_fired(hypot(*i.position_m), hypot(*i.rotation_rad), MODEL_BY_NAME[i.motion_model]))
        for i in run.innovations
    )
    return dict(sorted(fired.items(), key=lambda entry: (-entry[1], entry[0])))


def loop_closure_m(run: Run) -> float | None:
    """Return how far the path's end is from where it ought to be as seen from its beginning, horizontally.

    The walk ends where it began, but for what the visitor sways: that is taken off.
    """
    poses = [pose for pose in run.poses if pose.t_ns >= run.t_start_ns + LOOP_FROM_S * 1e9]
    if not poses or not run.truth:
        return None
    first, last = poses[0], poses[-1]
    at = partial(_true_position, np.array([t.t_ns for t in run.truth]), np.array([t.p_map_body_m for t in run.truth]))
    gap = np.subtract(last.p_site_m, first.p_site_m) - (at(last.t_ns) - at(first.t_ns))
    return float(np.hypot(gap[0], gap[1]))


def _true_position(t_ns: Any, p_m: Any, at_ns: int) -> Any:
    return np.array([np.interp(at_ns - t_ns[0], t_ns - t_ns[0], p_m[:, axis]) for axis in range(3)])


def camera_figures(seen: Seen) -> Figures:
    """Return what the camera gave: motions and keyframes a second, and the share of motions with a direction."""
    motions, duration_s = seen.motions, seen.walk.settings.duration_s
    return {
        "motions_hz": len(motions) / duration_s,
        "keyframes_hz": sum(motion.is_keyframe for motion in motions) / duration_s,
        "directed_share": sum(any(motion.direction_key) for motion in motions) / max(len(motions), 1),
    }


def mean_sigmas(rows: Iterable[Figures]) -> list[Figures]:
    """Return Sigma, (12, 12), of each dataset, sensors and model that has one: the mean over seeds."""
    found: dict[tuple[int, str, str], list[Any]] = defaultdict(list)
    for row in rows:
        if "state_covariance" in row:
            found[row["dataset"], row["sensors"], row["model"]].append(row["state_covariance"])
    return [
        {"dataset": d, "sensors": s, "model": m, "state_covariance": np.mean(sigmas, axis=0).tolist()}
        for (d, s, m), sigmas in sorted(found.items())
    ]


def _cost(case: Case) -> tuple[int, int, int]:
    """The longest first, so that no process is left with one at the end."""
    return DATASET_UPDATES[case.dataset], -case.dataset, -case.seed


def _order(row: Figures) -> tuple[int, int, str, str]:
    return row["dataset"], row["seed"], row["sensors"], row["model"]
