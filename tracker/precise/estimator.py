"""`precise`: measurements in, poses out. What a sensor says is applied when it was measured, however late it came."""

from copy import deepcopy
from math import hypot, isfinite

import numpy as np

from tracker.estimator import Innovation, Origin, Pose, Snapshot
from tracker.fixes import FASTEST_M_S
from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Matrix,
    Measurement,
    Outcome,
    Sighting,
    Standpoint,
    VisualMotion,
)
from tracker.precise.blend import Blend
from tracker.precise.compass import Compass
from tracker.precise.engine import Engine, EyeHeight
from tracker.precise.error_state import ErrorState
from tracker.precise.navigation import Biases, Navigation, advance, carried, mean
from tracker.precise.settings import PreciseSettings
from tracker.precise.timeline import Keyframe, Timeline
from tracker.rig import Rig

_KINDS = (ImuSample, MagSample, CompassHeading, GpsFix, GpsVelocity, VisualMotion, Sighting, Standpoint)
#: A stamp that is ahead of its arrival by more than this is a clock that leapt.
_FASTEST_CLOCK_NS = 2_000_000_000
#: A prediction goes on with the last rates at most this long, and turns on for the first part of it.
_LONGEST_PREDICTION_S, _LONGEST_TURN_S = 1.0, 0.1
#: A receiver that has told no position for this long may not be there: attitude alone is better than nothing.
_WAIT_FOR_FIX_S = 3.0
#: States of the free integral are kept for predictions of the recent past.
_KEPT_S = 2.0


class PreciseEstimator:
    """An error-state filter half a second behind, and the strapdown integral from there to now."""

    def __init__(
        self,
        name: str,
        *,
        origin: Origin,
        rig: Rig,
        compass: Compass,
        uses_camera: bool,
        settings: PreciseSettings | None = None,
        eyes_z_m: EyeHeight | None = None,
    ) -> None:
        """`eyes_z_m` is how high the rig is in site where it stands on the ground; None where no ground is known."""
        self._name, self._uses_camera = name, uses_camera
        self._settings = settings or PreciseSettings()
        self._gravity = gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m)
        self._timeline = Timeline()
        self._engine = Engine(self._settings, SiteFrame(origin), rig, compass, self._gravity, eyes_z_m)
        self._blend = Blend(self._settings.blend_s)
        self._free: list[tuple[Navigation, ImuSample]] = []
        """The strapdown integral that no measurement corrects, and the sample that ended each step."""

    @property
    def name(self) -> str:
        """For instance `camera-gps-imu/precise`."""
        return self._name

    @property
    def uses_camera(self) -> bool:
        """Whether it wants `VisualMotion`."""
        return self._uses_camera

    # -- in -----------------------------------------------------------------------------------------------------------

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement in order of arrival."""
        if not isinstance(measurement, _KINDS) or (isinstance(measurement, VisualMotion) and not self._uses_camera):
            return Outcome.IGNORED
        refused = _refusal(measurement)
        if refused is not None:
            return refused
        if not self._timeline.add(measurement):
            return Outcome.REJECTED_STALE
        if isinstance(measurement, VisualMotion):
            self._timeline.add(Keyframe(measurement.t_key_ns))
            if measurement.is_keyframe:
                self._timeline.add(Keyframe(measurement.t_ns))
        if isinstance(measurement, ImuSample):
            self._integrate(measurement)
            self._catch_up()
        return Outcome.USED if self._engine.hypotheses is not None else Outcome.WAITING

    def _catch_up(self) -> None:
        newest_ns, timeline, engine = self._timeline.newest_ns, self._timeline, self._engine
        if newest_ns is None:
            return
        taken = timeline.take(newest_ns - round(self._settings.lag_s * 1e9))
        if not taken:
            return
        before = engine.best.nav if engine.hypotheses is not None else None
        corrections = engine.hypotheses.corrections if engine.hypotheses is not None else 0
        for measurement in taken:
            engine.take(measurement, timeline.imu[0] if timeline.imu else None)
        if before is not None and engine.hypotheses is not None and engine.hypotheses.corrections != corrections:
            self._blend.corrected(self._carried(before, newest_ns), self._carried(engine.best.nav, newest_ns))

    def _integrate(self, sample: ImuSample) -> None:
        """Carry the free integral on; a sample that came late has it done again from there."""
        free = self._free
        late = [sample]
        while free and free[-1][0].t_ns >= sample.t_ns:
            late.append(free.pop()[1])
        for one in sorted(late, key=lambda s: s.t_ns):
            free.append((self._next(one), one))
        while free[-1][0].t_ns - free[0][0].t_ns > _KEPT_S * 1e9:
            del free[: len(free) // 4]

    def _next(self, sample: ImuSample) -> Navigation:
        if not self._free:
            zero = (0.0, 0.0, 0.0)
            return Navigation(sample.t_ns, zero, zero, (1.0, 0.0, 0.0, 0.0))
        nav, last = self._free[-1]
        gyro, accel = mean(last.gyro_rad_s, sample.gyro_rad_s), mean(last.accel_m_s2, sample.accel_m_s2)
        return advance(nav, sample.t_ns, gyro, accel, self._biases, self._gravity)

    @property
    def _biases(self) -> Biases:
        return self._engine.best.biases if self._engine.hypotheses is not None else Biases()

    # -- out ----------------------------------------------------------------------------------------------------------

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at t_ns."""
        engine = self._engine
        if engine.hypotheses is None or (engine.fix_ns is None and engine.age_s < _WAIT_FOR_FIX_S):
            return None
        best = engine.best
        nav = self._blend.shown(self._carried(best.nav, t_ns))
        cov = self._covariance(best, (t_ns - best.nav.t_ns) * 1e-9)
        if not all(map(isfinite, (*nav.p_m, *nav.wxyz_site_body))) or not np.all(np.isfinite(cov)):
            return None
        known = float(cov[5, 5]) < self._settings.heading_known_rad**2
        return Pose(t_ns, nav.p_m, nav.wxyz_site_body, nav.v_m_s, cov, engine.model, known)

    def _carried(self, state: Navigation, t_ns: int) -> Navigation:
        """Return a state of the filter, carried on to a time by the free integral."""
        return carried(state, self._free_at(state.t_ns), self._free_at(t_ns), self._gravity)

    def _free_at(self, t_ns: int) -> Navigation:
        """Return the free integral at a time: between two samples, or carried on after the newest."""
        free = self._free
        nav, sample = free[-1]
        if t_ns >= nav.t_ns:
            return self._beyond(nav, sample, t_ns)
        low, high = 0, len(free) - 1
        while low < high:
            middle = (low + high) // 2
            if free[middle][0].t_ns < t_ns:
                low = middle + 1
            else:
                high = middle
        if free[low][0].t_ns == t_ns or low == 0:
            return free[low][0]
        before, after = free[low - 1], free[low]
        gyro = mean(before[1].gyro_rad_s, after[1].gyro_rad_s)
        accel = mean(before[1].accel_m_s2, after[1].accel_m_s2)
        return advance(before[0], t_ns, gyro, accel, self._biases, self._gravity)

    def _beyond(self, nav: Navigation, sample: ImuSample, t_ns: int) -> Navigation:
        """Go on with the newest rates for a moment, then straight on, then not at all."""
        ahead_s = min((t_ns - nav.t_ns) * 1e-9, _LONGEST_PREDICTION_S)
        if ahead_s <= 0.0:
            return nav
        turning_s = min(ahead_s, _LONGEST_TURN_S)
        turned_ns = nav.t_ns + round(turning_s * 1e9)
        on = advance(nav, turned_ns, sample.gyro_rad_s, sample.accel_m_s2, self._biases, self._gravity)
        if ahead_s <= turning_s:
            return on._replace(t_ns=t_ns)
        # without a force that is known, the velocity is held: seen from a frame that falls freely, it does not change
        rest_s = ahead_s - turning_s
        (px, py, pz), (vx, vy, vz) = on.p_m, on.v_m_s
        return Navigation(t_ns, (px + vx * rest_s, py + vy * rest_s, pz + vz * rest_s), on.v_m_s, on.wxyz_site_body)

    def _covariance(self, best: ErrorState, ahead_s: float) -> Matrix:
        """Position and rotation of the filter's own time, carried on by what velocity is unsure of."""
        rows = np.array([0, 1, 2, 6, 7, 8])
        full = best.covariance
        cov: Matrix = full[np.ix_(rows, rows)].copy()
        if ahead_s > 0.0:
            velocity = full[3:6, 3:6]
            cross = full[0:3, 3:6]
            cov[:3, :3] += ahead_s * (cross + cross.T) + ahead_s**2 * velocity
        assert self._engine.hypotheses is not None
        cov[5, 5] += max(0.0, self._engine.hypotheses.yaw_variance_rad2 - float(full[8, 8]))
        return cov

    def innovations(self) -> list[Innovation]:
        """Return nothing: these are the paper's filter error, of measurements m_P and m_R that this filter does not make."""
        return []

    # -- state --------------------------------------------------------------------------------------------------------

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return deepcopy((self._timeline, self._engine, self._blend, self._free))

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._timeline, self._engine, self._blend, self._free = deepcopy(snapshot)


def _refusal(measurement: Measurement) -> Outcome | None:
    """Return why a measurement cannot be used, whatever the state is."""
    if measurement.t_ns > measurement.t_recv_ns + _FASTEST_CLOCK_NS:
        return Outcome.REJECTED_GATE
    match measurement:
        case ImuSample():
            if not all(map(isfinite, (*measurement.gyro_rad_s, *measurement.accel_m_s2))):
                return Outcome.REJECTED_NOT_FINITE
            if hypot(*measurement.gyro_rad_s) > 50.0 or hypot(*measurement.accel_m_s2) > 400.0:
                return Outcome.REJECTED_GATE
        case GpsFix():
            if not measurement.valid:
                return Outcome.REJECTED_WEAK
            numbers = (measurement.lat_deg, measurement.lon_deg, measurement.h_ellipsoid_m)
            if not all(map(isfinite, numbers)) or abs(measurement.lat_deg) > 90.0:
                return Outcome.REJECTED_NOT_FINITE
        case GpsVelocity():
            if not all(map(isfinite, measurement.v_enu_m_s)):
                return Outcome.REJECTED_NOT_FINITE
            if hypot(*measurement.v_enu_m_s) > FASTEST_M_S:
                return Outcome.REJECTED_GATE
        case MagSample():
            if not all(map(isfinite, measurement.field_body_t)):
                return Outcome.REJECTED_NOT_FINITE
        case CompassHeading():
            if not isfinite(measurement.yaw_rad):
                return Outcome.REJECTED_NOT_FINITE
        case Sighting():
            if not all(map(isfinite, (*measurement.point_site_m, *measurement.ray_cam, measurement.sigma_rad))):
                return Outcome.REJECTED_NOT_FINITE
            if measurement.sigma_rad <= 0.0 or abs(hypot(*measurement.ray_cam) - 1.0) > 1e-3:
                return Outcome.REJECTED_GATE
        case Standpoint():
            if not all(map(isfinite, (*measurement.p_site_m, measurement.sigma_m))):
                return Outcome.REJECTED_NOT_FINITE
            if measurement.sigma_m <= 0.0:
                return Outcome.REJECTED_GATE
    return None
