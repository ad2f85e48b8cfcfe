"""The study on a terminal: what is asked and what was measured, and the medians of every entrant."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from tests.benchmarks.accuracy.redrawn import medians
from tracker.score import Figures

#: Heading, figure, factor and format of each column of the medians.
COLUMNS = (
    ("ATE m", "ate_m", 1.0, "{:.2f}"),
    ("/raw", "ate_ratio", 1.0, "{:.2f}"),
    ("/batch", "batch_ratio", 1.0, "{:.2f}"),
    ("de-b. m", "debiased_m", 1.0, "{:.2f}"),
    ("90 s m", "debiased_90s_m", 1.0, "{:.2f}"),
    ("height m", "height_m", 1.0, "{:.2f}"),
    ("head. °", "heading_deg", 1.0, "{:.2f}"),
    ("walked °", "heading_walked_deg", 1.0, "{:.2f}"),
    ("20 m °", "heading_20m_deg", 1.0, "{:.2f}"),
    ("tilt °", "tilt_deg", 1.0, "{:.2f}"),
    ("walk mm", "jitter_walking_m", 1e3, "{:.1f}"),
    ("stand mm", "jitter_standing_m", 1e3, "{:.1f}"),
    ("NEES p", "nees_position", 1.0, "{:.2f}"),
    ("NEES h", "nees_heading", 1.0, "{:.2f}"),
)
MET = {"aim": "[green]aim[/]", "at least": "at least", "no": "[red]no[/]"}
#: What a scenario is about: shown as "special".
SPECIAL = {
    "no-magnetometer": ("heading_walked_deg",),
    "outage": ("outage_end_m", "outage_added_m"),
    "disturbance": ("excursion_deg",),
    "three-taps": ("told_m", "told_heading_deg", "told_px"),
    "stand-here": ("told_m", "told_heading_deg", "told_px"),
    "plain": ("prediction_deg", "prediction_added_deg", "cpu_us"),
}


def print_study(summary: Figures, console: Console) -> None:
    """Print both tables."""
    console.print(medians_table(summary["medians"]))
    console.print(goals_table(summary["goals"]))
    if summary["batch_is_a_ceiling"] is False:
        console.print(
            "The batch does not beat every online estimator without a camera: the ratio to it is void.", style="yellow"
        )


#: The same for the logs.
LOG_COLUMNS = (
    ("raw m", "raw_m", 1.0, "{:.2f}"),
    ("ATE m", "ate_m", 1.0, "{:.2f}"),
    ("raw de-b. m", "raw_debiased_m", 1.0, "{:.2f}"),
    ("de-b. m", "debiased_m", 1.0, "{:.2f}"),
    ("furthest m", "furthest_m", 1.0, "{:.1f}"),
    ("height m", "height_m", 1.0, "{:.2f}"),
    ("head. °", "heading_deg", 1.0, "{:.2f}"),
    ("tilt °", "tilt_deg", 1.0, "{:.2f}"),
    ("jitter mm", "jitter_m", 1e3, "{:.1f}"),
    ("NEES p", "nees_position", 1.0, "{:.2f}"),
    ("NEES h", "nees_heading", 1.0, "{:.2f}"),
    ("closing °", "closing_deg", 1.0, "{:.2f}"),
    ("begins s", "first_pose_s", 1.0, "{:.1f}"),
)


DRAW_COLUMNS = ("log", "estimator", "draws", "/raw", "95 %", "nearer than raw", "de-b. /raw")


def print_logs(found: Figures, console: Console) -> None:
    """Print the rows of the logs, then what is asked."""
    table = Table("log", "estimator", *(column[0] for column in LOG_COLUMNS))
    for row in found["rows"]:
        if row["failed"] is not None:
            table.add_row(row["log"], row["estimator"], "failed")
            continue
        cells = [cell(row.get(name), scale, form) for _, name, scale, form in LOG_COLUMNS]
        table.add_row(row["log"], row["estimator"], *cells)
    console.print(table)
    goals = Table("figure", "log", "estimator", "measured", "at least", "aim", "met")
    for row in found["summary"]["goals"]:
        measured = f"{row['value']:.3g} {row['unit']}"
        marks = (span(row["at_least"]), span(row["aim"]), MET[row["met"]])
        goals.add_row(row["goal"], row["log"], row["estimator"].removesuffix("/precise"), measured, *marks)
    console.print(goals)
    for log, estimator in found["summary"]["not_played"]:
        console.print(f"{log} did not play through with {estimator}.", style="yellow")


def print_draws(rows: Sequence[Figures], console: Console) -> None:
    """Print what other draws of the receiver's error make of recorded walks."""
    table = Table(*DRAW_COLUMNS)
    for row in draw_rows(rows):
        table.add_row(*row)
    if rows:
        console.print(table)


def draw_rows(rows: Sequence[Figures]) -> list[tuple[str, ...]]:
    """Return the cells of each log and entrant."""
    return [
        (
            row["log"],
            row["estimator"],
            f"{row['draws']}",
            f"{row['ratio']:.2f}",
            span(row["interval"]),
            f"{row['nearer']}",
            f"{row['debiased_ratio']:.2f}",
        )
        for row in medians(rows)
    ]


def goals_table(goals: Sequence[Figures]) -> Table:
    """Return the table of what is asked."""
    table = Table("figure", "scenario", "estimator", "measured", "95 %", "worst", "at least", "aim", "met")
    for row in goals:
        table.add_row(
            row["goal"],
            row["scenario"],
            row["estimator"].removesuffix("/precise"),
            f"{row['value']:.3g} {row['unit']}",
            span(row["interval"]),
            f"{row['worst']:.3g}",
            span(row["at_least"]),
            span(row["aim"]),
            MET[row["met"]],
        )
    return table


def medians_table(medians: Sequence[Figures]) -> Table:
    """Return the table of medians over seeds."""
    table = Table("scenario", "estimator", *(column[0] for column in COLUMNS), "special")
    for row in medians:
        cells = [cell(row.get(name), scale, form) for _, name, scale, form in COLUMNS]
        special = " ".join(cell(row.get(name), 1.0, "{:.2f}") for name in SPECIAL.get(row["scenario"], ()))
        table.add_row(row["scenario"], row["estimator"], *cells, special)
    return table


def cell(value: float | None, scale: float, form: str) -> str:
    """Return a figure in a column's unit; a dash where there is none."""
    return "-" if value is None else form.format(value * scale)


def span(value: float | Sequence[float] | None) -> str:
    """Return a limit, or a band from one to another."""
    if value is None:
        return "-"
    return f"{value:g}" if isinstance(value, float | int) else " to ".join(f"{one:.3g}" for one in value)
