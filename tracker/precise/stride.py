"""How a walker goes on while the receiver is silent: as fast as the steps shake the head, the way that they face.

How hard they shake at which speed is learned while the receiver tells speed.

Reference:
    Weinberg, Using the ADXL202 in pedometer and personal navigation applications, 2002: the force's swing grows with the step.
"""

from math import hypot

import numpy as np

from tracker.measurements import Matrix, Vector3, Wxyz
from tracker.pace import Pace
from tracker.precise.settings import PreciseSettings

#: What is remembered of a quarter of a second after another one: some minutes' walking.
_KEPT = 0.998
#: Before anything was learned: an easy pace, and more with more shaking, m/s and (m/s) / (m/s2), each worth so much.
_PRIOR, _PRIOR_WORTH = (0.7, 0.3), (1.0, 4.0)
_FASTEST_M_S = 2.5
#: One who holds the rig in the hands moves it, the more the harder it is shaken, and it stays about where it is.
_HELD_M_S, _HELD_S, _MOST_M_S = 0.3, 0.1, 1.6
#: The walker is where the steps and the facing say in the plane alone.
_ALL, _LEVEL = np.eye(3), np.diag([1.0, 1.0, 0.0])


class Stride:
    """Speed by the spread of the specific force (a straight line, by least squares that forget), direction by the facing."""

    def __init__(self) -> None:
        self._pace = Pace()
        self._n = self._x = self._xx = self._y = self._xy = 0.0
        """Sums over what was learned: of one, spread, its square, speed, and spread times speed."""

    def step(self, accel_m_s2: Vector3, wxyz_site_body: Wxyz, dt_s: float) -> None:
        """Watch the gait and the facing."""
        self._pace.step(accel_m_s2, wxyz_site_body, dt_s)

    def learn(self, spread_m_s2: float, v_site_m_s: Vector3) -> None:
        """Take how much the force spread while the velocity was known."""
        self._pace.learn(v_site_m_s, (1.0, 0.0))
        x, y = spread_m_s2, hypot(v_site_m_s[0], v_site_m_s[1])
        self._n, self._x, self._xx = _KEPT * self._n + 1.0, _KEPT * self._x + x, _KEPT * self._xx + x * x
        self._y, self._xy = _KEPT * self._y + y, _KEPT * self._xy + x * y

    def speed_m_s(self, spread_m_s2: float) -> float:
        """Return the speed that goes with a spread of the force."""
        (level, slope), (level_worth, slope_worth) = _PRIOR, _PRIOR_WORTH
        n, xx = self._n + level_worth, self._xx + slope_worth
        y, xy = self._y + level_worth * level, self._xy + slope_worth * slope
        slope = (n * xy - self._x * y) / (n * xx - self._x**2)
        level = (y - slope * self._x) / n
        return min(max(level + slope * spread_m_s2, 0.0), _FASTEST_M_S)

    def onward(self, spread_m_s2: float, settings: PreciseSettings) -> tuple[Vector3, Matrix]:
        """Return the velocity in site that is to be expected now, and its covariance, (3, 3)."""
        x, y, _ = self._pace.velocity_m_s((1.0, 0.0))
        length = hypot(x, y)
        if length == 0.0:
            return (0.0, 0.0, 0.0), min(_HELD_M_S + _HELD_S * spread_m_s2, _MOST_M_S) ** 2 * _ALL
        speed = self.speed_m_s(spread_m_s2)
        ahead = np.array([x / length, y / length, 0.0])
        # people look aside: the steps tell the speed better than the facing tells the way
        noise = settings.stride_sigma_m_s**2 * _ALL + settings.facing_sigma_m_s**2 * (_LEVEL - np.outer(ahead, ahead))
        return (speed * x / length, speed * y / length, 0.0), noise
