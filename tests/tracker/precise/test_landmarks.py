"""Landmarks: one alone says little where the place is open; looked at again from elsewhere, it says the same."""

from dataclasses import replace
from itertools import permutations
from math import pi

import numpy as np
import pytest

from tracker.geometry import matrix_from_wxyz, wxyz_from_yaw
from tracker.measurements import Sighting, Vector3
from tracker.precise import observations
from tracker.precise.error_model import P, start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.landmarks import DISCOUNTED, Landmarks
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings
from tracker.precise.way import Way

SETTINGS = PreciseSettings()
LEVER: Vector3 = (0.1, 0.0, 0.0)
S = 1_000_000_000


def _state(nav: Navigation, sigma_m: float) -> ErrorState:
    return ErrorState(SETTINGS, nav, Biases(), start_covariance(SETTINGS, (sigma_m,) * 3, 0.1, 0.1), 9.8)


def _sighting(nav: Navigation, point: Vector3) -> tuple[Sighting, Vector3]:
    R = matrix_from_wxyz(nav.wxyz_site_body)
    to = R.T @ (np.array(point) - nav.p_m - R @ np.array(LEVER))
    x, y, z = (to / np.linalg.norm(to)).tolist()
    return Sighting(nav.t_ns, nav.t_ns, point, (x, y, z), 0.003), (x, y, z)


HERE = Navigation(0, (1.0, 2.0, 1.6), (0.0, 0.0, 0.0), wxyz_from_yaw(0.3))
THERE = Navigation(S, (2.0, 1.0, 1.6), (0.0, 0.0, 0.0), wxyz_from_yaw(0.3 + pi / 2))


def test_a_sighting_that_agrees_moves_nothing_wherever_it_is_looked_at_from() -> None:
    way = Way()
    landmarks = Landmarks(LEVER, way)
    (first, *again) = landmarks.see(*_sighting(HERE, (12.0, 4.0, 3.0)))
    assert again == []
    state = _state(HERE, 2.0)
    landmarks.correct(state, first)
    assert state.nav.p_m == pytest.approx(HERE.p_m, abs=1e-9)
    way.moved(HERE, THERE)
    later = _state(THERE, 2.0)
    landmarks.correct(later, first)
    assert later.nav.p_m == pytest.approx(THERE.p_m, abs=1e-9)


def test_doubt_of_metres_discounts_and_a_known_place_does_not() -> None:
    landmarks = Landmarks(LEVER, Way())
    first = next(landmarks.see(*_sighting(HERE, (12.0, 4.0, 3.0))))
    landmarks.correct(_state(HERE, 2.0), first)
    assert first.discount > DISCOUNTED
    second = Navigation(S, HERE.p_m, HERE.v_m_s, HERE.wxyz_site_body)
    assert first in landmarks.see(*_sighting(second, (3.0, 14.0, 3.0)))
    assert landmarks.correct(_state(HERE, 2.0), first) is None, "it would say the same twice"
    landmarks.correct(_state(HERE, 0.1), first)
    assert first.discount == pytest.approx(1.0, abs=0.03)
    third = Navigation(2 * S, HERE.p_m, HERE.v_m_s, HERE.wxyz_site_body)
    assert first not in landmarks.see(*_sighting(third, (3.0, 14.0, 3.0)))


def test_three_directions_tell_the_place() -> None:
    """From three metres off, to decimetres; the covariance admits what is left."""
    landmarks = Landmarks(LEVER, Way())
    state = _state(HERE._replace(p_m=(3.0, -0.5, 1.2)), 2.5)
    for index, point in enumerate([(12.0, 4.0, 3.0), (3.0, 14.0, 3.0), (-9.0, -6.0, 4.0)]):
        at = HERE._replace(t_ns=index * S)
        for one in landmarks.see(*_sighting(at, point)):
            landmarks.correct(state, one)
    off_m = np.array(state.nav.p_m) - HERE.p_m
    assert np.linalg.norm(off_m) < 0.1
    assert off_m @ np.linalg.solve(state.covariance[P, P], off_m) < 12.0


def test_what_is_told_in_any_order_is_worth_the_same() -> None:
    """As much as all three at once would tell where the place is known: nothing is lost to the doubt at the first."""
    points = [(12.0, 4.0, 3.0), (3.0, 14.0, 3.0), (-9.0, -6.0, 4.0)]
    known = _state(HERE, 2.5)
    for point in points:
        _, ray = _sighting(HERE, point)
        known.correct(*observations.bearing(known, point, ray, LEVER), 0.003**2 * np.eye(2))
    best_m = np.sqrt(np.trace(known.covariance[P, P]))
    for order in permutations(points):
        landmarks, state = Landmarks(LEVER, Way()), _state(HERE._replace(p_m=(3.0, -0.5, 1.2)), 2.5)
        for index, point in enumerate(order):
            for one in landmarks.see(*_sighting(HERE._replace(t_ns=index * S), point)):
                landmarks.correct(state, one)
        assert 0.9 * best_m < np.sqrt(np.trace(state.covariance[P, P])) < DISCOUNTED * best_m, (
            "nor is it believed twice"
        )


def test_what_was_seen_a_minute_ago_is_forgotten() -> None:
    landmarks = Landmarks(LEVER, Way())
    first = next(landmarks.see(*_sighting(HERE, (12.0, 4.0, 3.0))))
    first.discount = 9.0
    later = HERE._replace(t_ns=61 * S)
    assert first not in landmarks.see(*_sighting(later, (12.0, 4.0, 3.0)))


@pytest.mark.parametrize("point", [(-9.0, -6.0, 4.0), (1.1, 2.0, 1.6), (12.0, 14.0, 3.0)])
def test_a_slip_of_the_finger_moves_nothing(point: Vector3) -> None:
    """The direction is that of another landmark: this one is behind, or where the rig is, or far aside."""
    landmarks, state = Landmarks(LEVER, Way()), _state(HERE, 0.3)
    state.covariance[8, 8] = 0.02**2
    seen, ray = _sighting(HERE, (12.0, 4.0, 3.0))
    (wrong,) = landmarks.see(replace(seen, point_site_m=point), ray)
    done = landmarks.correct(state, wrong)
    assert done is not None
    assert not done.used
    assert state.nav.p_m == HERE.p_m


def test_who_does_not_know_north_believes_what_is_pointed_out_behind() -> None:
    landmarks = Landmarks(LEVER, Way())
    state = _state(HERE._replace(wxyz_site_body=wxyz_from_yaw(0.3 + 2.0)), 0.3)
    state.covariance[8, 8] = 2.0**2
    (seen,) = landmarks.see(*_sighting(HERE, (12.0, 4.0, 3.0)))
    done = landmarks.correct(state, seen)
    assert done is not None
    assert done.used
