"""The report on an evaluation: tables in the paper's layout, figures of any log, in one page and beside it."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from assets.site import load_site
from server.blocks import Grid, Heading
from server.cli import SITE, app
from server.evaluation import Evaluation
from server.page import html
from server.report import report_of, slug_of, write_report
from server.tables import arrow, filter_error_grid, once, truth_grid, without_filter_error
from tests.server.plots.traces import trace, without_truth, without_updates
from tracker.errors import InputError
from tracker.log_writer import LogWriter
from tracker.score import Figures
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate


def _row(estimator: str, mean: float, ate: float | None) -> Figures:
    """Return what `tracker.evaluate.figures` says of a run, as far as a report reads it."""
    truth = None
    if ate is not None:
        truth = {
            "ate_rmse_m": ate,
            "rpe_10s_m": None,
            "heading_rmse_deg": 3.0,
            "tilt_rmse_deg": 0.5,
            "jitter_rms_m": 0.042,
            "nees_per_dim": 1.5,
            "registration_px": {"at_20m": {"median": 55.4}, "at_50m": {"median": 25.0}},
        }
    return {
        "log": "walk",
        "estimator": estimator,
        "updates": 152,
        "filter_error_m": {"mean": mean, "std": 0.25},
        "truth": truth,
        "gps": {"ate_rmse_m": 2.5} if truth else None,
        "motion_model_share": {"P0R0": 0.25, "P1R1": 0.75} if estimator.endswith("famm") else {"P1R1": 1.0},
    }


NAMES = ("gps-imu/imm", "gps-imu/famm", "gps-imu/cmm")
ROWS = [_row(name, mean, 2.0) for name, mean in zip(NAMES, (0.6, 0.75, 0.5), strict=True)]


def test_the_papers_table_has_its_arrows() -> None:
    grid = filter_error_grid(ROWS, "gps-imu", "errors")
    assert grid is not None
    assert grid.rows == (("walk", "152", "0.5000", "0.2500", "0.7500", "0.2500", "↑"),)
    assert filter_error_grid(ROWS, "camera-gps-imu", "errors") is None
    assert [arrow(1.0, 0.9), arrow(1.0, 1.1), arrow(1.0, 1.0)] == ["↓", "↑", "="]


def test_truth_beside_it_and_a_dash_for_what_is_not_known() -> None:
    grid = truth_grid(ROWS[:1], "truth")
    assert grid is not None
    assert grid.rows == (("walk", "gps-imu/imm", "2.50", "2.00", "–", "3.00", "0.50", "4.2", "1.50", "55", "25"),)
    assert truth_grid([_row("gps-imu/cmm", 0.5, None)], "truth") is None


def test_a_report_has_the_papers_figures_of_each_log() -> None:
    """The paper's two on one figure of paths, the rival on another; the missing and the changed are told."""
    missing = [{"log": "walk", "estimator": "camera-gps-imu/cmm", "missing": "no camera"}]
    evaluation = Evaluation(ROWS, missing, {"m_P": "literal_enu"})
    document = report_of(evaluation, [trace(name) for name in NAMES], load_site(SITE))
    names = [picture.name for picture in document.pictures()]
    assert names == ["path-walk", "path-walk-2", "angles-walk", "covariance-walk", "filter-error-walk"]
    captions = [picture.caption for picture in document.pictures()]
    assert "(b) gps-imu/cmm" in captions[0]
    assert "(c) gps-imu/famm" in captions[0]
    assert "(b) gps-imu/imm" in captions[1]
    grids = [block.name for block in document.blocks if isinstance(block, Grid)]
    assert grids == ["filter-error-gps-imu", "truth", "models"]
    page = html(document)
    assert "<code>m_P = literal_enu</code>" in page
    assert "walk: <code>camera-gps-imu/cmm</code>, no camera." in page


def test_a_log_without_truth_or_filter() -> None:
    """Nothing claims to know the truth; the ground truth's own estimator has a path and no filter."""
    rows = [{**_row("gps-imu/cmm", 0.5, None)}]
    document = report_of(Evaluation(rows), [without_truth(trace("gps-imu/cmm"))])
    assert not [b for b in document.blocks if isinstance(b, Grid)]
    assert [b.text for b in document.blocks if isinstance(b, Heading)] == ["Tables", "walk"]
    assert "Estimated paths of walk" in html(document)


def test_a_filter_without_the_papers_measurements_says_so() -> None:
    precise = without_updates(trace("gps-imu/precise"))
    row = {**_row("gps-imu/precise", 0.0, 0.8), "filter_error_m": None}
    document = report_of(Evaluation([row]), [precise])
    assert [picture.name for picture in document.pictures()] == ["path-walk", "angles-walk"]
    assert "gps-imu/precise has no filter error and no updates in the paper" in html(document)
    assert without_filter_error([row, {**row, "estimator": "camera-gps-imu/precise"}]) is not None
    assert without_filter_error(ROWS) is None


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written to"):
        write_report(report_of(Evaluation(ROWS), [trace(name) for name in NAMES]), tmp_path / "file" / "report")


def test_a_group_is_named_once() -> None:
    assert once([("a", "1"), ("a", "2"), ("b", "3")]) == (("a", "1"), ("", "2"), ("b", "3"))


def test_names_for_files_and_links() -> None:
    assert [slug_of(name) for name in ("State Agora.walk_2", "…")] == ["state-agora-walk-2", "log"]


def test_from_the_command_line(tmp_path: Path) -> None:
    """A log is made, evaluated and reported on; the page holds its figures, and the files are the same ones."""
    log = tmp_path / "walk.mcap"
    settings = WalkSettings(seed=5, duration_s=26.0, still_s=4.0, imu_hz=100.0, truth_hz=50.0)
    with LogWriter(log, default_rig(), AGORA_ORIGIN, t_start_ns=START_NS) as writer:
        for measurement in simulate(Walk(settings, default_rig())):
            writer.write(measurement)
    out = tmp_path / "report"
    arguments = [
        "evaluate",
        str(log),
        "--estimator",
        "gps-imu/cmm",
        "--estimator",
        "gps-imu/famm",
        "--report",
        str(out),
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    page = (out / "index.html").read_text(encoding="utf-8")
    assert {path.name for path in out.iterdir()} == {
        "index.html",
        "path-walk.svg",
        "angles-walk.svg",
        "covariance-walk.svg",
        "filter-error-walk.svg",
    }
    assert len(re.findall(r"<img ", page)) == 4
    assert "http" not in re.sub(r"data:[^\"]*", "", page)
