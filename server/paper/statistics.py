"""What the study's rows mean together: paired over seeds, because two models on one walk share its sensors' errors."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from scipy.stats import t as student_t

from server.tables import lookup
from tracker.score import Figures

#: (dataset, sensors, model) -> seed -> row
Table: TypeAlias = dict[tuple[int, str, str], dict[int, Figures]]

#: A name for each figure that is compared, and where it stands in a row.
METRICS: dict[str, tuple[str, ...]] = {
    "filter_error_m": ("filter_error_m", "mean"),
    "filter_error_rad": ("filter_error_rad", "mean"),
    "ate_m": ("truth", "ate_rmse_m"),
    "rpe_10s_m": ("truth", "rpe_10s_m"),
    "heading_deg": ("truth", "heading_rmse_deg"),
    "jitter_m": ("truth", "jitter_rms_m"),
    "nees_position": ("nees_position",),
    "loop_closure_m": ("loop_closure_m",),
}
BASE = "cmm"
PLAIN, CAMERA = "gps-imu", "camera-gps-imu"
#: Of the paper's datasets, the one in which nobody moves, and the one that closes a loop.
STATIONARY, LOOP = 3, 5
RESAMPLES = 2000
#: Up to here a ratio is printed as 1.00.
PRINTED_ONE = 1.005


def summary(rows: Iterable[Figures]) -> Figures:
    """Return all comparisons of a study's rows; a row is what `server.paper.study.row_of` returns."""
    table = by_cell(rows)
    cells = [_cell(key, seeds) for key, seeds in sorted(table.items())]
    against = [row for key in sorted(table) if key[2] != BASE for row in _against_base(table, key)]
    camera = [row for key in sorted(table) if key[1] == CAMERA for row in _against_plain(table, key)]
    return {"cells": cells, "against_cmm": against, "camera": camera, "claims": claims(cells, against, camera)}


def by_cell(rows: Iterable[Figures]) -> Table:
    """Return rows by dataset, sensors and model, then by seed."""
    table: Table = defaultdict(dict)
    for row in rows:
        table[row["dataset"], row["sensors"], row["model"]][row["seed"]] = row
    return dict(table)


def metric(row: Mapping[str, Any], name: str) -> float | None:
    """Return a figure of a row by its name in `METRICS`; None where the run has none."""
    value = lookup(row, *METRICS[name])
    return None if value is None else float(value)


def paired(ours: Sequence[float], theirs: Sequence[float]) -> Figures:
    """Compare two figures seed by seed; below zero, and a ratio below one, is ours the smaller.

    Args:
        ours, theirs: (n,) for the same n >= 2 seeds, theirs above zero.

    Returns:
        Means, medians, 95 % intervals of the mean difference (Student's t, and by resampling with a fixed seed), and how many
        seeds ours wins.
    """
    a, b = np.array(ours), np.array(theirs)
    if a.shape != b.shape or a.ndim != 1 or len(a) < 2:
        raise ValueError(f"expected two rows of the same n >= 2 seeds, got shapes {a.shape} and {b.shape}")
    difference, n = a - b, len(a)
    half = float(student_t.ppf(0.975, n - 1) * np.std(difference, ddof=1) / np.sqrt(n))
    mean = float(np.mean(difference))
    drawn = np.random.default_rng(0).integers(0, n, (RESAMPLES, n))
    low, high = np.percentile(np.mean(difference[drawn], axis=1), [2.5, 97.5]).tolist()
    return {
        "n": n,
        "ours_mean": float(np.mean(a)),
        "theirs_mean": float(np.mean(b)),
        "difference_mean": mean,
        "difference_median": float(np.median(difference)),
        "interval_t": [mean - half, mean + half],
        "interval_bootstrap": [low, high],
        "ratio_mean": float(np.mean(a / b)),
        "ratio_median": float(np.median(a / b)),
        "wins": int(np.sum(a < b)),
    }


def _cell(key: tuple[int, str, str], seeds: Mapping[int, Figures]) -> Figures:
    """Mean and spread over seeds of every figure of one cell."""
    found: Figures = {"dataset": key[0], "sensors": key[1], "model": key[2], "seeds": len(seeds)}
    for name in METRICS:
        values = [value for row in seeds.values() if (value := metric(row, name)) is not None]
        found[name] = _spread(values) if values else None
    found["raw_gps_m"] = _spread([row["gps"]["ate_rmse_m"] for row in seeds.values()])
    shares = [row["motion_model_share"] for row in seeds.values()]
    found["motion_model_share"] = {
        model: float(np.mean([share.get(model, 0.0) for share in shares]))
        for model in sorted({m for s in shares for m in s})
    }
    found["p0r0_share"] = _spread([share.get("P0R0", 0.0) for share in shares])
    return found


def _spread(values: Sequence[float]) -> Figures:
    return {
        "mean": float(np.mean(values)),
        "std": float(np.std(values, ddof=1)) if len(values) > 1 else 0.0,
        "median": float(np.median(values)),
        "min": float(np.min(values)),
        "max": float(np.max(values)),
    }


def _against_base(table: Table, key: tuple[int, str, str]) -> list[Figures]:
    dataset, sensors, model = key
    base = table.get((dataset, sensors, BASE), {})
    return _compared(table[key], base, {"dataset": dataset, "sensors": sensors, "model": model})


def _against_plain(table: Table, key: tuple[int, str, str]) -> list[Figures]:
    dataset, _, model = key
    plain = table.get((dataset, PLAIN, model), {})
    return _compared(table[key], plain, {"dataset": dataset, "model": model})


def _compared(ours: Mapping[int, Figures], theirs: Mapping[int, Figures], what: Figures) -> list[Figures]:
    """One row for each figure that both have, over the seeds that both have."""
    seeds = sorted(set(ours) & set(theirs))
    rows = []
    for name in METRICS:
        pairs = [(metric(ours[seed], name), metric(theirs[seed], name)) for seed in seeds]
        known = [(a, b) for a, b in pairs if a is not None and b is not None]
        if len(known) >= 2:
            rows.append({**what, "metric": name, **paired([a for a, _ in known], [b for _, b in known])})
    return rows


def claims(cells: Sequence[Figures], against: Sequence[Figures], camera: Sequence[Figures]) -> Figures:
    """Return the answers to what is asked of FAMM and of the camera, cell by cell."""
    famm = [row for row in against if row["model"] == "famm"]
    error = {_name(row): row for row in famm if row["metric"] == "filter_error_m"}
    ate = {_name(row): row for row in famm if row["metric"] == "ate_m"}
    moving = [row for row in camera if row["dataset"] != STATIONARY and row["model"] in (BASE, "famm")]
    return {
        "famm_filter_error_lower": sorted(n for n, row in error.items() if row["difference_mean"] < 0.0),
        "famm_filter_error_lower_surely": sorted(n for n, row in error.items() if row["interval_t"][1] < 0.0),
        "famm_filter_error_not_lower": sorted(n for n, row in error.items() if row["difference_mean"] >= 0.0),
        "famm_ate_ratio_median": {name: row["ratio_median"] for name, row in sorted(ate.items())},
        "famm_ate_at_most_cmm": sorted(n for n, row in ate.items() if row["ratio_median"] <= 1.0),
        "famm_ate_at_most_1_00": sorted(n for n, row in ate.items() if row["ratio_median"] <= PRINTED_ONE),
        "camera_better": _better(moving),
        "camera_worse_by_2_percent": sorted(
            f"{_camera_name(row)}/{row['metric']}"
            for row in moving
            if row["metric"] in ("ate_m", "rpe_10s_m") and row["ratio_median"] > 1.02
        ),
        "stationary_p0r0_share": {
            cell["sensors"]: cell["p0r0_share"]
            for cell in cells
            if cell["dataset"] == STATIONARY and cell["model"] == "famm"
        },
        "loop_closure_m": {
            f"{cell['sensors']}/{cell['model']}": cell["loop_closure_m"]["median"]
            for cell in cells
            if cell["dataset"] == LOOP and cell["loop_closure_m"] is not None
        },
    }


def _better(camera: Sequence[Figures]) -> list[str]:
    """The moving cells in which both ATE and RPE are smaller with the camera, by the median over seeds."""
    smaller: dict[str, set[str]] = defaultdict(set)
    for row in camera:
        if row["ratio_median"] < 1.0:
            smaller[_camera_name(row)].add(row["metric"])
    return sorted(name for name, metrics in smaller.items() if {"ate_m", "rpe_10s_m"} <= metrics)


def _name(row: Figures) -> str:
    return f"{row['dataset']}/{row['sensors']}"


def _camera_name(row: Figures) -> str:
    return f"{row['dataset']}/{row['model']}"
