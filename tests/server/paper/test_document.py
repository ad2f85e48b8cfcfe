"""The reproduction report: its sentences follow its numbers, a missing measurement leaves out its section, every link leads on."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.blocks import Document, Grid, Heading, Items, Text, numbers
from server.markdown import markdown
from server.page import html
from server.paper.document.composing import compose
from server.paper.document.opening import opening
from server.paper.document.printed import FILTER_ERRORS
from server.paper.document.results import SENSORS, Results, middle
from server.paper.document.words import cell_name, count, listed, percent, span
from server.paper.statistics import summary
from server.tables import PAPER_FOUR
from tests.server.plots.traces import trace
from tracker.score import Figures


def _row(dataset: int, seed: int, sensors: str, model: str, **changed: float) -> Figures:
    """Return a study's row with round numbers: 2 m against the truth, 0.5 m of filter error, a little different each seed."""
    figures = {"error": 0.5, "ate": 2.0, "rpe": 1.5, "jitter": 0.1, "heading": 4.0} | changed
    wobble = 1.0 + 0.01 * seed
    truth = {
        "ate_rmse_m": figures["ate"] * wobble,
        "rpe_10s_m": figures["rpe"] * wobble,
        "heading_rmse_deg": figures["heading"],
        "jitter_rms_m": figures["jitter"],
        "registration_px": {"at_20m": {"median": 110.85}, "at_50m": {"median": 55.4}},
    }
    return {
        "dataset": dataset,
        "seed": seed,
        "sensors": sensors,
        "model": model,
        "updates": 100,
        "filter_error_m": {"mean": figures["error"] * wobble, "std": 0.2},
        "filter_error_rad": {"mean": 0.01, "std": 0.005},
        "truth": truth,
        "gps": {"ate_rmse_m": 2.5},
        "motion_model_share": {"P0R0": 0.25, "P1R1": 0.75} if model == "famm" else {"P1R1": 1.0},
        "nees_position": 1.2,
        "loop_closure_m": 1.5 if dataset == 5 else None,
        "rules_fired": {"Low,Low,P0R0": 60, "Medium,Low,P0R0": 40} if model == "famm" else None,
    }


def _study(famm_error: float = 0.45, camera_ate: float = 1.8) -> Figures:
    rows = [
        _row(
            dataset,
            seed,
            sensors,
            model,
            error=famm_error if model == "famm" else 0.5,
            ate=camera_ate if sensors.startswith("camera") else 2.0,
            rpe=1.0 if sensors.startswith("camera") else 1.5,
        )
        for dataset in range(1, 6)
        for seed in (1, 2, 3)
        for sensors in SENSORS
        for model in ("cmm", "famm")
    ]
    return {"seeds": [1, 2, 3], "summary": summary(rows), "rows": rows, "sigma": []}


ATTITUDE: Figures = {
    "paper": {"drift_deg_min": 0.5, "accel_g": [0.0, 0.1, 1.0], "gyro_deg_s": [0.1, 0.2, 0.3]},
    "simulated": {
        "mean": {"raw": 7.0, "both": 0.34, "agora": 0.2},
        "seeds": [
            {
                "seed": 1,
                "offsets": {"accel_g": [0.0, 0.0, 1.0], "gyro_deg_s": [0.2, 0.1, 0.0]},
                "drift_deg_min": {"raw": 7.0, "mean": 7.0, "offsets": 0.35, "both": 0.34, "agora": 0.2},
            }
        ],
    },
    "recorded": [],
    "camera": None,
}


def _texts(document: Document) -> str:
    """Return all its words, without the numbers' links."""
    words: list[str] = []
    for block in document.blocks:
        match block:
            case Text(text) | Heading(text=text):
                words.append(text)
            case Items(items):
                words += items
    return "\n".join(words)


def _summary_of(results: Results) -> str:
    return _texts(Document("t", "l", tuple(opening(results))))


def test_nothing_measured_is_still_a_document() -> None:
    """No number is claimed; what would give the numbers is said."""
    document = compose(Results(), {})
    text = markdown(document, "paper")
    assert "`python -m server.paper` runs the study" in text
    assert "`python -m server.paper.attitude` writes its figures" in text
    assert "FAMM lowers" not in text
    assert "What it means for a visitor" not in text


def test_all_of_it() -> None:
    """Both renderings of the whole: every figure and table has its number and every reference finds it."""
    examples = {3: [trace(name) for name in PAPER_FOUR]}
    document = compose(Results(_study(), None, ATTITUDE), examples)
    names = numbers(document.blocks)
    assert {"paired", "rivals", "camera", "drift", "path-3", "angles-3", "filter-error-3", "truth", "offsets"} <= set(
        names
    )
    assert "[[" not in markdown(document, "paper")
    assert "[[" not in html(document)


def test_the_sentences_follow_the_numbers() -> None:
    """FAMM a tenth lower wins all ten; a tenth higher wins none, and each lost cell is named."""
    won = _summary_of(Results(_study(famm_error=0.45)))
    assert "**FAMM lowers the filter error** in ten of ten cells" in won
    assert "is not below" not in won
    lost = _summary_of(Results(_study(famm_error=0.55)))
    assert "**FAMM lowers the filter error** in none of ten cells" in lost
    assert "FAMM's filter error is not below CMM's in dataset 1 without the camera (+10.0 %)" in lost


def test_good_and_bad_news_of_the_camera() -> None:
    better = _summary_of(Results(_study(camera_ate=1.8)))
    assert "**The camera helps against the truth** in eight of eight moving cells" in better
    assert "worse by more than two per cent: none of these 16 numbers" in better
    worse = _summary_of(Results(_study(camera_ate=2.2)))
    assert "**The camera helps against the truth** in none of eight moving cells" in worse
    assert "worse by more than two per cent: eight of these 16 numbers" in worse


def test_the_camera_is_held_against_an_equal() -> None:
    """What the same averaging by the inertial unit leaves of the camera's gain is told in the summary, and tabled."""
    rows = [
        {**_row(dataset, seed, "gps-imu", model, ate=1.875, rpe=1.6), "seed": seed}
        for dataset in (1, 2, 4, 5)
        for seed in (1, 2, 3)
        for model in ("cmm", "famm")
    ]
    results = Results(_study(camera_ate=1.8), ablation={"rows": rows})
    assert "Of this −4.0 % and −37.5 % are the camera's own" in _summary_of(results)
    (grid,) = (b for b in compose(results, {}).blocks if isinstance(b, Grid) and b.name == "camera-own")
    assert len(grid.rows) == 8
    assert grid.rows[0][2:4] == ("0.960", "0.625")
    assert "the camera's own" not in _summary_of(Results(_study(camera_ate=1.8)))


def test_the_feature_camera_is_tabled_beside_rendered_pictures() -> None:
    names = [f"camera-gps-imu/{model}: {what}" for what in ("filter error m", "ATE m") for model in ("cmm", "famm")]
    walk = {"dataset": 4, "seed": 1, "drawn": dict.fromkeys(names, 2.0), "features": dict.fromkeys(names, 2.1)}
    document = compose(Results(_study(), feature={"walks": [walk]}), {})
    (grid,) = (b for b in document.blocks if isinstance(b, Grid) and b.name == "feature")
    assert grid.rows == (("4", "1", "1.050", "1.050", "1.050", "1.050"),)
    assert "5.0 % at most" in grid.caption


def test_what_a_visitor_sees() -> None:
    """110.85 px at a focal length of 1108.5 px are a tenth of the distance: 2 m at 20 m."""
    text = _summary_of(Results(_study()))
    assert "A column 20 m away is then drawn 111 pixels beside its place" in text
    assert ", 2.0 m at its distance" in text
    assert "one 50 m away 55 pixels, 2.5 m" in text
    assert "The picture trembles visibly (10.0 cm, 5.5 pixels at 20 m)" in text


def test_the_drift_is_judged() -> None:
    assert "as the paper says (0.5)" in _summary_of(Results(None, None, ATTITUDE))
    simulated = {**ATTITUDE["simulated"], "mean": {"raw": 7.0, "both": 0.9, "agora": 0.2}}
    assert "more than the paper says" in _summary_of(Results(None, None, {**ATTITUDE, "simulated": simulated}))


def test_the_papers_numbers_stand_beneath_ours() -> None:
    document = compose(Results(_study()), {})
    grid = next(b for b in document.blocks if isinstance(b, Grid) and b.name == "errors-gps-imu")
    assert grid.rows[0] == ("1", "3388", "here", "0.5100", "0.2000", "0.4590", "0.2000", "↓")
    assert grid.rows[1] == ("", "", "paper", "1.1065", "0.6386", "1.0877", "0.6330", "↓")
    assert [grid.rows[3][-1], grid.rows[5][-1]] == ["↑", "↓"]


def test_the_printed_tables() -> None:
    """Six of ten cells of the paper go down, as its arrows say."""
    assert sum(errors.change_percent < 0.0 for errors in FILTER_ERRORS.values()) == 6
    assert FILTER_ERRORS[3, "gps-imu"].change_percent == pytest.approx(-58.47, abs=0.01)


def test_the_filters_own_uncertainty() -> None:
    """Half the variance of P and forty times that of Omega is more in all, and told so; less in all is told too."""

    def study(omega: float) -> Figures:
        cmm = np.diag([4.0] * 3 + [1.0] * 3 + [1e-4] * 3 + [1.0] * 3)
        famm = np.diag([2.0] * 3 + [1.0] * 3 + [1e-4] * 3 + [omega] * 3)
        cell = {"dataset": 1, "sensors": "gps-imu"}
        sigmas = [{**cell, "model": m, "state_covariance": s.tolist()} for m, s in (("cmm", cmm), ("famm", famm))]
        return {**_study(), "sigma": sigmas}

    more = _summary_of(Results(study(40.0)))
    assert (
        "it does so in no cell: the variances of the position are 0.50 of CMM's, and those of the angular rate 40"
        in more
    )
    assert "it does so in one of one cells" in _summary_of(Results(study(1.0)))


def test_how_much_the_model_matters() -> None:
    """As many words as the numbers deserve: FAMM and CMM are equally far from the truth here."""
    assert "the choice of model hardly matters" in _summary_of(Results(_study()))


def test_the_sweep_tells_what_wins_a_lost_cell() -> None:
    """From a sweep whose defaults lose one cell: what wins it, at what price, and that the shipped thresholds are the rule's."""
    document = compose(Results(None, _sweep()), {})
    text = _texts(document)
    assert "for position crossings at 1 and 2.25 m (one cell won; which is what is shipped)" in text
    assert "dataset 3 with the camera: thresholds at 2 and 4.5 m (wins two of two, loses none" in text
    assert "or the rules `low-walks` (wins two of two" in text
    assert "P0R0 in 60 % of the updates as shipped; the position's breakpoints × 2 bring 97 %" in text
    grid = next(b for b in document.blocks if isinstance(b, Grid) and b.name == "factors")
    assert [row[:3] for row in grid.rows] == [
        ("default", "as shipped", "1 of 2"),
        ("accel noise", "2 m/s2", "2 of 2"),
        ("rules", "low-walks: rest does not last", "2 of 2"),
    ]


def _sweep() -> Figures:
    def cell(ratio: float) -> Figures:
        return {"filter_error_m": [0.5 * ratio, 0.5], "ate_m": [2.0, 2.0], "ate_ratio": 1.0, "p0r0_share": 0.6}

    def variant(factor: str, value: str, position_m: list[float], ratio: float) -> Figures:
        return {
            "factor": factor,
            "value": value,
            "position_m": position_m,
            "rotation_rad": [0.05, 0.15, 0.4],
            "wins": 1 + (ratio < 1.0),
            "sure_wins": 1,
            "ate_kept": 2,
            "rotation_wins": 2,
            "step_ratio_mean": 1.2,
            "lost": [] if ratio < 1.0 else ["3/camera-gps-imu"],
            "cells": {"3/gps-imu": cell(0.9), "3/camera-gps-imu": cell(ratio)},
            "filter_error_ratio": {"3/gps-imu": 0.9, "3/camera-gps-imu": ratio},
            "p0r0_share": {"3/gps-imu": 0.97, "3/camera-gps-imu": 0.97},
        }

    default = variant("default", "as shipped", [0.5, 1.5, 3.0], 1.5)
    wider = variant("position", "2 m, 4.5 m", [1.0, 3.0, 6.0], 0.8)
    rotation = variant("rotation", "0.1 rad, 0.275 rad", [0.5, 1.5, 3.0], 1.5)
    noise = variant("accel noise", "2 m/s2", [0.5, 1.5, 3.0], 0.9)
    walks = variant("rules", "low-walks", [0.5, 1.5, 3.0], 0.9)
    rest = variant("rest", "2", [1.0, 3.0, 6.0], 0.8)
    return {
        "seeds": [101, 102],
        "rule": "The one that wins most.",
        "rules": {"low-walks": "rest does not last"},
        "default": default,
        "chosen_position": default,
        "chosen_rotation": rotation,
        "smallest_changes": {"3/camera-gps-imu": {"membership": wider, "rules": [walks]}},
        "resting": {"gps-imu": rest, "camera-gps-imu": None},
        "variants": [default, wider, rotation, noise, walks, rest],
    }


def test_what_each_reading_does() -> None:
    """The default first; a tenth more is a change in per cent, a million times more a factor."""

    def row(sensors: str, changes: list[str], error: float) -> Figures:
        return {
            "sensors": sensors,
            "changes": changes,
            "filter_error_m": {"mean": error},
            "truth": {"ate_rmse_m": error, "rpe_10s_m": None},
            "motion_model_share": {"P0R0": 0.25},
        }

    rows = [row("gps-imu", [], 0.5), row("gps-imu", ["a=b"], 0.55), row("gps-imu", ["m_P=literal_ecef"], 500_000.0)]
    document = compose(Results(readings={"dataset": 4, "seed": 1, "rows": rows}), {})
    grid = next(b for b in document.blocks if isinstance(b, Grid) and b.name == "readings")
    assert [cells[1:5] for cells in grid.rows] == [
        ("defaults", "0.500", "+0.0 %", "0.500"),
        ("`a=b`", "0.550", "+10.0 %", "0.550"),
        ("`m_P=literal_ecef`", "5e+05", "× 1e+06", "5e+05"),
    ]


def test_results_are_read_from_files(tmp_path: Path) -> None:
    (tmp_path / "attitude.json").write_text(json.dumps(ATTITUDE))
    results = Results.read(tmp_path)
    assert results.attitude == ATTITUDE
    assert (results.study, results.seeds, results.rows) == (None, 0, [])


def test_a_middle_of_what_is_known() -> None:
    rows: list[Any] = [{"a": {"b": 1.0}}, {"a": None}, {"a": {"b": 3.0}}, {}]
    assert middle(rows, "a", "b") == 2.0
    assert middle(rows, "c") is None


def test_words() -> None:
    assert [count(0), count(8), count(16)] == ["none", "eight", "16"]
    assert [listed([]), listed(["a"]), listed(["a", "b", "c"])] == ["none", "a", "a, b and c"]
    assert [percent(1.031), percent(0.995)] == ["+3.1 %", "−0.5 %"]
    assert [span([0.97, 1.031], 2), span([1.0, 1.001], 2)] == ["0.97 to 1.03", "1.00"]
    assert cell_name(3, "camera-gps-imu") == "dataset 3 with the camera"
