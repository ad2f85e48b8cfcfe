"""The first half second: gravity tells the tilt, and nothing else is known but what the rig remembers of its sensors."""

from math import hypot, pi, sqrt

from tracker.geometry import wxyz_level_from_gravity
from tracker.measurements import ImuSample, Vector3
from tracker.precise.error_model import start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.memory import Memory, recall
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings

#: The first specific force is averaged over this long.
_START_NS = 500_000_000


class Start:
    """Collects the first samples."""

    def __init__(
        self, settings: PreciseSettings, gravity_m_s2: float, earth_rad_s: Vector3, memory: Memory | None
    ) -> None:
        self._settings, self._memory = settings, memory
        self._gravity, self._earth_rad_s = gravity_m_s2, earth_rad_s
        self._samples: list[ImuSample] = []

    def take(self, sample: ImuSample) -> ErrorState | None:
        """Take a sample; return the filter to begin with, once there are enough of them."""
        samples = self._samples
        samples.append(sample)
        if sample.t_ns - samples[0].t_ns < _START_NS:
            return None
        x, y, z = (sum(s.accel_m_s2[axis] for s in samples) / len(samples) for axis in range(3))
        samples.clear()
        if hypot(x, y, z) < 1.0:
            return None  # a rig in free fall has no up
        zero = (0.0, 0.0, 0.0)
        nav = Navigation(sample.t_ns, zero, zero, wxyz_level_from_gravity((x, y, z)))
        cov = start_covariance(self._settings, (1e3, 1e3, 1e3), 1.0, pi / sqrt(3.0))
        state = ErrorState(self._settings, nav, Biases(), cov, self._gravity, self._earth_rad_s)
        if self._memory is not None:
            recall(state, self._memory)
        return state
