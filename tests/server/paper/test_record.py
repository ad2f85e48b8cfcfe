"""Recorded cycles, filtered again: the same as a run through the estimator, digit for digit, whatever way they were kept."""

import json
from dataclasses import replace
from math import hypot

import numpy as np
import pytest

from server.paper.cases import Case, Seen, runs_of
from server.paper.record import Recording, _cycle, _numbers, read_recording, recorded, refilter
from tracker.cycle import Cycle
from tracker.estimators import SELECTORS
from tracker.fusion import FusionSettings
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate


@pytest.fixture(scope="module")
def seen() -> Seen:
    """Half a minute; its camera saw nothing."""
    walk = Walk(WalkSettings(dataset=4, duration_s=32.0, imu_hz=100.0, truth_hz=50.0), default_rig())
    return Seen(walk, list(simulate(walk)), [])


@pytest.fixture(scope="module")
def recording(seen: Seen) -> Recording:
    """Kept as JSON and read again."""
    held = json.loads(json.dumps({"dataset": 4, "seed": 1, "sensors": "gps-imu", **recorded(seen, "gps-imu")}))
    return read_recording(held)


def test_refiltered_as_run(seen: Seen, recording: Recording) -> None:
    """Every motion model's filter error is that of its whole run, bit for bit."""
    runs, family = next(runs_of(Case(4, 1), seen))
    assert recording.cycles == family.cycles
    for run, selector in zip(runs, SELECTORS.values(), strict=True):
        found = refilter(recording, selector(), FusionSettings())
        assert found["filter_error_m"] == np.mean([hypot(*i.position_m) for i in run.innovations])
        assert found["filter_error_rad"] == np.mean([hypot(*i.rotation_rad) for i in run.innovations])
        assert found["p0r0_share"] == np.mean([i.motion_model == "P0R0" for i in run.innovations])


def test_every_field_of_a_cycle_is_kept(recording: Recording) -> None:
    """One in which all has happened comes back as it was."""
    whole = Cycle(5, (0.1, 0.2, 0.3), (1.0, 2.0, 3.0), (0.4, 0.5, 0.6), 0.7, 0.8, (9.0, 8.0, 7.0))
    assert _cycle(json.loads(json.dumps(_numbers(whole)))) == whole
    assert any(cycle.turned_rad for cycle in recording.cycles)


def test_a_perfect_position_has_no_error(recording: Recording) -> None:
    """Fixes that are the truth and of great weight: error and trembling vanish; one metre off, only the error comes back."""
    for offset_m in (0.0, 1.0):
        cycles = [
            replace(cycle, m_P=(x + offset_m, y, z), var_P_m2=(1e-8, 1e-8, 1e-8))
            for cycle, (x, y, z) in zip(recording.cycles, recording.truth_m.tolist(), strict=True)
        ]
        found = refilter(replace(recording, cycles=cycles), SELECTORS["cmm"](), FusionSettings())
        assert found["ate_m"] == pytest.approx(offset_m, abs=1e-3)
        assert found["step_m"] == pytest.approx(0.0, abs=1e-3)


def test_the_start_is_left_out(recording: Recording) -> None:
    """As everywhere, the first twenty seconds are not scored."""
    cycles = [
        replace(cycle, m_P=(1e6, 0.0, 0.0)) if cycle.t_ns < START_NS + 10_000_000_000 else cycle
        for cycle in recording.cycles
    ]
    moved = [replace(cycles[0], m_P=recording.cycles[0].m_P), *cycles[1:]]
    assert refilter(replace(recording, cycles=moved), SELECTORS["cmm"](), FusionSettings())["ate_m"] < 50.0


def test_scaling_the_variance_is_another_filter(recording: Recording) -> None:
    """A fix that is believed less is followed less: the same as cycles of that variance."""
    scaled = [
        replace(c, var_P_m2=(4.0 * c.var_P_m2[0], 4.0 * c.var_P_m2[1], 4.0 * c.var_P_m2[2])) for c in recording.cycles
    ]
    by_hand = refilter(replace(recording, cycles=scaled), SELECTORS["famm"](), FusionSettings())
    assert refilter(recording, SELECTORS["famm"](), FusionSettings(), 4.0) == by_hand
    assert by_hand != refilter(recording, SELECTORS["famm"](), FusionSettings())
    assert recording.cell == "4/gps-imu"
