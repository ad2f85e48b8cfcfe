"""Fixes that leap aside and back: told from ordinary steps, held for as long as it lasts, and their velocities hardly believed."""

import numpy as np
import pytest

from tests.benchmarks.accuracy.redrawn import errors_m
from tests.benchmarks.endurance import new_filter
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, GpsVelocity, Matrix, Vector3
from tracker.precise import receiver_error
from tracker.precise.error_model import GPS_ERROR, P, V
from tracker.precise.error_state import ErrorState
from tracker.precise.hypotheses import Hypotheses
from tracker.precise.leaps import Leaps
from tracker.precise.receiver import Receiver
from tracker.precise.settings import PreciseSettings
from tracker.simulate import AGORA_ORIGIN

S = 1_000_000_000
LEAP_M = np.array([4.0, -2.0, 3.0])
SITE = SiteFrame(AGORA_ORIGIN)
REST: Vector3 = (0.0, 0.0, 0.0)


def usual(seed: int, count: int = 120) -> Matrix:
    """Return (count, 3) errors of a receiver near no wall, at every second."""
    return errors_m(np.arange(count) * S, seed, 20.0, np.array([1.0, 1.0, 1.8]), 0.3)


def aside(errors: Matrix, leaps: Leaps | None = None, from_s: int = 1) -> list[bool]:
    """Return for each fix whether the receiver is aside then."""
    leaps, found = leaps or Leaps(), []
    for second, error_m in enumerate(errors, from_s):
        leaps.take(second * S, error_m)
        found.append(leaps.is_aside(second * S))
    return found


def test_ordinary_steps_are_hardly_ever_leaps_however_far_they_lead() -> None:
    """Two hours of fixes in walks of two minutes, each from the beginning, when little is known of how this receiver steps."""
    walks = [aside(10.0 * usual(seed)) for seed in range(60)]
    assert sum(any(walk) for walk in walks) <= 2


@pytest.mark.parametrize("seed", range(20))
def test_who_leaps_is_aside_until_the_leap_back(seed: int) -> None:
    errors = usual(seed)
    errors[40:50] += LEAP_M
    errors[70:78] -= LEAP_M
    found = np.array(aside(errors))
    assert np.all(found[40:50])
    assert np.all(found[70:78])
    assert not found[50:70].any()
    assert not found[78:].any()


def test_a_leap_is_told_in_metres_out_and_back() -> None:
    errors = usual(3)
    errors[40:50] += LEAP_M
    leaps = Leaps()
    told = np.array([leaps.take(second * S, error_m) for second, error_m in enumerate(errors, 1)])
    assert np.flatnonzero(told.any(axis=1)).tolist() == [40, 50]
    assert told[40] == pytest.approx(LEAP_M, abs=1.5)
    assert told[50] == pytest.approx(-LEAP_M, abs=1.5)


def test_who_stays_for_long_is_at_another_place() -> None:
    errors = usual(4)
    errors[40:] += LEAP_M
    assert np.flatnonzero(aside(errors)).tolist() == list(range(40, 56))


def test_what_no_wall_throws_is_no_leap() -> None:
    errors = usual(8)
    errors[40:50] += 10.0 * LEAP_M
    assert not any(aside(errors))


def test_after_a_silence_nobody_is_aside_and_nothing_is_a_leap() -> None:
    errors = usual(5)
    errors[40:] += LEAP_M
    leaps = Leaps()
    assert aside(errors[:45], leaps)[-1]
    assert leaps.is_aside(46 * S)
    assert not leaps.is_aside(60 * S), "of a receiver without fixes nothing is known"
    errors[45:] -= 5.0 * LEAP_M
    assert not any(aside(errors[45:], leaps, from_s=60))


def test_before_it_is_known_how_a_receiver_steps_nothing_is_a_leap() -> None:
    errors = usual(6, 10)
    errors[5:] += LEAP_M
    assert not any(aside(errors))


# -- in the filter ----------------------------------------------------------------------------------------------------


def standing(receiver: Receiver, hypotheses: Hypotheses, second: int, error_m: Matrix, v_m_s: Vector3) -> None:
    """Let a second pass for a rig that stands, at whose end there are a fix and a velocity."""
    filter_ = hypotheses.best
    for tenth in range(1, 11):
        filter_.advance((second - 1) * S + tenth * S // 10, REST, (0.0, 0.0, filter_._gravity))
    x, y, z = error_m.tolist()
    t_ns = second * S
    receiver.take_fix(
        hypotheses, GpsFix(t_ns, t_ns, *SITE.geodetic_from_site((x, y, z)), (4.0, 0, 0, 0, 4.0, 0, 0, 0, 9.0)), REST
    )
    receiver.take_velocity(hypotheses, GpsVelocity(t_ns, t_ns, v_m_s), REST)


def beside_a_wall(leap_m: Matrix, v_m_s: Vector3) -> ErrorState:
    """Return the filter after a minute's rest and five seconds beside a wall."""
    hypotheses = Hypotheses(new_filter())
    receiver = Receiver(PreciseSettings(), SITE, REST)
    errors = usual(7)
    for second in range(1, 61):
        standing(receiver, hypotheses, second, errors[second], REST)
    for second in range(61, 66):
        standing(receiver, hypotheses, second, errors[second] + leap_m, v_m_s)
    hypotheses.best.settle()
    return hypotheses.best


def test_beside_a_wall_a_velocity_moves_little_and_the_leap_is_the_receivers() -> None:
    v: Vector3 = (0.3, -0.2, 0.0)
    beside, far = beside_a_wall(LEAP_M, v), beside_a_wall(0.0 * LEAP_M, v)
    assert np.hypot(*beside.nav.v_m_s[:2]) < 0.5 * np.hypot(*far.nav.v_m_s[:2])
    moved_m = np.hypot(*np.subtract(beside.nav.p_m, far.nav.p_m)[:2])
    assert moved_m < 0.25 * np.hypot(*LEAP_M[:2])
    assert np.all(np.diag(beside.covariance)[V] > np.diag(far.covariance)[V])


def test_what_is_doubted_of_the_receiver_is_not_doubted_of_the_place() -> None:
    state = new_filter()
    before = state.covariance.copy()
    receiver_error.doubt(state, np.array([4.0, 1.0, 2.0]))
    added = state.covariance - before
    assert np.diag(added)[GPS_ERROR].tolist() == [4.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    assert np.count_nonzero(added) == 3
    assert not added[P].any()
