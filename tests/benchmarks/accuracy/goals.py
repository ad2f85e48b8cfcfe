"""What is asked of the precise filter, and whether the study's rows show it."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from server.paper.statistics import RESAMPLES
from tracker.score import Figures

GPS_IMU, CAMERA = "gps-imu/precise", "camera-gps-imu/precise"
BOTH = (GPS_IMU, CAMERA)
BATCH = "gtsam/batch"


@dataclass(frozen=True)
class Goal:
    """One figure in one scenario: at most so much."""

    name: str
    scenario: str
    figure: str
    estimators: tuple[str, ...]
    at_least: float
    aim: float
    unit: str = ""
    scale: float = 1.0
    """From the row's unit to this one."""


@dataclass(frozen=True)
class BandGoal:
    """A consistency: neither too bold nor too shy, pooled over walks."""

    name: str
    scenario: str
    figure: str
    dimensions: int
    at_least: tuple[float, float] = (0.4, 2.5)


GOALS = (
    Goal("ATE over raw GPS's", "plain", "ate_ratio", BOTH, 0.90, 0.75),
    Goal("ATE over the offline batch's", "plain", "batch_ratio", (GPS_IMU,), 1.20, 1.10),
    Goal("de-biased ATE, 300 s", "plain", "debiased_m", (GPS_IMU,), 1.0, 0.8, "m"),
    Goal("de-biased ATE, 300 s", "plain", "debiased_m", (CAMERA,), 0.7, 0.55, "m"),
    Goal("de-biased ATE, 90 s", "plain", "debiased_90s_m", (CAMERA,), 0.35, 0.25, "m"),
    Goal("height RMSE, ground known", "ground", "height_m", BOTH, 0.3, 0.1, "m"),
    Goal("heading RMSE after 30 s of walking", "no-magnetometer", "heading_walked_deg", BOTH, 1.0, 0.5, "°"),
    Goal("heading after 20 m, start half a turn wrong", "turned-start", "heading_20m_deg", BOTH, 4.0, 2.5, "°"),
    Goal("tilt RMSE", "plain", "tilt_deg", BOTH, 0.3, 0.15, "°"),
    Goal("jitter walking", "plain", "jitter_walking_m", BOTH, 10.0, 5.0, "mm", 1e3),
    Goal("jitter standing", "plain", "jitter_standing_m", BOTH, 2.0, 1.0, "mm", 1e3),
    Goal("60 s outage, error at its end", "outage", "outage_end_m", (GPS_IMU,), 4.0, 2.0, "m"),
    Goal("60 s outage, error at its end", "outage", "outage_end_m", (CAMERA,), 2.5, 1.0, "m"),
    Goal("60 s disturbance, heading excursion", "disturbance", "excursion_deg", BOTH, 3.0, 1.0, "°"),
    Goal("60 s after three taps, position", "three-taps", "told_m", BOTH, 0.4, 0.2, "m"),
    Goal("60 s after three taps, heading", "three-taps", "told_heading_deg", BOTH, 0.6, 0.3, "°"),
    Goal("60 s after three taps, at 20 m", "three-taps", "told_px", BOTH, 30.0, 14.0, "px"),
    Goal("60 s after standing here, position", "stand-here", "told_m", BOTH, 0.4, 0.2, "m"),
    Goal("60 s after standing here, heading", "stand-here", "told_heading_deg", BOTH, 0.6, 0.3, "°"),
    Goal("60 s after standing here, at 20 m", "stand-here", "told_px", BOTH, 30.0, 14.0, "px"),
    Goal("prediction 50 ms ahead, all of its error", "plain", "prediction_deg", BOTH, 0.3, 0.1, "°"),
    Goal("prediction 50 ms ahead, what it adds", "plain", "prediction_added_deg", BOTH, 0.3, 0.1, "°"),
    Goal("cost per inertial sample", "plain", "cpu_us", (GPS_IMU,), 120.0, 50.0, "µs"),
)
BANDS = tuple(
    BandGoal(f"NEES per dimension, {what}", scenario, figure, dimensions)
    for scenario in ("plain", "understated")
    for what, figure, dimensions in (("horizontal position", "nees_position", 2), ("heading", "nees_heading", 1))
)


def summary(rows: Iterable[Figures]) -> Figures:
    """Return every goal's verdicts, and the medians of all figures by scenario and estimator."""
    table = by_cell(rows)
    verdicts = [
        *(row for goal in GOALS for name in goal.estimators if (row := judged(goal, name, table))),
        *(row for band in BANDS for name in BOTH if (row := judged_band(band, name, table))),
    ]
    return {"goals": verdicts, "batch_is_a_ceiling": batch_is_ceiling(table), "medians": medians(table)}


def by_cell(rows: Iterable[Figures]) -> dict[tuple[str, str], dict[int, Figures]]:
    """Return rows by scenario and estimator, then by seed, with the ratio to the batch where that has run."""
    table: dict[tuple[str, str], dict[int, Figures]] = {}
    for row in rows:
        table.setdefault((row["scenario"], row["estimator"]), {})[row["seed"]] = dict(row)
    for (scenario, _), seeds in table.items():
        for seed, row in seeds.items():
            ceiling = table.get((scenario, BATCH), {}).get(seed, {}).get("ate_m")
            ours = row.get("ate_m")
            row["batch_ratio"] = ours / ceiling if ours is not None and ceiling else None
    return table


def judged(goal: Goal, estimator: str, table: Mapping[tuple[str, str], Mapping[int, Figures]]) -> Figures | None:
    """Return the median over seeds with its interval, and which mark it reaches; None where nothing was run."""
    found = _values(table.get((goal.scenario, estimator), {}), goal.figure)
    if not found:
        return None
    values = goal.scale * np.array(found)
    middle = float(np.median(values))
    return {
        "goal": goal.name,
        "scenario": goal.scenario,
        "estimator": estimator,
        "seeds": len(found),
        "value": middle,
        "interval": interval(values.tolist(), np.median),
        "worst": float(np.max(values)),
        "at_least": goal.at_least,
        "aim": goal.aim,
        "unit": goal.unit,
        "met": "aim" if middle <= goal.aim else "at least" if middle <= goal.at_least else "no",
    }


def judged_band(
    band: BandGoal, estimator: str, table: Mapping[tuple[str, str], Mapping[int, Figures]]
) -> Figures | None:
    """Return the mean over walks with its interval; the aim is the 95 % band of chi-square.

    An error hardly changes within a walk: each walk counts as one draw of each dimension.
    """
    found = _values(table.get((band.scenario, estimator), {}), band.figure)
    if not found:
        return None
    freedom, pooled = band.dimensions * len(found), float(np.mean(found))
    aim = [float(chi2.ppf(share, freedom)) / freedom for share in (0.025, 0.975)]
    is_aim, is_least = aim[0] <= pooled <= aim[1], band.at_least[0] <= pooled <= band.at_least[1]
    return {
        "goal": band.name,
        "scenario": band.scenario,
        "estimator": estimator,
        "seeds": len(found),
        "value": pooled,
        "interval": interval(found, np.mean),
        "worst": float(np.max(found)),
        "at_least": list(band.at_least),
        "aim": aim,
        "unit": "",
        "met": "aim" if is_aim else "at least" if is_least else "no",
    }


def interval(values: Sequence[float], statistic: Callable[..., object]) -> list[float] | None:
    """Return the 95 % bootstrap interval of a statistic, by resampling seeds with a fixed seed; None for fewer than two."""
    if len(values) < 2:
        return None
    drawn = np.random.default_rng(0).integers(0, len(values), (RESAMPLES, len(values)))
    low, high = np.percentile(np.asarray(statistic(np.array(values)[drawn], axis=1)), [2.5, 97.5]).tolist()
    return [float(low), float(high)]


def batch_is_ceiling(table: Mapping[tuple[str, str], Mapping[int, Figures]]) -> bool | None:
    """Return whether the batch's median ATE is below that of every online estimator of its own sensors; None if it has not run.

    On the plain walks. It has no camera: who has one may come below it.
    """
    batch = _values(table.get(("plain", BATCH), {}), "ate_m")
    if not batch:
        return None
    online = [
        name for scenario, name in table if scenario == "plain" and name != BATCH and not name.startswith("camera")
    ]
    others = [_values(table["plain", name], "ate_m") for name in online]
    return all(float(np.median(batch)) < float(np.median(values)) for values in others if values)


def medians(table: Mapping[tuple[str, str], Mapping[int, Figures]]) -> list[Figures]:
    """Return the median over seeds of every figure, a row for each scenario and estimator."""
    found = []
    for (scenario, estimator), seeds in sorted(table.items()):
        row: Figures = {"scenario": scenario, "estimator": estimator, "seeds": len(seeds)}
        for name in next(iter(seeds.values())):
            if name not in ("scenario", "estimator", "seed"):
                values = _values(seeds, name)
                row[name] = float(np.median(values)) if values else None
        found.append(row)
    return found


def _values(seeds: Mapping[int, Figures], figure: str) -> list[float]:
    return [value for _, row in sorted(seeds.items()) if (value := row.get(figure)) is not None]
