"""Which way a walker goes, beside the way that the head faces: mostly the same, but for glances and for how the rig is worn.

How a rig is worn does not change from one breath to the next, and a glance aside is over in two seconds: what is remembered is the
direction of half a minute's walking, with little regard for what lies far from it.

Reference:
    Huber, Robust statistics, 1981: location and scale with weights that fall with the distance.
"""

from math import atan2, cos, hypot, sin

from tracker.geometry import wrap_rad, yaw_of
from tracker.measurements import Vector3, Wxyz
from tracker.pace import WALKING_M_S

#: What is remembered of a quarter of a second after another one.
_KEPT = 0.992
#: Before anything was learned: ahead, worth so much; and every other time the walk is as near to it as below.
_PRIOR_WORTH, _PRIOR_NEAR = 4.0, 0.5
#: Directions this far from the usual one count half, rad.
_NEAR_RAD = 0.2


class Facing:
    """The usual direction of travel against the facing, and how far from it one mostly is."""

    def __init__(self) -> None:
        self._ahead, self._left = _PRIOR_WORTH, 0.0
        self._near, self._n = _PRIOR_NEAR * _PRIOR_WORTH, _PRIOR_WORTH

    def learn(self, v_site_m_s: Vector3, wxyz_site_body: Wxyz) -> None:
        """Take a quarter of a second in which the velocity was known."""
        vx, vy, _ = v_site_m_s
        if hypot(vx, vy) < WALKING_M_S:
            return
        aside_rad = wrap_rad(atan2(vy, vx) - yaw_of(wxyz_site_body))
        off_rad = wrap_rad(aside_rad - self.aside_rad)
        weight = 1.0 / (1.0 + (off_rad / _NEAR_RAD) ** 2)
        self._ahead = _KEPT * self._ahead + weight * cos(aside_rad)
        self._left = _KEPT * self._left + weight * sin(aside_rad)
        self._near, self._n = _KEPT * self._near + weight, _KEPT * self._n + 1.0

    @property
    def aside_rad(self) -> float:
        """The usual direction of travel, counter-clockwise from the facing."""
        return atan2(self._left, self._ahead)

    @property
    def spread_rad(self) -> float:
        """The half width of the directions about it, were they Cauchy's: large where they are no matter of the facing."""
        near = self._near / self._n
        return _NEAR_RAD * (1.0 - near) / near

    def course_rad(self, wxyz_site_body: Wxyz) -> float:
        """Return which way one goes who faces there, counter-clockwise from east."""
        return yaw_of(wxyz_site_body) + self.aside_rad
