"""What the three sensors say of the rig's pose: the paper's measurements m_P and m_R, one cycle after another.

Nothing here knows of the filter. Where the text is silent or its literal equation breaks, these are the default readings,
`keyframe_local` and `sane` (the others: `tracker/readings.py`, `tracker/literal.py`):

- m_R is Madgwick's attitude turned to north at the start: once by a compass or magnetometer, else by the receiver's motion.
  With a camera the start heading's error, and what the gyroscope has drifted since, is corrected while walking (`VisualCourse`).
- m_P is the fix (one, or with a camera many), carried on by the camera's motion since then, and by the doubly integrated
  specific force (what the camera has not covered, or everything without one).
- v(0) of that integral is the receiver's own velocity, or what its fixes' displacements say where it tells none. While there
  are no fixes the walker goes on at their pace (`tracker/pace.py`), and m_P counts for less with every second.
- The essential matrix gives no length, so the camera's step is as long as the IMU's over the same time. Its direction is used
  where its parallax supports one, turned by what `VisualCourse` has found of the start heading's error, and every fix of the last
  seconds says where the camera's path lies in the site (`Anchor`).
"""

from math import hypot, isfinite

import numpy as np

from tracker.anchor import Anchor
from tracker.attitude import Madgwick
from tracker.calibration import MeanSample, RestCalibration, SampleMean
from tracker.camera_path import CameraPath
from tracker.course import CourseOverGround
from tracker.cycle import Cycle
from tracker.estimator import Origin
from tracker.fixes import FASTEST_M_S, Fix, FixGate, variance_m2
from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.geometry import matrix_from_wxyz, multiply, rpy_from_wxyz, wxyz_from_yaw
from tracker.heading import StartHeading
from tracker.inertial import InertialPath
from tracker.literal import FourSampleIntegral, m_P_ecef, m_P_enu
from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Matrix,
    Measurement,
    Outcome,
    Vector3,
    VisualMotion,
    Wxyz,
)
from tracker.readings import SensorSettings
from tracker.rig import Rig
from tracker.visual_course import VisualCourse

#: A stamp that runs ahead of its arrival by more than this, since the one before, is a clock that leapt.
_FASTEST_CLOCK_NS = 2_000_000_000
#: A walker is faster than this, dead reckoning of one who stands is slower.
_STILL_M_S = 0.3


class SensorPose:
    """Takes measurements in order of arrival, and has a `Cycle` ready four times a second."""

    def __init__(
        self, settings: SensorSettings, origin: Origin, rig: Rig, declination_rad: float, uses_camera: bool
    ) -> None:
        self._settings = settings
        self._uses_camera = uses_camera
        self._site = SiteFrame(origin)
        self._R_body_cam = rig.T_body_cam[:3, :3]
        self._period_ns = round(settings.cycle_s * 1e9)
        self._calibration = RestCalibration()
        self._sample_mean = SampleMean(settings.mean_samples)
        self._attitude = Madgwick()
        self._heading = StartHeading(declination_rad)
        self.path = InertialPath(gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m))
        """Where dead reckoning has gone; its displacements carry a fix, and a pose, to any time."""
        self._four_samples = FourSampleIntegral()
        self._camera = CameraPath()
        self._visual_course = VisualCourse()
        self._anchor = Anchor(settings.anchor_s)
        self._course = CourseOverGround()
        self._gate = FixGate()
        self._imu_ns: int | None = None
        self._imu_recv_ns = 0
        self.fix: Fix | None = None
        """The last one taken."""
        self._velocity: GpsVelocity | None = None
        self._compass_waiting: CompassHeading | None = None
        self._due_ns: int | None = None
        self._ready: Cycle | None = None
        self._turned_to_rad = 0.0
        self._widened_m2 = 0.0
        self._moved_to: Vector3 | None = None

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement."""
        match measurement:
            case ImuSample():
                return self._step_imu(measurement)
            case GpsFix():
                return self._step_fix(measurement)
            case VisualMotion() if self._uses_camera:
                return self._step_vision(measurement)
            case GpsVelocity():
                return self._step_velocity(measurement)
            case MagSample() | CompassHeading():
                return self._step_heading(measurement)
            case _:
                return Outcome.IGNORED

    def take(self) -> Cycle | None:
        """Return the cycle that has fallen due since the last call, if one has; the first is the filter's start."""
        ready, self._ready = self._ready, None
        return ready

    @property
    def yaw_offset_rad(self) -> float | None:
        """Turn from Madgwick's level frame to site; None until north is known."""
        return self._heading.yaw_offset_rad

    def doubt_m2(self, t_ns: int) -> float:
        """Return by how much, squared, dead reckoning may have gone astray that no cycle has told of yet."""
        return self._widened_m2 + self._drift_var_m2(t_ns)

    # -- inertial -----------------------------------------------------------------------------------------------------

    def _step_imu(self, sample: ImuSample) -> Outcome:
        if not all(map(isfinite, (*sample.gyro_rad_s, *sample.accel_m_s2))):
            return Outcome.REJECTED_NOT_FINITE
        if self._imu_ns is not None:
            if sample.t_ns <= self._imu_ns:
                return Outcome.REJECTED_STALE
            if _leapt(sample.t_ns - self._imu_ns, sample.t_recv_ns - self._imu_recv_ns):
                return Outcome.REJECTED_GATE
        self._imu_ns, self._imu_recv_ns = sample.t_ns, sample.t_recv_ns
        self._calibration.step(sample)
        mean = self._sample_mean.step(sample)
        if mean is not None:
            self._integrate(mean)
        return Outcome.USED if self._due_ns is not None else Outcome.WAITING

    def _integrate(self, mean: MeanSample) -> None:
        offset_rad_s = self._calibration.gyro_offset_rad_s if self._settings.calibration else (0.0, 0.0, 0.0)
        (gx, gy, gz), (bx, by, bz) = mean.gyro_rad_s, offset_rad_s
        gyro = (gx - bx, gy - by, gz - bz)
        if self._attitude.wxyz_level_body is None and hypot(*mean.accel_m_s2) < 1.0:
            return  # a rig in free fall has no up
        self._four_samples.step(mean, calibrating=not self._calibration.finished)
        q = self._attitude.update(gyro, mean.accel_m_s2, mean.dt_s)
        self.path.step(MeanSample(mean.t_ns, mean.dt_s, gyro, mean.accel_m_s2), q, self._heading.yaw_offset_rad)
        if self._compass_waiting is not None:
            # a phone tells its heading when it changes: one that was told before the first inertial sample still holds
            self._heading.compass(mean.t_ns, self._compass_waiting.yaw_rad, q)
            self._compass_waiting = None
        if self.fix is not None and (self._due_ns is None or mean.t_ns >= self._due_ns):
            self._ready = self._cycle(mean.t_ns, self.fix)
            # on the beat, so that four a second stay four; what comes after a silence begins a new one
            self._due_ns = max((self._due_ns or mean.t_ns) + self._period_ns, mean.t_ns)

    # -- measurements -------------------------------------------------------------------------------------------------

    def _cycle(self, t_ns: int, fix: Fix) -> Cycle:
        m_P, var_P_m2 = self._measured_position(t_ns, fix)
        yaw_offset_rad = self._heading.yaw_offset_rad or 0.0
        turned_rad, self._turned_to_rad = yaw_offset_rad - self._turned_to_rad, yaw_offset_rad
        widened_m2, self._widened_m2 = self._widened_m2, 0.0
        moved_to, self._moved_to = self._moved_to, None
        m_R = rpy_from_wxyz(self._dead_reckoned_attitude(t_ns))
        return Cycle(t_ns, m_P, var_P_m2, m_R, turned_rad, widened_m2, moved_to)

    def _dead_reckoned_attitude(self, t_ns: int) -> Wxyz:
        state = self.path.at(t_ns)
        q = state.wxyz_level_body if state else (1.0, 0.0, 0.0, 0.0)
        return multiply(wxyz_from_yaw(self._heading.yaw_offset_rad or 0.0), q)

    def _measured_position(self, t_ns: int, fix: Fix) -> tuple[Vector3, Vector3]:
        """m_P and its variance: the fix, carried on to t_ns."""
        more = self._drift_var_m2(t_ns)
        vx, vy, vz = fix.var_m2
        return self._m_P(t_ns, fix), (vx + more, vy + more, vz + more)

    def _m_P(self, t_ns: int, fix: Fix) -> Vector3:
        """Tr x m_gps + m_imu (eq. 8), in the reading that is asked for."""
        reading, literal_imu = self._settings.m_P, self._settings.m_imu == "literal"
        is_carried = self._camera.newest is not None or self._settings.anchor_imu
        if reading == "keyframe_local" and is_carried and not literal_imu:
            x, y, z = (c + o for c, o in zip(self._chain_m(t_ns), self._anchor.offset_m, strict=True))
            return (x, y, z)
        m_imu_m = self._four_samples.m_imu_m if literal_imu else _difference(self._path_m(t_ns), fix.path_m)
        if reading == "literal_enu":
            return m_P_enu(self._camera.Tr, fix.p_site_m, m_imu_m)
        if reading == "literal_ecef":
            return m_P_ecef(self._camera.Tr, fix.p_site_m, m_imu_m, self._site)
        last, sight = self._camera.newest, fix.sight
        moved = _difference(last.p_m, sight.p_m) if last and sight else (0.0, 0.0, 0.0)
        x, y, z = (p + m + i for p, m, i in zip(fix.p_site_m, moved, m_imu_m, strict=True))
        return (x, y, z)

    def _chain_m(self, t_ns: int) -> Vector3:
        """Where the camera's path is, carried on by the IMU from the picture nearest to a time, else from the newest."""
        sight = self._camera.near(t_ns) or self._camera.newest
        here = self._path_m(t_ns)
        if sight is None:
            return here
        x, y, z = (p + a - b for p, a, b in zip(sight.p_m, here, sight.path_m, strict=True))
        return (x, y, z)

    def _path_m(self, t_ns: int) -> Vector3:
        state = self.path.at(t_ns)
        return state.p_m if state else (0.0, 0.0, 0.0)

    def _drift_var_m2(self, t_ns: int) -> float:
        """How far dead reckoning may have gone astray since the last fix, beyond the usual second between two."""
        age_s = max(0.0, (t_ns - self.fix.t_ns) * 1e-9 - 1.0) if self.fix is not None else 0.0
        return (self._settings.outage_speed_m_s * age_s) ** 2

    # -- GPS ----------------------------------------------------------------------------------------------------------

    def _step_fix(self, fix: GpsFix) -> Outcome:
        if not fix.valid:
            return Outcome.REJECTED_WEAK
        if not all(map(isfinite, (fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m))) or abs(fix.lat_deg) > 90.0:
            return Outcome.REJECTED_NOT_FINITE
        p = self._site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m)
        old = self.fix
        if old is not None:
            if fix.t_ns <= old.t_ns:
                return Outcome.REJECTED_STALE
            dt_ns = fix.t_ns - old.t_ns
            if _leapt(dt_ns, fix.t_recv_ns - old.t_recv_ns) or self._gate.refuses(old.p_site_m, p, dt_ns * 1e-9):
                return Outcome.REJECTED_GATE
            insisted = self._gate.insisted()
            if self._due_ns is not None:
                self._widened_m2 += self._drift_var_m2(fix.t_ns)
                self._moved_to = p if insisted else self._moved_to
            if insisted:
                self._anchor.forget()
        var_m2 = variance_m2(fix, self._settings.gps_floor_m, self._settings.gps_var_m2)
        self.fix = Fix(fix.t_ns, fix.t_recv_ns, p, var_m2, self._path_m(fix.t_ns), self._camera.near(fix.t_ns))
        self._anchor.fix(fix.t_ns, p, self._chain_m(fix.t_ns))
        if self._velocity is None or fix.t_ns - self._velocity.t_ns > self._settings.velocity_held_s * 1e9:
            if old is not None:
                self.path.correct_by_displacement(old.t_ns, fix.t_ns, _difference(p, old.p_site_m), old.path_m)
            self._course.fix(fix.t_ns, p, self.path, self._heading)
        return Outcome.USED

    def _step_velocity(self, velocity: GpsVelocity) -> Outcome:
        """The receiver's own velocity is the integral's v(0); its gains, and its course, tell the start heading."""
        if not all(map(isfinite, velocity.v_enu_m_s)):
            return Outcome.REJECTED_NOT_FINITE
        old = self._velocity
        if old is not None and velocity.t_ns <= old.t_ns:
            return Outcome.REJECTED_STALE
        leapt = old is not None and _leapt(velocity.t_ns - old.t_ns, velocity.t_recv_ns - old.t_recv_ns)
        if leapt or hypot(*velocity.v_enu_m_s) > FASTEST_M_S:
            return Outcome.REJECTED_GATE
        self._velocity = velocity
        self.path.correct_velocity(velocity.t_ns, velocity.v_enu_m_s)
        self._course.velocity(velocity, self.path, self._heading)
        return Outcome.USED

    # -- heading and camera -------------------------------------------------------------------------------------------

    def _step_heading(self, measurement: MagSample | CompassHeading) -> Outcome:
        if self._heading.is_final:
            return Outcome.IGNORED  # the paper: once at the start, then six axes
        state = self.path.at(measurement.t_ns)
        if isinstance(measurement, CompassHeading):
            if not isfinite(measurement.yaw_rad):
                return Outcome.REJECTED_NOT_FINITE
            if state is None:
                self._compass_waiting = measurement
                return Outcome.WAITING
            self._heading.compass(measurement.t_ns, measurement.yaw_rad, state.wxyz_level_body)
            return Outcome.USED
        if not all(map(isfinite, measurement.field_body_t)):
            return Outcome.REJECTED_NOT_FINITE
        if state is None:
            return Outcome.WAITING
        self._heading.magnetometer(measurement.t_ns, measurement.field_body_t, state.wxyz_level_body)
        return Outcome.USED

    def _step_vision(self, motion: VisualMotion) -> Outcome:
        """Chain the camera's path. The essential matrix gives its direction, the IMU its length."""
        if self._due_ns is None or self._heading.yaw_offset_rad is None:
            return Outcome.WAITING
        last = self._camera.newest
        if last is not None and motion.t_ns <= last.t_ns:
            return Outcome.REJECTED_STALE
        key = self._camera.held(motion.t_key_ns)
        if key is None:
            key = self._camera.begin(motion.t_key_ns, self._R_level_cam(motion.t_key_ns), self._path_m(motion.t_key_ns))
        self._camera.R_site_level = matrix_from_wxyz(wxyz_from_yaw(self._heading.yaw_offset_rad))
        moved_m = self._seen_step_m(motion, self._camera.R_site_cam(key))
        self._camera.chain(motion, key, moved_m, self._R_level_cam(motion.t_ns), self._path_m(motion.t_ns))
        if self._settings.camera_north and self._visual_course.turn_rad is not None:
            turn_rad = self._visual_course.turn_rad
            self._heading.turn(turn_rad)
            self._visual_course.turn(turn_rad)
        return Outcome.USED

    def _seen_step_m(self, motion: VisualMotion, R_site_key: Matrix) -> Vector3:
        """Return the step from the keyframe to the picture, site: the camera's direction where its parallax supports one."""
        x, y, z = self.path.displacement_m(motion.t_key_ns, motion.t_ns)
        if not any(motion.direction_key):
            # no parallax: a rig that hardly moves by the IMU stands still, one that walks has only far things before it
            stands = hypot(x, y) < _STILL_M_S * (motion.t_ns - motion.t_key_ns) * 1e-9
            return (0.0, 0.0, 0.0) if stands else (x, y, z)
        ex, ey = (R_site_key @ np.array(motion.direction_key))[:2].tolist()
        self._visual_course.step(motion.t_ns, (ex, ey), (x, y))
        turned = self._visual_course.turned((ex, ey))
        if turned is None:
            return (x, y, z)
        length_m = min(hypot(x, y), self._settings.fastest_walk_m_s * (motion.t_ns - motion.t_key_ns) * 1e-9)
        size = hypot(*turned)
        if size < 0.5 or turned[0] * x + turned[1] * y < 0.5 * size * hypot(x, y):
            return (x, y, z)
        return (turned[0] / size * length_m, turned[1] / size * length_m, z)

    def _R_level_cam(self, t_ns: int) -> Matrix:
        state = self.path.at(t_ns)
        return matrix_from_wxyz(state.wxyz_level_body) @ self._R_body_cam if state else self._R_body_cam


def _leapt(stamps_ns: int, arrivals_ns: int) -> bool:
    return stamps_ns > arrivals_ns + _FASTEST_CLOCK_NS


def _difference(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
