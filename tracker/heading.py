"""Where north is, found once at the start of a walk, as in the paper: after that the six-axis filter carries it on.

Madgwick's filter starts at yaw 0. What is sought is the constant turn from its level frame to the site's east and north.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, cos, hypot, pi, sin

from tracker.geometry import rotate, wrap_rad, yaw_of
from tracker.measurements import Vector3, Wxyz

#: Samples of a magnetometer or compass are averaged over this long, so that a first glitch does not set the whole walk askew.
SPAN_S = 2.0
#: A course says where the walker faces only while walking; below this speed it is the receiver's noise.
WALKING_M_S = 0.7
#: Courses that must agree, and how closely (the length of their mean direction; 0.95 is a spread of about 18 degrees).
COURSES = 6
AGREEMENT = 0.95


class StartHeading:
    """Collects yaw offsets from whatever can tell north; the first source with enough of them decides.

    A phone's own compass is preferred to the bare magnetometer, and both to the course over the ground, which assumes that
    the walker looks where they walk.
    """

    def __init__(self, declination_rad: float) -> None:
        self._declination_rad = declination_rad
        self._compass = _Offsets()
        self._magnetometer = _Offsets()
        self._courses: list[float] = []
        self.yaw_offset_rad: float | None = None
        """Turn from the level frame to site, counter-clockwise; None until known."""

    def compass(self, t_ns: int, yaw_rad: float, wxyz_level_body: Wxyz) -> None:
        """Take a true heading of body x, and the attitude at its stamp."""
        self._compass.add(t_ns, yaw_rad - yaw_of(wxyz_level_body))
        self._decide()

    def magnetometer(self, t_ns: int, field_body: Vector3, wxyz_level_body: Wxyz) -> None:
        """Take a magnetic field: levelled by the attitude, its horizontal part points to magnetic north."""
        x, y, _ = rotate(wxyz_level_body, field_body)
        if hypot(x, y) == 0.0:
            return
        self._magnetometer.add(t_ns, pi / 2 - self._declination_rad - atan2(y, x))
        self._decide()

    def course(self, v_enu_m_s: Vector3, wxyz_level_body: Wxyz) -> None:
        """Take a velocity over the ground."""
        if hypot(v_enu_m_s[0], v_enu_m_s[1]) < WALKING_M_S:
            self._courses.clear()
            return
        self._courses.append(atan2(v_enu_m_s[1], v_enu_m_s[0]) - yaw_of(wxyz_level_body))
        self._courses = self._courses[-COURSES:]
        self._decide()

    def _decide(self) -> None:
        if self.yaw_offset_rad is not None:
            return
        for offsets in (self._compass, self._magnetometer):
            if offsets.span_s >= SPAN_S:
                self.yaw_offset_rad = _circular_mean(offsets.values)[0]
                return
        if len(self._courses) == COURSES:
            mean_rad, length = _circular_mean(self._courses)
            if length >= AGREEMENT:
                self.yaw_offset_rad = mean_rad


@dataclass
class _Offsets:
    values: list[float] = field(default_factory=list)
    first_ns: int = 0
    last_ns: int = 0

    def add(self, t_ns: int, offset_rad: float) -> None:
        if not self.values:
            self.first_ns = t_ns
        self.last_ns = t_ns
        self.values.append(offset_rad)

    @property
    def span_s(self) -> float:
        return (self.last_ns - self.first_ns) * 1e-9


def _circular_mean(angles_rad: Sequence[float]) -> tuple[float, float]:
    x, y = sum(map(cos, angles_rad)), sum(map(sin, angles_rad))
    return wrap_rad(atan2(y, x)), hypot(x, y) / len(angles_rad)
