"""GPS fixes in site: what is kept of one, how far it is to be believed, and which are out of the question."""

from dataclasses import dataclass
from math import hypot, isfinite

from tracker.camera_path import Sight
from tracker.measurements import GpsFix, Vector3

#: A jump up to this is a receiver's ordinary error, m;
ORDINARY_M = 50.0
#: beyond it, what needs more speed than this is refused, m/s,
FASTEST_M_S = 40.0
#: unless so many in a row say so: then the receiver had lied before.
BELIEVED = 5


@dataclass(frozen=True, slots=True)
class Fix:
    """A fix, and where the two paths that carry it on stood at its stamp."""

    t_ns: int
    t_recv_ns: int
    p_site_m: Vector3
    var_m2: Vector3
    path_m: Vector3
    """The inertial path's place."""
    sight: Sight | None
    """The picture nearest to it, where there is one."""


def variance_m2(fix: GpsFix, floor_m: float, default_m2: Vector3) -> Vector3:
    """Return the variances, east, north, up, that a receiver states: at least the floor's, the default where it states none."""
    stated = (fix.cov_enu_m2[0], fix.cov_enu_m2[4], fix.cov_enu_m2[8]) if len(fix.cov_enu_m2) == 9 else (0.0,) * 3
    x, y, z = (
        max(v, floor_m**2) if isfinite(v) and v > 0.0 else default
        for v, default in zip(stated, default_m2, strict=True)
    )
    return x, y, z


class FixGate:
    """Refuses positions that nobody can have walked to from the last one let through, until the receiver insists."""

    def __init__(self) -> None:
        self._refused = 0

    def refuses(self, old_m: Vector3, new_m: Vector3, dt_s: float) -> bool:
        """Return whether a fix must be left out."""
        jump_m = hypot(*(new - old for new, old in zip(new_m, old_m, strict=True)))
        if jump_m > ORDINARY_M + FASTEST_M_S * dt_s and self._refused < BELIEVED:
            self._refused += 1
            return True
        return False

    def insisted(self) -> bool:
        """Return whether the fix just let through had been refused until it was believed; begin anew."""
        insisted, self._refused = self._refused == BELIEVED, 0
        return insisted
