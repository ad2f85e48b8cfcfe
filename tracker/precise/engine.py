"""The filter fed in the order of measuring: each measurement carries the state on to its stamp and corrects it there."""

from collections.abc import Iterator
from contextlib import contextmanager
from math import hypot, sqrt

import numpy as np

from tracker.geodesy import SiteFrame
from tracker.geometry import wrap_rad, yaw_of
from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Sighting,
    Standpoint,
    Vector3,
    VisualMotion,
)
from tracker.precise import observations
from tracker.precise.activity import Activity
from tracker.precise.compass import Compass
from tracker.precise.error_state import ErrorState
from tracker.precise.eye import Eye
from tracker.precise.gap import LEVEL_NOISE, AfterGap, drift, has_lost_heading, is_gap
from tracker.precise.ground import EyeHeight, standing_z_m
from tracker.precise.hypotheses import Hypotheses
from tracker.precise.landmarks import Landmarks
from tracker.precise.memory import Memory
from tracker.precise.navigation import mean, sample_between
from tracker.precise.receiver import Receiver
from tracker.precise.settings import PreciseSettings
from tracker.precise.start import Start
from tracker.precise.stride import Stride
from tracker.precise.timeline import Keyframe, Timed
from tracker.precise.update import Correction
from tracker.precise.way import Way
from tracker.rig import Rig

_I3 = np.eye(3)


class Engine:
    """State of the world as of the last measurement taken."""

    def __init__(
        self,
        settings: PreciseSettings,
        site: SiteFrame,
        rig: Rig,
        compass: Compass,
        gravity_m_s2: float,
        earth_rad_s: Vector3,
        eyes_z_m: EyeHeight | None = None,
        memory: Memory | None = None,
    ) -> None:
        self._eyes_z_m = eyes_z_m
        self._settings = settings
        self._eye = Eye(settings, rig)
        x, y, z = rig.T_body_gps[:3, 3].tolist()
        self._receiver = Receiver(settings, site, (x, y, z), memory)
        self._way = Way()
        self._landmarks = Landmarks(self._eye.lever_m, self._way)
        self._compass = compass
        self._activity = Activity()
        self._stride = Stride()
        self._start = Start(settings, gravity_m_s2, earth_rad_s, memory)
        self._last: ImuSample | None = None
        self._counted_ns = 0
        self._after_gap: AfterGap | None = None
        self.hypotheses: Hypotheses | None = None
        """None until the first half second of inertial samples."""
        self._began_ns: int | None = None
        self._compass_due_ns = 0
        self._suspicion = 0.0
        self.heading_found = False

    @property
    def fix_ns(self) -> int | None:
        """When the last fix taken in was made."""
        return self._receiver.fix_ns

    @property
    def age_s(self) -> float:
        """How long the filter has run."""
        if self.hypotheses is None or self._began_ns is None:
            return 0.0
        return (self.best.nav.t_ns - self._began_ns) * 1e-9

    @property
    def model(self) -> str:
        """The motion model that the controller has chosen."""
        return str(self._activity.model)

    @property
    def stands(self) -> bool:
        """Whether the rig is where it was."""
        return self._activity.stands

    # -- time ---------------------------------------------------------------------------------------------------------

    def take(self, measurement: Timed, following: ImuSample | None) -> None:
        """Take the next measurement; `following` is the first inertial sample after it."""
        if isinstance(measurement, ImuSample):
            self._take_imu(measurement)
            return
        if self.hypotheses is None or self._last is None:
            return
        if following is not None and measurement.t_ns > self._last.t_ns:
            sample = sample_between(self._last, following, measurement.t_ns)
            self._take_imu(sample, counted=False, in_gap=is_gap(self._counted_ns, following.t_ns))
        with self._heading_followed():
            self._correct(measurement)

    @contextmanager
    def _heading_followed(self) -> Iterator[None]:
        """Tell the compass of every correction of the heading, since it holds what was measured against the filter's."""
        before_rad = yaw_of(self.best.nav.wxyz_site_body)
        yield
        self._compass.turned(wrap_rad(yaw_of(self.best.nav.wxyz_site_body) - before_rad))

    def _correct(self, measurement: Timed) -> None:
        assert self.hypotheses is not None
        match measurement:
            case GpsFix():
                self._take_fix(measurement)
            case GpsVelocity():
                self._take_velocity(measurement)
            case MagSample():
                self._take_magnetometer(measurement)
            case CompassHeading():
                self._compass.heading(wrap_rad(measurement.yaw_rad - yaw_of(self.best.nav.wxyz_site_body)))
            case VisualMotion():
                self._eye.take(self.hypotheses, measurement)
            case Sighting():
                self._take_sighting(measurement)
            case Standpoint():
                noise = measurement.sigma_m**2 * _I3
                self.hypotheses.correct(
                    lambda f: f.correct(*observations.position(f, measurement.p_site_m), noise, gated=False)
                )
            case Keyframe():
                self._eye.hold(self.hypotheses, measurement.t_ns)

    def _take_imu(self, sample: ImuSample, *, counted: bool = True, in_gap: bool = False) -> None:
        last = self._last
        if last is None or self.hypotheses is None:
            self._begin(sample)
            return
        self._last = sample
        gyro, accel = mean(last.gyro_rad_s, sample.gyro_rad_s), mean(last.accel_m_s2, sample.accel_m_s2)
        before, in_gap = self.best.nav, in_gap or (counted and is_gap(self._counted_ns, sample.t_ns))
        for filter_ in self.hypotheses.filters:
            if in_gap:
                drift(filter_, sample.t_ns)
            else:
                filter_.advance(sample.t_ns, gyro, accel)
        self._way.moved(before, self.best.nav)
        if counted:
            self._counted_ns = sample.t_ns
            self._look_after_gap(sample, in_gap)
        if counted and self._eye.is_behind:
            with self._heading_followed():
                self._eye.go_on(self.hypotheses)
        if counted and not in_gap and self._activity.step(sample):
            with self._heading_followed():
                self._cycle(sample.t_ns)

    @property
    def is_after_gap(self) -> bool:
        """Whether a gap was so short a time ago that nothing has told yet how the rig has turned in it."""
        return self._after_gap is not None

    def _look_after_gap(self, sample: ImuSample, in_gap: bool) -> None:
        """Level the rig when half a second after a gap is over, and look for its heading where nothing has told it."""
        hypotheses = self.hypotheses
        assert hypotheses is not None
        if in_gap:
            self._after_gap = AfterGap(sample.t_ns)
            self._compass.forget()
            self._activity.forget()
        elif self._after_gap is not None and (due := self._after_gap.take(sample, self.best)) is not None:
            if due == "level" and not hypotheses.are_many:
                level = self._after_gap.level()
                hypotheses.correct(lambda f: f.correct(*level, LEVEL_NOISE))
                self._compass.forget()  # it was told while the rig seemed to lean otherwise
            elif due == "heading":
                self._after_gap = None
                if not hypotheses.are_many and has_lost_heading(self.best):
                    self._find_heading(yaw_of(self.best.nav.wxyz_site_body))

    def _begin(self, sample: ImuSample) -> None:
        self._last, self._counted_ns = sample, sample.t_ns
        self._activity.step(sample)
        state = self._start.take(sample)
        if state is not None:
            self._began_ns = sample.t_ns
            self.hypotheses = Hypotheses(state)

    @property
    def best(self) -> ErrorState:
        """The most likely filter."""
        assert self.hypotheses is not None
        return self.hypotheses.best

    # -- standing and walking -----------------------------------------------------------------------------------------

    def _cycle(self, t_ns: int) -> None:
        """Four times a second: what the activity says of velocity and bias."""
        hypotheses, activity, settings = self.hypotheses, self._activity, self._settings
        assert hypotheses is not None
        if activity.stands:
            sigma = settings.still_sigma_m_s + 0.1 * hypot(*activity.gyro_mean_rad_s)
            hypotheses.correct(
                lambda f: f.correct(
                    *observations.velocity(f, (0.0, 0.0, 0.0)),
                    sigma**2 * _I3,
                    gated=not self._receiver.is_blind(t_ns),
                    tells_north=self._receiver.may_tell_north(self.best),
                )
            )
            if activity.is_still:
                noise = settings.still_rate_sigma_rad_s**2 * _I3
                hypotheses.correct(lambda f: f.correct(*observations.turn_rate(f, activity.gyro_mean_rad_s), noise))
        elif self._receiver.is_blind(t_ns):
            hypotheses.correct(self._go_on)
        else:
            self._stride.learn(activity.force_spread_m_s2, self.best.nav)
        self._stand_on_ground()

    def _go_on(self, filter_: ErrorState) -> Correction:
        seen, noise = self._stride.onward(self._activity.force_spread_m_s2, filter_, self._settings)
        # who looks where they do not go must not turn north; of a rig held in the hands nothing is known but that it stays
        tells_north = self._receiver.may_tell_north(self.best) and not self._stride.is_learned
        return filter_.correct(*seen, noise, gated=False, tells_north=tells_north)

    # -- receiver -----------------------------------------------------------------------------------------------------

    def _take_fix(self, fix: GpsFix) -> None:
        hypotheses, receiver = self.hypotheses, self._receiver
        assert hypotheses is not None
        is_first = receiver.fix_ns is None
        if is_first:
            receiver.place(hypotheses, fix)
            self._find_heading()
        receiver.take_fix(hypotheses, fix, self._way.walked_m)
        if is_first:
            self._stand_on_ground()  # before anything is shown: a first height that is off by metres would be seen sliding
        self._judge_heading()

    def _take_velocity(self, measured: GpsVelocity) -> None:
        hypotheses, last = self.hypotheses, self._last
        assert hypotheses is not None
        assert last is not None
        done = self._receiver.take_velocity(hypotheses, measured, last.gyro_rad_s)
        if done is not None and self.heading_found:
            self._suspicion += 0.1 * (min(done.nis, 30.0) - self._suspicion)
            if self._suspicion > 8.0:
                self._find_heading()
        self._judge_heading()

    def _judge_heading(self) -> None:
        assert self.hypotheses is not None
        if not self.hypotheses.are_many and float(self.best.covariance[8, 8]) < self._settings.converged_rad**2:
            self.heading_found = True

    # -- what people and the ground say -------------------------------------------------------------------------------

    def recalls(self, seen: Sighting) -> bool:
        """Whether a sighting of some time ago can still be taken: as seen from now, by the way since."""
        return self.hypotheses is not None and self._landmarks.recalls(seen)

    def _take_sighting(self, seen: Sighting) -> None:
        assert self.hypotheses is not None
        for one in self._landmarks.see(seen, self._eye.ray_body(seen.ray_cam)):
            self.hypotheses.correct(lambda f, one=one: self._landmarks.correct(f, one))  # type: ignore[misc]

    def _stand_on_ground(self) -> None:
        """Take the height of the eyes above the ground, unless the rig is off it: on stairs, or on something."""
        assert self.hypotheses is not None
        if self._eyes_z_m is None or self.fix_ns is None:
            return
        sigma, cov = self._settings.eye_height_sigma_m, self.best.covariance
        within_m, off_m = sqrt(max(float(cov[0, 0]), float(cov[1, 1]))), 4.0 * sigma + 3.0 * sqrt(float(cov[2, 2]))
        z_m = standing_z_m(self._eyes_z_m, self.best.nav.p_m, within_m, off_m)
        if z_m is not None:
            noise = np.array([[self._settings.eye_height_repeats * sigma**2]])
            self.hypotheses.correct(lambda f: f.correct(*observations.height(f, z_m), noise))

    # -- heading ------------------------------------------------------------------------------------------------------

    def _find_heading(self, likely_rad: float | None = None) -> None:
        """Try all headings; without a compass `likely_rad` is preferred."""
        assert self.hypotheses is not None
        self.heading_found, self._suspicion = False, 0.0
        told_rad = self._compass.yaw_rad(self.best.nav.wxyz_site_body)
        self.hypotheses.spread(self._settings.hypotheses, likely_rad if told_rad is None else told_rad)

    def _take_magnetometer(self, sample: MagSample) -> None:
        hypotheses, settings = self.hypotheses, self._settings
        assert hypotheses is not None
        self._compass.field(sample, self.best.nav.wxyz_site_body)
        leans = self._after_gap is not None and not self._after_gap.is_level
        if hypotheses.are_many or leans or not self._compass.is_trusted or sample.t_ns < self._compass_due_ns:
            return
        self._compass_due_ns = sample.t_ns + round(settings.magnetic_every_s * 1e9)
        noise = np.array([[settings.magnetic_sigma_rad**2]])
        declination_rad = self._compass.declination_rad
        hypotheses.correct(
            lambda f: f.correct(*observations.magnetic_yaw(f, sample.field_body_t, declination_rad), noise)
        )
