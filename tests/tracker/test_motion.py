"""Selectors behind one interface, on the cycles of one simulated walk."""

from itertools import pairwise
from math import hypot

import pytest

from tracker.cycle import Cycle, CycleFilter
from tracker.dfa import Automaton
from tracker.estimator import Innovation
from tracker.estimators import SELECTORS
from tracker.fusion import FusionSettings
from tracker.fuzzy import MODEL_BY_NAME, FuzzyController, Membership, ReducedController
from tracker.motion import AutomatonMotion, FuzzyMotion, MotionSelector, ReducedMotion
from tracker.readings import SensorSettings
from tracker.sensor_pose import SensorPose
from tracker.simulate import AGORA_ORIGIN, Walk, WalkSettings, default_rig, simulate

#: So low that every level of innovation comes about in half a minute.
LOW_P, LOW_R = Membership(0.1, 0.4, 0.8), Membership(0.01, 0.03, 0.06)


@pytest.fixture(scope="module")
def cycles() -> list[Cycle]:
    rig = default_rig()
    sensors = SensorPose(SensorSettings(), AGORA_ORIGIN, rig, 0.0, uses_camera=False)
    found = []
    for measurement in simulate(Walk(WalkSettings(seed=5, duration_s=40.0, still_s=4.0), rig)):
        sensors.step(measurement)
        cycle = sensors.take()
        if cycle is not None:
            found.append(cycle)
    return found


def followed(cycles: list[Cycle], selector: MotionSelector) -> list[Innovation]:
    filter_ = CycleFilter(selector, FusionSettings())
    return [seen for cycle in cycles if (seen := filter_.step(cycle)) is not None]


@pytest.mark.parametrize("name", SELECTORS)
def test_each_names_one_of_the_nine(cycles: list[Cycle], name: str) -> None:
    selector = SELECTORS[name]()
    models = [seen.motion_model for seen in followed(cycles, selector)]
    assert set(models) <= set(MODEL_BY_NAME)
    assert models[0] == str(selector.first)
    assert (len(set(models)) == 1) == (name == "cmm")


def test_the_reduced_rules_give_the_same_walk(cycles: list[Cycle]) -> None:
    """To the last bit, with every level of innovation among them."""
    whole, reduced = FuzzyController(LOW_P, LOW_R), ReducedController(LOW_P, LOW_R)
    seen = followed(cycles, FuzzyMotion(whole))
    assert seen == followed(cycles, ReducedMotion(reduced))
    fired = {
        whole.rule_fired(hypot(*i.position_m), hypot(*i.rotation_rad), MODEL_BY_NAME[i.motion_model]) for i in seen
    }
    assert {p for p, _, _ in fired} == {r for _, r, _ in fired} == {"Low", "Medium", "High"}


def test_which_rule_fired_tells_the_next_model(cycles: list[Cycle]) -> None:
    """A study recomputes the rules from what a run has recorded."""
    controller = FuzzyController(LOW_P, LOW_R)
    seen = followed(cycles, FuzzyMotion(controller))
    for before, after in pairwise(seen):
        present = MODEL_BY_NAME[before.motion_model]
        fired = controller.rule_fired(hypot(*before.position_m), hypot(*before.rotation_rad), present)
        assert str(controller.rules.table[fired]) == after.motion_model


def test_the_automaton_goes_its_own_way(cycles: list[Cycle]) -> None:
    """With the same crossings it changes when the fuzzy controller does, but not to the same models."""
    automaton = AutomatonMotion(Automaton(LOW_P.crossovers()[0], LOW_R.crossovers()[0]))
    theirs, ours = followed(cycles, automaton), followed(cycles, FuzzyMotion(FuzzyController(LOW_P, LOW_R)))
    assert [i.motion_model for i in theirs] != [i.motion_model for i in ours]
    for before, after in pairwise(theirs):
        small = hypot(*before.position_m) <= LOW_P.crossovers()[0]
        assert small == (before.motion_model[:2] == after.motion_model[:2])
