"""The filter's algebra: transition against differences, covariance that stays one, and estimates that honour it."""

from math import pi

import numpy as np
import pytest

from tracker.geodesy import earth_rate_rad_s
from tracker.geometry import conjugate, exp, log, multiply, normalise, rotate, wxyz_from_yaw
from tracker.measurements import Matrix, Vector3
from tracker.precise import observations
from tracker.precise.error_model import BA, BG, SIZE, THETA, P, V, inertial_transition, skew, start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases, Navigation, advance, carried
from tracker.precise.settings import PreciseSettings

G = 9.8
SETTINGS = PreciseSettings()
GYRO, ACCEL = (0.3, -0.2, 0.5), (0.4, 0.3, 9.9)


def _state(covariance_scale: float = 1.0) -> ErrorState:
    nav = Navigation(0, (1.0, 2.0, 3.0), (0.5, -0.4, 0.1), normalise((0.9, 0.1, -0.2, 0.3)))
    return ErrorState(
        SETTINGS, nav, Biases(), covariance_scale * start_covariance(SETTINGS, (1.0, 1.0, 1.0), 1.0, 1.0), G
    )


def _advanced(nav: Navigation, biases: Biases) -> Navigation:
    for step in range(1, 11):
        nav = advance(nav, step * 2_000_000, GYRO, ACCEL, biases, G)
    return nav


def _difference(a: Navigation, b: Navigation) -> list[float]:
    """b minus a as the filter's error: position, velocity, left rotation vector."""
    turn = log(multiply(b.wxyz_site_body, conjugate(a.wxyz_site_body)))
    return [
        *(y - x for x, y in zip(a.p_m, b.p_m, strict=True)),
        *(y - x for x, y in zip(a.v_m_s, b.v_m_s, strict=True)),
        *turn,
    ]


def test_transition_is_the_derivative_of_the_integral() -> None:
    start = _state().nav
    end = _advanced(start, Biases())
    gained = np.array(end.v_m_s) - start.v_m_s + np.array([0.0, 0.0, G * 0.02])
    state = _state()
    Phi = inertial_transition(0.02, state.R_site_body, gained)
    for column in range(15):
        error = np.zeros(SIZE)
        error[column] = 1e-5
        moved = _state()
        moved.move(error)
        numeric = np.array(_difference(end, _advanced(moved.nav, moved.biases))) / 1e-5
        assert Phi[:9, column] == pytest.approx(numeric, abs=2e-3 if column >= 6 else 1e-6), column


def test_who_turns_about_for_minutes_is_not_tilted_by_the_turning_earth() -> None:
    """The gyroscope feels both turns, and no bias of it can be mistaken for the Earth's once the rig has faced all around."""
    earth_rad_s, rate_rad_s, step_s = earth_rate_rad_s(37.9), 0.5, 0.02
    off_rad = []
    for known_rad_s in (earth_rad_s, (0.0, 0.0, 0.0)):
        nav = Navigation(0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
        cov = start_covariance(SETTINGS, (1.0, 1.0, 1.0), 1.0, 1.0)
        state = ErrorState(SETTINGS, nav, Biases(), cov, G, known_rad_s)
        for step in range(15_000):
            x, y, z = rotate(conjugate(wxyz_from_yaw(rate_rad_s * (step + 0.5) * step_s)), earth_rad_s)
            state.advance((step + 1) * 20_000_000, (x, y, z + rate_rad_s), (0.0, 0.0, G))
        state.settle()
        truth = wxyz_from_yaw(rate_rad_s * 15_000 * step_s)
        off_rad.append(np.linalg.norm(log(multiply(truth, conjugate(state.nav.wxyz_site_body)))))
    assert off_rad[0] < 2e-5
    assert off_rad[1] == pytest.approx(300.0 * np.linalg.norm(earth_rad_s), rel=0.02)


def test_what_is_relative_tells_nobody_which_way_all_of_it_lies() -> None:
    """Of a turn of everything about any place as much is known after such a correction as before it."""
    rng, state = np.random.default_rng(3), _state()
    for _ in range(2):
        state.hold(2)
        state.covariance += np.diag(rng.uniform(0.05, 0.1, len(state.covariance)))
    H, as_one = rng.normal(size=(5, len(state.covariance))), _as_one(state)
    H -= H @ as_one @ np.linalg.pinv(as_one)
    before = as_one.T @ np.linalg.solve(state.covariance, as_one)
    state.correct(rng.normal(size=5), [(slice(0, H.shape[1]), H)], 0.1 * np.eye(5), gated=False, is_relative=True)
    assert np.abs(_as_one(state) - as_one).max() > 0.1
    after = _as_one(state).T @ np.linalg.solve(state.covariance, _as_one(state))
    assert after == pytest.approx(before, abs=1e-9 * np.abs(before).max())


def test_a_part_of_a_correction_moves_that_part_of_the_way_and_its_covariance_knows() -> None:
    """Over many draws of the truth the error left is what the covariance says, though it is not the least."""
    rng, prior, noise = np.random.default_rng(5), _state(), 0.5 * np.eye(3)
    whole, part = _state(), _state()
    seen = np.array([0.9, -0.4, 0.2])
    for state, share in ((whole, 1.0), (part, 0.4)):
        residual, blocks = observations.position(state, tuple((seen + prior.nav.p_m).tolist()))
        state.correct(residual, blocks, noise, share=share)
    moved = np.subtract(part.nav.p_m, prior.nav.p_m)
    assert moved == pytest.approx(0.4 * np.subtract(whole.nav.p_m, prior.nav.p_m))
    truth = rng.multivariate_normal(np.zeros(3), prior.covariance[P, P], 20_000)
    told = truth + rng.multivariate_normal(np.zeros(3), noise, len(truth))
    gain = (moved / seen)[0]
    assert np.mean((truth - gain * told) ** 2, axis=0) == pytest.approx(np.diag(part.covariance)[P], rel=0.05)
    assert np.all(np.diag(part.covariance)[P] > np.diag(whole.covariance)[P])


def test_a_part_of_a_correction_leaves_the_receivers_error_as_likely_as_the_whole_does() -> None:
    whole, part = _state(), _state()
    for state, share in ((whole, 1.0), (part, 0.4)):
        seen = observations.gps_position(state, (2.0, 2.0, 3.0), (2.0, 2.0, 4.0), (0.0, 0.0, 0.0))
        state.correct(*seen, np.eye(3), share=share)
    assert np.all(part.gps_error == whole.gps_error)
    assert np.any(part.gps_error != 0.0)


def test_the_further_out_a_measurement_is_the_less_it_counts() -> None:
    """To the gate a correction grows with what is measured, beyond it shrinks, and in the end there is none."""
    per_m_s, gate_nis = _velocity_moved_by(0.01, None)[0] / 0.01, 2.5
    for off_m_s, asked_nis in ((0.5, None), (0.5, gate_nis), (3.0, None), (3.0, gate_nis), (5.5, gate_nis)):
        moved_m_s, nis = _velocity_moved_by(off_m_s, asked_nis)
        counts = min(1.0, (asked_nis or SETTINGS.gate_nis) / nis)
        assert moved_m_s == pytest.approx(counts * per_m_s * off_m_s, rel=1e-9), (off_m_s, asked_nis)
    assert _velocity_moved_by(3.0, gate_nis)[0] > _velocity_moved_by(5.5, gate_nis)[0]
    assert _velocity_moved_by(30.0, gate_nis)[0] == _velocity_moved_by(30.0, None)[0] == 0.0


def _velocity_moved_by(off_m_s: float, gate_nis: float | None) -> tuple[float, float]:
    """Return by how much a velocity that is off by so much moves the filter's, and its squared innovation per dimension."""
    state = _state()
    before, (residual, blocks) = state.nav.v_m_s[0], observations.velocity(state, (0.0, 0.0, 0.0))
    off = np.array([off_m_s, 0.0, 0.0])
    done = state.correct(off, blocks, 0.1 * np.eye(len(residual)), gate_nis=gate_nis)
    return state.nav.v_m_s[0] - before, done.nis


def _as_one(state: ErrorState) -> Matrix:
    """Return what the error is when everything is turned by a little about the origin, (n, 3)."""
    turn = np.zeros((len(state.covariance), 3))
    turn[THETA] = np.eye(3)
    turn[P], turn[V] = -skew(state.nav.p_m), -skew(state.nav.v_m_s)
    for k, clone in enumerate(state.clones):
        at = SIZE + 6 * k
        turn[at : at + 3], turn[at + 3 : at + 6] = -skew(clone.p_m), np.eye(3)
    return turn


def test_a_free_integral_carries_any_state_exactly() -> None:
    """What a state far away and turned would have become is read from an integral that ran elsewhere."""
    start = _state().nav
    elsewhere = Navigation(
        0, (100.0, -50.0, 7.0), (30.0, 4.0, -9.0), normalise(multiply(exp((0.5, 2.0, 1.0)), (1, 0, 0, 0)))
    )
    found = carried(start, elsewhere, _advanced(elsewhere, Biases()), G)
    assert _difference(found, _advanced(start, Biases())) == pytest.approx([0.0] * 9, abs=1e-9)


def test_covariance_stays_a_covariance() -> None:
    """Ten thousand steps and updates, exact measurements among them."""
    state, rng = _state(), np.random.default_rng(3)
    for step in range(1, 10_001):
        state.advance(step * 20_000_000, GYRO, ACCEL)
        if step % 50 == 0:
            state.hold(2)
        if step % 3 == 0:
            state.correct(*observations.velocity(state, (0.0, 0.0, 0.0)), 1e-10 * np.eye(3), gated=False)
        if step % 7 == 0:
            p: Vector3 = tuple(rng.normal(size=3).tolist())
            state.correct(*observations.gps_position(state, p, (2.0, 2.0, 4.0), (0.0, 0.0, 0.0)), 0.1 * np.eye(3))
    state.settle()
    assert state.covariance == pytest.approx(state.covariance.T, rel=1e-12, abs=1e-15)
    scale = np.sqrt(np.diag(state.covariance))
    assert np.all(scale > 0.0)
    assert np.linalg.eigvalsh(state.covariance / np.outer(scale, scale)).min() > -1e-9


def test_an_update_is_the_textbook_s() -> None:
    state = _state()
    before, residual = state.covariance.copy(), np.array([0.1, -0.2, 0.05])
    noise = np.diag([0.2, 0.3, 0.4])
    state.correct(residual, [(V, np.eye(3))], noise)
    S = before[V, V] + noise
    K = before[:, V] @ np.linalg.inv(S)
    assert state.covariance == pytest.approx(before - K @ S @ K.T)
    assert np.array(state.nav.v_m_s) == pytest.approx(np.array([0.5, -0.4, 0.1]) + (K @ residual)[V])


def test_what_lies_far_out_counts_for_less_and_further_out_for_nothing() -> None:
    near, far, absurd = _state(), _state(), _state()
    done = [
        state.correct(np.array([y, 0.0, 0.0]), [(V, np.eye(3))], 0.01 * np.eye(3))
        for state, y in ((near, 1.0), (far, 8.0), (absurd, 100.0))
    ]
    assert [one.used for one in done] == [True, True, False]
    assert absurd.nav == _state().nav
    gain_near, gain_far = near.nav.v_m_s[0] - 0.5, (far.nav.v_m_s[0] - 0.5) / 8.0
    assert 0.0 < gain_far < 0.7 * gain_near


def test_a_held_pose_is_the_present_one_until_the_rig_moves() -> None:
    state = _state()
    state.hold(2)
    cov = state.covariance
    assert cov[SIZE : SIZE + 6, SIZE : SIZE + 6] == pytest.approx(cov[np.ix_([0, 1, 2, 6, 7, 8], [0, 1, 2, 6, 7, 8])])
    assert cov[SIZE : SIZE + 3, P] == pytest.approx(cov[P, P])
    state.hold(2)
    state.hold(2)
    assert len(state.clones) == 2
    assert state.covariance.shape == (SIZE + 12, SIZE + 12)
    state.forget(0)
    assert state.covariance.shape == (SIZE + 6, SIZE + 6)


def test_a_new_place_is_split_with_the_receiver_s_error() -> None:
    """After one fix the position is as unsure as the fix, and its error is the receiver's."""
    state = _state()
    state.place((10.0, 20.0, 5.0))
    sigma = (2.0, 2.0, 4.0)
    white = 1.0 - sum(SETTINGS.gps_error_share)
    noise = np.diag([white * s * s for s in sigma])
    state.correct(*observations.gps_position(state, (11.0, 20.0, 5.0), sigma, (0.0, 0.0, 0.0)), noise)
    assert np.sqrt(np.diag(state.covariance)[P]) == pytest.approx(sigma, rel=1e-2)
    assert state.nav.p_m == pytest.approx((11.0, 20.0, 5.0), abs=0.01)


def test_a_rig_that_stands_learns_its_gyroscope_s_bias() -> None:
    state = _state()
    for step in range(1, 2001):
        state.advance(step * 10_000_000, (0.004, -0.002, 0.003), (0.0, 0.0, G))
        if step % 25 == 0:
            state.correct(*observations.velocity(state, (0.0, 0.0, 0.0)), 1e-4 * np.eye(3))
            state.correct(*observations.turn_rate(state, (0.004, -0.002, 0.003)), 1e-4 * np.eye(3))
    assert state.biases.gyro_rad_s == pytest.approx((0.004, -0.002, 0.003), abs=2e-4)
    sigma = np.sqrt(np.diag(state.covariance))
    assert np.all(sigma[BG] < 0.002)
    assert sigma[THETA][2] > 0.5  # nothing here tells north
    assert np.all(sigma[BA] <= SETTINGS.accel_bias_m_s2 + 0.01)


def test_yaw_turns_the_long_way_round() -> None:
    state = _state()
    state.nav = state.nav._replace(wxyz_site_body=wxyz_from_yaw(pi - 0.01))
    error = np.zeros(SIZE)
    error[8] = 0.02
    state.move(error)
    assert multiply(conjugate(wxyz_from_yaw(-pi + 0.01)), state.nav.wxyz_site_body)[0] ** 2 == pytest.approx(1.0)
