"""`agora evaluate`: logs through estimators, as a table, as JSON and as poses for other tools."""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from assets.site import LANGUAGE, Site
from server.settings import changes
from server.standing import FAR_M, distance_m, eye_heights, origin_of
from server.tables import lookup, without_filter_error
from tracker.errors import InputError, MissingSensor
from tracker.estimators import ESTIMATORS, Settings, check_name, missing_sensors
from tracker.evaluate import Run, figures, log_origin, run
from tracker.log import Log
from tracker.precise.ground import EyeHeight
from tracker.score import Figures

Progress = Callable[[str, float], None]


@dataclass
class Evaluation:
    """What came out of some logs and estimators."""

    runs: list[Figures] = field(default_factory=list)
    missing: list[dict[str, str]] = field(default_factory=list)
    """Log, estimator and what the log lacks for it."""
    settings: dict[str, Any] = field(default_factory=dict)
    """Those that were not the defaults."""


def evaluate(
    paths: Iterable[Path],
    estimators: tuple[str, ...],
    poses: Path | None,
    progress: Progress,
    settings: Settings | None = None,
    each: Callable[[Run], None] = lambda result: None,
    ground: Site | None = None,
    *,
    look_again: bool = False,
) -> Evaluation:
    """Run every log through every estimator (none named: all) that its sensors allow.

    Args:
        paths: The logs.
        estimators: By name.
        poses: Where poses are written, if at all.
        progress: Called with what is being done, and the share of it that is.
        settings: None for the defaults.
        each: Given every run as it ends, for what needs more of it than its figures.
        ground: The site on whose ground the walks were; None where no ground is known.
        look_again: Look at the pictures anew where a log holds what the live front end had made of them.

    Raises:
        InputError: A log cannot be read or was not on that ground, an estimator does not exist, or nothing could be run.
    """
    for name in estimators:
        check_name(name)
    evaluation = Evaluation(settings=changes(settings or Settings()))
    if ground is not None:
        evaluation.settings["ground"] = ground.id
    for log in [Log.open(path) for path in paths]:
        eyes_z_m = _eye_heights(log, ground) if ground is not None else None
        for name in estimators or ESTIMATORS:
            reason = missing_sensors(name, log.info, log.rig)
            if reason is not None:
                evaluation.missing.append({"log": log.name, "estimator": name, "missing": reason})
                continue
            label = f"{log.name}  {name}"
            result = run(
                log,
                name,
                settings,
                progress=lambda done, label=label: progress(label, done),  # type: ignore[misc]
                eyes_z_m=eyes_z_m,
                look_again=look_again,
            )
            evaluation.runs.append(figures(result))
            each(result)
            if poses is not None:
                _write_tum(result, poses)
    if not evaluation.runs:
        reasons = "; ".join(f"{m['log']} has {m['missing']} for {m['estimator']}" for m in evaluation.missing)
        raise MissingSensor(f"Nothing could be run: {reasons}.")
    return evaluation


def _eye_heights(log: Log, site: Site) -> EyeHeight:
    fix = log.info.first_fix
    if fix is None or (away_m := distance_m(fix, origin_of(site))) > FAR_M:
        where = "has no GPS" if fix is None else f"was recorded {away_m / 1000.0:,.0f} km from {site.name[LANGUAGE]}"
        raise InputError(f"{log.name} {where}: evaluate it without --ground.")
    return eye_heights(site, log_origin(log))


def write_json(evaluation: Evaluation, path: Path) -> None:
    """Write `{"runs": [...], "missing": [...], "settings": {...}}`."""
    content = {"runs": evaluation.runs, "missing": evaluation.missing, "settings": evaluation.settings}
    text = json.dumps(content, indent=1, allow_nan=False)
    try:
        path.write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror}.") from error


def _write_tum(result: Run, folder: Path) -> None:
    """Write poses as `t x y z qx qy qz qw`, t in seconds of the log."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / f"{result.log}.{result.estimator.replace('/', '-')}.tum").open("w", encoding="ascii") as file:
            for pose in result.poses:
                w, qx, qy, qz = pose.wxyz_site_body
                numbers = (pose.t_ns * 1e-9, *pose.p_site_m, qx, qy, qz, w)
                file.write(" ".join(f"{number:.9f}" for number in numbers) + "\n")
    except OSError as error:
        raise InputError(f"{folder} cannot be written to: {error.strerror}.") from error


@dataclass(frozen=True)
class _Column:
    heading: str
    path: tuple[str, ...]
    """Keys into a run's figures; one that ends nowhere shows a dash."""
    form: str
    scale: int = 1
    """What turns the figure's unit into the heading's."""


_COLUMNS = (
    _Column("updates", ("updates",), "{:d}"),
    _Column("filter error\nm", ("filter_error_m", "mean"), "{:.2f}"),
    _Column("\nrad", ("filter_error_rad", "mean"), "{:.3f}"),
    _Column("raw GPS\nm", ("gps", "ate_rmse_m"), "{:.2f}"),
    _Column("ATE\nm", ("truth", "ate_rmse_m"), "{:.2f}"),
    _Column("RPE 10 s\nm", ("truth", "rpe_10s_m"), "{:.2f}"),
    _Column("heading\ndeg", ("truth", "heading_rmse_deg"), "{:.2f}"),
    _Column("tilt\ndeg", ("truth", "tilt_rmse_deg"), "{:.2f}"),
    _Column("jitter\ncm", ("truth", "jitter_rms_m"), "{:.1f}", scale=100),
    _Column("at 20 m\npx", ("truth", "registration_px", "at_20m", "median"), "{:.0f}"),
    _Column("vision\n1/s", ("vision_rate_hz",), "{:.1f}"),
    _Column("real\ntime", ("realtime_factor",), "{:.0f}x"),
)


def print_table(evaluation: Evaluation, console: Console) -> None:
    """Print one row for each run, and what was missing for the others."""
    table = Table(title="Against the filter's own measurements, and against truth", title_justify="left")
    table.add_column("log")
    table.add_column("estimator")
    for column in _COLUMNS:
        table.add_column(column.heading, justify="right")
    last = ""
    for row in evaluation.runs:
        if last and row["log"] != last:
            table.add_section()
        table.add_row(row["log"] if row["log"] != last else "", row["estimator"], *_cells(row))
        last = row["log"]
    console.print(table)
    if evaluation.settings:
        console.print(
            "With " + ", ".join(f"{key} = {value}" for key, value in evaluation.settings.items()), style="dim"
        )
    if (reason := without_filter_error(evaluation.runs)) is not None:
        console.print(reason, style="dim")
    for entry in evaluation.missing:
        console.print(f"{entry['log']} cannot run {entry['estimator']}: it has {entry['missing']}.", style="yellow")
    # every run of a log reads the same messages, and one without a camera fewer of them: the fullest reading speaks
    fullest: dict[str, dict[str, int]] = {}
    for row in evaluation.runs:
        skipped = row["counts"]["skipped"]
        fullest[row["log"]] = max(fullest.get(row["log"], {}), skipped, key=lambda counts: sum(counts.values()))
    for name, skipped in fullest.items():
        _print_skipped(name, skipped, console)


def _print_skipped(log: str, skipped: dict[str, int], console: Console) -> None:
    if "truncated" in skipped:
        console.print(f"{log} is cut off: it was played to where it breaks.", style="yellow")
    reasons = sorted((reason, count) for reason, count in skipped.items() if reason != "truncated")
    if reasons:
        what = ", ".join(f"{count} {reason.replace('_', ' ')}" for reason, count in reasons)
        console.print(f"{log}: left out {what}.", style="dim")


def _cells(row: Figures) -> list[str]:
    values = ((column, lookup(row, *column.path)) for column in _COLUMNS)
    return ["-" if value is None else column.form.format(value * column.scale) for column, value in values]
