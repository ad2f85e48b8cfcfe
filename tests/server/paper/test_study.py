"""Rows of the study, on short walks: what is promised is there, and says what the run did."""

from dataclasses import replace

import numpy as np
import pytest

from server.paper.cases import SITE, Case, Seen, runs_of, sources_key
from server.paper.study import loop_closure_m, mean_sigmas, row_of, rules_fired
from tracker.estimators import SELECTORS, SENSORS
from tracker.evaluate import Run
from tracker.fuzzy import RULES, rule_name, rules_by_name
from tracker.measurements import TruePose
from tracker.score import Figures
from tracker.simulate import Walk, WalkSettings, default_rig, simulate

CASE = Case(5, 1)


@pytest.fixture(scope="module")
def seen() -> Seen:
    """Forty seconds of a loop; its camera saw nothing."""
    walk = Walk(WalkSettings(dataset=5, duration_s=40.0, imu_hz=100.0, truth_hz=50.0), default_rig())
    return Seen(walk, list(simulate(walk)), [])


@pytest.fixture(scope="module")
def runs(seen: Seen) -> list[Run]:
    """All motion models, without and with the camera."""
    return [run for runs, _ in runs_of(CASE, seen) for run in runs]


@pytest.fixture(scope="module")
def rows(seen: Seen, runs: list[Run]) -> list[Figures]:
    """Their rows."""
    return [row_of(CASE, run, seen) for run in runs]


def test_a_row_for_every_estimator(rows: list[Figures]) -> None:
    """Sensors times models, each with figures, and no times: those are this machine's."""
    assert [(row["sensors"], row["model"]) for row in rows] == [(s, m) for s in SENSORS for m in SELECTORS]
    for row in rows:
        assert row["updates"] > 150
        assert 0.0 < row["filter_error_m"]["mean"] < 5.0
        assert row["truth"]["ate_rmse_m"] < 8.0
        assert row["nees_position"] == row["truth"]["nees_per_dim"]
        assert not {"latency_ms", "realtime_factor", "vision_rate_hz"} & set(row)


def test_rules_fired_are_those_that_led_on(runs: list[Run]) -> None:
    """One for every update; each fired rule leads to the model of the next prediction."""
    famm = next(run for run in runs if run.estimator == "gps-imu/famm")
    fired, base = rules_fired(famm), rules_by_name()
    assert sum(fired.values()) == len(famm.innovations)
    assert len(fired) > 3
    assert set(fired) <= set(base) == {rule_name(antecedent) for antecedent in RULES}
    for now, following in zip(famm.innovations[:-1], famm.innovations[1:], strict=True):
        (rule,) = rules_fired(replace(famm, innovations=[now]))
        assert base[rule] == following.motion_model


def test_rules_are_the_fuzzy_models_and_two_have_sigma(rows: list[Figures]) -> None:
    """As the paper shows them."""
    assert {row["model"] for row in rows if "rules_fired" in row} == {"famm"}
    assert {row["model"] for row in rows if "state_covariance" in row} == {"cmm", "famm"}
    means = mean_sigmas(rows)
    assert len(means) == 4
    for entry in means:
        Sigma = np.array(entry["state_covariance"])
        assert Sigma.shape == (12, 12)
        assert np.all(np.linalg.eigvalsh(Sigma) > 0.0)


def test_the_loop_closes_by_truth(runs: list[Run]) -> None:
    """Poses that are the truth close it exactly; an end that is off by 3 and 4 metres leaves five."""
    run = runs[0]
    t_ns = np.array([pose.t_ns for pose in run.truth])
    p_m = np.array([pose.p_map_body_m for pose in run.truth])
    inside = [pose for pose in run.poses if pose.t_ns <= t_ns[-1]]
    exact = [
        replace(pose, p_site_m=tuple(np.interp(pose.t_ns - t_ns[0], t_ns - t_ns[0], p_m[:, a]) for a in range(3)))
        for pose in inside
    ]
    assert loop_closure_m(replace(run, poses=exact)) == pytest.approx(0.0, abs=1e-9)
    x, y, z = exact[-1].p_site_m
    off = [*exact[:-1], replace(exact[-1], p_site_m=(x + 3.0, y - 4.0, z + 7.0))]
    assert loop_closure_m(replace(run, poses=off)) == pytest.approx(5.0)
    assert loop_closure_m(replace(run, truth=[])) is None


def test_only_dataset_five_is_a_loop(seen: Seen, runs: list[Run], rows: list[Figures]) -> None:
    """And only runs with the camera say what the camera gave."""
    assert all(row["loop_closure_m"] is not None for row in rows)
    assert row_of(Case(1, 1), runs[0], seen)["loop_closure_m"] is None
    assert [row["sensors"] for row in rows if "camera" in row] == ["camera-gps-imu"] * len(SELECTORS)
    assert rows[-1]["camera"] == {"motions_hz": 0.0, "keyframes_hz": 0.0, "directed_share": 0.0}


def test_members_of_a_case_saw_the_same(runs: list[Run]) -> None:
    """Paired: the same fixes and truth for all, the same beats for those with the same sensors."""
    assert all(run.fixes == runs[0].fixes and run.truth == runs[0].truth for run in runs)
    assert all(isinstance(pose, TruePose) for pose in runs[0].truth)
    stamps = [[i.t_ns for i in run.innovations] for run in runs]
    assert stamps[0] == stamps[1]


def test_the_key_is_of_the_sources() -> None:
    """It does not change by itself, and what is asked for is part of it."""
    assert sources_key("study") == sources_key("study") != sources_key("record")
    assert (SITE / "site.toml").is_file()
