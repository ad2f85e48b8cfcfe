"""One estimator's curves, and figures that are those of `agora evaluate`."""

from pathlib import Path

import msgspec
import numpy as np
import pytest

from server.evaluation import evaluate
from server.reviewing.course import Course, course_of
from tests.walks import write_walk
from tracker.errors import MissingSensor
from tracker.log import Log

SECONDS = 30.0


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A walk without a camera, longer than filters take to settle."""
    return write_walk(tmp_path_factory.mktemp("logs") / "walk.mcap", SECONDS)


@pytest.mark.parametrize("estimator", ["gps-imu/famm", "gps-imu/precise", "truth"])
def test_its_figures_are_those_that_evaluate_prints(path: Path, estimator: str) -> None:
    """All but how long it took."""
    (row,) = evaluate([path], (estimator,), None, lambda label, done: None).runs
    figures = dict(course_of(Log.open(path), estimator).figures)
    for timed in ("latency_ms", "realtime_factor"):
        del row[timed], figures[timed]
    assert figures == row
    assert figures["truth"] is not None


def test_its_curves_have_a_value_for_each_time_and_agree_with_the_figures(path: Path) -> None:
    course = course_of(Log.open(path), "gps-imu/famm")
    for name in ("e_m", "n_m", "heading_deg", "sigma_m", "sigma_heading_deg", "error_m", "heading_error_deg"):
        assert len(getattr(course, name)) == len(course.t_s) > 100
    settled = [
        error for t_s, error in zip(course.t_s, course.error_m, strict=True) if t_s >= 20.0 and error is not None
    ]
    rmse_m = float(np.sqrt(np.mean(np.square(settled))))
    assert rmse_m == pytest.approx(course.figures["truth"]["ate_rmse_m"], rel=0.05)
    assert np.mean(course.innovation_m) == pytest.approx(course.figures["filter_error_m"]["mean"], rel=1e-3)
    assert len(course.innovation_s) == course.figures["updates"]
    assert all(t_s <= SECONDS + 1.0 for t_s, _ in course.models)
    assert {model for _, model in course.models} == set(course.figures["motion_model_share"]) | {"P1R1"}
    assert msgspec.json.decode(msgspec.json.encode(course), type=Course) == course


def test_the_truth_is_sure_and_has_no_error(path: Path) -> None:
    course = course_of(Log.open(path), "truth")
    assert max(course.sigma_m) == 0.0
    assert max(error for error in course.error_m if error is not None) < 0.2
    assert course.models == []


def test_what_the_walk_lacks_is_said(path: Path) -> None:
    with pytest.raises(MissingSensor, match="no camera"):
        course_of(Log.open(path), "camera-gps-imu/famm")
