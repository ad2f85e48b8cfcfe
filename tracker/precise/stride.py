"""How a walker goes on while the receiver is silent: as fast as the steps shake the head, the way that they face.

How hard they shake at which speed is learned while the receiver tells speed, and how well that tells it.

Reference:
    Weinberg, Using the ADXL202 in pedometer and personal navigation applications, 2002: the force's swing grows with the step.
"""

from math import atan2, cos, hypot, sin, sqrt

import numpy as np

from tracker.geometry import wrap_rad
from tracker.measurements import Matrix
from tracker.pace import GAIT_STD_M_S2, WALKING_M_S
from tracker.precise.error_model import THETA, V
from tracker.precise.error_state import ErrorState
from tracker.precise.facing import Facing
from tracker.precise.navigation import Navigation
from tracker.precise.settings import PreciseSettings
from tracker.precise.update import Observation

#: What is remembered of a quarter of a second after another one: some minutes' walking.
_KEPT = 0.998
#: Before anything was learned: an easy pace, and more with more shaking, m/s and (m/s) / (m/s2), each worth so much.
_PRIOR, _PRIOR_WORTH = (0.7, 0.3), (1.0, 4.0)
_FASTEST_M_S = 2.5
#: One who holds the rig in the hands moves it, the more the harder it is shaken, and it stays about where it is.
_HELD_M_S, _HELD_S, _MOST_M_S = 0.3, 0.1, 1.6
#: A quarter of a second errs as the ones before: by so much its deviation is taken larger than it is.
_ALIKE = 1.5
#: Nobody goes more evenly than this.
_LEAST_M_S = 0.15
#: How far off the speed may be counts like so many quarters of a second before anything was learned.
_DOUBT_WORTH = 8.0
#: Directions that have nothing to do with the facing are no further apart than this.
_ANYWHERE_RAD = 2.0
#: Who looks further than this from where they go looks aside.
_GLANCE_RAD = 0.2
#: Who faces elsewhere than it seems goes elsewhere.
_BY_HEADING = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 0.0]])


class Stride:
    """Speed by the spread of the specific force (a straight line, by least squares that forget), direction by the facing."""

    def __init__(self) -> None:
        self._facing = Facing()
        self._n = self._x = self._xx = self._y = self._xy = 0.0
        """Sums over what was learned: of one, spread, its square, speed, and spread times speed."""
        self._steps = self._off = 0.0
        """Over the part of it that was walked: of one, and of the square of what the speed was foreseen wrong by."""

    def learn(self, spread_m_s2: float, nav: Navigation) -> None:
        """Take how much the force spread in a quarter of a second while the velocity was known."""
        x, y = spread_m_s2, hypot(nav.v_m_s[0], nav.v_m_s[1])
        if y < WALKING_M_S:
            return  # who stops shakes on for a moment: a line through that, too, would be too low for who walks
        if x > GAIT_STD_M_S2:
            self._facing.learn(nav.v_m_s, nav.wxyz_site_body)
            self._steps, self._off = _KEPT * self._steps + 1.0, _KEPT * self._off + (y - self.speed_m_s(x)) ** 2
        self._n, self._x, self._xx = _KEPT * self._n + 1.0, _KEPT * self._x + x, _KEPT * self._xx + x * x
        self._y, self._xy = _KEPT * self._y + y, _KEPT * self._xy + x * y

    @property
    def is_learned(self) -> bool:
        """Whether somebody has walked while the velocity was known."""
        return self._steps > 0.0

    def speed_m_s(self, spread_m_s2: float) -> float:
        """Return the speed that goes with a spread of the force."""
        (level, slope), (level_worth, slope_worth) = _PRIOR, _PRIOR_WORTH
        n, xx = self._n + level_worth, self._xx + slope_worth
        y, xy = self._y + level_worth * level, self._xy + slope_worth * slope
        slope = (n * xy - self._x * y) / (n * xx - self._x**2)
        level = (y - slope * self._x) / n
        return min(max(level + slope * spread_m_s2, 0.0), _FASTEST_M_S)

    def onward(self, spread_m_s2: float, state: ErrorState, settings: PreciseSettings) -> tuple[Observation, Matrix]:
        """Return what is to be expected of the velocity now, and its noise, (3, 3): speed, course (rad), and upwards."""
        if spread_m_s2 < GAIT_STD_M_S2 or not self.is_learned:
            sigma = min(_HELD_M_S + _HELD_S * spread_m_s2, _MOST_M_S)
            return (-np.array(state.nav.v_m_s), [(V, np.eye(3))]), sigma**2 * np.eye(3)
        told, sigma = self.speed_m_s(spread_m_s2), self._sigma_m_s(settings)
        course_rad = self._facing.course_rad(state.nav.wxyz_site_body)
        aside_rad = min(self._facing.spread_rad, _ANYWHERE_RAD)
        east, north, up = state.nav.v_m_s
        speed = hypot(east, north)
        off_rad = wrap_rad(course_rad - atan2(north, east))
        if speed < WALKING_M_S:
            across = hypot(sigma, told * aside_rad)
            return _as_faced(state, course_rad, told), np.diag([sigma**2, across**2, settings.stride_sigma_m_s**2])
        x, y = east / speed, north / speed
        H = np.array([[x, y, 0.0], [-y / speed, x / speed, 0.0], [0.0, 0.0, 1.0]])
        # the more it would turn the walker, the less the facing counts: people look aside, and go on as they went
        doubt_rad = max(_ALIKE * aside_rad, _LEAST_M_S / speed) * (1.0 + (off_rad / _GLANCE_RAD) ** 2)
        seen = np.array([told - speed, off_rad, -up]), [(V, H), (THETA, _BY_HEADING)]
        return seen, np.diag([sigma**2, doubt_rad**2, settings.stride_sigma_m_s**2])

    def _sigma_m_s(self, settings: PreciseSettings) -> float:
        """Return how far the speed may be from what a spread tells."""
        prior = (settings.stride_sigma_m_s / _ALIKE) ** 2 * _DOUBT_WORTH
        return max(_ALIKE * sqrt((self._off + prior) / (self._steps + _DOUBT_WORTH)), _LEAST_M_S)


def _as_faced(state: ErrorState, course_rad: float, speed_m_s: float) -> Observation:
    """Return a velocity that is wholly along a course: of who begins to walk."""
    c, s = cos(course_rad), sin(course_rad)
    H = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    v = H @ state.nav.v_m_s
    by_heading = np.zeros((3, 3))
    by_heading[:2, 2] = v[1], -v[0]
    return np.array([speed_m_s, 0.0, 0.0]) - v, [(V, H), (THETA, by_heading)]
