"""The automaton against its table of transitions, walked as an automaton and not as the code walks it."""

from math import nan, nextafter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.dfa import Automaton
from tracker.fuzzy import (
    MODEL_BY_NAME,
    MOTION_MODELS,
    POSITION_MEMBERSHIP_M,
    ROTATION_MEMBERSHIP_RAD,
    FuzzyController,
    MotionModel,
)

#: Transitions of one coefficient: state and symbol (small, large) to state.
TABLE = {("0", "s"): "0", ("1", "s"): "1", ("2", "s"): "2", ("0", "l"): "1", ("1", "l"): "2", ("2", "l"): "1"}
words = st.lists(st.tuples(st.sampled_from("sl"), st.sampled_from("sl")), max_size=12)


@given(words, st.sampled_from(MOTION_MODELS))
def test_a_word_leads_where_the_table_says(word: list[tuple[str, str]], start: MotionModel) -> None:
    automaton = Automaton(position=2.0, rotation=0.3)
    magnitude_p, magnitude_r = {"s": 2.0, "l": 2.1}, {"s": 0.3, "l": 0.31}
    i, j, model = str(start.i), str(start.j), start
    for p, r in word:
        i, j = TABLE[i, p], TABLE[j, r]
        model = automaton.next_model(magnitude_p[p], magnitude_r[r], model)
    assert model == MODEL_BY_NAME[f"P{i}R{j}"]


@given(st.floats(0.0, 9.0), st.floats(0.0, 2.0), st.sampled_from(MOTION_MODELS))
def test_it_keeps_a_model_when_the_fuzzy_controller_does_for_low(y_p: float, y_r: float, model: MotionModel) -> None:
    """One threshold stands where Low and Medium cross: both keep on one side of it, and both change on the other."""
    automaton, fuzzy = Automaton(), FuzzyController()
    level_p, level_r, _ = fuzzy.rule_fired(y_p, y_r, model)
    following = automaton.next_model(y_p, y_r, model)
    assert (following.i == model.i) == (level_p == "Low")
    if abs(y_r - ROTATION_MEMBERSHIP_RAD.crossovers()[0]) > 1e-15:  # the degrees' rounding
        assert (following.j == model.j) == (level_r == "Low")


BELOW_HIGH = (
    st.floats(0.0, POSITION_MEMBERSHIP_M.crossovers()[1]),
    st.floats(0.0, ROTATION_MEMBERSHIP_RAD.crossovers()[1]),
)


@given(*BELOW_HIGH, st.sampled_from(MOTION_MODELS))
def test_only_high_tells_it_from_the_fuzzy_controller(y_p: float, y_r: float, model: MotionModel) -> None:
    """Below the second crossings both choose alike."""
    if abs(y_r - ROTATION_MEMBERSHIP_RAD.crossovers()[0]) > 1e-15:
        assert Automaton().next_model(y_p, y_r, model) == FuzzyController().next_model(y_p, y_r, model)


def test_thresholds_are_the_first_crossings() -> None:
    automaton = Automaton()
    assert automaton.position == POSITION_MEMBERSHIP_M.crossovers()[0]
    assert automaton.rotation == pytest.approx(ROTATION_MEMBERSHIP_RAD.crossovers()[0], abs=1e-15)


def test_what_is_no_number_is_large() -> None:
    assert Automaton().next_model(nan, nan, MotionModel(0, 2)) == MotionModel(1, 1)
    automaton = Automaton(1.0, 0.1)
    assert automaton.next_model(nextafter(1.0, 2.0), 0.1, MotionModel(0, 2)) == MotionModel(1, 2)


@pytest.mark.parametrize("thresholds", [(0.0, 0.1), (1.0, -0.1), (nan, 0.1)])
def test_thresholds_are_positive(thresholds: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="above 0"):
        Automaton(*thresholds)
