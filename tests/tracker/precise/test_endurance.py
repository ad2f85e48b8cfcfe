"""A covariance stays one: over a hundred thousand samples of everything, over a day of standing, over hours without a receiver."""

import numpy as np
import pytest

from tests.benchmarks.endurance import GRAVITY_M_S2, endure, health, new_filter
from tracker.precise import observations
from tracker.precise.error_model import BA, BG, GPS_ERROR, MAGNETIC, SIZE, THETA, P, V

S = 1_000_000_000
UP = (0.0, 0.0, GRAVITY_M_S2)
ZERO = (0.0, 0.0, 0.0)


def test_a_hundred_thousand_samples_of_everything() -> None:
    """`make bench` takes a million."""
    seen = list(endure(100_000, 1_000))
    assert len(seen) == 100
    assert max(one.asymmetry for one in seen) < 1e-12
    assert min(one.least_eigenvalue for one in seen) > 0.0
    assert {len(one.sigmas) for one in seen} >= {SIZE + 18, SIZE + 24}, "pictures were held, and forgotten"
    assert max(one.sigmas[P].max() for one in seen) < 100.0


def test_a_day_of_standing_neither_wears_out_nor_runs_away() -> None:
    """Eight seconds a step: what standing tells is known, the rest is as unsure as it may be, and nothing is known for certain."""
    state, noise = new_filter(), np.eye(3)
    for step in range(1, 10_800):
        state.advance(step * 8 * S, ZERO, UP)
        state.correct(*observations.velocity(state, ZERO), 0.03**2 * noise)
        if step % 2:
            state.correct(*observations.turn_rate(state, ZERO), 0.012**2 * noise)
        if step % 10 == 0:
            state.correct(*observations.gps_position(state, ZERO, (2.0, 2.0, 4.0), ZERO), 0.25 * noise)
    seen = health(state.covariance)
    assert seen.asymmetry < 1e-12
    assert seen.least_eigenvalue > 0.0
    assert np.all((seen.sigmas[P] > 0.05) & (seen.sigmas[P] < 5.0))
    assert np.all((seen.sigmas[V] > 1e-4) & (seen.sigmas[V] < 0.05))
    assert np.all((seen.sigmas[THETA][:2] > 1e-4) & (seen.sigmas[THETA][:2] < 0.02))
    assert seen.sigmas[THETA][2] > 0.5, "nothing here tells north"
    assert np.all((seen.sigmas[BG] > 1e-5) & (seen.sigmas[BG] < 0.006))
    assert np.all((seen.sigmas[BA] > 1e-4) & (seen.sigmas[BA] < 0.2))
    assert np.all((seen.sigmas[GPS_ERROR] > 0.1) & (seen.sigmas[GPS_ERROR] <= 0.6))
    assert seen.sigmas[MAGNETIC] == pytest.approx(state.settings.magnetic_deviation_rad, rel=0.01)


def test_three_hours_of_nothing_are_very_unsure_and_end_with_one_fix() -> None:
    """Nobody measures anything: doubt grows beyond all bounds, and is a covariance all the same."""
    state = new_filter()
    for step in range(1, 10_800):
        state.advance(step * S, ZERO, UP)
    state.settle()
    lost = health(state.covariance)
    assert lost.asymmetry < 1e-12
    assert lost.least_eigenvalue > 0.0
    assert np.all(lost.sigmas[P] > 1e5)
    state.correct(*observations.gps_position(state, ZERO, (2.0, 2.0, 4.0), ZERO), 0.25 * np.eye(3))
    found = health(state.covariance)
    assert found.least_eigenvalue > 0.0
    assert np.all(found.sigmas[P] < 10.0)
