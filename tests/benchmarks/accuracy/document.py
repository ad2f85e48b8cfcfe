"""docs/accuracy.md, written from what the study and the logs measured: every number in it is one of theirs."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from server.blocks import Block, Code, Document, Grid, Heading, Items, Shown, Text
from server.markdown import write_markdown
from server.paper.cases import ROOT
from server.plots.style import drawn
from tests.benchmarks.accuracy.goals import BOTH, CAMERA, GOALS, GPS_IMU
from tests.benchmarks.accuracy.plots import goals_figure, logs_figure, seeds_figure
from tests.benchmarks.accuracy.scenarios import SCENARIOS
from tests.benchmarks.accuracy.study import RIVALLED
from tests.benchmarks.accuracy.tables import COLUMNS, DRAW_COLUMNS, LOG_COLUMNS, SPECIAL, cell, draw_rows, span
from tests.benchmarks.accuracy.told import TOLD
from tracker.score import Figures

DOCUMENT = ROOT / "docs" / "accuracy.md"
FOLDER = "accuracy"
_MET = {"aim": "yes, the aim too", "at least": "yes", "no": "**no**"}
#: Of the medians, what a page has room for.
_SHOWN = (
    "/raw",
    "ATE m",
    "/batch",
    "de-b. m",
    "height m",
    "head. °",
    "tilt °",
    "walk mm",
    "stand mm",
    "NEES p",
    "NEES h",
)
_SHOWN_LOGS = ("raw m", "ATE m", "raw de-b. m", "de-b. m", "head. °", "tilt °", "jitter mm", "NEES p", "closing °")
_LEAD = (
    "How far the trackers are from the truth, over simulated walks whose sensors err as no filter here assumes, and on "
    "recorded walks, beside raw GPS, the paper's filter and rivals that run on the same measurements. Nothing is aligned "
    "to the truth, every pose is causal, and what is missed is told first."
)
_METHOD = (
    "Every walk lasts 300 s. The receiver's error has two time scales (20 s and 400 s) and its velocity now and then is "
    "half a metre a second off; the inertial unit has scales, leaning axes, biases that drift and spikes; the "
    "magnetometer has iron about it. Walls with echoes, and claims that waver, were added when a recorded walk had shown what "
    "they do. None of these models is that of a filter here, and the simulator shares nothing with "
    "`agora simulate`. Seeds {first} to {last} were never used for tuning; twice a choice was made again, on other seeds, after "
    "these had been seen. The camera is one without pictures: corners of the model, followed with the errors that were "
    "measured on drawn pictures. Medians are over {count} walks; intervals are 95 %, by resampling walks."
)
_TOLD = (
    "`gps-imu/told` is our filter without a camera, told what no filter can know: the true sizes and times of the receiver's "
    "errors. It stands where a figure is missed without a camera; what it misses as well is not for want of knowing the receiver."
)
_TOLD_LOGS = (
    "`gps-imu/told` knows the sizes and times of the errors of these recordings' simulated receivers, but not their echoes "
    "and jumps. Where it, too, is worse than raw GPS, knowing more of them would not have helped."
)
_BAND = (
    "Consistency is the squared error by what the filter claims of it, for each dimension: one is honest, less is shy, "
    "more is bold."
)


def write_document(study: Path, logs: Path, draws: Path, path: Path = DOCUMENT) -> list[Path]:
    """Write the document and its figures; return what was written.

    Args:
        study: JSON that `study` wrote.
        logs: JSON that `logs` wrote.
        draws: JSON that `draws` wrote.
        path: The Markdown file; figures go into a folder beside it.
    """
    found = json.loads(study.read_text(encoding="utf-8"))
    recorded = json.loads(logs.read_text(encoding="utf-8")) if logs.is_file() else None
    redrawn = json.loads(draws.read_text(encoding="utf-8"))["rows"] if draws.is_file() else []
    return write_markdown(compose(found, recorded, redrawn), path, FOLDER)


def compose(study: Figures, logs: Figures | None, draws: Sequence[Figures] = ()) -> Document:
    """Return the document of a study, of recorded walks where there were any, and of these with other draws of their receiver."""
    seeds, summary = study["seeds"], study["summary"]
    blocks: list[Block] = [
        *_asked(summary["goals"]),
        *_beside(study),
        *_scenarios(summary["medians"]),
        *(_recorded(logs) if logs is not None else ()),
        *(_redrawn(draws) if draws else ()),
        Heading("How it was measured"),
        Text(_METHOD.format(first=seeds[0], last=seeds[-1], count=len(seeds))),
        Text(_BAND),
        Code("make bench-accuracy"),
    ]
    return Document("Accuracy against the truth", _LEAD, tuple(blocks))


def _asked(goals: Sequence[Figures]) -> list[Block]:
    missed = [row for row in goals if row["met"] == "no"]
    rows, left_out = tuple(_goal(row) for row in goals), _left_out(goals)
    head = ("figure", "walks", "sensors", "median", "95 %", "worst walk", "at most", "aim", "met")
    caption = "Diamonds are missed, bars are 95 % intervals, the small marks are the aims."
    return [
        Heading("What is asked, and what was measured"),
        Text(
            f"{len(goals) - len(missed)} of {len(goals)} figures are met, {len(missed)} are not"
            + (":" if missed else ".")
        ),
        *([Items(tuple(_miss(row) for row in missed))] if missed else ()),
        Shown(drawn(goals_figure(goals), "goals", f"What was asked and what was measured, over seeds. {caption}")),
        *([Text(f"Not measured in this run: {left_out}.")] if left_out else []),
        Grid(
            "all-goals",
            "Every figure that is asked for; of a consistency the mean over walks, and its band.",
            head,
            rows,
            left=3,
        ),
    ]


def _goal(row: Figures) -> tuple[str, ...]:
    measured = (_number(row), span(row["interval"]), f"{row['worst']:.3g}")
    asked = (span(row["at_least"]), span(row["aim"]), _MET[row["met"]])
    walks = f"{row['scenario']}, {row['seeds']}"
    return (row["goal"], walks, _sensors(row["estimator"]), *measured, *asked)


def _left_out(goals: Sequence[Figures]) -> str:
    """Return what is asked for and was not run, scenario by scenario."""
    done = {(row["scenario"], row["estimator"]) for row in goals}
    asked = dict.fromkeys((goal.scenario, name) for goal in GOALS for name in goal.estimators)
    return "; ".join(f"{scenario} ({_sensors(name)})" for scenario, name in asked if (scenario, name) not in done)


def _miss(row: Figures) -> str:
    where = f"{row['scenario']}, {_sensors(row['estimator'])}"
    return f"{row['goal']} ({where}): {_number(row)}, asked {span(row['at_least'])} {row['unit']}".rstrip() + "."


def _beside(study: Figures) -> list[Block]:
    table: dict[str, list[float]] = {}
    for row in study["rows"]:
        if row["scenario"] == "plain" and row.get("ate_ratio") is not None:
            table.setdefault(row["estimator"], []).append(row["ate_ratio"])
    if not table:
        return []
    ceiling = study["summary"]["batch_is_a_ceiling"]
    caption = "A dot is a walk, a bar the median; ours are in colour, the dashed line is what is asked of them."
    text = "GTSAM's batch sees the whole walk at once, before and after: it is there to show how much the measurements hold."
    text += " It has no camera, and the ratio to it is of those who have none either."
    void = " It does not beat every online estimator without a camera here, so the ratio to it is void."
    return [
        Heading("Beside the others"),
        Text(text + (void if ceiling is False else "")),
        Shown(
            drawn(
                seeds_figure(table, "horizontal error as a ratio of raw GPS's", 0.9),
                "beside",
                f"The horizontal error of every entrant on the same ordinary walks, as a ratio of raw GPS's. {caption}",
            )
        ),
    ]


def _scenarios(medians: Sequence[Figures]) -> list[Block]:
    blocks: list[Block] = [Heading("Scenario by scenario")]
    blocks += [Text(_TOLD)] if any(row["estimator"] == TOLD for row in medians) else []
    columns = [column for column in COLUMNS if column[0] in _SHOWN]
    for name, scenario in SCENARIOS.items():
        rows = [row for row in medians if row["scenario"] == name]
        if not rows:
            continue
        used = [column for column in columns if any(row.get(column[1]) is not None for row in rows)]
        extra = SPECIAL.get(name, ())
        rows.sort(key=lambda row: (row["estimator"] not in BOTH, row["ate_m"] if row.get("ate_m") is not None else 1e9))
        asked = [
            *((figure, scale, form) for _, figure, scale, form in used),
            *((figure, 1.0, "{:.2f}") for figure in extra),
        ]
        body = tuple(
            (row["estimator"], *(cell(row.get(figure), scale, form) for figure, scale, form in asked)) for row in rows
        )
        head = ("estimator", *(column[0] for column in used), *(figure.replace("_", " ") for figure in extra))
        rivals = "" if name in RIVALLED else " The rivals run in the ordinary walks and in the outage."
        blocks.append(Grid(name, f"{name}: {scenario.says}; medians.{rivals}", head, body))
    return blocks


def _recorded(logs: Figures) -> list[Block]:
    goals, rows = logs["summary"]["goals"], [row for row in logs["rows"] if row["failed"] is None]
    missed = [row for row in goals if row["met"] == "no"]
    ratios: dict[str, dict[str, float]] = {}
    for row in rows:
        if row.get("ate_m") is not None and row.get("raw_m") and row["estimator"] != "gps":
            ratios.setdefault(row["log"], {})[row["estimator"]] = row["ate_m"] / row["raw_m"]
    columns = [column for column in LOG_COLUMNS if column[0] in _SHOWN_LOGS]
    body = tuple(
        (row["log"], row["estimator"], *(cell(row.get(f), s, form) for _, f, s, form in columns)) for row in rows
    )
    caption = "Right of one is worse than the receiver alone."
    return [
        Heading("Recorded walks"),
        Text(
            "Real recordings, and some of a simulator that shares nothing with ours. They were in sight when settings were chosen. "
            f"{len(goals) - len(missed)} of {len(goals)} figures are met."
        ),
        *([Items(tuple(_miss_log(row) for row in missed))] if missed else ()),
        *([Text(_TOLD_LOGS)] if any(row["estimator"] == TOLD for row in rows) else ()),
        Shown(
            drawn(
                logs_figure(ratios, "horizontal error as a ratio of raw GPS's"),
                "recorded",
                f"The horizontal error on recorded walks, as a ratio of raw GPS's. {caption}",
            )
        ),
        Grid("recorded-walks", "All recorded walks.", ("log", "estimator", *(c[0] for c in columns)), body, left=2),
    ]


def _redrawn(draws: Sequence[Figures]) -> list[Block]:
    return [
        Heading("The same walks with other receivers"),
        Text(
            "The receiver of these recordings was simulated on their truth, with an error that lasts for a minute. Of a walk of "
            "two minutes one draw of it says little: here it is drawn anew, again and again, and all else is as recorded."
        ),
        Grid(
            "draws",
            "Errors as ratios of the receiver's own, medians over draws.",
            DRAW_COLUMNS,
            tuple(draw_rows(draws)),
            left=2,
        ),
    ]


def _miss_log(row: Figures) -> str:
    asked = f"{row['at_least']:g} {row['unit']}".rstrip()
    return f"{row['goal']} ({row['log']}, {_sensors(row['estimator'])}): {_number(row)}, asked {asked}."


def _sensors(estimator: str) -> str:
    return {GPS_IMU: "GPS, IMU", CAMERA: "with camera"}.get(estimator, estimator)


def _number(row: Figures) -> str:
    """Return what was measured, with as many digits as tell what is missed from what was asked."""
    texts = [f"{row['value']:.{digits}g}" for digits in range(3, 17)]
    bounds = np.atleast_1d(row["at_least"])
    told = texts[0] if row["met"] != "no" else next((text for text in texts if float(text) not in bounds), texts[-1])
    return f"{told} {row['unit']}".rstrip()
