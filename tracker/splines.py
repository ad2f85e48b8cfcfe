"""Smooth functions of time with their first two derivatives: what a simulated body moves along; nothing of walking or sensors."""

from dataclasses import dataclass

import numpy as np

from tracker.measurements import Matrix


@dataclass(frozen=True, slots=True, eq=False)
class Jet:
    """A function at n instants with its first two time derivatives, each (n,). Arithmetic follows the chain rule."""

    value: Matrix
    rate: Matrix
    accel: Matrix

    def __add__(self, other: "Jet") -> "Jet":
        return Jet(self.value + other.value, self.rate + other.rate, self.accel + other.accel)

    def __sub__(self, other: "Jet") -> "Jet":
        return self + other * -1.0

    def __mul__(self, other: "Jet | float") -> "Jet":
        if not isinstance(other, Jet):
            return Jet(self.value * other, self.rate * other, self.accel * other)
        return Jet(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.accel * other.value + 2.0 * self.rate * other.rate + self.value * other.accel,
        )


def cos(angle: Jet) -> Jet:
    """Return the cosine of an angle in radians."""
    c, s = np.cos(angle.value), np.sin(angle.value)
    return Jet(c, -s * angle.rate, -s * angle.accel - c * angle.rate**2)


def sin(angle: Jet) -> Jet:
    """Return the sine of an angle in radians."""
    c, s = np.cos(angle.value), np.sin(angle.value)
    return Jet(s, c * angle.rate, c * angle.accel - s * angle.rate**2)


class Spline:
    """A uniform cubic B-spline (C2): it follows its control values closely and runs through them only where they are straight.

    Four equal control values in a row hold it exactly still between the middle two.
    """

    def __init__(self, controls: Matrix, interval_s: float) -> None:
        """Lay control value k at k * interval_s; `controls` is (m,), and its ends are held beyond both ends."""
        self._controls = np.pad(np.asarray(controls, dtype=np.float64), (1, 2), mode="edge")
        self._interval_s = interval_s
        self._segments = len(controls)

    def at(self, t_s: Matrix) -> Jet:
        """Return the spline at (n,) instants; time outside [0, m * interval_s] is taken as the nearer end."""
        position = np.clip(np.asarray(t_s, dtype=np.float64) / self._interval_s, 0.0, self._segments - 1e-9)
        k = position.astype(np.int64)
        u = position - k
        a, b, c, d = (self._controls[k + i] for i in range(4))
        # in differences from b, so that equal controls give the value exactly and derivatives of exactly zero
        da, dc, dd = a - b, c - b, d - b
        value = b + ((1.0 - u) ** 3 * da + (-3.0 * u**3 + 3.0 * u**2 + 3.0 * u + 1.0) * dc + u**3 * dd) / 6.0
        rate = (-((1.0 - u) ** 2) * da + (-3.0 * u**2 + 2.0 * u + 1.0) * dc + u**2 * dd) / 2.0
        accel = (1.0 - u) * da + (1.0 - 3.0 * u) * dc + u * dd
        return Jet(value, rate / self._interval_s, accel / self._interval_s**2)


def smoothed(samples: Matrix, sigma_s: float, interval_s: float) -> Matrix:
    """Return (m,) samples after a Gaussian of sigma_s, cut at three sigma: what is constant for longer stays exactly so."""
    half = int(np.ceil(3.0 * sigma_s / interval_s))
    weights = np.exp(-0.5 * (np.arange(-half, half + 1) * interval_s / sigma_s) ** 2)
    offset = samples[0]  # convolving differences from it keeps the first rest free of rounding
    smooth = np.convolve(np.pad(samples - offset, half, mode="edge"), weights / weights.sum(), mode="valid")
    return np.asarray(offset + smooth)


def slewed(samples: Matrix, limit_per_s: float, interval_s: float) -> Matrix:
    """Return (m,) samples that follow the given ones no faster than the limit."""
    step = limit_per_s * interval_s
    followed = np.array(samples, dtype=np.float64)
    for k in range(1, len(followed)):
        followed[k] = followed[k - 1] + min(step, max(-step, samples[k] - followed[k - 1]))
    return followed
