"""Refuses what does not go on from what came before, unless it insists: stamps that leap, fixes that nobody can have walked to."""

from math import hypot
from typing import TypeAlias

from tracker.fixes import BELIEVED, FASTEST_M_S, ORDINARY_M
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, ImuSample, Measurement, Standpoint, Vector3

#: Inertial samples further apart than this do not belong to one motion.
LEAP_NS = 1_000_000_000
#: So many after a leap, one soon after the other, show that the sensor was away, or its clock set.
_LEAPT = 10
#: What is stamped this far ahead of the newest inertial sample would wait for a time that may not come.
_AHEAD_NS = 5_000_000_000
#: Who says that they stand further than this from where the receiver has them is mistaken.
_ASTRAY_M = 1_000.0

_Place: TypeAlias = tuple[int, Vector3]


class Admission:
    """The last stamps and places, those let in and those refused."""

    def __init__(self, site: SiteFrame) -> None:
        self._site = site
        self._leaps: list[int] = []
        self._fix: _Place | None = None
        self._far: list[_Place] = []

    def refuses(self, measurement: Measurement, newest_ns: int) -> bool:
        """Return whether a measurement must be left out; `newest_ns` is the stamp of the newest inertial sample."""
        if isinstance(measurement, ImuSample):
            return self._refuses_imu(measurement.t_ns, newest_ns)
        if measurement.t_ns > newest_ns + _AHEAD_NS:
            return True
        match measurement:
            case GpsFix():
                return self._refuses_fix(measurement)
            case Standpoint():
                return self._fix is not None and _distance_m(self._fix[1], measurement.p_site_m) > _ASTRAY_M
        return False

    def _refuses_imu(self, t_ns: int, newest_ns: int) -> bool:
        leaps = self._leaps
        if t_ns <= newest_ns + LEAP_NS:
            leaps.clear()
            return False
        if leaps and not 0 < t_ns - leaps[-1] <= LEAP_NS:
            leaps.clear()
        leaps.append(t_ns)
        return len(leaps) < _LEAPT

    def _refuses_fix(self, fix: GpsFix) -> bool:
        here = (fix.t_ns, self._site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m))
        if self._fix is None or _is_walkable(self._fix, here):
            self._far.clear()
            if self._fix is None or fix.t_ns > self._fix[0]:
                self._fix = here
            return False
        if self._far and fix.t_ns <= self._far[-1][0]:
            return True
        if self._far and not _is_walkable(self._far[-1], here):
            self._far.clear()
        self._far.append(here)
        if len(self._far) < BELIEVED:
            return True
        self._far.clear()
        self._fix = here
        return False


def _is_walkable(one: _Place, other: _Place) -> bool:
    return _distance_m(one[1], other[1]) <= ORDINARY_M + FASTEST_M_S * abs(other[0] - one[0]) * 1e-9


def _distance_m(a: Vector3, b: Vector3) -> float:
    return hypot(*(y - x for x, y in zip(a, b, strict=True)))
