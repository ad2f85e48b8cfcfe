"""The filter's covariance over many samples: walking, standing and turning, with and without each sensor.

What is measured is what the state foresees and a little noise, so that the state stays where the covariance has it. In CI a
hundred thousand samples, by tests/tracker/precise/test_endurance.py; `make bench` runs a million.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.random import Generator

from tests.tracker.precise.points import seen_from
from tracker.geometry import rotate
from tracker.measurements import Matrix, Vector3
from tracker.precise import observations
from tracker.precise.error_model import SIZE, start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.parallax import Cameras, constraint
from tracker.precise.settings import PreciseSettings
from tracker.precise.tracks import seen_in
from tracker.precise.update import Observation
from tracker.rig import R_BODY_CAM_FORWARD

GRAVITY_M_S2 = 9.8
RATE_HZ = 200
#: Phases of so many seconds follow each other: each has its own motion and its own sensors.
PHASE_S = 40
_LEVER: Vector3 = (0.1, -0.05, 0.2)
_SIGMA_M: Vector3 = (2.0, 2.0, 4.0)


@dataclass(frozen=True)
class Health:
    """A covariance at one time."""

    asymmetry: float
    """Largest difference of two correlations that should be one."""
    least_eigenvalue: float
    """Of the correlation matrix: zero or less is no covariance."""
    sigmas: Matrix
    """(n,) standard deviations."""


def health(cov: Matrix) -> Health:
    """Return how far a matrix is from no covariance."""
    sigmas = np.sqrt(np.diag(cov))
    correlation = cov / np.outer(sigmas, sigmas)
    asymmetry = float(np.abs(correlation - correlation.T).max())
    return Health(asymmetry, float(np.linalg.eigvalsh(0.5 * (correlation + correlation.T))[0]), sigmas)


def new_filter() -> ErrorState:
    """Return a filter that has just begun."""
    settings = PreciseSettings()
    nav = Navigation(0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    return ErrorState(settings, nav, Biases(), start_covariance(settings, (1.0, 1.0, 2.0), 1.0, 1.0), GRAVITY_M_S2)


def endure(samples: int, every: int) -> Iterator[Health]:
    """Take so many samples with all that is measured beside them; yield the covariance's health once in each `every`.

    Never when a picture has just been held: that is the present pose once more, and the covariance rightly singular.
    """
    state, rng = new_filter(), np.random.default_rng(1)
    for index in range(1, samples + 1):
        t_s, phase = index / RATE_HZ, index // (PHASE_S * RATE_HZ) % 6
        turning, walking = phase in (1, 4), phase in (0, 1, 3)
        gyro = (0.3 * sin(t_s), 0.2 * cos(1.3 * t_s), 2.0 * sin(0.7 * t_s)) if turning else (0.0, 0.0, 0.0)
        x, y, z = _up(state)
        swing = 2.0 * sin(11.0 * t_s) if walking else 0.0
        state.advance(round(index * 1e9 / RATE_HZ), gyro, (x + 0.3 * swing, y, z + swing))
        for observation, sigma, gated in _measured(state, index, phase, rng):
            residual, blocks = observation
            state.correct(sigma * rng.normal(size=len(residual)), blocks, sigma**2 * np.eye(len(residual)), gated=gated)
        if index % every == every // 2 + RATE_HZ // 8:
            state.settle()
            yield health(state.covariance)


def _up(state: ErrorState) -> Vector3:
    """Return what holds a rig up, in its own axes, so that it does not fall for a million samples."""
    w, x, y, z = state.nav.wxyz_site_body
    vx, vy, vz = state.nav.v_m_s
    return rotate((w, -x, -y, -z), (-0.5 * vx, -0.5 * vy, GRAVITY_M_S2 - 0.5 * vz))


def _measured(state: ErrorState, index: int, phase: int, rng: Generator) -> Iterator[tuple[Observation, float, bool]]:
    """Yield observations with their sigma, and whether they are gated."""
    zero = (0.0, 0.0, 0.0)
    if phase in (0, 1, 2, 4) and index % RATE_HZ == 0:
        yield observations.gps_position(state, zero, _SIGMA_M, _LEVER), 0.5, True
        yield observations.gps_velocity(state, zero, (0.1, 0.2, 0.3), _LEVER), 0.12, True
    if phase in (2, 5) and index % (RATE_HZ // 4) == 0:
        yield observations.velocity(state, zero), 0.03, True
        yield observations.turn_rate(state, zero), 0.012, True
        yield observations.height(state, 1.65), 0.3, True
    if phase in (1, 2) and index % (RATE_HZ // 2) == 0:
        yield observations.magnetic_yaw(state, (2e-5, 1e-5, -3e-5), 0.1), 0.05, True
    if phase in (0, 4) and index % (RATE_HZ // 8) == 0:
        yield from _seen(state, index, rng)
    if index % (10 * PHASE_S * RATE_HZ) == 0:
        # the surest that anybody can be
        yield observations.position(state, zero), 1e-4, False
        yield observations.bearing(state, (12.0, 3.0, 2.0), (1.0, 0.0, 0.0), _LEVER), 1e-5, False


def _seen(state: ErrorState, index: int, rng: Generator) -> Iterator[tuple[Observation, float, bool]]:
    """Yield what features ahead of the rig say of the pictures that are held."""
    if len(state.clones) >= 3:
        state.settle()
        R_site_body = np.array([clone.R_site_body for clone in state.clones])
        lever_m = R_site_body @ np.array(_LEVER)
        p_m = np.array([clone.p_m for clone in state.clones]) + lever_m
        cameras = Cameras(R_site_body @ R_BODY_CAM_FORWARD, p_m, lever_m)
        points_m = p_m[-1] + (cameras.R_site_cam[-1] @ rng.uniform((-5, -4, 6), (5, 4, 20), (12, 3)).T).T
        xy = seen_from(cameras.R_site_cam, cameras.p_site_m, points_m)
        xy = xy[seen_in(xy).sum(axis=1) >= 3]
        if len(xy):
            said = constraint(cameras, xy, 0.001, state.covariance[SIZE:, SIZE:], 9.0)
            yield (said.residual, [(slice(SIZE, SIZE + said.H.shape[1]), said.H)]), 1.0, False
    if index % (RATE_HZ // 4) == 0:
        state.hold(4)
    elif rng.uniform() < 0.05 and state.clones:
        state.forget(0)
