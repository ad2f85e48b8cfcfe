"""The sensitivity sweep: memberships, Q, R and rules on seeds of its own; the shipped defaults are chosen from what it finds."""

import json
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from math import log
from pathlib import Path
from typing import Any

import numpy as np

from server.paper.cases import FILTERING, Case, sources_key
from server.paper.digits import write_figures
from server.paper.record import Recording, read_recording, record_case, refilter
from server.paper.statistics import CAMERA, PLAIN, PRINTED_ONE, STATIONARY, paired
from server.paper.tasks import FOLDER, Task, kept_file, progress_bar, run_tasks
from server.paper.variants import DEFAULT, RULE_MEANINGS, Variant, variants
from tracker.fusion import FusionSettings
from tracker.motion import ConstantMotion
from tracker.score import Figures

#: Not those of the study, which are to judge what these have chosen.
SEEDS = tuple(range(101, 109))
#: The share of a stationary walk that the paper's P0R0 is asked for.
RESTING = 0.95
RULE = (
    "Of the position memberships: those whose mean filter error is below CMM's in the most of the ten cells; of these, those "
    "whose median ATE is at most 1.00 x CMM's in the most cells; of these, those whose lead is sure (95 % interval, paired over "
    "seeds) in the most cells; of these, the one that trembles least (mean over cells of the RMS step of the error, as a "
    "multiple of CMM's). The same for rotation, by the rotational filter error."
)


def sweep(path: Path, seeds: Iterable[int] = SEEDS, jobs: int = 1, folder: Path = FOLDER) -> None:
    """Record every case, filter it with every variant, and write what is found."""
    seeds = tuple(seeds)
    cases = [Case(dataset, seed) for dataset in (1, 5, 2, 4, 3) for seed in seeds]
    key = sources_key("record", without=FILTERING)
    with progress_bar("recording") as bar:
        records = [Task(f"record-{case.name}", record_case, (case.dataset, case.seed)) for case in cases]
        run_tasks(records, key=key, jobs=jobs, folder=folder, done=bar)
    with progress_bar("sweep") as bar:
        filters = [
            Task(f"sweep-{case.name}", sweep_case, (str(kept_file(folder, f"record-{case.name}", key)),))
            for case in cases
        ]
        results = run_tasks(filters, key=sources_key("record", "variants", "sweep"), jobs=jobs, folder=folder, done=bar)
    found = judged(variants(), [row for rows in results for row in rows])
    write_figures(
        path, {"seeds": list(seeds), "rule": RULE, "rules": RULE_MEANINGS, **conclusions(found), "variants": found}
    )


def sweep_case(file: str) -> list[Figures]:
    """Return a row for each recording of a kept case and each variant: FAMM's figures, and CMM's with the same Q and R."""
    rows = []
    for recording in map(read_recording, json.loads(Path(file).read_text(encoding="utf-8"))):
        rows += swept(recording, variants())
    return rows


def swept(recording: Recording, tried: Sequence[Variant]) -> list[Figures]:
    """Return a row for each variant."""

    @cache
    def constant(settings: FusionSettings, var_scale: float) -> Figures:
        return refilter(recording, ConstantMotion(), settings, var_scale)

    return [
        {
            "variant": variant.name,
            "cell": recording.cell,
            "seed": recording.seed,
            "famm": refilter(recording, variant.selector(), variant.fusion, variant.var_scale, variant.innovation),
            "cmm": constant(variant.fusion, variant.var_scale),
        }
        for variant in tried
    ]


def judged(tried: Sequence[Variant], rows: Iterable[Figures]) -> list[Figures]:
    """Return each variant with its settings, its figures cell by cell, and in how many cells it does what is asked."""
    by_variant: dict[str, dict[str, list[Figures]]] = {}
    for row in rows:
        by_variant.setdefault(row["variant"], {}).setdefault(row["cell"], []).append(row)
    return [_judged(variant, by_variant[variant.name]) for variant in tried]


def _judged(variant: Variant, cells: Mapping[str, Sequence[Figures]]) -> Figures:
    error = {cell: _compared(rows, "filter_error_m") for cell, rows in sorted(cells.items())}
    turn = {cell: _compared(rows, "filter_error_rad") for cell, rows in sorted(cells.items())}
    ate = {cell: _compared(rows, "ate_m") for cell, rows in sorted(cells.items())}
    step = {cell: _compared(rows, "step_m") for cell, rows in sorted(cells.items())}
    return {
        **variant.described(),
        "wins": sum(found["difference_mean"] < 0.0 for found in error.values()),
        "sure_wins": sum(found["interval_t"][1] < 0.0 for found in error.values()),
        "ate_kept": sum(found["ratio_median"] <= PRINTED_ONE for found in ate.values()),
        "lost": [cell for cell, found in error.items() if found["difference_mean"] >= 0.0],
        "rotation_wins": sum(found["difference_mean"] < 0.0 for found in turn.values()),
        "rotation_sure_wins": sum(found["interval_t"][1] < 0.0 for found in turn.values()),
        "step_ratio_mean": float(np.mean([found["ratio_median"] for found in step.values()])),
        "cells": {
            cell: {
                "filter_error_m": [error[cell]["ours_mean"], error[cell]["theirs_mean"]],
                "filter_error_difference_m": [error[cell]["difference_mean"], *error[cell]["interval_t"]],
                "filter_error_rad_ratio": turn[cell]["ours_mean"] / turn[cell]["theirs_mean"],
                "ate_m": [ate[cell]["ours_mean"], ate[cell]["theirs_mean"]],
                "ate_ratio": ate[cell]["ratio_median"],
                "step_m": [step[cell]["ours_mean"], step[cell]["theirs_mean"]],
                "step_ratio": step[cell]["ratio_median"],
                "p0r0_share": float(np.mean([row["famm"]["p0r0_share"] for row in cells[cell]])),
            }
            for cell in error
        },
    }


def _compared(rows: Sequence[Figures], name: str) -> Figures:
    return paired([row["famm"][name] for row in rows], [row["cmm"][name] for row in rows])


def conclusions(found: Sequence[Figures]) -> Figures:
    """Return what follows: the chosen memberships, the smallest change that wins each lost cell, and the price of resting."""
    default = _of(found, DEFAULT.factor)[0]
    positions = [default, *_of(found, "position")]
    rotations = [default, *_of(found, "rotation")]
    return {
        "default": default,
        "chosen_position": max(positions, key=_merit),
        "chosen_rotation": max(rotations, key=_rotation_merit),
        "smallest_changes": {cell: _smallest_change(cell, default, found) for cell in default["lost"]},
        "resting": {
            sensors: _resting(f"{STATIONARY}/{sensors}", [default, *_of(found, "rest")]) for sensors in (PLAIN, CAMERA)
        },
    }


def _of(found: Sequence[Figures], factor: str) -> list[Figures]:
    return [row for row in found if row["factor"] == factor]


def _merit(row: Figures) -> tuple[int, int, int, float]:
    return row["wins"], row["ate_kept"], row["sure_wins"], -row["step_ratio_mean"]


def _rotation_merit(row: Figures) -> tuple[int, int, float]:
    ratios = [cell["filter_error_rad_ratio"] for cell in row["cells"].values()]
    return row["rotation_wins"], row["rotation_sure_wins"], -float(np.mean(ratios))


def _smallest_change(cell: str, default: Figures, found: Sequence[Figures]) -> Figures:
    """Return, for a cell that the defaults lose, the nearest position membership that wins it, and each rule base that does."""
    wins = [row for row in found if cell not in row["lost"]]
    positions = sorted(_of(wins, "position"), key=lambda row: _distance(row["position_m"], default["position_m"]))
    return {
        "membership": _short(positions[0]) if positions else None,
        "rules": [_short(row) for row in _of(wins, "rules")],
    }


def _distance(ours_m: Sequence[float], theirs_m: Sequence[float]) -> float:
    """How far apart two memberships are: the sum of their crossings' ratios, as logarithms."""
    ours, theirs = (((low + medium) / 2.0, (medium + high) / 2.0) for low, medium, high in (ours_m, theirs_m))
    return sum(abs(log(a / b)) for a, b in zip(ours, theirs, strict=True))


def _resting(cell: str, scales: Sequence[Figures]) -> Figures | None:
    """Return the least stretched membership under which the stationary set rests, with what it does to the other cells."""
    resting = [row for row in scales if row["cells"][cell]["p0r0_share"] >= RESTING]
    return _short(resting[0]) if resting else None


def _short(row: Figures) -> dict[str, Any]:
    """A variant without what the defaults have as well."""
    cells = row["cells"]
    return {
        **{key: row[key] for key in ("factor", "value", "position_m", "rules", "wins", "ate_kept", "lost")},
        "filter_error_ratio": {c: f["filter_error_m"][0] / f["filter_error_m"][1] for c, f in cells.items()},
        "ate_ratio": {c: f["ate_ratio"] for c, f in cells.items()},
        "p0r0_share": {c: f["p0r0_share"] for c, f in cells.items() if c.startswith(f"{STATIONARY}/")},
    }
