"""What is shown follows a corrected filter smoothly: each correction is faded in, not jumped to."""

from math import exp, hypot

from tracker.geometry import conjugate, log, multiply, normalise
from tracker.geometry import exp as rotation_exp
from tracker.measurements import Vector3
from tracker.precise.navigation import Navigation

#: Corrections larger than these are shown at once: the filter has begun anew, and a long slide would be a second error.
_LARGEST_M, _LARGEST_RAD = 10.0, 0.15
_ZERO: Vector3 = (0.0, 0.0, 0.0)


class Blend:
    """What is still to be faded in: an offset from the filter's state to what is shown, which decays."""

    def __init__(self, time_s: float) -> None:
        self._time_s = time_s
        self._t_ns = 0
        self._p_m = _ZERO
        self._turn_rad = _ZERO

    def corrected(self, before: Navigation, after: Navigation) -> None:
        """Take what the state at one time was before and after a correction."""
        keep = self._left(after.t_ns)
        p = _sum(_scaled(self._p_m, keep), _sum(before.p_m, _scaled(after.p_m, -1.0)))
        turn = _sum(
            _scaled(self._turn_rad, keep), log(multiply(before.wxyz_site_body, conjugate(after.wxyz_site_body)))
        )
        p = p if hypot(*p) <= _LARGEST_M else _ZERO
        turn = turn if hypot(*turn) <= _LARGEST_RAD else _ZERO
        self._t_ns, self._p_m, self._turn_rad = after.t_ns, p, turn

    def shown(self, nav: Navigation) -> Navigation:
        """Return the state as it is to be shown."""
        keep = self._left(nav.t_ns)
        turn = rotation_exp(_scaled(self._turn_rad, keep))
        return nav._replace(
            p_m=_sum(nav.p_m, _scaled(self._p_m, keep)), wxyz_site_body=normalise(multiply(turn, nav.wxyz_site_body))
        )

    def _left(self, t_ns: int) -> float:
        return exp(-max(0.0, (t_ns - self._t_ns) * 1e-9) / self._time_s)


def _sum(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def _scaled(a: Vector3, by: float) -> Vector3:
    return (a[0] * by, a[1] * by, a[2] * by)
