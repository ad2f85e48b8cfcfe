"""What is asked of the precise filter on recorded walks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tests.benchmarks.accuracy.goals import BOTH, CAMERA, GPS_IMU
from tracker.score import Figures

WALKS = ("walk0827-a", "walk0827-spp", "tumvi-room1")
BROAD = ("broad-02", "broad-21", "broad-33")
#: From a simulator that is not the project's: what holds on ours is to hold there.
FOREIGN = ("sim-dev-camera", "sim-dev-long-1", "sim-dev-long-2")


@dataclass(frozen=True)
class LogGoal:
    """One figure on some logs: at most so much, or so many times another's figure on the same log."""

    name: str
    logs: tuple[str, ...]
    figure: str
    at_least: float
    aim: float
    unit: str = ""
    estimators: tuple[str, ...] = BOTH
    over: str | None = None
    """A figure of the same row to divide by,"""
    over_rival: str | None = None
    """ or a rival whose figure of that name divides."""


def _exactly(name: str, logs: tuple[str, ...], figure: str, limit: float, unit: str = "", **more: str) -> LogGoal:
    return LogGoal(name, logs, figure, limit, limit, unit, over=more.get("over"), over_rival=more.get("over_rival"))


GOALS = (
    _exactly("ATE over raw GPS's", WALKS, "ate_m", 1.0, over="raw_m"),
    _exactly("de-biased ATE over raw GPS's", WALKS, "debiased_m", 1.0, over="raw_debiased_m"),
    _exactly("furthest off over raw GPS's furthest", WALKS, "furthest_m", 1.5, over="raw_furthest_m"),
    _exactly("tilt RMSE", ("tumvi-room1",), "tilt_deg", 1.0, "°"),
    _exactly("tilt RMSE over vqf's", BROAD, "tilt_deg", 1.1, over_rival="vqf"),
    _exactly("loop closure of a full turn", ("transformflow-1606",), "closing_deg", 3.0, "°"),
    LogGoal("ATE over raw GPS's", FOREIGN, "ate_m", 0.90, 0.75, over="raw_m"),
    LogGoal(
        "ATE over the offline batch's", FOREIGN, "ate_m", 1.20, 1.10, estimators=(GPS_IMU,), over_rival="gtsam/batch"
    ),
    LogGoal("de-biased ATE", FOREIGN, "debiased_m", 1.0, 0.8, "m", estimators=(GPS_IMU,)),
    LogGoal("de-biased ATE", FOREIGN, "debiased_m", 0.7, 0.55, "m", estimators=(CAMERA,)),
    LogGoal("tilt RMSE", FOREIGN, "tilt_deg", 0.3, 0.15, "°"),
)
#: A log plays through if poses begin by then and have no gaps.
BEGINS_S, PLAYED = 5.0, 0.99


def summary(rows: Sequence[Figures]) -> Figures:
    """Return verdicts, goal by goal, log by log; and which runs did not play through or told something that is no number."""
    table = {(row["log"], row["estimator"]): row for row in rows}
    verdicts = [
        row
        for goal in GOALS
        for log in goal.logs
        for estimator in goal.estimators
        if (row := judged(goal, log, estimator, table)) is not None
    ]
    ours = [row for row in rows if row["estimator"] in BOTH]
    return {
        "goals": verdicts,
        "not_played": [[row["log"], row["estimator"]] for row in ours if not plays(row)],
    }


def plays(row: Figures) -> bool:
    """Return whether a run began, went on to the end and told only numbers."""
    first_s = row["first_pose_s"]
    return bool(first_s is not None and first_s <= BEGINS_S and row["covered"] >= PLAYED and row["finite"])


def judged(goal: LogGoal, log: str, estimator: str, table: Mapping[tuple[str, str], Figures]) -> Figures | None:
    """Return one verdict; None where the figure or what divides it is not known."""
    row = table.get((log, estimator), {})
    value = row.get(goal.figure)
    if goal.over is not None:
        value = _ratio(value, row.get(goal.over))
    if goal.over_rival is not None:
        value = _ratio(value, table.get((log, goal.over_rival), {}).get(goal.figure))
    if value is None:
        return None
    return {
        "goal": goal.name,
        "log": log,
        "estimator": estimator,
        "value": value,
        "at_least": goal.at_least,
        "aim": goal.aim,
        "unit": goal.unit,
        "met": "aim" if value <= goal.aim else "at least" if value <= goal.at_least else "no",
    }


def _ratio(value: float | None, by: float | None) -> float | None:
    return value / by if value is not None and by else None
