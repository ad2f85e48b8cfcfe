"""docs/paper/attitude.json: what it must show, that it is what the code measures, and that it survives without recordings."""

import json
from pathlib import Path
from typing import Any

import pytest

from server.paper import attitude, drift
from server.paper.attitude import OUT, SEEDS, STILL_LOGS, kept, measure, recorded, simulated

WAYS = {"raw", "mean", "offsets", "both", "agora", "vqf", "imufusion"}


@pytest.fixture(scope="module")
def written() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(OUT.read_text(encoding="utf-8"))
    return found


def test_a_resting_rig_drifts_by_no_more_than_the_papers(written: dict[str, Any]) -> None:
    """Half a degree a minute: ours for every seed, the paper's own way in the mean of them; without calibration ten times that."""
    limit = written["paper"]["drift_deg_min"]
    simulated = written["simulated"]
    assert [row["seed"] for row in simulated["seeds"]] == list(SEEDS)
    assert set(simulated["mean"]) == WAYS
    assert simulated["largest"]["agora"] <= limit
    assert simulated["mean"]["both"] <= limit
    assert simulated["mean"]["raw"] > 10.0 * limit
    rests = [rest for log in written["recorded"] for rest in log["rests"]]
    assert len(rests) == 6
    assert all(rest["drift_deg_min"]["agora"] <= limit for rest in rests)


def test_the_camera_agrees_with_the_gyroscope(written: dict[str, Any]) -> None:
    assert all(log["fitted"]["median_deg"] < 0.5 for log in written["camera"]["logs"])
    assert written["camera"]["full_turn"]["together_off_deg"] < 5.0


def test_a_seed_is_measured_as_it_is_written(written: dict[str, Any]) -> None:
    """The one whose offset wanders most."""
    worst = max(written["simulated"]["seeds"], key=lambda row: row["drift_deg_min"]["agora"])
    found = simulated(worst["seed"])
    assert found["offsets"]["gyro_deg_s"] == pytest.approx(worst["offsets"]["gyro_deg_s"], abs=1e-4)
    assert found["drift_deg_min"] == pytest.approx(worst["drift_deg_min"], abs=0.01)


def test_a_recording_is_measured_as_it_is_written(written: dict[str, Any], shared: Path) -> None:
    """Drift in both rests and the error against truth, by every way."""
    before = {row["log"]: row for row in written["recorded"]}["broad-33"]
    found = recorded(shared / "data" / "broad-33.mcap")
    assert len(found["rests"]) == len(before["rests"]) == 2
    for new, old in zip(found["rests"], before["rests"], strict=True):
        assert new["drift_deg_min"] == pytest.approx(old["drift_deg_min"], abs=0.02)
    for way, error in found["error_deg"].items():
        assert error == pytest.approx(before["error_deg"][way], abs=0.1)


def test_without_recordings_what_the_file_says_of_them_is_kept(
    written: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And what it says of a rival that is not installed; with no file before, there is nothing to say."""
    monkeypatch.setattr(drift, "by_vqf", lambda samples: None)
    monkeypatch.setattr(attitude, "DATASET_DURATION_S", {attitude.AT_REST: 36.0})
    found = measure(tmp_path, written, list, seeds=[1])
    assert found["recorded"] == written["recorded"]
    assert found["camera"] == written["camera"]
    assert found["simulated"]["mean"]["vqf"] == written["simulated"]["mean"]["vqf"]
    assert found["simulated"]["mean"]["agora"] == found["simulated"]["seeds"][0]["drift_deg_min"]["agora"]
    bare = measure(tmp_path, {}, list, seeds=[1])
    assert bare["recorded"] == []
    assert bare["camera"] is None
    assert set(bare["simulated"]["mean"]) == WAYS - {"vqf"}


def test_new_figures_win_over_old_ones() -> None:
    old = {"a": 1, "b": {"c": 2, "d": [1, {"e": 5}]}, "f": [1]}
    new = {"a": 9, "b": {"d": [2, {"g": 6}]}, "f": [3, 4]}
    assert kept(new, old) == {"a": 9, "b": {"c": 2, "d": [2, {"e": 5, "g": 6}]}, "f": [3, 4]}


def test_the_file_holds_every_still_recording(written: dict[str, Any]) -> None:
    assert [row["log"] for row in written["recorded"]] == list(STILL_LOGS)
    assert all(set(row["error_deg"]) == WAYS for row in written["recorded"])
