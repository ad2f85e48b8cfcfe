"""The rule base against the paper's own table, and the controller's laws."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.fuzzy import LEVELS, MOTION_MODELS, RULES, FuzzyController, Membership, MotionModel, rules_by_name

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


@given(magnitudes, st.floats(0.0, 3.0), st.sampled_from(MOTION_MODELS))
def test_the_strongest_of_all_81_rules_wins(y_p_m: float, y_r_rad: float, model: MotionModel) -> None:
    """The controller's short cut equals the paper's procedure over the whole rule base."""
    position, rotation = Membership(0.5, 1.5, 3.0), Membership(0.05, 0.15, 0.40)
    strengths: dict[MotionModel, float] = {}
    for (p, level_p), (r, level_r), present in product(enumerate(LEVELS), enumerate(LEVELS), MOTION_MODELS):
        strength = position.degrees(y_p_m)[p] * rotation.degrees(y_r_rad)[r] if present == model else 0.0
        following = RULES[level_p, level_r, present]
        strengths[following] = max(strengths.get(following, 0.0), strength)
    chosen = FuzzyController(position, rotation).next_model(y_p_m, y_r_rad, model)
    assert strengths[chosen] == max(strengths.values())


def test_a_tie_keeps_the_model() -> None:
    assert FuzzyController().next_model(1.0, 0.0, MotionModel(1, 1)) == MotionModel(1, 1)


@pytest.mark.parametrize("breakpoints", [(1.0, 1.0, 2.0), (-0.1, 1.0, 2.0), (0.5, 3.0, 2.0)])
def test_breakpoints_out_of_order_are_refused(breakpoints: tuple[float, float, float]) -> None:
    with pytest.raises(ValueError, match="low < medium < high"):
        Membership(*breakpoints)
