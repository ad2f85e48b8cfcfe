"""The ablation: GPS and IMU are given the averaging that the camera's path gives, and nothing else changes."""

import pytest

from server.paper import ablation as module
from server.paper.ablation import CHANGES, ablation_case
from server.paper.cases import Seen
from server.paper.readings import reading_row
from tracker.simulate import Walk, WalkSettings, default_rig, simulate


def test_fixes_that_the_inertial_path_carries_surprise_less(monkeypatch: pytest.MonkeyPatch) -> None:
    walk = Walk(WalkSettings(seed=5, duration_s=35.0, still_s=4.0, imu_hz=100.0, truth_hz=50.0), default_rig())
    seen = Seen(walk, list(simulate(walk)), [])
    monkeypatch.setattr(module, "see", lambda case: seen)
    cmm, famm = ablation_case(4, 5)
    assert (cmm["model"], famm["model"], cmm["dataset"], famm["seed"]) == ("cmm", "famm", 4, 5)
    usual = reading_row(seen, "gps-imu", ())
    assert famm["filter_error_m"]["mean"] < 0.5 * usual["filter_error_m"]["mean"]
    assert famm["truth"]["heading_rmse_deg"] == usual["truth"]["heading_rmse_deg"]
    again = reading_row(seen, "gps-imu", CHANGES)
    assert famm["truth"] == again["truth"]
