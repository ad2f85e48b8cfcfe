"""`vqf` and `imufusion`: six-axis attitude with the libraries' own defaults, and no position.

Both take samples at an even rate; ours come in pairs, with gaps, so what they are fed is interpolated to even times.
"""

from collections.abc import Iterator, Sequence
from itertools import islice, pairwise
from math import isfinite
from statistics import median
from typing import Any, Protocol

import imufusion
import numpy as np
from vqf import VQF

from tests.benchmarks.accuracy.rivals.online import follow
from tracker.estimator import NO_MOTION_MODEL, Origin, Pose
from tracker.geometry import exp, multiply, normalise
from tracker.measurements import ImuSample, Measurement, Vector3, Wxyz
from tracker.precise.navigation import sample_between
from tracker.rig import Rig

#: In which accelerations are given to imufusion.
G_M_S2 = 9.80665
#: The rate is the median over so many first intervals: from what a sensor's data sheet says, which a library asks for as well.
RATE_SAMPLES = 200
#: Gaps longer than this are not filled.
LONGEST_GAP_NS = 500_000_000


class Filter(Protocol):
    """An attitude filter of samples at an even rate."""

    def update(self, sample: ImuSample) -> Wxyz:
        """Take the next sample and return the attitude against a level frame of arbitrary yaw."""
        ...


class Vqf:
    """VQF with its own estimate of the gyroscope's offset."""

    def __init__(self, period_s: float) -> None:
        self._filter = VQF(period_s)

    def update(self, sample: ImuSample) -> Wxyz:
        """Take the next sample and return the attitude against a level frame of arbitrary yaw."""
        self._filter.update(np.array(sample.gyro_rad_s), np.array(sample.accel_m_s2))
        w, x, y, z = self._filter.getQuat6D().tolist()
        return (w, x, y, z)


class Imufusion:
    """imufusion's filter behind its own estimate of the gyroscope's offset."""

    def __init__(self, period_s: float) -> None:
        settings: Any = imufusion.BiasSettings()
        settings.sample_rate = 1.0 / period_s
        self._bias: Any = imufusion.Bias()
        self._bias.set_settings(settings)
        self._filter: Any = imufusion.Ahrs()
        self._filter.set_sample_period(period_s)

    def update(self, sample: ImuSample) -> Wxyz:
        """Take the next sample and return the attitude against a level frame of arbitrary yaw."""
        gyro_deg_s = self._bias.update(np.degrees(sample.gyro_rad_s))
        self._filter.update_no_magnetometer(gyro_deg_s, np.array(sample.accel_m_s2) / G_M_S2)
        w, x, y, z = np.array(self._filter.get_quaternion(), float).tolist()
        return normalise((w, x, y, z))


class Even:
    """Samples at an even rate out of those that came."""

    def __init__(self, period_ns: int) -> None:
        self._period_ns = period_ns
        self._last: ImuSample | None = None
        self._due_ns = 0

    def add(self, sample: ImuSample) -> Iterator[ImuSample]:
        """Take a sample and yield the even ones until its stamp."""
        last = self._last
        if not isfinite(sum(sample.gyro_rad_s) + sum(sample.accel_m_s2)) or (last and sample.t_ns <= last.t_ns):
            return
        self._last = sample
        if last is None or sample.t_ns - last.t_ns > LONGEST_GAP_NS:
            self._due_ns = sample.t_ns + self._period_ns
            yield sample
            return
        while self._due_ns <= sample.t_ns:
            yield sample_between(last, sample, self._due_ns)
            self._due_ns += self._period_ns


class Attitude:
    """An attitude filter run live."""

    def __init__(self, filter_: Filter, period_s: float) -> None:
        self._filter, self._even = filter_, Even(round(period_s * 1e9))
        self._rate_rad_s: Vector3 = (0.0, 0.0, 0.0)
        self._t_ns = 0
        self.wxyz_level_body: Wxyz | None = None
        """At the newest even sample; None before the first."""

    def add(self, measurement: Measurement) -> None:
        """Take the next measurement to arrive."""
        if not isinstance(measurement, ImuSample):
            return
        for sample in self._even.add(measurement):
            self.wxyz_level_body = self._filter.update(sample)
            self._t_ns, self._rate_rad_s = sample.t_ns, sample.gyro_rad_s

    def at(self, t_ns: int) -> Wxyz | None:
        """Return the attitude at a time, which is now: turned on with the last rate for the few milliseconds since."""
        if self.wxyz_level_body is None:
            return None
        dt_s = min(max(t_ns - self._t_ns, 0) * 1e-9, 0.1)
        x, y, z = self._rate_rad_s
        return normalise(multiply(self.wxyz_level_body, exp((x * dt_s, y * dt_s, z * dt_s))))

    def pose(self, t_ns: int) -> Pose | None:
        """Return the attitude as a pose that stands at the origin."""
        wxyz = self.at(t_ns)
        if wxyz is None:
            return None
        zero = (0.0, 0.0, 0.0)
        return Pose(t_ns, zero, wxyz, zero, np.zeros((6, 6)), NO_MOTION_MODEL, heading_known=False)


def period_s(measurements: Sequence[Measurement]) -> float | None:
    """Return the usual time between inertial samples; None where there are fewer than two."""
    stamps = (m.t_ns for m in measurements if isinstance(m, ImuSample))
    gaps = [b - a for a, b in pairwise(islice(stamps, RATE_SAMPLES)) if b > a]
    return median(gaps) * 1e-9 if gaps else None


def by_vqf(measurements: Sequence[Measurement], origin: Origin, rig: Rig, ticks: Sequence[int]) -> list[Pose]:
    """Return VQF's attitude at ticks."""
    period = period_s(measurements)
    return [] if period is None else follow(Attitude(Vqf(period), period), measurements, ticks)


def by_imufusion(measurements: Sequence[Measurement], origin: Origin, rig: Rig, ticks: Sequence[int]) -> list[Pose]:
    """Return imufusion's attitude at ticks."""
    period = period_s(measurements)
    return [] if period is None else follow(Attitude(Imufusion(period), period), measurements, ticks)
