"""Interacting models: three filters against the nine of filterpy that they stand for, and what they conclude of a walk."""

import warnings

import numpy as np
import pytest
from filterpy.kalman import IMMEstimator, KalmanFilter
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.test_fusion import VARIANCES, H, noise
from tracker.fusion import FusionFilter, FusionSettings, transition
from tracker.fuzzy import INDICES, MOTION_MODELS, MotionModel
from tracker.imm import STAYS, InteractingFilter
from tracker.measurements import Matrix, Vector3
from tracker.motion import CONSTANT

DT_S = 0.25
SETTINGS = FusionSettings()
START_M: Vector3 = (1.0, 2.0, 3.0)
START_RAD: Vector3 = (0.1, -0.1, 0.2)
SWITCH = np.where(np.eye(3) > 0.0, STAYS, (1.0 - STAYS) / 2.0)
small = st.floats(-0.4, 0.4)
walks = st.lists(st.tuples(small, small), min_size=1, max_size=8)
axes = st.integers(0, 2)


def nine_filters() -> IMMEstimator:
    """The nine models as nine filters of twelve states, with a chain whose two indices switch independently."""
    first = InteractingFilter.start(SETTINGS, START_M, START_RAD, VARIANCES).members[0]
    filters = []
    for model in MOTION_MODELS:
        kf = KalmanFilter(dim_x=12, dim_z=6)
        kf.x, kf.P = first.state()[:, None], first.covariance()
        kf.F, kf.H, kf.Q = transition(DT_S, model), H, noise(DT_S, model, SETTINGS)
        kf.R = np.diag([*VARIANCES, *[SETTINGS.rotation_sigma_rad**2] * 3])
        filters.append(kf)
    return IMMEstimator(filters, np.full(9, 1.0 / 9.0), np.kron(SWITCH, SWITCH))


def step(ours: InteractingFilter, z: Matrix) -> None:
    """Predict and take a measurement, (6,)."""
    ours.predict(DT_S, CONSTANT)
    y_p, y_r = ours.innovation((z[0], z[1], z[2]), (z[3], z[4], z[5]))
    ours.update(y_p, y_r, VARIANCES)


@settings(max_examples=20)
@given(walks, axes, axes)
def test_three_filters_are_the_nine_of_filterpy(walk: list[tuple[float, float]], along: int, about: int) -> None:
    """Along one axis and about one axis: there no covariance between axes arises, and the two must agree exactly."""
    ours, theirs = InteractingFilter.start(SETTINGS, START_M, START_RAD, VARIANCES), nine_filters()
    z = np.array([*START_M, *START_RAD])
    for metres, turn in walk:
        z[along] += metres
        z[3 + about] += 0.02 * turn  # a rotation's noise is small, and filterpy's likelihoods must not become zero
        step(ours, z)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of filterpy's own
            theirs.predict()
            theirs.update(z[:, None])
        x, P = theirs.x.ravel(), theirs.P
        assert np.allclose(ours.value, [*x[:3], *x[6:9]], atol=1e-7)
        assert np.allclose(ours.velocity_m_s, x[3:6], atol=1e-6)
        assert np.allclose(ours.var_value, [*np.diag(P)[:3], *np.diag(P)[6:9]], atol=1e-7)
        both = np.outer(ours.position_probability, ours.rotation_probability).ravel()
        assert np.allclose(both, theirs.mu, atol=1e-7)


def test_a_standing_rig_is_held_and_a_walking_one_is_not() -> None:
    standing = InteractingFilter.start(SETTINGS, START_M, START_RAD, (0.01, 0.01, 0.01))
    walking = InteractingFilter.start(SETTINGS, START_M, START_RAD, (0.01, 0.01, 0.01))
    for k in range(1, 60):
        for filter_, speed_m_s in ((standing, 0.0), (walking, 3.0)):
            filter_.predict(DT_S, CONSTANT)
            z = (START_M[0] + speed_m_s * DT_S * k, START_M[1], START_M[2])
            y_p, y_r = filter_.innovation(z, START_RAD)
            filter_.update(y_p, y_r, (0.01, 0.01, 0.01))
    assert standing.most_likely == MotionModel(0, 0)
    assert walking.most_likely.i == 1
    assert walking.velocity_m_s[0] == pytest.approx(3.0, abs=0.1)


@given(st.floats(-1e6, 1e6), st.floats(-3.0, 3.0))
def test_an_outlier_leaves_probabilities_that_are_some(jump_m: float, turn_rad: float) -> None:
    ours = InteractingFilter.start(SETTINGS, START_M, START_RAD, VARIANCES)
    for _ in range(3):
        step(ours, np.array([jump_m, 0.0, 0.0, 0.0, 0.0, turn_rad]))
    for probability in (ours.position_probability, ours.rotation_probability):
        assert sum(probability) == pytest.approx(1.0)
        assert all(np.isfinite(probability))
    assert np.isfinite(ours.value).all()


def test_a_move_and_a_turn_reach_every_member_across_the_wrap() -> None:
    ours = InteractingFilter.start(SETTINGS, START_M, (0.0, 0.0, 3.1), VARIANCES)
    ours.turn(0.1)
    ours.move_to((7.0, 8.0, 9.0))
    ours.predict(DT_S, CONSTANT)
    assert ours.rpy_rad[2] == pytest.approx(3.2 - 2 * np.pi)
    assert ours.position_m == pytest.approx((7.0, 8.0, 9.0))
    assert len(INDICES) == len(ours.members)


def test_the_joint_covariance_is_the_filters_when_they_agree() -> None:
    ours = InteractingFilter.start(SETTINGS, START_M, START_RAD, VARIANCES)
    alone = FusionFilter.start(SETTINGS, START_M, START_RAD, VARIANCES)
    assert ours.covariance() == pytest.approx(alone.covariance())
    for _ in range(5):
        step(ours, np.array([1.0, -2.0, 0.5, 0.0, 0.0, 0.3]))
    Sigma = ours.covariance()
    assert [Sigma[v, v] for v in (0, 1, 2, 6, 7, 8)] == pytest.approx(ours.var_value)
    assert np.linalg.eigvalsh(Sigma).min() > 0.0
