"""The sweep's judgement: on rows worked by hand, and on one short recording from end to end."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from server.paper import sweep as module
from server.paper.cases import Seen
from server.paper.record import Recording, read_recording, recorded
from server.paper.sweep import conclusions, judged, swept
from server.paper.variants import DEFAULT, OTHER_RULES, Variant, crossing_at, variants
from tracker.fuzzy import RuleBase
from tracker.score import Figures
from tracker.simulate import Walk, WalkSettings, default_rig, simulate

CELLS = [f"{dataset}/{sensors}" for dataset in range(1, 6) for sensors in ("gps-imu", "camera-gps-imu")]
LOST = "3/camera-gps-imu"


def _figures(scale: float, p0r0: float) -> Figures:
    names = ("filter_error_m", "filter_error_rad", "ate_m", "step_m")
    return {**dict.fromkeys(names, scale), "p0r0_share": p0r0}


def _rows(variant: Variant, scales: dict[str, float], p0r0: float = 0.1) -> list[Figures]:
    """Rows of three seeds: FAMM's figures are CMM's times a scale, 0.9 where none is given."""
    return [
        {
            "variant": variant.name,
            "cell": cell,
            "seed": seed,
            "famm": _figures(scales.get(cell, 0.9) * (1.0 + 0.1 * seed), p0r0),
            "cmm": _figures(1.0 + 0.1 * seed, 0.0),
        }
        for cell in CELLS
        for seed in range(3)
    ]


def _judged(tried: dict[Variant, list[Figures]]) -> list[Figures]:
    return judged(list(tried), [row for rows in tried.values() for row in rows])


_LOW_M, _HIGH_M = DEFAULT.position.crossovers()
NEAR = Variant("position", "near", position=crossing_at(0.9 * _LOW_M, _HIGH_M))
FAR = Variant("position", "far", position=crossing_at(0.4 * _LOW_M, _HIGH_M))
RULES = Variant("rules", "low-rests", rules=RuleBase.separable("low-rests", OTHER_RULES["low-rests"]))
REST = [Variant("rest", f"{s:g}", position=crossing_at(s, 2.25 * s)) for s in (1.5, 2.0, 3.0)]


@pytest.fixture(scope="module")
def found() -> list[Figures]:
    """The default loses a cell; two memberships and a rule base win it, one of them at the price of another cell."""
    return _judged(
        {
            DEFAULT: _rows(DEFAULT, {LOST: 1.2}),
            NEAR: _rows(NEAR, {LOST: 0.99, "1/gps-imu": 1.1}),
            FAR: _rows(FAR, {LOST: 0.95}),
            RULES: _rows(RULES, {}),
            REST[0]: _rows(REST[0], {}, 0.94),
            REST[1]: _rows(REST[1], {"2/gps-imu": 1.3}, 0.96),
            REST[2]: _rows(REST[2], {}, 1.0),
        }
    )


def test_cells_are_counted(found: list[Figures]) -> None:
    """Won, surely won, and lost by name."""
    default, near, far = found[:3]
    assert (default["wins"], default["sure_wins"], default["lost"]) == (9, 9, [LOST])
    assert (near["wins"], near["lost"]) == (9, ["1/gps-imu"])
    assert (far["wins"], far["lost"], far["ate_kept"]) == (10, [], 10)
    assert default["ate_kept"] == 9
    assert far["cells"][LOST]["ate_ratio"] == pytest.approx(0.95)
    assert far["cells"][LOST]["filter_error_m"] == pytest.approx([0.95 * 1.1, 1.1])


def test_the_rule_chooses_the_one_that_wins_most(found: list[Figures]) -> None:
    """Of the position memberships only; rules are variants with names, not defaults."""
    told = conclusions(found)
    assert told["chosen_position"]["value"] == FAR.value
    assert told["chosen_rotation"]["factor"] == "default"


def test_of_equals_the_calmest_is_chosen() -> None:
    """As many cells, as sure: then trembling decides."""
    calm, restless = _rows(FAR, {}), _rows(NEAR, {})
    for row in restless:
        row["famm"]["step_m"] *= 2.0
    told = conclusions(_judged({DEFAULT: _rows(DEFAULT, {LOST: 1.2}), NEAR: restless, FAR: calm}))
    assert told["chosen_position"]["value"] == FAR.value


def test_the_smallest_change_is_the_nearest_that_wins(found: list[Figures]) -> None:
    """Whatever it does to other cells, which stands beside it."""
    change = conclusions(found)["smallest_changes"]
    assert set(change) == {LOST}
    assert change[LOST]["membership"]["value"] == NEAR.value
    assert change[LOST]["membership"]["lost"] == ["1/gps-imu"]
    assert [row["rules"] for row in change[LOST]["rules"]] == ["low-rests"]


def test_resting_has_its_price(found: list[Figures]) -> None:
    """The least stretched that reaches 95 %, and the cells that it loses; none where none does."""
    resting = conclusions(found)["resting"]["gps-imu"]
    assert resting["value"] == "2"
    assert resting["lost"] == ["2/gps-imu"]
    assert resting["p0r0_share"] == pytest.approx({"3/gps-imu": 0.96, LOST: 0.96})
    assert conclusions(found[:4])["resting"] == {"gps-imu": None, "camera-gps-imu": None}


@pytest.fixture(scope="module")
def held() -> list[Figures]:
    """One short recording, as kept."""
    walk = Walk(WalkSettings(dataset=4, duration_s=26.0, imu_hz=100.0, truth_hz=50.0), default_rig())
    seen = Seen(walk, list(simulate(walk)), [])
    return [{"dataset": 4, "seed": 1, "sensors": "gps-imu", **recorded(seen, "gps-imu")}]


def test_every_variant_is_filtered(held: list[Figures]) -> None:
    """Each has a row; changed settings change what comes out, and CMM is filtered with the same Q and R."""
    recording: Recording = read_recording(held[0])
    rows = {row["variant"]: row for row in swept(recording, variants())}
    assert len(rows) == len(variants())
    default = rows[DEFAULT.name]
    shipped = pytest.approx(DEFAULT.position.crossovers())
    usual = next(v.name for v in variants() if v.factor == "position" and v.position.crossovers() == shipped)
    assert rows[usual]["famm"] == default["famm"]
    for name in ("position 0.2 m, 0.8 m", "rotation 0.02 rad, 0.275 rad", "rules low-rests", "innovation nis x 0.25"):
        assert rows[name]["famm"] != default["famm"]
        assert rows[name]["cmm"] == default["cmm"]
    for name in ("accel noise 1 m/s2", "GPS variance x 4", "rotation sigma 0.0011 rad"):
        assert rows[name]["cmm"] != default["cmm"]


def test_from_end_to_end(held: list[Figures], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Recorded, filtered, judged and written; the second time nothing is recorded or filtered, and the file is the same."""
    calls = []

    def record(dataset: int, seed: int) -> list[Figures]:
        calls.append((dataset, seed))
        return [
            {**held[0], "dataset": dataset, "seed": seed, "sensors": sensors}
            for sensors in ("gps-imu", "camera-gps-imu")
        ]

    few = [DEFAULT, replace(NEAR), REST[0]]
    monkeypatch.setattr(module, "record_case", record)
    monkeypatch.setattr(module, "variants", lambda: few)
    module.sweep(tmp_path / "a.json", [1, 2], jobs=1, folder=tmp_path)
    assert sorted(calls) == [(dataset, seed) for dataset in range(1, 6) for seed in (1, 2)]
    module.sweep(tmp_path / "b.json", [1, 2], jobs=1, folder=tmp_path)
    assert len(calls) == 10
    written = json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
    assert written["seeds"] == [1, 2]
    assert [row["factor"] for row in written["variants"]] == ["default", "position", "rest"]
    assert set(written["default"]["cells"]) == set(CELLS)
    assert np.isfinite(written["default"]["cells"][LOST]["ate_ratio"])
