"""What is shown follows a corrected filter smoothly: each correction is faded in, not jumped to.

Who stands sees every move of the square, and it is given time; who walks sees none of a few millimetres, and what a correction
has not brought yet is an error.
"""

from math import exp, hypot

import numpy as np

from tracker.geometry import conjugate, log, multiply, normalise
from tracker.geometry import exp as rotation_exp
from tracker.measurements import Matrix, Vector3
from tracker.precise.navigation import Navigation

#: Corrections larger than these are shown at once: the filter has begun anew, and a long slide would be a second error.
_LARGEST_M, _LARGEST_RAD = 10.0, 0.15
_ZERO: Vector3 = (0.0, 0.0, 0.0)


class Blend:
    """What is still to be faded in: an offset, at the filter's own time, from its state to the one that is shown.

    Kept at the filter's time it does not depend on when a measurement arrived, only on when it was made.
    """

    def __init__(self, time_s: float, walking_time_s: float, turn_time_s: float, lag_s: float) -> None:
        """Begin with nothing to be faded in.

        Args:
            time_s: Decay of position and velocity while the rig stands.
            walking_time_s: While it is moved.
            turn_time_s: Decay of attitude.
            lag_s: How far behind what is shown the filter is.
        """
        self._standing_time_s, self._walking_time_s = time_s, walking_time_s
        self._time_s, self._turn_time_s, self._lag_s = time_s, turn_time_s, lag_s
        self._t_ns = 0
        self._p_m = self._v_m_s = self._turn_rad = _ZERO

    def corrected(self, before: Navigation, after: Navigation) -> None:
        """Take what the state at one time was before and after a correction."""
        keep, keep_turn = self._left((after.t_ns - self._t_ns) * 1e-9)
        p = _sum(_scaled(self._p_m, keep), _difference(before.p_m, after.p_m))
        v = _sum(_scaled(self._v_m_s, keep), _difference(before.v_m_s, after.v_m_s))
        turned = log(multiply(before.wxyz_site_body, conjugate(after.wxyz_site_body)))
        turn = _sum(_scaled(self._turn_rad, keep_turn), turned)
        self._p_m, self._v_m_s = (p, v) if hypot(*p) <= _LARGEST_M else (_ZERO, _ZERO)
        self._turn_rad = turn if hypot(*turn) <= _LARGEST_RAD else _ZERO
        self._t_ns = after.t_ns

    def pace(self, t_ns: int, *, stands: bool) -> None:
        """Go on from a time of the filter's as is right for who stands, or for who walks."""
        time_s = self._standing_time_s if stands else self._walking_time_s
        if time_s == self._time_s:
            return
        keep, keep_turn = self._left((t_ns - self._t_ns) * 1e-9)
        self._p_m, self._v_m_s = _scaled(self._p_m, keep), _scaled(self._v_m_s, keep)
        self._turn_rad = _scaled(self._turn_rad, keep_turn)
        self._t_ns, self._time_s = max(t_ns, self._t_ns), time_s

    def shown(self, nav: Navigation, t_ns: int) -> Navigation:
        """Return the state, at its own time, that is to be carried on and shown at t_ns."""
        keep, keep_turn = self._left((t_ns - self._t_ns) * 1e-9 - self._lag_s)
        turn = rotation_exp(_scaled(self._turn_rad, keep_turn))
        return Navigation(
            nav.t_ns,
            _sum(nav.p_m, _scaled(self._p_m, keep)),
            _sum(nav.v_m_s, _scaled(self._v_m_s, keep)),
            normalise(multiply(turn, nav.wxyz_site_body)),
        )

    def offset(self, t_ns: int) -> Matrix:
        """Return how far what is shown at t_ns is from the filter's state, (9,): position, velocity and rotation, site axes."""
        keep, keep_turn = self._left((t_ns - self._t_ns) * 1e-9 - self._lag_s)
        left = (_scaled(self._p_m, keep), _scaled(self._v_m_s, keep), _scaled(self._turn_rad, keep_turn))
        return np.concatenate(left)

    def _left(self, after_s: float) -> tuple[float, float]:
        after_s = max(0.0, after_s)
        return exp(-after_s / self._time_s), exp(-after_s / self._turn_time_s)


def _sum(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def _difference(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _scaled(a: Vector3, by: float) -> Vector3:
    return (a[0] * by, a[1] * by, a[2] * by)
