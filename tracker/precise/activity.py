"""What the walker is doing, felt by the inertial sensors and classified by the paper's fuzzy rules.

The nine motion models are nine activities: standing, walking or brisk (P0, P1, P2), with the view still, turning or turning fast
(R0, R1, R2). A model foresees how much the sensors feel; the innovation is how far from that they are. The rules that follow one
model by another are the paper's, unchanged.
"""

from collections import deque
from math import hypot, log, sqrt

from tracker.fuzzy import FuzzyController, Membership, MotionModel
from tracker.measurements import ImuSample, Vector3

WINDOW_S = 0.5
CYCLE_S = 0.25
#: Spread of the specific force's length, m/s2, that stands for models P0, P1 and P2: a standing head shows up to 0.1, walking
#: 0.4 to 2, brisk walking more.
_FORCE_M_S2 = (0.02, 1.0, 4.0)
#: Turn rate, rad/s, that stands for R0, R1 and R2.
_RATE_RAD_S = (0.03, 0.5, 2.0)
#: In steps from one model to the next: half a step off is as much Low as Medium.
_STEPS = Membership(0.25, 0.75, 1.75)


class Activity:
    """A motion model every quarter of a second, from the last half."""

    def __init__(self) -> None:
        self._controller = FuzzyController(_STEPS, _STEPS)
        self._window: deque[ImuSample] = deque()
        self._due_ns: int | None = None
        self.model = MotionModel(0, 0)
        self.gyro_mean_rad_s: Vector3 = (0.0, 0.0, 0.0)
        self.gyro_spread_rad_s = 0.0
        self.force_spread_m_s2 = 0.0

    def step(self, sample: ImuSample) -> bool:
        """Take a sample; return whether a cycle has ended with it, and the model is new."""
        window = self._window
        window.append(sample)
        while sample.t_ns - window[0].t_ns > WINDOW_S * 1e9:
            window.popleft()
        if self._due_ns is None:
            self._due_ns = sample.t_ns + round(WINDOW_S * 1e9)
        if sample.t_ns < self._due_ns:
            return False
        self._due_ns = max(self._due_ns + round(CYCLE_S * 1e9), sample.t_ns)
        self._judge()
        return True

    def forget(self) -> None:
        """Begin a new window: samples were missing, and one alone looks as still as can be."""
        self._window.clear()
        self._due_ns = None

    def _judge(self) -> None:
        window, n = self._window, len(self._window)
        x, y, z = (sum(s.gyro_rad_s[axis] for s in window) / n for axis in range(3))
        self.gyro_mean_rad_s = (x, y, z)
        square = sum(
            (s.gyro_rad_s[0] - x) ** 2 + (s.gyro_rad_s[1] - y) ** 2 + (s.gyro_rad_s[2] - z) ** 2 for s in window
        )
        self.gyro_spread_rad_s = sqrt(square / n)
        norms = [hypot(*s.accel_m_s2) for s in window]
        mean = sum(norms) / n
        self.force_spread_m_s2 = sqrt(sum((norm - mean) ** 2 for norm in norms) / n)
        rate = hypot(x, y, z, self.gyro_spread_rad_s)
        y_p = abs(_place(self.force_spread_m_s2, _FORCE_M_S2) - self.model.i)
        y_r = abs(_place(rate, _RATE_RAD_S) - self.model.j)
        self.model = self._controller.next_model(y_p, y_r, self.model)

    @property
    def stands(self) -> bool:
        """Whether the rig is where it was."""
        return self.model.i == 0 and self.force_spread_m_s2 < _crossover(_FORCE_M_S2)

    @property
    def is_still(self) -> bool:
        """Whether the view is where it was, too."""
        return (
            self.stands and self.model.j == 0 and self.gyro_spread_rad_s < 0.03 and hypot(*self.gyro_mean_rad_s) < 0.04
        )


def _place(value: float, scale: tuple[float, float, float]) -> float:
    """Return where a value stands among the three, 0 to 2, by its logarithm."""
    low, middle, high = (log(one) for one in scale)
    x = log(max(value, 1e-6))
    if x <= middle:
        return max(0.0, (x - low) / (middle - low))
    return min(2.0, 1.0 + (x - middle) / (high - middle))


def _crossover(scale: tuple[float, float, float]) -> float:
    return sqrt(scale[0] * scale[1])
