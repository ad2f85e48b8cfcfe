"""What a step makes of all of the covariance, against differences: inertial states, errors of sensors, held pictures."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.random import Generator

from tracker.geometry import conjugate, log, multiply, normalise
from tracker.measurements import Matrix, Vector3
from tracker.precise.error_model import SIZE
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings

#: No noise worth the name, so that a step is F P F^T and nothing else.
QUIET = 1e-15
SETTINGS = replace(
    PreciseSettings(),
    gyro_noise_rad_s_sqrt_hz=QUIET,
    accel_noise_m_s2_sqrt_hz=QUIET,
    gyro_scale=QUIET,
    accel_scale=QUIET,
    gyro_bias_walk_rad_s2_sqrt_hz=QUIET,
    accel_bias_walk_m_s3_sqrt_hz=QUIET,
    gps_error_s=(0.3, 1.0, 4.0),
    gps_error_share=(QUIET, QUIET, QUIET),
    magnetic_deviation_rad=QUIET,
    magnetic_deviation_s=0.5,
)
STEPS, STEP_NS = 5, 4_000_000


def _vector(rng: Generator, scale: float) -> Vector3:
    x, y, z = (scale * rng.normal(size=3)).tolist()
    return (x, y, z)


def _state(rng: Generator) -> ErrorState:
    """A state with two held pictures, all of it anywhere; its covariance is any."""
    w, x, y, z = rng.normal(size=4).tolist()
    nav = Navigation(0, _vector(rng, 5.0), _vector(rng, 1.0), normalise((w, x, y, z)))
    state = ErrorState(SETTINGS, nav, Biases(_vector(rng, 0.01), _vector(rng, 0.1)), np.eye(SIZE), 9.8)
    for _ in range(2):
        state.hold(2)
        state.move(0.3 * rng.normal(size=len(state.covariance)))
    state.biases = replace(state.biases, gyro_axes=((0.01, -0.02, 0.005), (0.01, 0.0, -0.01), (0.02, 0.01, 0.01)))
    root = rng.normal(size=state.covariance.shape)
    state.covariance = root @ root.T
    return state


def _carried(state: ErrorState, gyro_rad_s: Vector3, accel_m_s2: Vector3) -> ErrorState:
    for step in range(1, STEPS + 1):
        state.advance(step * STEP_NS, gyro_rad_s, accel_m_s2)
    state.settle()
    return state


def _difference(a: ErrorState, b: ErrorState) -> Matrix:
    """b minus a, as an error of a."""
    parts = [
        np.subtract(b.nav.p_m, a.nav.p_m),
        np.subtract(b.nav.v_m_s, a.nav.v_m_s),
        log(multiply(b.nav.wxyz_site_body, conjugate(a.nav.wxyz_site_body))),
        np.subtract(b.biases.gyro_rad_s, a.biases.gyro_rad_s),
        np.subtract(b.biases.accel_m_s2, a.biases.accel_m_s2),
        b.gps_error - a.gps_error,
        [b.magnetic_rad - a.magnetic_rad],
        np.subtract(b.biases.gyro_axes, a.biases.gyro_axes).ravel(),
    ]
    for one, other in zip(a.clones, b.clones, strict=True):
        parts += [
            np.subtract(other.p_m, one.p_m),
            log(multiply(other.wxyz_site_body, conjugate(one.wxyz_site_body))),
        ]
    return np.concatenate([np.asarray(part) for part in parts])


@pytest.mark.parametrize("seed", range(5))
def test_the_covariance_follows_the_derivative_of_everything(seed: int) -> None:
    """Over a chunk of some samples, in which the rig turns by some degrees."""
    rng = np.random.default_rng(seed)
    start = _state(rng)
    gyro, accel = _vector(rng, 1.0), _vector(rng, 6.0)
    end = _carried(start.copied(), gyro, accel)
    F = np.zeros(start.covariance.shape)
    for index in range(len(F)):
        error = np.zeros(len(F))
        error[index] = 1e-5
        ahead, behind = start.copied(), start.copied()
        ahead.move(error)
        behind.move(-error)
        F[:, index] = _difference(_carried(behind, gyro, accel), _carried(ahead, gyro, accel)) / 2e-5
    expected = F @ start.covariance @ F.T
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((end.covariance - expected) / scale).max() < 5e-3
    assert np.abs(F[SIZE:, :SIZE]).max() < 1e-9, "what is held does not move"
    assert np.abs(F - np.eye(len(F))).max() > 0.01, "something has"
