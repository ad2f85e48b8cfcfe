"""The paper's tracker: measurements m_P and m_R of three sensors into the 12-state filter, four times a second.

Bostanci et al., Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models, arXiv 1512.02766.
Where the text is silent or its literal equation breaks, this takes the readings `keyframe_local` and `sane`:

- m_R is Madgwick's attitude turned to north at the start: once by a compass or magnetometer, else by the receiver's motion.
- m_P is the last fix, carried on by the camera's motion since the keyframe nearest that fix (camera), and by the doubly
  integrated specific force since then (what the camera has not covered, or everything without one).
- v(0) of that integral is the receiver's own velocity, or what its fixes' displacements say where it tells none. While there
  are no fixes the walker goes on at their pace (`tracker/pace.py`), and m_P counts for less with every second.
- The essential matrix gives no length, so the camera's step is as long as the IMU's over the same time.
"""

from copy import deepcopy
from dataclasses import dataclass, field
from math import hypot, isfinite, pi, sqrt

import numpy as np

from tracker.attitude import Madgwick
from tracker.calibration import MeanSample, RestCalibration, SampleMean
from tracker.camera_path import CameraPath
from tracker.course import CourseOverGround
from tracker.estimator import Innovation, Origin, Pose, Snapshot
from tracker.fixes import FASTEST_M_S, Fix, FixGate, variance_m2
from tracker.fusion import FusionSettings
from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.geometry import (
    conjugate,
    matrix_from_wxyz,
    multiply,
    normalise,
    rpy_from_wxyz,
    wxyz_from_rpy,
    wxyz_from_yaw,
)
from tracker.heading import StartHeading
from tracker.inertial import InertialPath
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
from tracker.motion import MotionFilter, MotionSelector
from tracker.rig import Rig


@dataclass(frozen=True)
class PaperSettings:
    """What the paper leaves open beyond the filter's noise."""

    fusion: FusionSettings = field(default_factory=FusionSettings)
    cycle_s: float = 0.25
    """Its camera's four keyframes a second."""
    gps_var_m2: Vector3 = (2.12**2, 2.12**2, 4.0**2)
    """For a receiver that states none: 2.5 m CEP."""
    gps_floor_m: float = 1.0
    """A receiver that states less is not believed."""
    tilt_sigma_rad: float = 0.017
    heading_sigma_rad: float = 0.09
    """What Madgwick's filter and the start heading are good for; the filter's own R only holds their noise."""
    fastest_walk_m_s: float = 2.0
    outage_speed_m_s: float = 0.5
    """An old fix is off by this much more for every second of its age."""
    velocity_held_s: float = 3.0
    """A receiver that has told no velocity for this long tells none: its fixes' displacements are used."""


#: A stamp that runs ahead of its arrival by more than this, since the one before, is a clock that leapt.
_FASTEST_CLOCK_NS = 2_000_000_000


class PaperEstimator:
    """GPS-IMU or camera-GPS-IMU, with a constant or a fuzzy motion model: the paper's four columns."""

    def __init__(
        self,
        name: str,
        selector: MotionSelector,
        *,
        origin: Origin,
        rig: Rig,
        declination_rad: float,
        uses_camera: bool,
        settings: PaperSettings | None = None,
    ) -> None:
        self._name = name
        self._uses_camera = uses_camera
        self._selector = selector
        self._settings = settings or PaperSettings()
        self._period_ns = round(self._settings.cycle_s * 1e9)
        self._site = SiteFrame(origin)
        self._R_body_cam = rig.T_body_cam[:3, :3]
        self._state = _State(gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m), declination_rad, selector)

    @property
    def name(self) -> str:
        """For instance `camera-gps-imu/famm`."""
        return self._name

    @property
    def uses_camera(self) -> bool:
        """Whether it wants `VisualMotion`."""
        return self._uses_camera

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement in order of arrival."""
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

    # -- inertial -----------------------------------------------------------------------------------------------------

    def _step_imu(self, sample: ImuSample) -> Outcome:
        s = self._state
        if not all(map(isfinite, (*sample.gyro_rad_s, *sample.accel_m_s2))):
            return Outcome.REJECTED_NOT_FINITE
        if s.imu_ns is not None:
            if sample.t_ns <= s.imu_ns:
                return Outcome.REJECTED_STALE
            if _leapt(sample.t_ns - s.imu_ns, sample.t_recv_ns - s.imu_recv_ns):
                return Outcome.REJECTED_GATE
        s.imu_ns, s.imu_recv_ns = sample.t_ns, sample.t_recv_ns
        s.calibration.step(sample)
        mean = s.sample_mean.step(sample)
        if mean is not None:
            self._integrate(mean)
        return Outcome.USED if s.filter is not None else Outcome.WAITING

    def _integrate(self, mean: MeanSample) -> None:
        s = self._state
        bias = s.calibration.gyro_offset_rad_s
        (gx, gy, gz), (bx, by, bz) = mean.gyro_rad_s, bias
        gyro = (gx - bx, gy - by, gz - bz)
        if s.attitude.wxyz_level_body is None and hypot(*mean.accel_m_s2) < 1.0:
            return  # a rig in free fall has no up
        q = s.attitude.update(gyro, mean.accel_m_s2, mean.dt_s)
        s.path.step(MeanSample(mean.t_ns, mean.dt_s, gyro, mean.accel_m_s2), q, s.heading.yaw_offset_rad)
        if s.compass_waiting is not None:
            # a phone tells its heading when it changes: one that was told before the first inertial sample still holds
            s.heading.compass(mean.t_ns, s.compass_waiting.yaw_rad, q)
            s.compass_waiting = None
        if s.filter is None:
            self._start(mean.t_ns)
        elif mean.t_ns >= s.due_ns:
            self._cycle(mean.t_ns)

    # -- the filter's cycle -------------------------------------------------------------------------------------------

    def _start(self, t_ns: int) -> None:
        s = self._state
        if s.fix is None:
            return
        s.filter = self._selector.filter_kind.start(
            self._settings.fusion, self._measured_position(t_ns)[0], self._measured_rotation(t_ns), s.fix.var_m2
        )
        s.cycle_ns, s.due_ns = t_ns, t_ns + self._period_ns
        s.filter_yaw_offset_rad = s.heading.yaw_offset_rad

    def _cycle(self, t_ns: int) -> None:
        """Predict, measure, update, and choose the next motion model."""
        s = self._state
        if s.filter is None:
            return
        self._turn_to_north(s.filter)
        s.filter.predict((t_ns - s.cycle_ns) * 1e-9, s.model)
        m_P, var_P = self._measured_position(t_ns)
        y_p, y_r = s.filter.innovation(m_P, self._measured_rotation(t_ns))
        s.filter.update(y_p, y_r, var_P)
        if y_p is not None:
            s.innovations.append(Innovation(t_ns, y_p, y_r, str(s.model)))
            s.model = self._selector.following(hypot(*y_p), hypot(*y_r), s.filter, s.model)
        s.cycle_ns = t_ns
        # on the beat, so that four a second stay four; what comes after a silence begins a new one
        s.due_ns = max(s.due_ns + self._period_ns, t_ns)

    def _turn_to_north(self, filter_: MotionFilter) -> None:
        """When north becomes known, or better known, the whole past was turned by a constant: that is no innovation."""
        s = self._state
        if s.heading.yaw_offset_rad != s.filter_yaw_offset_rad:
            turn_rad = (s.heading.yaw_offset_rad or 0.0) - (s.filter_yaw_offset_rad or 0.0)
            filter_.turn(turn_rad)
            s.filter_yaw_offset_rad = s.heading.yaw_offset_rad

    def _measured_rotation(self, t_ns: int) -> Vector3:
        """m_R: roll, pitch, yaw of Madgwick's attitude in site."""
        q = self._dead_reckoned_attitude(t_ns)
        return rpy_from_wxyz(q)

    def _dead_reckoned_attitude(self, t_ns: int) -> Wxyz:
        s = self._state
        state = s.path.at(t_ns)
        q = state.wxyz_level_body if state else (1.0, 0.0, 0.0, 0.0)
        return multiply(wxyz_from_yaw(s.heading.yaw_offset_rad or 0.0), q)

    def _measured_position(self, t_ns: int) -> tuple[Vector3, Vector3]:
        """m_P and its variance: the fix, carried on to t_ns (`keyframe_local`: p_gps plus the camera's displacement)."""
        s = self._state
        if s.fix is None:
            raise RuntimeError("a cycle needs a fix")
        here, sight, last = self._path_m(t_ns), s.fix.sight, s.camera.newest
        if sight is not None and last is not None and last is not sight:
            moved, inertial = _difference(last.p_m, sight.p_m), _difference(here, last.path_m)
        else:
            moved, inertial = (0.0, 0.0, 0.0), _difference(here, s.fix.path_m)
        x, y, z = (p + m + i for p, m, i in zip(s.fix.p_site_m, moved, inertial, strict=True))
        more = self._drift_var_m2(t_ns)
        vx, vy, vz = s.fix.var_m2
        return (x, y, z), (vx + more, vy + more, vz + more)

    def _path_m(self, t_ns: int) -> Vector3:
        state = self._state.path.at(t_ns)
        return state.p_m if state else (0.0, 0.0, 0.0)

    # -- GPS ----------------------------------------------------------------------------------------------------------

    def _step_fix(self, fix: GpsFix) -> Outcome:
        s = self._state
        if not fix.valid:
            return Outcome.REJECTED_WEAK
        if not all(map(isfinite, (fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m))) or abs(fix.lat_deg) > 90.0:
            return Outcome.REJECTED_NOT_FINITE
        p = self._site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m)
        old = s.fix
        if old is not None:
            if fix.t_ns <= old.t_ns:
                return Outcome.REJECTED_STALE
            dt_ns = fix.t_ns - old.t_ns
            if _leapt(dt_ns, fix.t_recv_ns - old.t_recv_ns) or s.gate.refuses(old.p_site_m, p, dt_ns * 1e-9):
                return Outcome.REJECTED_GATE
            insisted = s.gate.insisted()
            if s.filter is not None:
                s.filter.widen(self._drift_var_m2(fix.t_ns))
                if insisted:
                    s.filter.move_to(p)
        var_m2 = variance_m2(fix, self._settings.gps_floor_m, self._settings.gps_var_m2)
        s.fix = Fix(fix.t_ns, fix.t_recv_ns, p, var_m2, self._path_m(fix.t_ns), s.camera.near(fix.t_ns))
        if s.velocity is None or fix.t_ns - s.velocity.t_ns > self._settings.velocity_held_s * 1e9:
            if old is not None:
                s.path.correct_by_displacement(old.t_ns, fix.t_ns, _difference(p, old.p_site_m), old.path_m)
            s.course.fix(fix.t_ns, p, s.path, s.heading)
        return Outcome.USED

    def _drift_var_m2(self, t_ns: int) -> float:
        """How far dead reckoning may have gone astray since the last fix, beyond the usual second between two."""
        fix = self._state.fix
        age_s = max(0.0, (t_ns - fix.t_ns) * 1e-9 - 1.0) if fix is not None else 0.0
        return (self._settings.outage_speed_m_s * age_s) ** 2

    def _step_velocity(self, velocity: GpsVelocity) -> Outcome:
        """The receiver's own velocity is the integral's v(0); its gains, and its course, tell the start heading."""
        s = self._state
        if not all(map(isfinite, velocity.v_enu_m_s)):
            return Outcome.REJECTED_NOT_FINITE
        old = s.velocity
        if old is not None and velocity.t_ns <= old.t_ns:
            return Outcome.REJECTED_STALE
        leapt = old is not None and _leapt(velocity.t_ns - old.t_ns, velocity.t_recv_ns - old.t_recv_ns)
        if leapt or hypot(*velocity.v_enu_m_s) > FASTEST_M_S:
            return Outcome.REJECTED_GATE
        s.velocity = velocity
        s.path.correct_velocity(velocity.t_ns, velocity.v_enu_m_s)
        s.course.velocity(velocity, s.path, s.heading)
        return Outcome.USED

    # -- heading and camera -------------------------------------------------------------------------------------------

    def _step_heading(self, measurement: MagSample | CompassHeading) -> Outcome:
        s = self._state
        if s.heading.is_final:
            return Outcome.IGNORED  # the paper: once at the start, then six axes
        state = s.path.at(measurement.t_ns)
        if isinstance(measurement, CompassHeading):
            if not isfinite(measurement.yaw_rad):
                return Outcome.REJECTED_NOT_FINITE
            if state is None:
                s.compass_waiting = measurement
                return Outcome.WAITING
            s.heading.compass(measurement.t_ns, measurement.yaw_rad, state.wxyz_level_body)
            return Outcome.USED
        if not all(map(isfinite, measurement.field_body_t)):
            return Outcome.REJECTED_NOT_FINITE
        if state is None:
            return Outcome.WAITING
        s.heading.magnetometer(measurement.t_ns, measurement.field_body_t, state.wxyz_level_body)
        return Outcome.USED

    def _step_vision(self, motion: VisualMotion) -> Outcome:
        """Chain the camera's path. The essential matrix gives its direction, the IMU its length."""
        s = self._state
        if s.filter is None or s.heading.yaw_offset_rad is None:
            return Outcome.WAITING
        last = s.camera.newest
        if last is not None and motion.t_ns <= last.t_ns:
            return Outcome.REJECTED_STALE
        key = s.camera.held(motion.t_key_ns)
        if key is None:
            key = s.camera.begin(motion.t_key_ns, self._R_site_cam(motion.t_key_ns), self._path_m(motion.t_key_ns))
        walked_m = hypot(*s.path.displacement_m(motion.t_key_ns, motion.t_ns)[:2])
        length_m = min(walked_m, self._settings.fastest_walk_m_s * (motion.t_ns - motion.t_key_ns) * 1e-9)
        s.camera.chain(motion, key, length_m, self._R_site_cam(motion.t_ns), self._path_m(motion.t_ns))
        return Outcome.USED

    def _R_site_cam(self, t_ns: int) -> Matrix:
        return matrix_from_wxyz(self._dead_reckoned_attitude(t_ns)) @ self._R_body_cam

    # -- answers ------------------------------------------------------------------------------------------------------

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at t_ns: the last filtered one, moved by the inertial path between its cycle and t_ns."""
        s = self._state
        if s.filter is None:
            return None
        then, cycle = s.path.at(t_ns), s.path.at(s.cycle_ns)
        if then is None or cycle is None:
            return None
        x, y, z = (p + a - b for p, a, b in zip(s.filter.position_m, then.p_m, cycle.p_m, strict=True))
        turned = multiply(conjugate(cycle.wxyz_level_body), then.wxyz_level_body)
        q = multiply(wxyz_from_rpy(s.filter.rpy_rad), turned)
        yaw_rad = s.heading.yaw_offset_rad
        if yaw_rad is not None and yaw_rad != s.filter_yaw_offset_rad:
            q = multiply(wxyz_from_yaw(yaw_rad - (s.filter_yaw_offset_rad or 0.0)), q)
        return Pose(
            t_ns, (x, y, z), normalise(q), then.v_m_s, self._covariance(t_ns), str(s.model), yaw_rad is not None
        )

    def _covariance(self, t_ns: int) -> Matrix:
        """What a reader should believe. The filter takes GPS errors for white, but they last for minutes, and so does the
        error of the start heading: what averaging cannot remove is added back."""
        s, settings = self._state, self._settings
        if s.filter is None or s.fix is None:
            raise RuntimeError("no pose yet")
        drift = self._drift_var_m2(t_ns)
        heading = settings.heading_sigma_rad if s.heading.yaw_offset_rad is not None else pi / sqrt(3.0)
        rotation = (settings.tilt_sigma_rad**2, settings.tilt_sigma_rad**2, heading**2)
        position = (v + fix + drift for v, fix in zip(s.filter.var_value[:3], s.fix.var_m2, strict=True))
        return np.diag([*position, *(r + v for r, v in zip(rotation, s.filter.var_value[3:], strict=True))])

    def innovations(self) -> list[Innovation]:
        """Return the updates since the last call and forget them."""
        innovations, self._state.innovations = self._state.innovations, []
        return innovations

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return deepcopy(self._state)

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._state = deepcopy(snapshot)


class _State:
    """All that changes."""

    def __init__(self, gravity: float, declination_rad: float, selector: MotionSelector) -> None:
        self.calibration = RestCalibration()
        self.sample_mean = SampleMean()
        self.attitude = Madgwick()
        self.heading = StartHeading(declination_rad)
        self.path = InertialPath(gravity)
        self.filter: MotionFilter | None = None
        self.filter_yaw_offset_rad: float | None = None
        self.model = selector.first
        self.cycle_ns = 0
        self.due_ns = 0
        self.imu_ns: int | None = None
        self.imu_recv_ns = 0
        self.fix: Fix | None = None
        self.gate = FixGate()
        self.velocity: GpsVelocity | None = None
        self.course = CourseOverGround()
        self.compass_waiting: CompassHeading | None = None
        self.camera = CameraPath()
        self.innovations: list[Innovation] = []


def _leapt(stamps_ns: int, arrivals_ns: int) -> bool:
    return stamps_ns > arrivals_ns + _FASTEST_CLOCK_NS


def _difference(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
