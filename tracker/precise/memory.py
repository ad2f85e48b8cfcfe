"""What a rig has learned that outlives its filter: sensor biases and the receiver's error, for the next start of the same rig.

An alignment (a landmark pointed out, a known place) tells the receiver's error, which lasts for minutes; where the rig stands and
looks is for the next start to find out. What is remembered fades as it would have in the filter, until it is as if nothing were
known. As text it is TOML, which people can read and which is checked like anything that comes from outside. Pure.
"""

import tomllib
from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from tracker.errors import MalformedInput
from tracker.measurements import Matrix, Vector3
from tracker.precise.error_model import BA, BG, GPS_ERROR
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases
from tracker.precise.settings import PreciseSettings

#: States that are kept: both biases, then the receiver's error.
KEPT = slice(BG.start, GPS_ERROR.stop)
SIZE = KEPT.stop - KEPT.start
_GYRO, _ACCEL, _RECEIVER = (slice(s.start - KEPT.start, s.stop - KEPT.start) for s in (BG, BA, GPS_ERROR))
#: No sensor that a filter could live with is off by more: rad/s, m/s2, and the receiver in units of its sigma, which may have been
#: a hundred times as large when the error was told.
_LARGEST = np.array([0.5] * 3 + [5.0] * 3 + [3000.0] * (SIZE - 6))
_LARGEST_SIGMA_M = 1e4
_LONGEST_TEXT = 65_536
#: Memories of earlier versions lack it.
_SIGMA = "receiver_sigma_m"
_NAMES = {"gyro_bias_rad_s": _GYRO, "accel_bias_m_s2": _ACCEL, "receiver_error": _RECEIVER}


@dataclass(frozen=True, eq=False)
class Memory:
    """Kept states and their covariance, as of a time by a clock that the next start has too."""

    t_ns: int
    mean: Matrix
    """(15,): gyro bias (rad/s), accelerometer bias (m/s²), and the receiver's error in units of its stated sigma."""
    covariance: Matrix
    """(15, 15)."""
    receiver_sigma_m: Vector3 | None = None
    """That sigma; None where it was not kept."""


def remember(state: ErrorState) -> Memory:
    """Return what a filter has learned of its sensors."""
    state.settle()
    mean = np.array([*state.biases.gyro_rad_s, *state.biases.accel_m_s2, *state.gps_error])
    covariance = state.covariance[KEPT, KEPT]
    symmetric = 0.5 * (covariance + covariance.T)  # a prediction leaves it so but for rounding
    return Memory(state.nav.t_ns, mean, symmetric, state.gps_sigma_m)


def recall(state: ErrorState, memory: Memory) -> None:
    """Give a filter that has just begun what was remembered; a memory from the future is left out, for its clock is another one."""
    if memory.t_ns > state.nav.t_ns:
        return
    faded = _faded(memory, state.nav.t_ns, state.settings)
    (gx, gy, gz), (ax, ay, az) = faded.mean[_GYRO].tolist(), faded.mean[_ACCEL].tolist()
    state.biases = Biases((gx, gy, gz), (ax, ay, az))
    state.gps_error, state.gps_sigma_m = faded.mean[_RECEIVER].copy(), memory.receiver_sigma_m
    state.covariance[KEPT, :] = state.covariance[:, KEPT] = 0.0
    state.covariance[KEPT, KEPT] = faded.covariance


def _faded(memory: Memory, t_ns: int, settings: PreciseSettings) -> Memory:
    """Return a memory as it is later: every state forgets towards what is known of it at a start.

    A bias that wanders at a known rate about a known spread has the correlation time of a first-order Gauss-Markov process.
    """
    spread, walk = (
        np.repeat((gyro, accel), 3)
        for gyro, accel in (
            (settings.gyro_bias_rad_s, settings.accel_bias_m_s2),
            (settings.gyro_bias_walk_rad_s2_sqrt_hz, settings.accel_bias_walk_m_s3_sqrt_hz),
        )
    )
    times_s = np.concatenate([2.0 * (spread / walk) ** 2, np.repeat(settings.gps_error_s, 3)])
    kept = np.exp(-(t_ns - memory.t_ns) * 1e-9 / times_s)
    new = np.concatenate([spread**2 * (1.0 - kept[:6] ** 2), forgotten(memory, t_ns, settings)])
    covariance = kept[:, None] * memory.covariance * kept + np.diag(new)
    return Memory(t_ns, kept * memory.mean, covariance, memory.receiver_sigma_m)


def forgotten(memory: Memory, t_ns: int, settings: PreciseSettings) -> Matrix:
    """Return what a receiver's error varies by that has come up since it was remembered, (9,), in units of its stated variance."""
    kept = np.exp(-max(0, t_ns - memory.t_ns) * 1e-9 / np.repeat(settings.gps_error_s, 3))
    return np.asarray(np.repeat(settings.gps_error_share, 3) * (1.0 - kept**2))


# -- as text ----------------------------------------------------------------------------------------------------------


def to_toml(memory: Memory) -> str:
    """Return the memory as TOML, to the last bit."""
    lines = [
        "# What this rig has learned of its sensors; it fades within minutes to hours. Delete it to begin anew.",
        f"t_ns = {memory.t_ns}",
        *(f"{name} = {memory.mean[where].tolist()}" for name, where in _NAMES.items()),
        *([f"{_SIGMA} = {list(memory.receiver_sigma_m)}"] if memory.receiver_sigma_m else []),
        "covariance = [",
        *(f"    {row}," for row in memory.covariance.tolist()),
        "]",
    ]
    return "\n".join(lines) + "\n"


def from_toml(text: str) -> Memory:
    """Read what `to_toml` wrote.

    Raises:
        MalformedInput: It is not that, or holds what no filter can have learned.
    """
    if len(text) > _LONGEST_TEXT:
        raise MalformedInput(f"A rig's memory is {len(text)} characters long, expected at most {_LONGEST_TEXT}.")
    try:
        table = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise MalformedInput("A rig's memory is no TOML: delete the file, and it is written anew.") from error
    if table.keys() - {_SIGMA} != {"t_ns", "covariance", *_NAMES}:
        raise MalformedInput(f"A rig's memory has {', '.join(table) or 'nothing'}, expected other names.")
    t_ns = table["t_ns"]
    if type(t_ns) is not int or not 0 <= t_ns < 2**63:
        raise MalformedInput("The time of a rig's memory is not a number of nanoseconds.")
    mean = np.concatenate([_row(table[name], where.stop - where.start) for name, where in _NAMES.items()])
    rows = table["covariance"]
    if not isinstance(rows, list) or len(rows) != SIZE:
        raise MalformedInput(f"The covariance of a rig's memory has not {SIZE} rows.")
    covariance = np.array([_row(row, SIZE) for row in rows])
    if np.any(np.abs(mean) > _LARGEST) or not _is_covariance(covariance):
        raise MalformedInput("A rig's memory holds numbers that no sensor can have.")
    return Memory(t_ns, mean, covariance, _sigma(table[_SIGMA]) if _SIGMA in table else None)


def _sigma(values: Any) -> Vector3:
    x, y, z = _row(values, 3).tolist()
    if not 0.0 < min(x, y, z) <= max(x, y, z) < _LARGEST_SIGMA_M:
        raise MalformedInput("A rig's memory holds a claim that no receiver makes.")
    return x, y, z


def _row(values: Any, length: int) -> Matrix:
    if (
        not isinstance(values, list)
        or len(values) != length
        or not all(type(v) in (int, float) and abs(v) < 1e6 and isfinite(v) for v in values)
    ):
        raise MalformedInput(f"A rig's memory has not {length} numbers where they are expected.")
    return np.array(values, np.float64)


def _is_covariance(matrix: Matrix) -> bool:
    variances = np.diag(matrix)
    if not np.array_equal(matrix, matrix.T) or np.any(variances <= 0.0) or np.any(variances > _LARGEST**2):
        return False
    sigma = np.sqrt(variances)
    return bool(np.linalg.eigvalsh(matrix / np.outer(sigma, sigma))[0] > 0.0)
