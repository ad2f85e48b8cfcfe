"""`filterpy/imm`: stationary, walking and manoeuvring on position and velocity of the receiver, as filterpy's users write it.

The inertial sensors give it the attitude only, by vqf's six axes; its heading is set once, by magnetometer or else by course.
"""

from cmath import phase
from collections.abc import Sequence
from math import isfinite

import numpy as np
from filterpy.kalman import IMMEstimator, KalmanFilter

from tests.benchmarks.accuracy.rivals.attitude import Attitude, Vqf, period_s
from tests.benchmarks.accuracy.rivals.online import follow
from tracker.estimator import NO_MOTION_MODEL, Origin, Pose
from tracker.fixes import variance_m2
from tracker.geodesy import SiteFrame
from tracker.geomagnetism import magnetic_field
from tracker.geometry import multiply, normalise, rotate, wxyz_from_yaw, yaw_of
from tracker.measurements import GpsFix, GpsVelocity, MagSample, Matrix, Measurement
from tracker.rig import Rig

#: White acceleration of the three models, m/s2: stationary, walking, manoeuvring.
ACCEL_M_S2 = (0.01, 0.3, 2.0)
STAY = 0.94
DEFAULT_VAR_M2 = (4.5, 4.5, 16.0)
FLOOR_M, VELOCITY_SIGMA_M_S = 0.3, (0.12, 0.12, 0.18)
#: Headings by the magnetometer are averaged over so many samples; a course counts when walked this fast, so many times.
MAGNETIC_SAMPLES, WALKING_M_S, COURSES = 50, 0.7, 6
ROTATION_VAR_RAD2 = 0.05**2
HEADING_VAR_RAD2 = 0.2**2


class North:
    """The turn from the attitude's level frame to site, set once."""

    def __init__(self, declination_rad: float) -> None:
        self._declination_rad = declination_rad
        self._by_field: list[complex] = []
        self._by_course: list[complex] = []
        self.turn_rad: float | None = None

    def field(self, sample: MagSample, attitude: Attitude) -> None:
        """Take a magnetic field."""
        if self.turn_rad is not None or attitude.wxyz_level_body is None or not isfinite(sum(sample.field_body_t)):
            return
        x, y, _ = rotate(attitude.wxyz_level_body, sample.field_body_t)
        # the field's horizontal part points to magnetic north, which is the declination clockwise of true north
        self._by_field.append(1j * complex(x, -y) * np.exp(-1j * self._declination_rad))
        if len(self._by_field) == MAGNETIC_SAMPLES:
            self.turn_rad = phase(sum(self._by_field))

    def course(self, v_m_s: Matrix, attitude: Attitude) -> None:
        """Take a velocity: people look where they walk."""
        if self.turn_rad is not None or attitude.wxyz_level_body is None or np.hypot(v_m_s[0], v_m_s[1]) < WALKING_M_S:
            return
        self._by_course.append(complex(v_m_s[0], v_m_s[1]) * np.exp(-1j * yaw_of(attitude.wxyz_level_body)))
        if len(self._by_course) == COURSES:
            self.turn_rad = phase(sum(self._by_course))


class Imm:
    """The three filters, and the attitude beside them."""

    def __init__(self, origin: Origin, period: float, start_ns: int) -> None:
        self._site = SiteFrame(origin)
        earth = magnetic_field(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, start_ns)
        self._north = North(earth.declination_rad)
        self._attitude = Attitude(Vqf(period), period)
        self._imm: IMMEstimator | None = None
        self._t_ns = 0

    def add(self, measurement: Measurement) -> None:
        """Take the next measurement to arrive."""
        self._attitude.add(measurement)
        match measurement:
            case GpsFix(valid=True) if isfinite(measurement.lat_deg + measurement.lon_deg + measurement.h_ellipsoid_m):
                self._take_fix(measurement)
            case GpsVelocity() if isfinite(sum(measurement.v_enu_m_s)):
                v = np.array(measurement.v_enu_m_s)
                self._north.course(v, self._attitude)
                self._update(measurement.t_ns, v, np.square(VELOCITY_SIGMA_M_S), slice(3, 6))
            case MagSample():
                self._north.field(measurement, self._attitude)

    def _take_fix(self, fix: GpsFix) -> None:
        p = np.array(self._site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m))
        var = np.array(variance_m2(fix, FLOOR_M, DEFAULT_VAR_M2))
        if self._imm is None:
            self._imm, self._t_ns = started(p, var), fix.t_ns
        self._update(fix.t_ns, p, var, slice(0, 3))

    def _update(self, t_ns: int, z: Matrix, var: Matrix, part: slice) -> None:
        if self._imm is None or t_ns < self._t_ns:
            return
        if t_ns > self._t_ns:
            dt_s, self._t_ns = (t_ns - self._t_ns) * 1e-9, t_ns
            for filter_, accel_m_s2 in zip(self._imm.filters, ACCEL_M_S2, strict=True):
                filter_.F, filter_.Q = step(dt_s, accel_m_s2, stands=accel_m_s2 == ACCEL_M_S2[0])
            self._imm.predict()
        for filter_ in self._imm.filters:
            filter_.H, filter_.R = np.eye(6)[part], np.diag(var)
        self._imm.update(z[:, None])

    def pose(self, t_ns: int) -> Pose | None:
        """Return the pose at a time, which is now; None before the first fix."""
        wxyz = self._attitude.at(t_ns)
        if self._imm is None or wxyz is None:
            return None
        dt_s = (t_ns - self._t_ns) * 1e-9
        x, P = self._imm.x[:, 0], self._imm.P
        carry = np.hstack([np.eye(3), dt_s * np.eye(3)])
        known = self._north.turn_rad is not None
        cov = np.diag([0.0, 0.0, 0.0, ROTATION_VAR_RAD2, ROTATION_VAR_RAD2, HEADING_VAR_RAD2 if known else np.pi**2])
        cov[:3, :3] = carry @ P @ carry.T
        (px, py, pz), (vx, vy, vz) = (carry @ x).tolist(), x[3:].tolist()
        wxyz = normalise(multiply(wxyz_from_yaw(self._north.turn_rad or 0.0), wxyz))
        return Pose(t_ns, (px, py, pz), wxyz, (vx, vy, vz), cov, NO_MOTION_MODEL, known)


def started(p_m: Matrix, var_m2: Matrix) -> IMMEstimator:
    """Return the estimator at a first position, standing."""
    filters = []
    for _ in ACCEL_M_S2:
        filter_ = KalmanFilter(dim_x=6, dim_z=3)
        filter_.x = np.concatenate([p_m, np.zeros(3)])[:, None]
        filter_.P = np.diag([*var_m2, 1.0, 1.0, 1.0])
        filters.append(filter_)
    others = (1.0 - STAY) / 2.0
    transition = np.full((3, 3), others) + (STAY - others) * np.eye(3)
    return IMMEstimator(filters, np.full(3, 1.0 / 3.0), transition)


def step(dt_s: float, accel_m_s2: float, *, stands: bool) -> tuple[Matrix, Matrix]:
    """Return F and Q, (6, 6): constant velocity with white acceleration, or the velocity forgotten."""
    unit = np.eye(3)
    F = np.block(
        [[unit, np.zeros((3, 3)) if stands else dt_s * unit], [np.zeros((3, 3)), 0.0 * unit if stands else unit]]
    )
    gain = np.vstack([0.5 * dt_s**2 * unit, dt_s * unit])
    return F, accel_m_s2**2 * gain @ gain.T


def by_imm(measurements: Sequence[Measurement], origin: Origin, rig: Rig, ticks: Sequence[int]) -> list[Pose]:
    """Return the poses at ticks from the first fix on."""
    period = period_s(measurements)
    return [] if period is None else follow(Imm(origin, period, measurements[0].t_ns), measurements, ticks)
