"""The study: what is run where, what is kept, and that its entrants run."""

import json
from pathlib import Path

import pytest

from tests.benchmarks.accuracy.__main__ import main
from tests.benchmarks.accuracy.entrants import RAW, run_unit
from tests.benchmarks.accuracy.figures import row_of
from tests.benchmarks.accuracy.goals import CAMERA, GPS_IMU
from tests.benchmarks.accuracy.scenarios import SCENARIOS
from tests.benchmarks.accuracy.study import PAPER, RIVALS, SEEDS, key_of, kind_of, study, units
from tests.benchmarks.accuracy.told import TOLD
from tests.benchmarks.accuracy.world import Recording, record
from tracker.estimators import Settings
from tracker.precise.settings import PreciseSettings
from tracker.score import Figures


@pytest.fixture(scope="module")
def short() -> Recording:
    """Fifty seconds, of which thirty walking."""
    return record(SCENARIOS["plain"], 1, duration_s=50.0)


def test_the_plain_walks_are_everybodys() -> None:
    assert units("plain") == [GPS_IMU, CAMERA, RAW, *PAPER, *RIVALS]
    assert units("three-taps") == [GPS_IMU, CAMERA, TOLD]
    assert units("stand-here", ("precise",)) == [GPS_IMU, CAMERA]
    assert units("plain", ("precise",)) == [GPS_IMU, CAMERA]
    assert units("plain", (GPS_IMU, "gtsam")) == [GPS_IMU, "gtsam/batch", "gtsam/fixed-lag"]
    assert set(range(201, 300)).isdisjoint(SEEDS)


def test_results_are_kept_by_what_they_depend_on() -> None:
    kinds = {unit: kind_of(unit) for unit in units("plain")}
    assert set(kinds.values()) == {"precise", "paper", "rivals"}
    assert kinds[RAW] == "rivals"
    others = Settings(precise=PreciseSettings(lag_s=0.4))
    assert len({key_of("precise"), key_of("precise", others), key_of("paper"), key_of("rivals")}) == 4
    assert key_of("paper", others) == key_of("paper")


@pytest.mark.parametrize("unit", [GPS_IMU, TOLD, "gps-imu/paper", RAW])
def test_an_entrant_stays_with_the_walk(short: Recording, unit: str) -> None:
    for watched in run_unit(short, unit):
        row = row_of(short, watched)
        assert 0.0 < row["ate_m"] < 8.0
        assert (row["cpu_us"] is not None) == (unit in (GPS_IMU, TOLD))
        assert (row["prediction_deg"] is not None) == (unit in (GPS_IMU, TOLD))
        assert row["estimator"] == unit or unit.endswith("/paper")


def test_a_study_is_written_and_what_was_run_is_read_again(tmp_path: Path) -> None:
    def run() -> Figures:
        return study(tmp_path / "study.json", (1, 2), scenarios=("plain",), wanted=(RAW,), folder=tmp_path / "kept")

    found = run()
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "kept").iterdir()}
    assert len(kept) == 2
    assert run() == found
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "kept").iterdir()} == kept
    written = json.loads((tmp_path / "study.json").read_text(encoding="utf-8"))
    assert [row["seed"] for row in written["rows"]] == [1, 2]
    assert written["seeds"] == [1, 2]
    assert written["summary"]["medians"][0]["estimator"] == RAW


def test_the_command_line_refuses_what_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--scenarios", "plain,sunny"])
    assert "there is no sunny" in capsys.readouterr().err
