"""The rule base against the paper's own table, and the controller's laws."""

from copy import deepcopy
from fractions import Fraction
from math import inf, nan, nextafter

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.fuzzy import (
    ANTECEDENTS,
    LEVELS,
    MOTION_MODELS,
    NEXT_INDEX,
    POSITION_MEMBERSHIP_M,
    ROTATION_MEMBERSHIP_RAD,
    RULES,
    Antecedent,
    FuzzyController,
    Membership,
    MotionModel,
    NextIndex,
    ReducedController,
    RuleBase,
    rules_by_name,
)

# The 54 rows that the paper prints: for each positional innovation and present model, what follows Low, Medium and High.
PRINTED = """
Low    P0R0 P0R0 P0R1 P0R2
Low    P0R2 P0R2 P0R1 P0R0
Low    P1R0 P1R0 P1R1 P1R2
Low    P1R2 P1R2 P1R1 P1R0
Low    P2R0 P2R0 P2R1 P2R2
Low    P2R2 P2R2 P2R1 P2R0
Medium P0R0 P1R0 P1R1 P1R2
Medium P0R2 P1R2 P1R1 P1R0
Medium P1R0 P2R0 P2R1 P2R2
Medium P1R2 P2R2 P2R1 P2R0
Medium P2R0 P1R0 P1R1 P1R2
Medium P2R2 P1R2 P1R1 P1R0
High   P0R0 P2R0 P2R1 P2R2
High   P0R2 P2R2 P2R1 P2R0
High   P1R0 P0R0 P0R1 P0R2
High   P1R2 P0R2 P0R1 P0R0
High   P2R0 P0R0 P0R1 P0R2
High   P2R2 P0R2 P0R1 P0R0
"""


def printed_rules() -> dict[str, str]:
    rules: dict[str, str] = {}
    for row in PRINTED.split("\n"):
        if row:
            y_p, model, *following = row.split()
            rules |= {f"{y_p},{y_r},{model}": after for y_r, after in zip(LEVELS, following, strict=True)}
    return rules


def test_the_54_printed_rules_are_ours() -> None:
    printed = printed_rules()
    assert len(printed) == 54
    ours = rules_by_name()
    assert {name: ours[name] for name in printed} == printed


def test_the_27_others_follow_from_symmetry() -> None:
    """Position and rotation play the same part: swap them in a rule and its consequent is swapped too."""
    assert len(RULES) == 81
    for (y_p, y_r, model), following in RULES.items():
        swapped = RULES[y_r, y_p, MotionModel(model.j, model.i)]
        assert (swapped.i, swapped.j) == (following.j, following.i)


magnitudes = st.floats(0.0, 20.0)


@given(magnitudes)
def test_memberships_sum_to_one(magnitude: float) -> None:
    degrees = Membership(0.5, 1.5, 3.0).degrees(magnitude)
    assert sum(degrees) == pytest.approx(1.0)
    assert all(0.0 <= degree <= 1.0 for degree in degrees)


def strongest(position: Membership, rotation: Membership, y_p: float, y_r: float, model: MotionModel) -> Antecedent:
    """The paper's procedure to the letter: 81 firing strengths, products of three degrees, and the first of the strongest.

    In whole fractions, so that no rounding of a product decides; the third degree is 1 for rules of the present model, else 0.
    """
    degrees_p = dict(zip(LEVELS, map(Fraction, position.degrees(y_p)), strict=True))
    degrees_r = dict(zip(LEVELS, map(Fraction, rotation.degrees(y_r)), strict=True))
    strengths = {
        (level_p, level_r, present): degrees_p[level_p] * degrees_r[level_r] * Fraction(present == model)
        for level_p, level_r, present in ANTECEDENTS
    }
    return max(ANTECEDENTS, key=lambda antecedent: strengths[antecedent])


breakpoints = st.lists(st.floats(0.001, 5.0), min_size=3, max_size=3, unique=True).map(sorted)
memberships = st.sampled_from([POSITION_MEMBERSHIP_M, ROTATION_MEMBERSHIP_RAD]) | breakpoints.map(
    lambda three: Membership(*three)
)
#: Where along low, medium, high a magnitude lies; whole and half steps are the breakpoints and the ties.
steps = st.floats(-0.5, 2.5) | st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.0])


def magnitude_at(membership: Membership, step: float, ulps: int) -> float:
    low, medium, high = membership.low, membership.medium, membership.high
    magnitude = low + (medium - low) * step if step <= 1.0 else medium + (high - medium) * (step - 1.0)
    for _ in range(abs(ulps)):
        magnitude = nextafter(magnitude, inf if ulps > 0 else -inf)
    return max(0.0, magnitude)


@pytest.mark.parametrize("kind", [FuzzyController, ReducedController])
@settings(max_examples=300)
@given(memberships, memberships, steps, steps, st.integers(-2, 2), st.integers(-2, 2), st.sampled_from(MOTION_MODELS))
def test_one_query_equals_the_strongest_of_81_rules(
    kind: type[FuzzyController],
    position: Membership,
    rotation: Membership,
    step_p: float,
    step_r: float,
    ulps_p: int,
    ulps_r: int,
    model: MotionModel,
) -> None:
    """On ties too, and a bit to either side of them: the table's look-up and the reduced base's nine rules, used twice."""
    y_p, y_r = magnitude_at(position, step_p, ulps_p), magnitude_at(rotation, step_r, ulps_r)
    fired = strongest(position, rotation, y_p, y_r, model)
    controller = kind(position, rotation)
    assert controller.rule_fired(y_p, y_r, model) == fired
    assert controller.next_model(y_p, y_r, model) == RULES[fired]


def test_nine_rules_used_twice_are_the_81() -> None:
    """Each of the 81, by an innovation that is wholly of its two levels."""
    controller = ReducedController(Membership(1.0, 2.0, 3.0), Membership(1.0, 2.0, 3.0))
    whole = {"Low": 1.0, "Medium": 2.0, "High": 3.0}
    found = {(p, r, m): controller.next_model(whole[p], whole[r], m) for p, r, m in ANTECEDENTS}
    assert len(found) == 81
    assert found == RULES == controller.rules.table


def test_an_innovation_that_is_no_number_is_high() -> None:
    assert FuzzyController().rule_fired(nan, nan, MotionModel(1, 1)) == ("High", "High", MotionModel(1, 1))


def test_rules_can_be_other_ones() -> None:
    """A variant has a name and 81 rules of its own, and leaves the paper's alone."""
    steady: NextIndex = {"Low": (0, 1, 2), "Medium": (1, 1, 1), "High": (2, 2, 2)}
    rules = RuleBase.separable("steady", steady, NEXT_INDEX)
    controller = FuzzyController(rules=rules)
    assert controller.next_model(9.0, 9.0, MotionModel(1, 1)) == MotionModel(2, 0)
    assert FuzzyController().next_model(9.0, 9.0, MotionModel(1, 1)) == MotionModel(0, 0)
    assert rules.by_name()["High,High,P1R1"] == "P2R0"
    with pytest.raises(ValueError, match="expected 81 rules, got 1"):
        RuleBase("short", (MotionModel(0, 0),))


def test_a_controller_is_shared_by_snapshots() -> None:
    controller = FuzzyController()
    assert deepcopy(controller) is controller


def test_a_tie_keeps_the_model() -> None:
    controller = FuzzyController(Membership(0.5, 1.5, 3.0))
    assert controller.next_model(1.0, 0.0, MotionModel(1, 1)) == MotionModel(1, 1)


@pytest.mark.parametrize("breakpoints", [(1.0, 1.0, 2.0), (-0.1, 1.0, 2.0), (0.5, 3.0, 2.0)])
def test_breakpoints_out_of_order_are_refused(breakpoints: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="low < medium < high"):
        Membership(*breakpoints)
