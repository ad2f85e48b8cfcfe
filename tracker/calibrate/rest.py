"""`agora calibrate imu`: bias and noise of an inertial unit that lies still; it refuses one that does not. Numpy only.

One rest tells the gyroscope's bias, and of the accelerometer the length of what it says, which is scale and bias in one. Rests in
six attitudes or more tell both apart for each axis, since gravity has the same length in all of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tracker.errors import InputError
from tracker.measurements import ImuSample, Matrix

#: A rest shorter than this tells too little.
LEAST_S = 10.0
#: ... one of several, each.
LEAST_SIDE_S = 3.0
LEAST_SIDES = 6
#: Two rests are two attitudes where gravity's direction differs by this.
_OTHER_SIDE_RAD = np.radians(25.0)
_BLOCK_S = 0.5
#: Within a block no axis of the gyroscope spreads wider: a table's 0.002, a hand's 0.02 and more.
LARGEST_GYRO_STD_RAD_S = 0.015
LARGEST_ACCEL_STD_M_S2 = 0.15
#: Blocks' means differ by noise and by this at most; a person who stands sways by ten times as much.
LARGEST_DRIFT_RAD_S = 0.0012
LARGEST_TILT_RAD = np.radians(0.2)
#: No unit that can be used is off by more.
LARGEST_BIAS_RAD_S = 0.2
LARGEST_SCALE_ERROR = 0.1


@dataclass(frozen=True, eq=False)
class RestFit:
    """What a rest tells; vectors are (3,), in the unit's own axes."""

    gyro_bias_rad_s: Matrix
    gyro_bias_sigma_rad_s: Matrix
    accel_bias_m_s2: Matrix
    accel_scale: Matrix
    gyro_noise_rad_s_sqrt_hz: Matrix
    accel_noise_m_s2_sqrt_hz: Matrix
    norm_m_s2: float
    """Length of the specific force at rest, before correction."""
    duration_s: float
    rate_hz: float
    attitudes: int


@dataclass(frozen=True, eq=False)
class _Samples:
    t_s: Matrix
    gyro: Matrix
    accel: Matrix

    def between(self, begin: int, end: int) -> "_Samples":
        return _Samples(self.t_s[begin:end], self.gyro[begin:end], self.accel[begin:end])


def fit_rest(samples: Sequence[ImuSample], R_body_imu: Matrix, gravity_m_s2: float) -> RestFit:
    """Return what one rest tells.

    Args:
        samples: All of one rest, in body axes as sources give them.
        R_body_imu: (3, 3).
        gravity_m_s2: Where the rig lies.

    Raises:
        InputError: The rig moved, the rest is too short, or the unit says what none says; with time, amount and remedy.
    """
    data = _arrays(samples, R_body_imu)
    blocks = _blocks(data)
    if len(blocks) * _BLOCK_S < LEAST_S:
        raise InputError(
            f"The rest is {_span(data):.1f} s long, expected at least {LEAST_S:g}: leave the rig alone for longer."
        )
    usual = _usual(data, blocks)
    for begin, end in blocks:
        moved = _moved(data.between(begin, end), usual)
        if moved:
            raise InputError(
                f"The rig moved {data.t_s[begin] - data.t_s[0]:.1f} s after the start ({moved}): "
                "lay it on something firm, let go of it, and try again."
            )
    return _fit([data], gravity_m_s2)


def fit_sides(samples: Sequence[ImuSample], R_body_imu: Matrix, gravity_m_s2: float) -> RestFit:
    """Return what rests in several attitudes tell; what lies between them is left out.

    Raises:
        InputError: There are rests in fewer than six attitudes.
    """
    rests = _rests(_arrays(samples, R_body_imu))
    directions = np.array([rest.accel.mean(axis=0) / np.linalg.norm(rest.accel.mean(axis=0)) for rest in rests])
    sides: list[int] = []
    for i, direction in enumerate(directions):
        if all(direction @ directions[k] < np.cos(_OTHER_SIDE_RAD) for k in sides):
            sides.append(i)
    if len(sides) < LEAST_SIDES:
        raise InputError(
            f"The rig rested in {len(sides)} attitudes for {LEAST_SIDE_S:g} s or more, expected at least {LEAST_SIDES}: "
            "lay it on each of its six sides for five seconds."
        )
    return _fit(rests, gravity_m_s2, len(sides))


def longest_rest(samples: Sequence[ImuSample]) -> Sequence[ImuSample]:
    """Return the longest stretch of a recording in which the rig lay still, which may be empty."""
    if len(samples) < 2:
        return []
    rests = _rests(_arrays(samples, np.eye(3)))
    if not rests:
        return []
    best = max(rests, key=_span)
    begin_ns, end_ns = (samples[0].t_ns + round(float(best.t_s[k]) * 1e9) for k in (0, -1))
    return [sample for sample in samples if begin_ns <= sample.t_ns <= end_ns]


def _arrays(samples: Sequence[ImuSample], R_body_imu: Matrix) -> _Samples:
    kept: list[ImuSample] = []
    for sample in samples:
        if not kept or sample.t_ns > kept[-1].t_ns:
            kept.append(sample)
    if len(kept) < 20:
        raise InputError(f"There are {len(kept)} inertial samples in this: is the inertial unit attached?")
    return _Samples(
        np.array([(sample.t_ns - kept[0].t_ns) * 1e-9 for sample in kept]),
        np.array([sample.gyro_rad_s for sample in kept]) @ R_body_imu,
        np.array([sample.accel_m_s2 for sample in kept]) @ R_body_imu,
    )


def _span(data: _Samples) -> float:
    return float(data.t_s[-1] - data.t_s[0])


def _blocks(data: _Samples) -> list[tuple[int, int]]:
    """Return begin and end of half-second blocks; a block with fewer than four samples, beside a gap, is left out."""
    edges = np.searchsorted(data.t_s, np.arange(data.t_s[0], data.t_s[-1] + 1e-9, _BLOCK_S))
    return [(int(a), int(b)) for a, b in pairwise(edges) if b - a >= 4]


@dataclass(frozen=True, eq=False)
class _Usual:
    """What blocks are compared with."""

    gyro: Matrix
    direction: Matrix
    gyro_sigma: Matrix
    tilt_sigma: float


def _usual(data: _Samples, blocks: Sequence[tuple[int, int]]) -> _Usual:
    """Return the median of the blocks that are still in themselves, if any are, and how far noise alone takes blocks from it."""
    still = [(a, b) for a, b in blocks if float(np.std(data.gyro[a:b], axis=0).max()) <= LARGEST_GYRO_STD_RAD_S]
    blocks = still or blocks
    gyros = np.array([data.gyro[a:b].mean(axis=0) for a, b in blocks])
    accels = np.array([data.accel[a:b].mean(axis=0) for a, b in blocks])
    size = float(np.median([b - a for a, b in blocks]))
    accel = np.median(accels, axis=0)
    norm = max(float(np.linalg.norm(accel)), 1e-6)
    gyro_sigma = np.median([_white(data.gyro[a:b]) for a, b in blocks], axis=0) / np.sqrt(size)
    tilt_sigma = float(np.max(np.median([_white(data.accel[a:b]) for a, b in blocks], axis=0))) / np.sqrt(size) / norm
    return _Usual(np.median(gyros, axis=0), accel / norm, gyro_sigma, tilt_sigma)


def _white(values: Matrix) -> Matrix:
    """Return the (3,) standard deviations of what changes from sample to sample: noise, and not motion."""
    return np.asarray(np.std(np.diff(values, axis=0), axis=0) / np.sqrt(2.0))


def _moved(block: _Samples, usual: _Usual) -> str:
    """Return how a block moved, or nothing."""
    spread = float(np.std(block.gyro, axis=0).max())
    if spread > LARGEST_GYRO_STD_RAD_S:
        return f"its turning spread by {np.degrees(spread):.1f} degrees/s"
    off = np.abs(block.gyro.mean(axis=0) - usual.gyro)
    if np.any(off > LARGEST_DRIFT_RAD_S + 5.0 * usual.gyro_sigma):
        return f"it turned at {np.degrees(off.max()):.2f} degrees/s"
    shaken = float(np.std(np.linalg.norm(block.accel, axis=1)))
    if shaken > LARGEST_ACCEL_STD_M_S2:
        return f"it was shaken by {shaken:.2f} m/s²"
    accel = block.accel.mean(axis=0)
    tilt = float(np.linalg.norm(np.cross(accel / max(float(np.linalg.norm(accel)), 1e-6), usual.direction)))
    if tilt > LARGEST_TILT_RAD + 5.0 * usual.tilt_sigma:
        return f"it tilted by {np.degrees(tilt):.1f} degrees"
    return ""


def _rests(data: _Samples) -> list[_Samples]:
    """Return the stretches of at least three seconds in which nothing moved, each grown block by block from a still one."""
    found: list[_Samples] = []
    run: list[tuple[int, int]] = []
    for block in [*_blocks(data), None]:
        if block is not None:
            trial = [*run, block]
            usual = _usual(data, trial)
            if not any(_moved(data.between(*one), usual) for one in (trial[0], trial[len(trial) // 2], block)):
                run = trial
                continue
        if len(run) * _BLOCK_S >= LEAST_SIDE_S + 2 * _BLOCK_S:
            # the first and last block may hold the end of a motion
            found.append(data.between(run[1][0], run[-2][1]))
        run = [] if block is None or _moved(data.between(*block), _usual(data, [block])) else [block]
    return found


def _fit(rests: Sequence[_Samples], gravity_m_s2: float, attitudes: int = 1) -> RestFit:
    gyro = np.concatenate([rest.gyro for rest in rests])
    means = np.array([rest.accel.mean(axis=0) for rest in rests])
    blocks = np.array([rest.gyro[a:b].mean(axis=0) for rest in rests for a, b in _blocks(rest)])
    period_s = float(np.median(np.concatenate([np.diff(rest.t_s) for rest in rests])))
    root_hz = np.sqrt(period_s)
    norm = float(np.mean(np.linalg.norm(means, axis=1)))
    bias, scale = (
        (np.zeros(3), np.full(3, gravity_m_s2 / norm)) if attitudes < LEAST_SIDES else _gravity(means, gravity_m_s2)
    )
    gyro_bias = gyro.mean(axis=0)
    if float(np.abs(gyro_bias).max()) > LARGEST_BIAS_RAD_S or np.any(np.abs(scale - 1.0) > LARGEST_SCALE_ERROR):
        raise InputError(
            f"At rest the gyroscope says {np.degrees(np.abs(gyro_bias).max()):.1f} degrees/s and the accelerometer "
            f"{norm:.2f} m/s²: no sound unit does; is the right one attached, and are its units right?"
        )
    return RestFit(
        gyro_bias,
        np.std(blocks, axis=0) / np.sqrt(len(blocks)),
        bias,
        scale,
        np.median([_white(rest.gyro) for rest in rests], axis=0) * root_hz,
        np.median([_white(rest.accel) for rest in rests], axis=0) * root_hz,
        norm,
        sum(_span(rest) for rest in rests),
        1.0 / period_s,
        attitudes,
    )


def _gravity(means: Matrix, gravity_m_s2: float) -> tuple[Matrix, Matrix]:
    """Return bias and scale, (3,) each, that bring all (N, 3) means to gravity's length (Gauss-Newton; N >= 6)."""
    bias, scale = np.zeros(3), np.ones(3)
    for _ in range(20):
        fixed = (means - bias) * scale
        lengths = np.linalg.norm(fixed, axis=1)
        units = fixed / lengths[:, None]
        slopes = np.column_stack([-units * scale, units * (means - bias)])
        # a hair of damping: sides that are nearly the same leave some combination free
        step = np.linalg.solve(slopes.T @ slopes + 1e-9 * np.eye(6), slopes.T @ (gravity_m_s2 - lengths))
        bias, scale = bias + step[:3], scale + step[3:]
    return bias, scale
