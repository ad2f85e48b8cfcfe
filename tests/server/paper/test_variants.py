"""What the sweep tries: names that tell apart, memberships that cross where they say, the default among them once."""

from itertools import pairwise

import pytest

from server.paper.variants import DEFAULT, OTHER_RULES, RULE_MEANINGS, crossing_at, variants
from tracker.fuzzy import LEVELS, NEXT_INDEX, PAPER_RULES, POSITION_MEMBERSHIP_M, ROTATION_MEMBERSHIP_RAD


def test_every_variant_has_its_name() -> None:
    """Rows of a sweep are told apart by it, and all are different settings but for a factor's usual value."""
    tried = variants()
    assert len({variant.name for variant in tried}) == len(tried)
    assert tried[0] is DEFAULT
    assert DEFAULT.position is POSITION_MEMBERSHIP_M
    assert DEFAULT.rules is PAPER_RULES
    usual = [variant.factor for variant in tried[1:] if {**variant.described(), "factor": 0, "value": 0} == _default()]
    # the usual crossings give the shipped breakpoints but for the last bit
    assert sorted(usual) == sorted(["accel noise", "angular noise", "rotation sigma", "GPS variance"])


def _default() -> dict[str, object]:
    return {**DEFAULT.described(), "factor": 0, "value": 0}


@pytest.mark.parametrize(("low", "high"), [(0.1, 0.8), (0.3, 2.25), (1.0, 2.25), (1.5, 3.5)])
def test_memberships_cross_where_they_say(low: float, high: float) -> None:
    """Just below a crossing the lower level is the stronger, just above it the higher."""
    membership = crossing_at(low, high)
    for magnitude, level in ((low, 0), (high, 1)):
        below, above = membership.degrees(magnitude * 0.999), membership.degrees(magnitude * 1.001)
        assert below[level] > below[level + 1]
        assert above[level] < above[level + 1]


def test_the_shipped_memberships_are_of_the_shape_that_is_tried() -> None:
    """So that crossings are all that a variant changes, and the shipped ones are among them."""
    tried = variants()
    for shipped, memberships in (
        (POSITION_MEMBERSHIP_M, [v.position for v in tried if v.factor == "position"]),
        (ROTATION_MEMBERSHIP_RAD, [v.rotation for v in tried if v.factor == "rotation"]),
    ):
        breakpoints = [(m.low, m.medium, m.high) for m in memberships]
        assert any(b == pytest.approx((shipped.low, shipped.medium, shipped.high)) for b in breakpoints)


def test_crossings_too_near_are_refused() -> None:
    """They have no such shape."""
    with pytest.raises(ValueError, match="low < medium < high"):
        crossing_at(1.0, 1.4)


def test_stretched_memberships_grow() -> None:
    """Each a wider Low than the one before."""
    scales = [variant.position.low for variant in variants() if variant.factor == "rest"]
    assert len(scales) > 4
    assert all(a < b for a, b in pairwise([POSITION_MEMBERSHIP_M.low, *scales]))


def test_other_rules_are_others_and_explained() -> None:
    """Each differs from the paper's and from each other, has all three levels, and a sentence."""
    tables = [tuple(table[level] for level in LEVELS) for table in OTHER_RULES.values()]
    paper = tuple(NEXT_INDEX[level] for level in LEVELS)
    assert len({*tables, paper}) == len(OTHER_RULES) + 1
    assert set(RULE_MEANINGS) == {"paper", *OTHER_RULES}
