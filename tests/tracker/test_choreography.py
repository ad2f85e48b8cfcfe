"""Drafts of walks: long enough, still at first, on the route, and closing where they should."""

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.choreography import (
    AGORA_TOUR,
    DATASET_DURATION_S,
    DATASET_UPDATES,
    KNOT_S,
    PATTERNS,
    Route,
    choreograph,
    nearest_turn_rad,
)
from tracker.simulate import SensorNoise


@settings(max_examples=30, deadline=None)
@given(dataset=st.sampled_from(sorted(PATTERNS)), seed=st.integers(0, 10_000), duration=st.floats(20.0, 90.0))
def test_a_draft_is_long_enough_and_still_at_first(dataset: int, seed: int, duration: float) -> None:
    """For the calibration at rest; no knot is further from the one before than a fast walker gets."""
    draft = choreograph(PATTERNS[dataset], AGORA_TOUR, duration, 6.0, 1.65, np.random.default_rng(seed))
    assert len(draft.e_m) * KNOT_S >= duration - KNOT_S
    still = round(0.7 * 6.0 / KNOT_S)
    for values in (draft.e_m, draft.n_m, draft.yaw_rad, draft.nose_up_rad):
        assert np.ptp(values[:still]) == 0.0
    assert np.hypot(np.diff(draft.e_m), np.diff(draft.n_m)).max() <= 2.0 * KNOT_S


def test_dataset_five_comes_home() -> None:
    """The paper's loop-closing walk ends where it began."""
    draft = choreograph(PATTERNS[5], AGORA_TOUR, 120.0, 6.0, 1.65, np.random.default_rng(2))
    assert np.hypot(draft.e_m[-1] - draft.e_m[0], draft.n_m[-1] - draft.n_m[0]) < 0.5
    assert np.ptp(draft.e_m) > 10.0


@pytest.mark.parametrize("dataset", DATASET_UPDATES)
def test_the_printed_sizes_at_four_a_second(dataset: int) -> None:
    """Whenever the first fix arrives, as many quarters of a second are left as the paper prints updates."""
    earliest_s, latest_s = SensorNoise().gps_late_s
    mean_s = 0.016
    for start_s in (earliest_s, latest_s + mean_s):
        assert int((DATASET_DURATION_S[dataset] - start_s - mean_s) * 4.0) == DATASET_UPDATES[dataset]


def test_a_route_is_closed() -> None:
    """By arc length, round and round."""
    route = Route(np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0)]))
    assert route.length_m == pytest.approx(12.0)
    assert route.at(4.0) == pytest.approx((3.0, 1.0, pi / 2))
    assert route.at(16.0) == pytest.approx(route.at(4.0))


@given(angle=st.floats(-30.0, 30.0), to=st.floats(-30.0, 30.0))
def test_a_turn_is_never_the_long_way_round(angle: float, to: float) -> None:
    """The same direction, at most half a turn away."""
    found = nearest_turn_rad(angle, to)
    assert abs(found - to) <= pi + 1e-9
    assert (found - angle) / (2.0 * pi) == pytest.approx(round((found - angle) / (2.0 * pi)), abs=1e-9)
