"""What a receiver claims: its usual claim is told from one of a moment, and its error stays what it is in metres."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.benchmarks.endurance import new_filter
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, Vector3
from tracker.precise import receiver_error
from tracker.precise.claims import Claims
from tracker.precise.error_model import GPS_ERROR
from tracker.precise.error_state import ErrorState
from tracker.precise.hypotheses import Hypotheses
from tracker.precise.receiver import Receiver
from tracker.precise.settings import PreciseSettings
from tracker.simulate import AGORA_ORIGIN

S = 1_000_000_000
SITE = SiteFrame(AGORA_ORIGIN)
REST: Vector3 = (0.0, 0.0, 0.0)
USUAL_M: Vector3 = (1.5, 1.5, 3.0)
SETTINGS = PreciseSettings()

sigmas = st.tuples(*[st.floats(0.3, 1000.0)] * 3)


@given(st.lists(sigmas, min_size=1, max_size=20))
def test_what_is_believed_of_a_fix_is_never_less_than_it_claims(claims: list[Vector3]) -> None:
    taken = Claims()
    for sigma_m in claims:
        usual_m, noisier_m2 = taken.take(sigma_m)
        assert np.all(noisier_m2 >= 0.0)
        assert np.all(np.square(usual_m) + noisier_m2 >= np.square(sigma_m) * (1.0 - 1e-12))


def test_two_worse_claims_are_noise_and_a_third_is_what_is_usual() -> None:
    claims, worse = Claims(), (6.0, 5.0, 9.0)
    for _ in range(5):
        usual_m, noisier_m2 = claims.take(USUAL_M)
        assert usual_m == USUAL_M
        assert not noisier_m2.any()
    for _ in range(2):
        usual_m, noisier_m2 = claims.take(worse)
        assert usual_m == USUAL_M
        assert noisier_m2 == pytest.approx(np.square(worse) - np.square(USUAL_M))
    usual_m, noisier_m2 = claims.take(worse)
    assert usual_m == worse
    assert not noisier_m2.any()


@given(sigmas, sigmas)
def test_in_metres_an_error_is_the_same_whatever_it_is_told_in(before_m: Vector3, after_m: Vector3) -> None:
    state = new_filter()
    receiver_error.restate(state, before_m)
    state.gps_error = np.arange(1.0, 10.0)
    old, cov = state.gps_error * np.tile(before_m, 3), state.covariance.copy()
    receiver_error.restate(state, after_m)
    assert state.gps_error * np.tile(after_m, 3) == pytest.approx(old)
    units_before, units_after = np.ones(len(cov)), np.ones(len(cov))
    units_before[GPS_ERROR], units_after[GPS_ERROR] = np.tile(before_m, 3), np.tile(after_m, 3)
    in_metres = units_before[:, None] * cov * units_before
    assert units_after[:, None] * state.covariance * units_after == pytest.approx(in_metres)


def test_a_first_claim_says_how_large_an_error_is_of_which_nothing_is_known() -> None:
    state = new_filter()
    before = state.covariance.copy()
    receiver_error.restate(state, (7.0, 7.0, 9.0))
    assert np.array_equal(state.covariance, before)


def standing(claims_m: list[Vector3], off_m: Vector3) -> ErrorState:
    """Return a filter after fixes that are as far off as each other, whatever they claim."""
    hypotheses, receiver = Hypotheses(new_filter()), Receiver(SETTINGS, SITE, REST)
    x, y, z = off_m
    for second, sigma_m in enumerate(claims_m, 1):
        t_ns = second * S
        for tenth in range(1, 11):
            hypotheses.best.advance((second - 1) * S + tenth * S // 10, REST, (0.0, 0.0, hypotheses.best._gravity))
        cov = tuple(np.diag(np.square(sigma_m)).ravel().tolist())
        receiver.take_fix(hypotheses, GpsFix(t_ns, t_ns, *SITE.geodetic_from_site((x, y, z)), cov), REST)
    hypotheses.best.settle()
    return hypotheses.best


def test_a_claim_that_wavers_does_not_tell_where_the_receiver_is_off_to() -> None:
    """An error in units of the claim would have to move with it: fixes that stay would tell that there is none."""
    rng = np.random.default_rng(4)
    steady = standing([USUAL_M] * 60, (3.0, -2.0, 1.0))
    wavering = standing([(a * 1.5, a * 1.5, a * 3.0) for a in rng.uniform(0.7, 1.4, 60).tolist()], (3.0, -2.0, 1.0))
    assert wavering.nav.p_m == pytest.approx(steady.nav.p_m, abs=0.15)
    for axis in range(2):
        assert wavering.covariance[axis, axis] > 0.8 * steady.covariance[axis, axis]


def test_claims_beyond_all_measure_leave_the_filter_sound() -> None:
    absurd: Vector3 = (1e150, 1e120, 1e140)
    state = standing([USUAL_M] * 6 + [absurd] * 6 + [USUAL_M] * 12, (1.0, 0.0, 0.0))
    assert np.all(np.isfinite(state.covariance))
    assert np.linalg.eigvalsh(state.covariance)[0] > -1e-9
    assert np.hypot(*state.nav.p_m[:2]) < 10.0


def test_a_receiver_that_claims_nothing_is_believed_as_the_settings_say() -> None:
    hypotheses, receiver = Hypotheses(new_filter()), Receiver(SETTINGS, SITE, REST)
    hypotheses.best.advance(S, REST, (0.0, 0.0, hypotheses.best._gravity))
    receiver.take_fix(hypotheses, GpsFix(S, S, *SITE.geodetic_from_site((0.0, 0.0, 0.0)), (0.0,) * 9), REST)
    assert hypotheses.best.gps_sigma_m == pytest.approx(
        np.sqrt(SETTINGS.gps_inflation) * np.array(SETTINGS.gps_sigma_m)
    )
