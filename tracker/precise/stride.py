"""How fast a walker goes, told by how hard the steps shake the head: learned while speed is known, used while it is not.

Reference:
    Weinberg, Using the ADXL202 in pedometer and personal navigation applications, 2002: the force's swing grows with the step.
"""

#: What is remembered of a quarter of a second after another one: some minutes' walking.
_KEPT = 0.998
#: Before anything was learned: an easy pace, and more with more shaking, m/s and (m/s) / (m/s2), each worth so much.
_PRIOR = (0.7, 0.3)
_PRIOR_WORTH = (1.0, 4.0)
_FASTEST_M_S = 2.5


class Stride:
    """A straight line from the spread of the specific force to speed over the ground, by least squares that forget."""

    def __init__(self) -> None:
        self._n, self._x, self._xx = _PRIOR_WORTH[0], 0.0, _PRIOR_WORTH[1]
        self._y, self._xy = _PRIOR[0] * _PRIOR_WORTH[0], _PRIOR[1] * _PRIOR_WORTH[1]

    def learn(self, spread_m_s2: float, speed_m_s: float) -> None:
        """Take how much the force spread while the speed was known."""
        self._n = _KEPT * self._n + 1.0
        self._x = _KEPT * self._x + spread_m_s2
        self._xx = _KEPT * self._xx + spread_m_s2**2
        self._y = _KEPT * self._y + speed_m_s
        self._xy = _KEPT * self._xy + spread_m_s2 * speed_m_s

    def speed_m_s(self, spread_m_s2: float) -> float:
        """Return the speed that goes with a spread of the force."""
        across = self._n * self._xx - self._x**2
        slope = (self._n * self._xy - self._x * self._y) / across
        level = (self._y - slope * self._x) / self._n
        return min(max(level + slope * spread_m_s2, 0.0), _FASTEST_M_S)
