"""How far an attitude drifts while the rig lies still, and how far it is from truth on a whole log; and what its rivals do there.

Everything is fed the same samples, of which the offset that our calibration found at rest has been subtracted.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tracker import rotations
from tracker.attitude import Madgwick
from tracker.calibration import MEAN_SAMPLES, REST_BLOCK_S, RestCalibration, SampleMean, at_rest
from tracker.measurements import ImuSample, Matrix, Vector3
from tracker.score import Figures, between

#: Standard gravity, in which the paper's table of offsets gives accelerations.
G_M_S2 = 9.80665
#: Madgwick's first second, and what the rivals need to find the tilt: not counted as drift.
SETTLING_S = 3.0
#: An attitude at one end of a rest is the mean over this time: what drifts, without what trembles.
MEAN_S = 1.0
#: Shorter rests say more of noise than of drift.
LEAST_REST_S = 10.0


@dataclass(frozen=True)
class Offsets:
    """What the calibration at rest found: the paper's table "Calibration parameters found for accelerometer and gyroscope"."""

    samples: int
    end_ns: int
    """When it was finished, or the last sample's stamp."""
    gyro_rad_s: Vector3
    accel_m_s2: Vector3
    """Mean at rest, gravity and the tilt of the table included, as the paper's: shown, never subtracted."""


@dataclass(frozen=True)
class Attitudes:
    """An attitude through time, level frame of its own: only turns within it mean something."""

    t_ns: NDArray[np.int64]
    """(n,)"""
    wxyz: Matrix
    """(n, 4)"""

    def between(self, begin_ns: int, end_ns: int) -> "Attitudes":
        """Return the part in [begin, end)."""
        use = (self.t_ns >= begin_ns) & (self.t_ns < end_ns)
        return Attitudes(self.t_ns[use], self.wxyz[use])


def calibrated(samples: Sequence[ImuSample]) -> Offsets:
    """Return the offsets of a log that begins at rest; zero for the gyroscope where it does not."""
    calibration, end_ns = RestCalibration(), samples[0].t_ns
    for sample in samples:
        calibration.step(sample)
        end_ns = sample.t_ns
        if calibration.finished:
            break
    accel = np.mean([sample.accel_m_s2 for sample in samples[: max(1, calibration.samples)]], axis=0)
    return Offsets(calibration.samples, end_ns, calibration.gyro_offset_rad_s, _vector(accel))


def without(samples: Sequence[ImuSample], gyro_offset_rad_s: Vector3) -> list[ImuSample]:
    """Return samples from which a gyroscope's offset is subtracted."""
    bx, by, bz = gyro_offset_rad_s
    return [
        ImuSample(s.t_ns, s.t_recv_ns, (s.gyro_rad_s[0] - bx, s.gyro_rad_s[1] - by, s.gyro_rad_s[2] - bz), s.accel_m_s2)
        for s in samples
    ]


def by_madgwick(samples: Sequence[ImuSample], mean_samples: int = MEAN_SAMPLES) -> Attitudes:
    """Return our attitude: the mean of up to four samples (the paper's), or each by itself, into Madgwick's filter."""
    filter_, group = Madgwick(), SampleMean(mean_samples)
    times, found = [], []
    for sample in samples:
        mean = group.step(sample)
        if mean is not None:
            times.append(mean.t_ns)
            found.append(filter_.update(mean.gyro_rad_s, mean.accel_m_s2, mean.dt_s))
    return Attitudes(np.array(times, np.int64), np.array(found))


def by_us(samples: Sequence[ImuSample]) -> Attitudes:
    """Return the attitude as the tracker has it: the offset followed while the rig lies still, mean of four, Madgwick's filter."""
    calibration, filter_, group = RestCalibration(), Madgwick(), SampleMean()
    times, found = [], []
    for sample in samples:
        calibration.step(sample)
        mean = group.step(sample)
        if mean is not None:
            (gx, gy, gz), (bx, by, bz) = mean.gyro_rad_s, calibration.gyro_offset_rad_s
            times.append(mean.t_ns)
            found.append(filter_.update((gx - bx, gy - by, gz - bz), mean.accel_m_s2, mean.dt_s))
    return Attitudes(np.array(times, np.int64), np.array(found))


def by_vqf(samples: Sequence[ImuSample]) -> Attitudes | None:
    """Return VQF's six-axis attitude with its own defaults (which go on estimating the offset); None where it is not installed."""
    try:
        from vqf import VQF
    except ImportError:
        return None
    period_s = _period_s(samples)
    gyro, accel = _arrays(samples)
    found = VQF(period_s).updateBatch(gyro, accel)["quat6D"]
    return Attitudes(_times(samples), np.asarray(found, float))


def by_imufusion(samples: Sequence[ImuSample]) -> Attitudes | None:
    """Return imufusion's six-axis attitude (Madgwick's later filter, its own defaults); None where it is not installed."""
    try:
        import imufusion
    except ImportError:
        return None
    times = _times(samples)
    gyro, accel = _arrays(samples)
    gyro_deg_s, accel_g = np.degrees(gyro), accel / G_M_S2
    steps_s = np.diff(times, prepend=times[0] - round(_period_s(samples) * 1e9)) * 1e-9
    filter_: Any = imufusion.Ahrs()
    found = []
    for step_s, w, f in zip(steps_s.tolist(), gyro_deg_s, accel_g, strict=True):
        filter_.set_sample_period(step_s)
        filter_.update_no_magnetometer(w, f)
        found.append(np.array(filter_.get_quaternion(), float))
    return Attitudes(times, np.array(found))


def drift_deg_min(attitudes: Attitudes) -> float | None:
    """Return how fast a resting rig's attitude turned, in degrees a minute; None for a rest too short to say."""
    t_s = (attitudes.t_ns - attitudes.t_ns[0]) * 1e-9 if len(attitudes.t_ns) else np.zeros(1)
    if t_s[-1] < LEAST_REST_S:
        return None
    first, last = (_mean(attitudes.wxyz[use]) for use in (t_s < MEAN_S, t_s > t_s[-1] - MEAN_S))
    half = min(1.0, abs(float(first @ last)))
    return float(np.degrees(2.0 * np.arccos(half)) / ((t_s[-1] - MEAN_S) / 60.0))


def error_figures(attitudes: Attitudes, t_true_ns: NDArray[np.int64], wxyz_true: Matrix) -> Figures:
    """Return root mean squares in degrees against truth: of the whole rotation, of heading and of tilt.

    Six axes do not know north: the mean heading of the first seconds is taken from truth, and what follows is drift.

    Args:
        attitudes: Estimated.
        t_true_ns: (n,) stamps of truth.
        wxyz_true: (n, 4).
    """
    rows = np.searchsorted(attitudes.t_ns, t_true_ns).clip(1, len(attitudes.t_ns) - 1)
    inside = (t_true_ns >= attitudes.t_ns[0]) & (t_true_ns <= attitudes.t_ns[-1])
    estimate = _between(attitudes, rows, t_true_ns)[inside]
    turn = rotations.multiply(estimate, rotations.conjugate(wxyz_true[inside]))
    heading = 2.0 * np.arctan2(turn[:, 3], turn[:, 0])
    start = t_true_ns[inside] - t_true_ns[inside][0] < MEAN_S * 1e9
    at_start = np.angle(np.mean(np.exp(1j * heading[start])))
    heading = np.angle(np.exp(1j * (heading - at_start)))
    tilt = 2.0 * np.arccos(np.clip(np.hypot(turn[:, 0], turn[:, 3]), 0.0, 1.0))
    whole = 2.0 * np.arccos(np.clip(np.cos(heading / 2.0) * np.cos(tilt / 2.0), 0.0, 1.0))
    return {
        name: float(np.degrees(np.sqrt(np.mean(angle**2))))
        for name, angle in (("whole", whole), ("heading", heading), ("tilt", tilt))
    }


def rests(samples: Sequence[ImuSample]) -> list[tuple[int, int]]:
    """Return begin and end of every stretch, at least `LEAST_REST_S` long, in which the rig lies still: half seconds at rest."""
    found: list[tuple[int, int]] = []
    block: list[ImuSample] = []
    begin_ns: int | None = None
    for sample in samples:
        block.append(sample)
        if sample.t_ns - block[0].t_ns < REST_BLOCK_S * 1e9:
            continue
        if at_rest(block):
            begin_ns = block[0].t_ns if begin_ns is None else begin_ns
        elif begin_ns is not None:
            found.append((begin_ns, block[0].t_ns))
            begin_ns = None
        block = []
    if begin_ns is not None:
        found.append((begin_ns, samples[-1].t_ns))
    return [(begin, end) for begin, end in found if end - begin >= LEAST_REST_S * 1e9]


def _between(attitudes: Attitudes, rows: NDArray[np.intp], t_ns: NDArray[np.int64]) -> Matrix:
    """Return attitudes at times between rows - 1 and rows: neighbours are so close that the chord is the arc."""
    before, after = attitudes.wxyz[rows - 1], attitudes.wxyz[rows]
    gap = np.maximum(attitudes.t_ns[rows] - attitudes.t_ns[rows - 1], 1)
    share = ((t_ns - attitudes.t_ns[rows - 1]) / gap)[:, None]
    return between(before, after, share)


def _mean(wxyz: Matrix) -> Matrix:
    total = np.sum(wxyz * np.where(wxyz @ wxyz[0] < 0.0, -1.0, 1.0)[:, None], axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _times(samples: Sequence[ImuSample]) -> NDArray[np.int64]:
    return np.array([sample.t_ns for sample in samples], np.int64)


def _arrays(samples: Sequence[ImuSample]) -> tuple[Matrix, Matrix]:
    return np.array([s.gyro_rad_s for s in samples]), np.array([s.accel_m_s2 for s in samples])


def _period_s(samples: Sequence[ImuSample]) -> float:
    return float(np.median(np.diff(_times(samples)))) * 1e-9


def _vector(values: Matrix) -> Vector3:
    x, y, z = values.tolist()
    return (x, y, z)
