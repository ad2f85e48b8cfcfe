"""Attitude from the gyroscope alone, at any time within a recording: how the rig turned between two moments."""

from collections.abc import Sequence

import numpy as np

from tracker import geometry, rotations
from tracker.errors import InputError
from tracker.measurements import ImuSample, Matrix

#: Between samples further apart than this the turning is unknown.
LONGEST_GAP_S = 0.3


class GyroTrack:
    """The rig's turning, from samples in body axes, with rates taken as cubic from sample to sample.

    A chord cuts the crest of every swing: taken as straight, rates of 16 to 32 samples a second make a hand's turns too small, and
    a focal length that is found from them too long by as much.
    """

    def __init__(self, times_s: Matrix, rates_rad_s: Matrix) -> None:
        """Integrate.

        Args:
            times_s: (N,) rising, N >= 2.
            rates_rad_s: (N, 3).
        """
        self.times_s, self.rates_rad_s = times_s, rates_rad_s
        steps_s = np.diff(times_s)
        self._slopes_rad_s2 = _slopes(times_s, rates_rad_s)
        # what Hermite's cubic comes to over a whole step
        bend = (self._slopes_rad_s2[:-1] - self._slopes_rad_s2[1:]) * (steps_s / 12.0)[:, None]
        mean = 0.5 * (rates_rad_s[1:] + rates_rad_s[:-1]) + bend
        # the second-order term of Magnus' series: rates that turn within a step
        cross = np.cross(rates_rad_s[:-1], rates_rad_s[1:]) * (steps_s**2 / 12.0)[:, None]
        turns = rotations.exp(mean * steps_s[:, None] + cross)
        attitude, attitudes = geometry.IDENTITY, [geometry.IDENTITY]
        for w, x, y, z in turns.tolist():
            attitude = geometry.normalise(geometry.multiply(attitude, (w, x, y, z)))
            attitudes.append(attitude)
        self._attitudes = np.array(attitudes)
        self._gaps_s = steps_s

    @classmethod
    def of(cls, samples: Sequence[ImuSample], t_zero_ns: int) -> "GyroTrack":
        """Integrate samples; those whose time does not rise are left out.

        Raises:
            InputError: There are fewer than two.
        """
        kept: list[ImuSample] = []
        for sample in samples:
            if not kept or sample.t_ns > kept[-1].t_ns:
                kept.append(sample)
        if len(kept) < 2:
            raise InputError("There is no gyroscope in this: `agora calibrate rig` needs one beside the camera.")
        times = np.array([(sample.t_ns - t_zero_ns) * 1e-9 for sample in kept])
        return cls(times, np.array([sample.gyro_rad_s for sample in kept]))

    def without(self, bias_rad_s: Matrix) -> "GyroTrack":
        """Return the track of the same rates with a bias taken off."""
        return GyroTrack(self.times_s, self.rates_rad_s - bias_rad_s)

    def knows(self, begin_s: Matrix, end_s: Matrix) -> Matrix:
        """Return (N,) bool: whether the turning is known all the way from each time to the other."""
        first = np.searchsorted(self.times_s, begin_s, side="right") - 1
        last = np.searchsorted(self.times_s, end_s, side="left")
        inside = (first >= 0) & (last < len(self.times_s))
        gaps = np.concatenate([[0], np.cumsum(self._gaps_s > LONGEST_GAP_S)])
        count = len(gaps) - 1
        return np.asarray(inside & (gaps[np.clip(last, 0, count)] == gaps[np.clip(first, 0, count)]))

    def between(self, begin_s: Matrix, end_s: Matrix) -> Matrix:
        """Return (N, 4) quaternions that map body coordinates at the end to those at the beginning."""
        return rotations.multiply(rotations.conjugate(self._at(begin_s)), self._at(end_s))

    def _at(self, t_s: Matrix) -> Matrix:
        k = np.clip(np.searchsorted(self.times_s, t_s, side="right") - 1, 0, len(self.times_s) - 2)
        step_s, into_s = self._gaps_s[k][:, None], (t_s - self.times_s[k])[:, None]
        x = into_s / step_s
        begin, end = self._slopes_rad_s2[k], self._slopes_rad_s2[k + 1]
        rise = (self.rates_rad_s[k + 1] - self.rates_rad_s[k]) / step_s
        # the integral of Hermite's cubic, in Newton's form
        second, third = rise - begin, begin + end - 2.0 * rise
        turned = self.rates_rad_s[k] + into_s * (begin / 2.0 + x * (second / 3.0 + (x / 4.0 - 1.0 / 3.0) * third))
        return rotations.multiply(self._attitudes[k], rotations.exp(turned * into_s))


def _slopes(times_s: Matrix, rates_rad_s: Matrix) -> Matrix:
    """Return (N, 3) the rates' change at each sample, between its neighbours: samples close together make no noise of it."""
    inner = (rates_rad_s[2:] - rates_rad_s[:-2]) / (times_s[2:] - times_s[:-2])[:, None]
    ends = np.diff(rates_rad_s[[0, 1, -2, -1]], axis=0)[[0, 2]] / np.diff(times_s[[0, 1, -2, -1]])[[0, 2], None]
    return np.concatenate([ends[:1], inner, ends[1:]])
