"""How near the feature camera is to drawn pictures: both on one simulated walk, side by side.

    python -m server.feature_measure DATASET SEED LOG [--json FILE]

LOG is that walk with its pictures: `agora simulate LOG --dataset DATASET --seed SEED --camera`, which takes up to half an hour; so
docs/paper/feature.json, which docs/paper.md tabulates, is written by hand: one call for each walk.
"""

import argparse
import json
from collections.abc import Iterable
from heapq import merge
from itertools import pairwise
from math import hypot
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from assets.site import Site, load_site
from server.feature_world import dataset_walk, world_of
from server.motions import feature_motions, poses_of, rendered_motions
from server.paper.digits import write_figures
from tracker.errors import InputError
from tracker.evaluate import Run, figures, follow, log_origin, make_pipeline
from tracker.log import Log
from tracker.measurements import Matrix, Measurement, VisualMotion
from tracker.pipeline import Pipeline
from tracker.simulate import Walk

SITE = Path(__file__).parents[1] / "assets" / "state_agora"
MODELS = ("cmm", "famm")
Row = dict[str, float]


def vision_figures(walk: Walk, motions: list[VisualMotion]) -> Row:
    """Return what a walk's motions are like, and how far from its truth, by what is measured.

    Rotation against truth between keyframe and picture, direction against that of the true step where it is over 5 cm.
    """
    poses = poses_of(walk)
    duration_s, keyframes = walk.settings.duration_s, [motion for motion in motions if motion.is_keyframe]
    directed = [motion for motion in motions if any(motion.direction_key)]
    steps = [poses[motion.t_key_ns][:3, :3].T @ _step_m(motion, poses) for motion in directed]
    off_deg = [
        _angle_deg(np.array(motion.direction_key), step)
        for motion, step in zip(directed, steps, strict=True)
        if hypot(*step) > 0.05
    ]
    ages_s = [(b.t_ns - a.t_ns) * 1e-9 for a, b in pairwise(keyframes)]
    return {
        "motions a second": len(motions) / duration_s,
        "keyframes a second": len(keyframes) / duration_s,
        "between keyframes, median s": _median(ages_s),
        "features followed, mean": float(np.mean([motion.inliers for motion in motions])) if motions else float("nan"),
        "share with a direction": len(directed) / max(len(motions), 1),
        "parallax, median px": _median([motion.parallax_px for motion in motions]),
        "rotation error, median deg": _median([_turn_deg(motion, poses) for motion in motions]),
        "direction error, median deg": _median(off_deg),
    }


def filter_figures(log: Log, name: str, motions: list[VisualMotion]) -> Row:
    """Return the filter error (m, rad) and ATE (m) of an estimator that is fed a log with these motions for its pictures."""
    sensors: Iterable[Measurement] = log.messages(camera=False)
    # without a front end: the motions are there
    pipeline = Pipeline(make_pipeline(name, log, log_origin(log)).estimator)
    info = log.info
    run = Run(log.name, name, info.t_start_ns, info.duration_s, log_origin(log), info.truth_origin)
    follow(pipeline, merge(sensors, motions, key=lambda measurement: measurement.t_recv_ns), run)
    told = figures(run)
    ate_m = told["truth"]["ate_rmse_m"] if told["truth"] else float("nan")
    return {
        f"{name}: filter error m": told["filter_error_m"]["mean"],
        f"{name}: filter error rad": told["filter_error_rad"]["mean"],
        f"{name}: ATE m": ate_m,
    }


def compare(site: Site, log: Log, dataset: int, seed: int) -> tuple[Row, Row]:
    """Return the figures of the drawn pictures and of the features, by the same names.

    Raises:
        InputError: The log is of another walk.
    """
    walk = dataset_walk(site, dataset, seed)
    rendered = rendered_motions(log)
    if not {motion.t_ns for motion in rendered} <= poses_of(walk).keys():
        raise InputError(f"{log.path} is not dataset {dataset}, seed {seed}: its pictures have other stamps.")
    with world_of(site) as world:
        featured = feature_motions(walk, world)
    without: Row = {}
    for model in MODELS:
        without |= filter_figures(log, f"gps-imu/{model}", [])
    return _row(walk, log, rendered, without), _row(walk, log, featured, without)


def _row(walk: Walk, log: Log, motions: list[VisualMotion], without: Row) -> Row:
    row = vision_figures(walk, motions)
    for model in MODELS:
        found = filter_figures(log, f"camera-gps-imu/{model}", motions)
        ate, blind = found[f"camera-gps-imu/{model}: ATE m"], without[f"gps-imu/{model}: ATE m"]
        row |= found | {f"{model}: ATE over that without camera": ate / blind}
    return row


def print_table(rendered: Row, featured: Row, console: Console) -> None:
    """Print both columns, and the second over the first."""
    table = Table("", "drawn", "features", "ratio")
    for name, value in rendered.items():
        ratio = featured[name] / value if value else float("nan")
        table.add_row(name, f"{value:.4g}", f"{featured[name]:.4g}", f"{ratio:.3f}")
    console.print(table)


def _step_m(motion: VisualMotion, poses: dict[int, Matrix]) -> Matrix:
    return np.asarray(poses[motion.t_ns][:3, 3] - poses[motion.t_key_ns][:3, 3])


def _turn_deg(motion: VisualMotion, poses: dict[int, Matrix]) -> float:
    off = motion.R_key_cam.T @ poses[motion.t_key_ns][:3, :3].T @ poses[motion.t_ns][:3, :3]
    return float(np.degrees(np.arccos(np.clip((np.trace(off) - 1.0) / 2.0, -1.0, 1.0))))


def _angle_deg(a: Matrix, b: Matrix) -> float:
    cosine = float(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)))
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def _median(values: list[float]) -> float:
    return float(np.median(values)) if values else float("nan")


def keep(path: Path, dataset: int, seed: int, rendered: Row, featured: Row) -> None:
    """Write a walk's two columns into a file, in the place of what it held of that walk."""
    held = json.loads(path.read_text(encoding="utf-8"))["walks"] if path.is_file() else []
    walks = [walk for walk in held if (walk["dataset"], walk["seed"]) != (dataset, seed)]
    walks.append({"dataset": dataset, "seed": seed, "drawn": rendered, "features": featured})
    write_figures(path, {"walks": sorted(walks, key=lambda walk: (walk["dataset"], walk["seed"]))})


def main() -> None:
    """Print the table, and keep it where that is asked for."""
    parser = argparse.ArgumentParser("python -m server.feature_measure", description=__doc__.partition("\n")[0])
    parser.add_argument("dataset", type=int)
    parser.add_argument("seed", type=int)
    parser.add_argument("log", type=Path, help="that walk with its pictures")
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="keep the figures in this file, beside those of other walks"
    )
    asked = parser.parse_args()
    rendered, featured = compare(load_site(SITE), Log.open(asked.log), asked.dataset, asked.seed)
    print_table(rendered, featured, Console())
    if asked.json is not None:
        keep(asked.json, asked.dataset, asked.seed, rendered, featured)


if __name__ == "__main__":
    main()
