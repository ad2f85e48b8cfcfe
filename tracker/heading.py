"""Where north is, found at the start of a walk, as in the paper: after that the six-axis filter carries it on.

Madgwick's filter starts at yaw 0. What is sought is the constant turn from its level frame to the site's east and north.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, cos, hypot, inf, pi, sin, sqrt

from tracker.geometry import rotate, wrap_rad, yaw_of
from tracker.measurements import Vector3, Wxyz

#: Samples of a magnetometer or compass are averaged over this long, so that a first glitch does not set the whole walk askew.
SPAN_S = 2.0
#: A mean that differs by less from what was first said is no better than it: nothing is gained by turning the world.
WORTH_A_TURN_RAD = 0.05
#: A course says where the walker faces only while walking; below this speed it is the receiver's noise.
WALKING_M_S = 0.7
#: Courses that must agree, and how closely (the length of their mean direction; 0.95 is a spread of about 18 degrees).
COURSES = 6
AGREEMENT = 0.95
#: How far the gaze may stay off the path for as long as that, rad: people look aside.
COURSE_SIGMA_RAD = 0.35
#: ... and for good: a rig may sit askew.
ASKEW_SIGMA_RAD = 0.15
#: Gains of velocity tell north without any guess about where the walker looks. Smaller ones than this are noise, m/s;
LEAST_GAIN_M_S = 0.4
#: one is off by this much: the receiver's 0.1 m/s twice, and a second of gravity through a degree and a half of tilt;
GAIN_SIGMA_M_S = 0.45
#: the answer is used when it is this certain, rad, and stands for good at the second figure;
USABLE_RAD, FINAL_RAD = 0.3, 0.05
#: and only if the two sets of gains are turned copies of each other (1 is exactly).
COHERENCE = 0.75


class StartHeading:
    """Collects yaw offsets from whatever can tell north; the first source with enough of them decides.

    A phone's own compass is preferred to the bare magnetometer. Without either, the course over the ground is taken until
    something better is known; it assumes that walkers look where they walk, and a rig in the hand may look anywhere. The gains
    of velocity (what the IMU felt against what the receiver saw) assume nothing; where the two contradict each other, they win.
    """

    def __init__(self, declination_rad: float) -> None:
        self._declination_rad = declination_rad
        self._compass = _Offsets()
        self._magnetometer = _Offsets()
        self._courses: list[float] = []
        self._agreed: list[float] = []
        """Means of courses that agreed."""
        self._gains = _Gains()
        self._is_final = False
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
        if len(self._courses) < COURSES:
            return
        mean_rad, length = _circular_mean(self._courses)
        if length < AGREEMENT:
            del self._courses[0]
            return
        self._courses.clear()
        self._agreed.append(mean_rad)
        self._decide()

    def gain(self, level_m_s: tuple[float, float], enu_m_s: tuple[float, float]) -> None:
        """Take what the horizontal velocity gained over about a second: as the IMU felt it, and as the receiver saw it."""
        if not self._is_final and hypot(*enu_m_s) >= LEAST_GAIN_M_S:
            self._gains.add(level_m_s, enu_m_s)
            self._decide()

    def turn(self, yaw_rad: float) -> None:
        """Take a correction of what is known already: the camera has seen, while walking, by how much it was off."""
        if self.yaw_offset_rad is not None:
            self.yaw_offset_rad = wrap_rad(self.yaw_offset_rad + yaw_rad)

    @property
    def is_final(self) -> bool:
        """Whether nothing more is to be learnt."""
        return self._is_final

    def _decide(self) -> None:
        if self._is_final:
            return
        for offsets in (self._compass, self._magnetometer):
            if offsets.values:
                self._is_final = offsets.span_s >= SPAN_S
                mean_rad = _circular_mean(offsets.values)[0]
                # at once, so that pictures are right from the first second on
                known_rad = self.yaw_offset_rad
                if known_rad is None or abs(wrap_rad(mean_rad - known_rad)) > WORTH_A_TURN_RAD:
                    self.yaw_offset_rad = mean_rad
                return
        self._decide_by_motion()

    def _decide_by_motion(self) -> None:
        gains, yaw_rad, sigma_rad = self._gains, 0.0, inf
        if self._agreed:
            yaw_rad = _circular_mean(self._agreed)[0]
            sigma_rad = max(ASKEW_SIGMA_RAD, COURSE_SIGMA_RAD / sqrt(len(self._agreed)))
        if gains.sigma_rad <= USABLE_RAD:
            off_rad = wrap_rad(gains.yaw_rad - yaw_rad)
            if abs(off_rad) > 3.0 * hypot(sigma_rad, gains.sigma_rad):
                sigma_rad = inf
            # weighted by certainty; an infinite sigma leaves it to the gains alone
            share = 1.0 / (1.0 + (gains.sigma_rad / sigma_rad) ** 2)
            yaw_rad, sigma_rad = yaw_rad + share * off_rad, gains.sigma_rad * sqrt(share)
        if sigma_rad < inf:
            self.yaw_offset_rad, self._is_final = wrap_rad(yaw_rad), sigma_rad <= FINAL_RAD


@dataclass
class _Gains:
    """The turn that best lays one set of plane vectors on another."""

    along: float = 0.0
    across: float = 0.0
    felt: float = 0.0
    seen: float = 0.0

    def add(self, level_m_s: tuple[float, float], enu_m_s: tuple[float, float]) -> None:
        (lx, ly), (ex, ey) = level_m_s, enu_m_s
        self.along += lx * ex + ly * ey
        self.across += lx * ey - ly * ex
        self.felt += lx * lx + ly * ly
        self.seen += ex * ex + ey * ey

    @property
    def yaw_rad(self) -> float:
        return atan2(self.across, self.along)

    @property
    def sigma_rad(self) -> float:
        """Infinite where the two sets do not match."""
        if self.felt == 0.0 or hypot(self.along, self.across) < COHERENCE * sqrt(self.felt * self.seen):
            return inf
        return GAIN_SIGMA_M_S / sqrt(self.seen)


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
