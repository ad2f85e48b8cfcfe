"""The document says what was measured, bad news first, and the same for the same numbers."""

import numpy as np

from server.blocks import Items
from server.markdown import markdown
from tests.benchmarks.accuracy.document import compose
from tests.benchmarks.accuracy.goals import BATCH, CAMERA, GPS_IMU, summary
from tests.benchmarks.accuracy.plots import goals_figure, seeds_figure
from tracker.score import Figures


def _study(tilt_deg: float) -> Figures:
    seeds = [101, 102, 103]
    rows = [
        {
            "scenario": "plain",
            "estimator": name,
            "seed": seed,
            "ate_m": ate,
            "ate_ratio": ate / 2.0,
            "tilt_deg": tilt_deg,
        }
        for seed in seeds
        for name, ate in ((GPS_IMU, 1.2), (CAMERA, 1.1), (BATCH, 1.0 + 0.01 * seed % 3))
    ]
    return {"seeds": seeds, "summary": summary(rows), "rows": rows}


def test_what_is_missed_is_told_with_what_was_asked() -> None:
    missed = [block for block in compose(_study(0.5), None).blocks if isinstance(block, Items)]
    assert "tilt RMSE (plain, GPS, IMU): 0.5 °, asked 0.3 °." in missed[0].items
    assert len(missed[0].items) == 2
    assert not any(isinstance(block, Items) for block in compose(_study(0.2), None).blocks)


def test_what_is_missed_by_little_does_not_look_met() -> None:
    missed = [block for block in compose(_study(0.30004), None).blocks if isinstance(block, Items)]
    assert "tilt RMSE (plain, GPS, IMU): 0.30004 °, asked 0.3 °." in missed[0].items


def test_every_number_of_the_study_is_in_the_tables() -> None:
    text = markdown(compose(_study(0.2), None), "accuracy")
    assert "| ATE over raw GPS's | plain, 3 | with camera | 0.55 |" in text
    assert "Seeds 101 to 103" in text
    assert "Not measured in this run: ground (GPS, IMU); ground (with camera);" in text
    assert markdown(compose(_study(0.2), None), "accuracy") == text


def test_recorded_walks_are_told_where_there_are_any() -> None:
    row = {"log": "walk", "estimator": GPS_IMU, "failed": None, "raw_m": 2.0, "ate_m": 3.0}
    goal = {"goal": "ATE over raw GPS's", "log": "walk", "estimator": GPS_IMU, "value": 1.5, "at_least": 1.0}
    goal |= {"aim": 1.0, "unit": "", "met": "no"}
    logs = {"rows": [row, {"log": "walk", "estimator": CAMERA, "failed": "no camera"}], "summary": {"goals": [goal]}}
    text = markdown(compose(_study(0.2), logs), "accuracy")
    assert "- ATE over raw GPS's (walk, GPS, IMU): 1.5, asked 1." in text
    assert "| walk | gps-imu/precise | 2.00 | 3.00 |" in text


def test_other_draws_of_a_receiver_are_told_as_ratios() -> None:
    """Three draws: nearer than the receiver in two of them."""
    draws = [
        {"log": "walk", "estimator": GPS_IMU, "ate_m": ate, "raw_m": 2.0, "debiased_m": 0.5, "raw_debiased_m": 1.0}
        for ate in (1.0, 1.6, 2.4)
    ]
    text = markdown(compose(_study(0.2), None, draws), "accuracy")
    assert "| walk | gps-imu/precise | 3 | 0.80 | 0.5 to 1.2 | 2 | 0.50 |" in text


def test_the_best_entrant_is_drawn_first() -> None:
    axes = seeds_figure({"worse": [1.0, 1.2], "better": [0.5, 0.6]}, "ratio", 0.9).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["better", "worse"]


def test_a_goal_that_is_just_met_is_drawn_at_one() -> None:
    goal = {"goal": "tilt", "estimator": GPS_IMU, "value": 0.3, "at_least": 0.3, "aim": 0.1, "met": "at least"}
    axes = goals_figure([goal | {"interval": None}]).axes[0]
    assert [1.0] in [np.asarray(line.get_xdata()).tolist() for line in axes.lines if line.get_marker() == "o"]
