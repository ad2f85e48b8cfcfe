"""A hand that pans, nods and tilts a rig, and the gyroscope that feels it: smooth random turning with planted errors."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from tracker import rotations
from tracker.calibrate.gyro_track import GyroTrack
from tracker.measurements import ImuSample, Matrix

_STEP_S = 0.002


@dataclass(frozen=True, eq=False)
class RigMotion:
    """Turning of the body over a time, known at every moment."""

    seed: int
    duration_s: float = 10.0
    size_rad: tuple[float, float, float] = (0.3, 0.45, 0.7)
    """Of roll, nod and pan: amplitudes of the turning."""

    @property
    def track(self) -> GyroTrack:
        """The truth, as rates at every other millisecond from -1 s on."""
        return _track(self.seed, self.duration_s, self.size_rad)

    def R_start_body(self, t_s: Matrix) -> Matrix:
        """Return (N, 3, 3) attitudes as against that at zero."""
        return rotations.matrices(self.track.between(np.zeros_like(t_s), t_s))

    def samples(
        self, t_zero_ns: int, *, rate_hz: float = 250.0, bias_rad_s: tuple[float, float, float] = (0.01, -0.02, 0.005)
    ) -> list[ImuSample]:
        """Return what the gyroscope says: white noise of 0.1 deg/s a sample, a bias, and uneven times."""
        rng = np.random.default_rng([self.seed, 6])
        t = np.arange(-0.8, self.duration_s + 0.8, 1.0 / rate_hz)
        t = t + rng.uniform(-0.2, 0.2, len(t)) / rate_hz
        exact = np.stack([np.interp(t, self.track.times_s, self.track.rates_rad_s[:, k]) for k in range(3)], axis=1)
        said = exact + bias_rad_s + rng.normal(0.0, np.radians(0.1), exact.shape)
        return [
            ImuSample(
                t_zero_ns + round(when * 1e9), t_zero_ns + round(when * 1e9) + 1_000_000, (x, y, z), (0.0, 0.0, 9.81)
            )
            for when, (x, y, z) in zip(t.tolist(), said.tolist(), strict=True)
        ]


@cache
def _track(seed: int, duration_s: float, size_rad: tuple[float, float, float]) -> GyroTrack:
    rng = np.random.default_rng([seed, 5])
    t = np.arange(-1.0, duration_s + 1.0, _STEP_S)
    rates = np.zeros((len(t), 3))
    for axis, size in enumerate(size_rad):
        for hz in rng.uniform(0.15, 0.9, 4):
            rates[:, axis] += size * 0.5 * 2 * np.pi * hz * np.cos(2 * np.pi * hz * t + rng.uniform(0, 2 * np.pi))
    return GyroTrack(t, rates)
