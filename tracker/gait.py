"""How a walking body moves: a draft of where to be and look becomes smooth position and attitude, with steps in them."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, radians

import numpy as np

from tracker.choreography import KNOT_S, Draft
from tracker.measurements import Matrix
from tracker.splines import Jet, Spline, cos, sin, slewed, smoothed

#: A head turns no faster than this in ordinary looking about.
FASTEST_TURN_RAD_S = radians(150.0)
#: Steps per second of a walk at 1.2 m/s, and how little the pace changes with speed (people lengthen their steps first).
STEPS_HZ, STEPS_PER_M = 1.35, 0.45
#: At 1.2 m/s, metres: the head's rise and fall with every step, its sway with every second one.
BOB_M, SWAY_M = 0.018, 0.012
NOD_RAD, ROLL_RAD = radians(0.6), radians(0.8)

Ground = Callable[[Matrix, Matrix], Matrix]
"""Height of the ground, (n,) metres, at (n,) east and (n,) north."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A rigid body's motion at n instants, in site axes but for the rates."""

    p_m: Matrix
    """(n, 3)"""
    v_m_s: Matrix
    a_m_s2: Matrix
    R_site_body: Matrix
    """(n, 3, 3)"""
    omega_body_rad_s: Matrix


class Body:
    """A visitor's head, with the rig on it."""

    def __init__(self, draft: Draft, ground_z_m: Ground, eye_height_m: float, sways: bool) -> None:
        e, n = (smoothed(values, 0.35, KNOT_S) for values in (draft.e_m, draft.n_m))
        yaw = smoothed(slewed(draft.yaw_rad, FASTEST_TURN_RAD_S, KNOT_S), 0.15, KNOT_S)
        course = smoothed(draft.course_rad, 0.5, KNOT_S)
        nose_up = smoothed(slewed(draft.nose_up_rad, FASTEST_TURN_RAD_S, KNOT_S), 0.15, KNOT_S)
        speed = np.hypot(np.gradient(e, KNOT_S), np.gradient(n, KNOT_S))
        stride = smoothed(np.minimum(speed / 1.2, 1.4), 0.3, KNOT_S) if sways else np.zeros_like(speed)
        steps = np.cumsum(np.where(speed > 0.05, STEPS_HZ + STEPS_PER_M * speed, 0.0)) * KNOT_S
        # a closed loop of hills would still be smooth enough to walk: a second of smoothing is a foot's length of slope
        z = smoothed(ground_z_m(e, n), 0.4, KNOT_S) + eye_height_m
        curves = (e, n, z, yaw, nose_up, course, stride, smoothed(steps, 0.3, KNOT_S))
        self._splines = tuple(Spline(values, KNOT_S) for values in curves)

    def at(self, t_s: Matrix) -> Motion:
        """Return the motion at (n,) instants, seconds from the walk's start."""
        e, n, z, yaw, nose_up, course, stride, steps = (spline.at(t_s) for spline in self._splines)
        step, pair = steps * (2.0 * pi), steps * pi
        sway = stride * sin(pair) * SWAY_M
        e, n = e - sway * sin(course), n + sway * cos(course)
        z = z + stride * cos(step) * BOB_M
        pitch = stride * sin(step) * NOD_RAD - nose_up
        roll = stride * cos(pair) * ROLL_RAD
        p, v, a = (np.stack([getattr(axis, part) for axis in (e, n, z)], axis=1) for part in ("value", "rate", "accel"))
        return Motion(p, v, a, _rotation(roll.value, pitch.value, yaw.value), _omega(roll, pitch, yaw))


def _rotation(roll: Matrix, pitch: Matrix, yaw: Matrix) -> Matrix:
    """Return R = Rz(yaw) Ry(pitch) Rx(roll), (n, 3, 3)."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(a), np.sin(a)) for a in (roll, pitch, yaw))
    rows = (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )
    return np.stack([np.stack(row, axis=1) for row in rows], axis=1)


def _omega(roll: Jet, pitch: Jet, yaw: Jet) -> Matrix:
    """Return the body's angular rate, (n, 3), from the rates of its three angles."""
    (cr, sr), (cp, sp) = ((np.cos(a), np.sin(a)) for a in (roll.value, pitch.value))
    return np.stack(
        [
            roll.rate - yaw.rate * sp,
            pitch.rate * cr + yaw.rate * sr * cp,
            -pitch.rate * sr + yaw.rate * cr * cp,
        ],
        axis=1,
    )
