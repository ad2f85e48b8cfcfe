"""A body that walks: its velocity, acceleration and rate are the derivatives of its pose."""

import numpy as np
import pytest

from tracker.choreography import AGORA_TOUR, KNOT_S, PATTERNS, Draft, choreograph
from tracker.gait import Body
from tracker.measurements import Matrix

EYE_M = 1.65
STEP_S = 1e-4


def _flat(e_m: Matrix, n_m: Matrix) -> Matrix:
    return np.zeros_like(e_m)


def _body(dataset: int = 0) -> Body:
    draft = choreograph(PATTERNS[dataset], AGORA_TOUR, 40.0, 5.0, EYE_M, np.random.default_rng(3))
    return Body(draft, _flat, EYE_M, PATTERNS[dataset].sways)


def test_derivatives() -> None:
    """By differences over a tenth of a millisecond."""
    body, t = _body(), np.linspace(6.0, 38.0, 300)
    before, here, after = (body.at(t + d) for d in (-STEP_S, 0.0, STEP_S))
    np.testing.assert_allclose((after.p_m - before.p_m) / (2 * STEP_S), here.v_m_s, atol=1e-4)
    np.testing.assert_allclose((after.v_m_s - before.v_m_s) / (2 * STEP_S), here.a_m_s2, atol=2e-2)
    turn = np.einsum("nji,njk->nik", here.R_site_body, (after.R_site_body - before.R_site_body) / (2 * STEP_S))
    rate = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=1)
    np.testing.assert_allclose(rate, here.omega_body_rad_s, atol=1e-3)


def test_steps_are_felt_while_walking_only() -> None:
    """The head bobs by centimetres; a body that does not sway, as on a tripod, stays level."""
    motion = _body().at(np.arange(0.0, 39.0, 0.02))
    walking = np.hypot(motion.v_m_s[:, 0], motion.v_m_s[:, 1]) > 0.8
    bob = motion.p_m[:, 2] - EYE_M
    assert 0.01 < np.abs(bob[walking]).max() < 0.04
    assert np.abs(bob[:100]).max() < 1e-9
    still = _body(3).at(np.arange(0.0, 39.0, 0.02))
    np.testing.assert_allclose(still.p_m[:, 2], EYE_M, atol=1e-9)
    np.testing.assert_allclose(still.omega_body_rad_s, 0.0, atol=1e-9)


def test_the_ground_lifts_the_eyes() -> None:
    """On a slope of a tenth the eyes rise a tenth of the way."""
    count = 200
    e = np.arange(count, dtype=np.float64) * (KNOT_S * 1.2)
    zero = np.zeros(count)
    body = Body(Draft(e, zero, zero, zero, zero), lambda e_m, n_m: 0.1 * e_m, EYE_M, sways=False)
    motion = body.at(np.array([8.0, 12.0]))
    assert motion.p_m[1, 2] - motion.p_m[0, 2] == pytest.approx(0.1 * (motion.p_m[1, 0] - motion.p_m[0, 0]))
