"""What a receiver's path tells of its error: who goes as it claims to is believed, who goes evenly errs more slowly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.benchmarks.accuracy.redrawn import errors_m
from tests.benchmarks.endurance import new_filter
from tracker.measurements import Matrix, Vector3
from tracker.precise import receiver_error
from tracker.precise.error_model import GPS_ERROR, P
from tracker.precise.evenness import Evenness
from tracker.precise.settings import PreciseSettings

S = 1_000_000_000
SETTINGS = PreciseSettings()
USUAL = Evenness(SETTINGS)


def wandering(seed: int, count: int, dt_s: float, time_s: float, sigma_m: Vector3, white_m: float) -> Matrix:
    """Return (count, 3) places of a receiver that rests, whose error has a correlation time, and white noise."""
    return errors_m(np.round(np.arange(count) * dt_s * S).astype(np.int64), seed, time_s, np.array(sigma_m), white_m)


def told(evenness: Evenness, places: Matrix, dt_s: float, sigma_m: Vector3, from_s: float = 0.0) -> list[float]:
    """Give it fixes; return when it came to believe otherwise, s."""
    changed = []
    for i, (x, y, z) in enumerate(places.tolist()):
        t_s = from_s + i * dt_s
        if evenness.take(round(t_s * S), (x, y, z), sigma_m):
            changed.append(t_s)
    return changed


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.25, 1.0]), st.floats(1.0, 10.0))
def test_one_that_wanders_as_fast_as_it_claims_is_believed(seed: int, dt_s: float, sigma_m: float) -> None:
    evenness, sigma = Evenness(SETTINGS), (sigma_m, sigma_m, 2.0 * sigma_m)
    places = wandering(seed, 120, dt_s, 15.0, sigma, 0.25 * sigma_m)
    assert told(evenness, places, dt_s, sigma) == []
    assert np.array_equal(evenness.errors, USUAL.errors)
    assert np.array_equal(evenness.white_share, USUAL.white_share)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.25, 1.0]))
def test_one_that_claims_metres_and_goes_evenly_errs_slowly(seed: int, dt_s: float) -> None:
    """The whole of its error stays what it claims, but most of it lasts."""
    evenness, sigma = Evenness(SETTINGS), (10.0, 8.0, 25.0)
    places = wandering(seed, 60, dt_s, 3600.0, sigma, 0.05)
    first_s, *_ = told(evenness, places, dt_s, sigma)
    assert first_s < 14.0
    (shares, times_s), (usual, usual_s) = evenness.errors, USUAL.errors
    assert shares.reshape(3, 3).sum(axis=0) + evenness.white_share == pytest.approx(1.0)
    assert np.all(shares[:3] < 0.25 * usual[:3])
    assert np.all(shares[3:6] < 0.5 * usual[3:6])
    assert np.all(shares[6:] > usual[6:])
    assert np.all(times_s >= usual_s)
    grown = shares / times_s
    assert np.all(grown[6:] <= grown[:3] * (1.0 + 1e-9))


def test_one_that_tells_the_same_again_tells_nothing() -> None:
    places = np.tile([1.0, 2.0, 3.0], (100, 1)) + np.outer(np.arange(100), [0.0, 0.0, 0.1])
    evenness = Evenness(SETTINGS)
    assert told(evenness, places, 1.0, (10.0, 10.0, 20.0)) == []


def test_one_that_no_longer_goes_evenly_is_believed_as_it_claims_again() -> None:
    sigma = (10.0, 10.0, 20.0)
    evenness = Evenness(SETTINGS)
    even = wandering(1, 60, 1.0, 3600.0, sigma, 0.05)
    uneven = even[-1] + wandering(2, 90, 1.0, 15.0, sigma, 2.0)
    assert len(told(evenness, even, 1.0, sigma)) == 1
    assert told(evenness, uneven, 1.0, sigma, from_s=60.0)
    assert np.array_equal(evenness.errors, USUAL.errors)


def test_another_belief_moves_neither_the_place_nor_what_is_known_of_it() -> None:
    """And not what the next fix would tell: the error of now is as large as before, and only lasts longer."""
    state = new_filter()
    state.gps_error = np.arange(1.0, 10.0)
    rng = np.random.default_rng(2)
    mixed = rng.normal(size=(len(state.covariance), len(state.covariance)))
    state.covariance = state.covariance + mixed @ mixed.T
    H = np.zeros((3, len(state.covariance)))
    H[:, P] = np.eye(3)
    H[:, GPS_ERROR] = np.hstack([2.0 * np.eye(3)] * 3)
    before, p_m, error = state.covariance.copy(), state.nav.p_m, state.gps_error.reshape(3, 3).sum(axis=0)
    quick = np.array([0.01, 0.01, 0.02, 0.03, 0.03, 0.04])
    receiver_error.believe(state, np.array([[*quick, 0.9, 0.9, 0.9], [15.0] * 3 + [90.0] * 3 + [3600.0] * 3]))
    assert state.nav.p_m == p_m
    assert state.gps_error.reshape(3, 3).sum(axis=0) == pytest.approx(error)
    assert state.covariance[P, P] == pytest.approx(before[P, P])
    fresh = np.diag(4.0 * quick.reshape(2, 3).sum(axis=0))
    assert H @ state.covariance @ H.T == pytest.approx(H @ before @ H.T + fresh)
    assert np.linalg.eigvalsh(state.covariance)[0] > 0.0
