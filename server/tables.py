"""Tables of a report from the rows of an evaluation (`tracker.evaluate.figures`): the paper's layout, and what it lacks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from server.blocks import Grid
from tracker.estimators import PRECISE
from tracker.score import Figures

DASH = "–"
#: The paper's four columns, in the order of the panels of its path figures.
PAPER_FOUR = ("gps-imu/cmm", "camera-gps-imu/cmm", "gps-imu/famm", "camera-gps-imu/famm")


def number(value: float | None, decimals: int) -> str:
    """Return a number as a table shows it; a dash for what is not known."""
    return DASH if value is None else f"{value:.{decimals}f}"


def lookup(row: Mapping[str, Any], *keys: str) -> Any:
    """Return what lies at the end of some keys; None where they end nowhere."""
    value: Any = row
    for key in keys:
        value = value.get(key) if isinstance(value, dict) else None
    return value


def arrow(before: float, after: float) -> str:
    """Return the paper's arrow: which way the error went when FAMM was employed."""
    return "↓" if after < before else "↑" if after > before else "="


def filter_error_grid(rows: Sequence[Figures], sensors: str, name: str) -> Grid | None:
    """Return the paper's table of filter errors for some sensors; None where no log was run with both CMM and FAMM."""
    by_name = {(row["log"], row["estimator"]): row for row in rows}
    cells = []
    for log in dict.fromkeys(row["log"] for row in rows):
        both = [by_name.get((log, f"{sensors}/{model}")) for model in ("cmm", "famm")]
        if any(lookup(row or {}, "filter_error_m") is None for row in both):
            continue
        cmm, famm = (
            {"mean": row["filter_error_m"]["mean"], "std": row["filter_error_m"]["std"]} for row in both if row
        )
        size = str(both[0]["updates"] if both[0] else DASH)
        values = (cmm["mean"], cmm["std"], famm["mean"], famm["std"])
        cells.append((log, size, *(f"{value:.4f}" for value in values), arrow(cmm["mean"], famm["mean"])))
    if not cells:
        return None
    caption = (
        f"Filter error of {sensors} in the paper's layout. Metres between predicted and measured position, over all updates; the "
        "arrow tells which way the mean went when FAMM was employed."
    )
    head = ("log", "size", "CMM mean", "CMM std", "FAMM mean", "FAMM std", "")
    return Grid(name, caption, head, tuple(cells))


def without_filter_error(rows: Sequence[Figures]) -> str | None:
    """Say which runs have no filter error and why; None where none lacks it for that reason."""
    names = list(dict.fromkeys(row["estimator"] for row in rows if row["estimator"].endswith(f"/{PRECISE}")))
    if not names:
        return None
    return (
        f"{' and '.join(names)} {'has' if len(names) == 1 else 'have'} no filter error and no updates in the paper's sense: they "
        "are of m_P and m_R, which only the paper's filter measures."
    )


def once(rows: Sequence[tuple[str, ...]]) -> tuple[tuple[str, ...], ...]:
    """Return rows whose first cell is said only where it changes: a table's groups are seen at a glance."""
    firsts = ["", *(row[0] for row in rows)]
    return tuple((row[0] if row[0] != before else "", *row[1:]) for row, before in zip(rows, firsts, strict=False))


@dataclass(frozen=True)
class _Column:
    head: str
    keys: tuple[str, ...]
    decimals: int
    scale: float = 1.0


_TRUTH = (
    _Column("raw GPS, m", ("gps", "ate_rmse_m"), 2),
    _Column("ATE, m", ("truth", "ate_rmse_m"), 2),
    _Column("RPE 10 s, m", ("truth", "rpe_10s_m"), 2),
    _Column("heading, °", ("truth", "heading_rmse_deg"), 2),
    _Column("tilt, °", ("truth", "tilt_rmse_deg"), 2),
    _Column("jitter, cm", ("truth", "jitter_rms_m"), 1, 100.0),
    _Column("NEES", ("truth", "nees_per_dim"), 2),
    _Column("px at 20 m", ("truth", "registration_px", "at_20m", "median"), 0),
    _Column("px at 50 m", ("truth", "registration_px", "at_50m", "median"), 0),
)


def truth_grid(rows: Sequence[Figures], name: str) -> Grid | None:
    """Return every run's error against truth; None where there is no truth."""
    known = [row for row in rows if row["truth"] is not None]
    if not known:
        return None
    cells = []
    for row in known:
        values = []
        for column in _TRUTH:
            value = lookup(row, *column.keys)
            values.append(number(None if value is None else value * column.scale, column.decimals))
        cells.append((row["log"], row["estimator"], *values))
    caption = (
        "Error against truth, which the paper's tables lack. Horizontal root mean squares without any alignment, from 20 s into "
        "each log on: the position (ATE), its change over ten seconds (RPE), heading and tilt, the part of the error above 1 Hz "
        "(jitter), the squared error over what the covariance promised, for each dimension (NEES: 1 is honest, more is too sure "
        "of itself), and how many pixels of a 1280 pixel, 60 degree picture an object ahead is drawn beside its place."
    )
    return Grid(name, caption, ("log", "estimator", *(column.head for column in _TRUTH)), once(cells), left=2)


def share_grid(rows: Sequence[Figures], name: str) -> Grid | None:
    """Return how often each motion model was in force; None where no run had more than one."""
    chosen = [row for row in rows if len(row["motion_model_share"]) > 1]
    if not chosen:
        return None
    models = sorted({model for row in chosen for model in row["motion_model_share"]})
    cells = [
        (
            row["log"],
            row["estimator"],
            *(f"{100.0 * share:.0f}" if (share := row["motion_model_share"].get(model)) else DASH for model in models),
        )
        for row in chosen
    ]
    return Grid(
        name,
        "Motion models in force. Per cent of each run's updates; of the time where the filter has none in the paper's sense.",
        ("log", "estimator", *models),
        once(cells),
        left=2,
    )
