"""A run reduced to arrays: the numbers are the run's, and a file gives them back."""

from pathlib import Path

import numpy as np
import pytest

from server.plots.trace import Trace, trace_of
from tests.server.plots.traces import trace, without_truth
from tracker import evaluate
from tracker.evaluate import Run
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Half a minute of a walk without a camera."""
    path = tmp_path_factory.mktemp("trace") / "walk.mcap"
    settings = WalkSettings(seed=5, duration_s=30.0, still_s=4.0, imu_hz=100.0, truth_hz=50.0)
    with LogWriter(path, default_rig(), AGORA_ORIGIN, t_start_ns=START_NS) as writer:
        for measurement in simulate(Walk(settings, default_rig())):
            writer.write(measurement)
    return evaluate.run(Log.open(path), "gps-imu/famm")


def test_a_trace_has_the_runs_error(run: Run) -> None:
    """Its RMS distance from the truth is the score's, to what a tenth of the samples allows."""
    found = trace_of(run)
    score = evaluate.figures(run)
    assert np.sqrt(np.mean(found.error_m[found.scored] ** 2)) == pytest.approx(score["truth"]["ate_rmse_m"], rel=0.03)
    assert np.mean(found.update_m) == pytest.approx(score["filter_error_m"]["mean"])
    yaw = np.degrees(np.sqrt(np.mean(found.turn_error_rad[found.scored, 2] ** 2)))
    assert yaw == pytest.approx(score["truth"]["heading_rmse_deg"], rel=0.1)
    assert (found.sensors, found.selector, found.has_truth) == ("gps-imu", "famm", True)
    assert len(found.fix_site_m) == len(run.fixes)
    assert found.state_covariance.shape == (12, 12)


def test_a_file_gives_it_back(run: Run, tmp_path: Path) -> None:
    written = trace_of(run)
    written.save(tmp_path / "deep" / "walk.npz")
    read = Trace.load(tmp_path / "deep" / "walk.npz")
    assert (read.log, read.estimator, read.origin) == ("walk", "gps-imu/famm", run.origin)
    for name in ("t_s", "p_site_m", "rpy_rad", "truth_rpy_rad", "update_m", "fix_site_m", "state_covariance"):
        np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
    assert read.model.tolist() == written.model.tolist()


def test_a_run_without_poses_is_an_empty_trace() -> None:
    empty = trace_of(Run("none", "gps-imu/cmm", 0, 10.0, AGORA_ORIGIN, None))
    assert (len(empty.t_s), len(empty.update_m), empty.state_covariance.size) == (0, 0, 0)
    assert not empty.has_truth


def test_the_start_is_not_scored() -> None:
    known = trace()
    assert known.t_s[known.scored].min() == pytest.approx(20.0)
    assert not without_truth(known).scored.any()
