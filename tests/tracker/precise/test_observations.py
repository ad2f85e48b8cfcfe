"""Every Jacobian of a measurement against differences, at states and measurements drawn by chance."""

import inspect
from collections.abc import Callable

import numpy as np
import pytest
from numpy.random import Generator

from tracker.geometry import normalise
from tracker.measurements import Matrix, Vector3, Wxyz
from tracker.precise import observations
from tracker.precise.error_model import THETA, start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings
from tracker.precise.update import Observation

SETTINGS = PreciseSettings()
LEVER: Vector3 = (0.1, -0.2, 0.3)
Sensor = Callable[[ErrorState], Observation | None]


def _vector(rng: Generator, scale: float = 1.0) -> Vector3:
    x, y, z = (scale * rng.normal(size=3)).tolist()
    return (x, y, z)


def _attitude(rng: Generator) -> Wxyz:
    w, x, y, z = rng.normal(size=4).tolist()
    return normalise((w, x, y, z))


def _state(rng: Generator) -> ErrorState:
    """A state, all of it anywhere."""
    state = ErrorState(
        SETTINGS,
        Navigation(0, _vector(rng), _vector(rng), _attitude(rng)),
        Biases(),
        start_covariance(SETTINGS, (1.0, 1.0, 1.0), 1.0, 1.0),
        9.8,
    )
    state.move(0.5 * rng.normal(size=len(state.covariance)))
    return state


def _numeric(state: ErrorState, sensor: Sensor) -> Matrix:
    columns = []
    for index in range(len(state.covariance)):
        error = np.zeros(len(state.covariance))
        error[index] = 1e-6
        ahead, behind = state.copied(), state.copied()
        ahead.move(error)
        behind.move(-error)
        (a, _), (b, _) = _seen(sensor, ahead), _seen(sensor, behind)
        columns.append((b - a) / 2e-6)
    return np.stack(columns, axis=1)


def _seen(sensor: Sensor, state: ErrorState) -> Observation:
    seen = sensor(state)
    assert seen is not None
    return seen


def _magnetometer(rng: Generator, state: ErrorState) -> Sensor:
    x, y, z = (state.R_site_body.T @ np.array([0.05, 0.25, -0.4])).tolist()
    return lambda s: observations.magnetic_yaw(s, (x, y, z), 0.1)


def _landmark(rng: Generator, state: ErrorState) -> Sensor:
    point = _vector(rng, 10.0)
    to = np.array(point) - state.nav.p_m - state.R_site_body @ np.array(LEVER)
    x, y, z = (state.R_site_body.T @ to / np.linalg.norm(to)).tolist()
    return lambda s: observations.bearing(s, point, (x, y, z), LEVER)


def _pictures(rng: Generator, state: ErrorState) -> Sensor:
    state.hold(1)
    state.move(0.5 * rng.normal(size=len(state.covariance)))
    R_held_now = state.clones[0].R_site_body.T @ state.R_site_body
    return lambda s: observations.turn(s, 0, R_held_now)


SENSORS: dict[str, Callable[[Generator, ErrorState], Sensor]] = {
    "gps_position": lambda rng, _: lambda s: observations.gps_position(s, (1.0, 2.0, 3.0), (2.0, 2.0, 4.0), LEVER),
    "gps_velocity": lambda rng, _: lambda s: observations.gps_velocity(s, (1.0, 2.0, 3.0), (0.1, 0.2, 0.3), LEVER),
    "velocity": lambda rng, _: lambda s: observations.velocity(s, (0.0, 0.0, 0.0)),
    "turn_rate": lambda rng, _: lambda s: observations.turn_rate(s, (0.01, 0.02, 0.03)),
    "height": lambda rng, _: lambda s: observations.height(s, 1.6),
    "position": lambda rng, _: lambda s: observations.position(s, (1.0, 2.0, 3.0)),
    "magnetic_yaw": _magnetometer,
    "bearing": _landmark,
    "turn": _pictures,
}


def _dense(state: ErrorState, sensor: Sensor) -> Matrix:
    residual, blocks = _seen(sensor, state)
    H = np.zeros((len(residual), len(state.covariance)))
    for columns, block in blocks:
        H[:, columns] += block
    return H


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", SENSORS)
def test_jacobians(name: str, seed: int) -> None:
    """Where what is seen is what the state foresees, so far as that matters."""
    rng = np.random.default_rng([seed, len(name)])
    state = _state(rng)
    sensor = SENSORS[name](rng, state)
    assert _dense(state, sensor) == pytest.approx(_numeric(state, sensor), abs=1e-7)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", ["bearing", "magnetic_yaw"])
def test_jacobians_hold_near_by(name: str, seed: int) -> None:
    """A state that is off by two degrees: the derivative of a direction changes by as much, and no more."""
    rng = np.random.default_rng([seed, len(name)])
    state = _state(rng)
    sensor = SENSORS[name](rng, state)
    error = np.zeros(len(state.covariance))
    error[THETA] = 0.02 * rng.normal(size=3)
    state.move(error)
    H = _dense(state, sensor)
    assert _dense(state, sensor) == pytest.approx(_numeric(state, sensor), abs=0.1 * np.abs(H).max())


def test_no_observation_is_left_out() -> None:
    functions = inspect.getmembers(observations, inspect.isfunction)
    own = {
        name
        for name, f in functions
        if f.__module__ == observations.__name__ and "state" in inspect.signature(f).parameters
    }
    assert own == set(SENSORS)
