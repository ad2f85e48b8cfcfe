"""Stretches without inertial samples: a plug that was loose, a device that began anew. Nobody knows what the rig did then.

A head goes on as it went and looks where it looked, more or less: velocity and attitude are held, and the doubt about them grows
with time as below. Pictures that were taken before, in and after the gap then tell how it has turned, two by two; what they
leave open, the first half second afterwards has to tell: gravity the tilt, and motion and compass the heading.
"""

from math import sqrt
from typing import Literal

import numpy as np

from tracker.geometry import rotate
from tracker.measurements import ImuSample, Matrix
from tracker.precise.error_model import FORGETTING, THETA, P, V
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Navigation
from tracker.precise.update import Observation

#: The slowest units say something every 60 ms; after this long they have been away.
GAP_NS = 200_000_000
#: After a longer one the filter begins anew.
LONGEST_GAP_NS = 30_000_000_000
#: What a walker's head does without being watched, standard deviations after a second, growing with the root of time.
_TURN_RAD, _TILT_RAD, _SPEED_M_S = 0.6, 0.15, 1.0
#: The mean specific force is taken over this long; a walker's steps leave so much of them in it.
_LEVEL_NS, _LEVEL_M_S2 = 500_000_000, 0.8
#: A compass is asked before all directions are tried; not before the tilt is known, since what leans seems to be near iron.
_COMPASS_NS = 300_000_000
LEVEL_NOISE: Matrix = _LEVEL_M_S2**2 * np.eye(2)
#: A heading that is less sure than this afterwards is looked for in all directions.
_LOST_RAD = 0.35


def is_gap(before_ns: int, after_ns: int) -> bool:
    """Return whether there is a gap between two samples that follow each other."""
    return after_ns - before_ns > GAP_NS


def held(nav: Navigation, t_ns: int) -> Navigation:
    """Return the state at t_ns with velocity and attitude as they are."""
    dt_s = (t_ns - nav.t_ns) * 1e-9
    (px, py, pz), (vx, vy, vz) = nav.p_m, nav.v_m_s
    return nav._replace(t_ns=t_ns, p_m=(px + vx * dt_s, py + vy * dt_s, pz + vz * dt_s))


def doubt(dt_s: float) -> tuple[float, float, float, float]:
    """Return what a gap adds: variances of position (m²), velocity, tilt and heading (rad²), per axis."""
    v = _SPEED_M_S**2 * dt_s
    return v * dt_s**2 / 3.0, v, _TILT_RAD**2 * dt_s, _TURN_RAD**2 * dt_s


def drift(state: ErrorState, t_ns: int) -> None:
    """Carry a filter on to t_ns, in a gap."""
    state.settle()
    dt_s = (t_ns - state.nav.t_ns) * 1e-9
    if dt_s <= 0.0:
        return
    cov = state.covariance
    cov[P, :] += dt_s * cov[V, :]
    cov[:, P] += dt_s * cov[:, V]
    keep = state.noise.kept(dt_s)
    cov[FORGETTING, :] *= keep[:, None]
    cov[:, FORGETTING] *= keep
    added = state.noise.added(dt_s)
    p, v, tilt, turn = doubt(dt_s)
    added[P], added[V], added[THETA] = p, v, (tilt, tilt, turn)
    index = np.arange(len(added))
    cov[index, index] += added
    half = 0.5 * v * dt_s
    rows = np.arange(3)
    cov[rows, rows + 3] += half
    cov[rows + 3, rows] += half
    state.gps_error = keep[:9] * state.gps_error
    state.magnetic_rad *= float(keep[9])
    state.nav = held(state.nav, t_ns)
    state.restart_chunk()


class AfterGap:
    """The time after a gap: the mean specific force of half a second, in site by what the filter believes of its attitude."""

    def __init__(self, t_ns: int) -> None:
        self._until_ns = t_ns + _LEVEL_NS
        self._force = np.zeros(3)
        self._count = 0
        self.is_level = False
        """Whether the half second is over: before, nothing that hangs on the tilt is to be believed."""

    def take(self, sample: ImuSample, state: ErrorState) -> Literal["level", "heading"] | None:
        """Take a sample, and what the filter believes at its stamp; return what is to be done now: `level`, later `heading`."""
        if self.is_level:
            return "heading" if sample.t_ns >= self._until_ns + _COMPASS_NS else None
        (ax, ay, az), (bx, by, bz) = sample.accel_m_s2, state.biases.accel_m_s2
        self._force += rotate(state.nav.wxyz_site_body, (ax - bx, ay - by, az - bz))
        self._count += 1
        self.is_level = sample.t_ns >= self._until_ns
        return "level" if self.is_level else None

    def level(self) -> Observation:
        """Return the tilt that the mean force wants; its noise is `LEVEL_NOISE`."""
        east, north, up = (self._force / self._count).tolist()
        H = np.array([[0.0, up, -north], [-up, 0.0, east]])
        return np.array([-east, -north]), [(THETA, H)]


def has_lost_heading(state: ErrorState) -> bool:
    """Return whether the heading must be looked for."""
    return sqrt(max(0.0, float(state.covariance[THETA, THETA][2, 2]))) > _LOST_RAD
