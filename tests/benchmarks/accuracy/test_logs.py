"""Recorded walks: who can run, what a row tells, and verdicts on rows made by hand."""

from pathlib import Path

import pytest

from tests.benchmarks.accuracy.entrants import RAW
from tests.benchmarks.accuracy.goals import CAMERA, GPS_IMU
from tests.benchmarks.accuracy.log_goals import plays, summary
from tests.benchmarks.accuracy.logs import PAPER, entrants, log_case, logs
from tests.benchmarks.accuracy.study import RIVALS
from tests.walks import write_walk
from tracker.log import Log
from tracker.score import Figures

PLAYED: Figures = {"first_pose_s": 1.2, "covered": 1.0, "finite": True}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one walk of thirty seconds, without a camera."""
    found = tmp_path_factory.mktemp("logs")
    write_walk(found / "short.mcap", 30.0)
    return found


def test_only_who_has_his_sensors_runs(folder: Path) -> None:
    log = Log.open(folder / "short.mcap")
    assert entrants(log) == [GPS_IMU, *PAPER[:2], RAW, *RIVALS]
    assert entrants(log, ("precise", RAW)) == [GPS_IMU, RAW]


def test_rows_of_a_folder_are_written(folder: Path, tmp_path: Path) -> None:
    """The receiver's place at the stamps of its fixes is what `agora evaluate` calls raw; held fixes are an entrant like others."""
    found = logs(tmp_path / "logs.json", folder, wanted=(RAW, "precise"), folder=tmp_path / "kept")
    ours, raw = found["rows"]
    assert (ours["estimator"], raw["estimator"]) == (GPS_IMU, RAW)
    assert ours["raw_m"] == raw["raw_m"] > ours["raw_debiased_m"] > 0.0
    assert raw["tilt_deg"] is None
    assert 0.0 < ours["tilt_deg"] < 2.0
    assert 0.0 < ours["ate_m"] <= ours["furthest_m"] < 10.0
    assert ours["closing_deg"] is None
    assert found["summary"]["not_played"] == []
    assert (tmp_path / "logs.json").is_file()


def test_a_rival_that_gives_up_has_a_row_that_says_so(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One of ours that gives up is an error."""

    def give_up(*_: object) -> None:
        raise RuntimeError("Indeterminate\nlinear system")

    monkeypatch.setattr("tests.benchmarks.accuracy.logs.rivals", lambda: {"gtsam/batch": give_up})
    found = log_case(folder / "short.mcap", "gtsam/batch", None)
    assert found == {"log": "short", "estimator": "gtsam/batch", "failed": "Indeterminate linear system"}
    monkeypatch.setattr("tests.benchmarks.accuracy.logs.run", give_up)
    with pytest.raises(RuntimeError, match="Indeterminate"):
        log_case(folder / "short.mcap", GPS_IMU, None)


def row(log: str, estimator: str, **figures: float) -> Figures:
    """Return a row by hand."""
    return {"log": log, "estimator": estimator, **PLAYED, **figures}


def test_a_figure_is_divided_by_the_same_logs() -> None:
    found = summary(
        [
            row("walk0827-a", GPS_IMU, ate_m=1.8, raw_m=2.0, debiased_m=1.1, raw_debiased_m=1.0),
            row("broad-02", GPS_IMU, tilt_deg=1.05),
            row("broad-02", "vqf", tilt_deg=1.0),
            row("broad-21", GPS_IMU, tilt_deg=1.2),
            row("broad-21", "vqf", tilt_deg=1.0),
            row("broad-33", GPS_IMU, tilt_deg=1.2),
            row("sim-dev-long-1", GPS_IMU, ate_m=1.6, raw_m=2.0),
        ]
    )
    met = {(entry["goal"], entry["log"]): (entry["value"], entry["met"]) for entry in found["goals"]}
    assert met == {
        ("ATE over raw GPS's", "walk0827-a"): (pytest.approx(0.9), "aim"),
        ("de-biased ATE over raw GPS's", "walk0827-a"): (pytest.approx(1.1), "no"),
        ("tilt RMSE over vqf's", "broad-02"): (pytest.approx(1.05), "aim"),
        ("tilt RMSE over vqf's", "broad-21"): (pytest.approx(1.2), "no"),
        ("ATE over raw GPS's", "sim-dev-long-1"): (pytest.approx(0.8), "at least"),
    }


@pytest.mark.parametrize("flaw", [{"first_pose_s": None}, {"first_pose_s": 6.0}, {"covered": 0.9}, {"finite": False}])
def test_a_log_that_does_not_play_through_is_named(flaw: Figures) -> None:
    assert plays(PLAYED)
    assert not plays(PLAYED | flaw)
    found = summary([row("gopro-walk", GPS_IMU), row("gopro-walk", CAMERA) | flaw])
    assert found["not_played"] == [["gopro-walk", CAMERA]]
