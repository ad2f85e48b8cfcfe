"""run(A + B) is run(A), snapshot, restore into another estimator, run(B), bit for bit, wherever it is cut."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.precise.stream import NAMES, estimator, feed, stream
from tracker.measurements import Sighting, Standpoint, VisualMotion


@pytest.fixture(scope="module")
def whole() -> dict[str, list[tuple[object, ...]]]:
    """What is to be seen of a run without a cut."""
    return {name: feed(estimator(name), stream()) for name in NAMES}


@settings(max_examples=4)
@given(cut=st.integers(0, len(stream()) // 10), astray=st.integers(1, 400))
@pytest.mark.parametrize("name", NAMES)
def test_a_run_goes_on_from_a_snapshot(
    whole: dict[str, list[tuple[object, ...]]], name: str, cut: int, astray: int
) -> None:
    """Also once the one that it was taken of has gone on, and once another that began from it has."""
    first, second, third = estimator(name), estimator(name), estimator(name)
    seen = feed(first, stream()[: 10 * cut])
    snapshot = first.snapshot()
    feed(first, stream()[10 * cut : 10 * cut + astray])
    feed(second, stream()[:astray])
    second.restore(snapshot)
    assert seen + feed(second, stream()[10 * cut :]) == whole[name]
    third.restore(snapshot)
    assert seen + feed(third, stream()[10 * cut :]) == whole[name]


def test_the_run_has_everything_in_it() -> None:
    kinds = {type(m) for m in stream()}
    assert {VisualMotion, Sighting, Standpoint} <= kinds
