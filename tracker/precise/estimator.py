"""`precise`: measurements in, poses out. What a sensor says is applied when it was measured, however late it came."""

from copy import deepcopy
from math import hypot, isfinite

import numpy as np

from tracker.estimator import Innovation, Origin, Pose, Snapshot
from tracker.fixes import FASTEST_M_S
from tracker.geodesy import SiteFrame, earth_rate_rad_s, gravity_m_s2
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
from tracker.precise.admission import Admission
from tracker.precise.blend import Blend
from tracker.precise.compass import Compass
from tracker.precise.engine import Engine
from tracker.precise.error_model import inertial_transition
from tracker.precise.free import FreeIntegral
from tracker.precise.gap import LONGEST_GAP_NS, doubt
from tracker.precise.ground import EyeHeight
from tracker.precise.memory import Memory, remember
from tracker.precise.navigation import Navigation
from tracker.precise.refusal import refusal
from tracker.precise.settings import PreciseSettings
from tracker.precise.timeline import Keyframe, Timed, Timeline
from tracker.rig import Rig

_KINDS = (ImuSample, MagSample, CompassHeading, GpsFix, GpsVelocity, VisualMotion, Sighting, Standpoint)
#: Further ahead of the newest inertial sample than this, nothing is known.
_LONGEST_PREDICTION_NS = 1_000_000_000
#: One head in a hundred has turned by 25 degrees that nobody saw when this long has passed since the newest sample.
_HEADING_HOLDS_NS = 300_000_000
#: What a head may do after the newest inertial sample: standard deviations of what adds to its motion then.
_UNFORESEEN_M_S2, _UNFORESEEN_RAD_S2 = 3.0, 4.0
#: A receiver that has told no position for this long may not be there: attitude alone is better than nothing.
_WAIT_FOR_FIX_S = 3.0
#: Position and rotation among the inertial states, and so in a pose.
_POSE = np.array([0, 1, 2, 6, 7, 8])
_DIAGONAL = (np.arange(6), np.arange(6))


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
        memory: Memory | None = None,
    ) -> None:
        """`eyes_z_m` is how high the rig is in site where it stands on the ground; None where no ground is known.

        `memory` is what the same rig had learned of its sensors at its last start; None where nothing is known.
        """
        self._name, self._uses_camera = name, uses_camera
        self._settings = settings or PreciseSettings()
        self._gravity = gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m)
        self._earth_rad_s = earth_rate_rad_s(origin.lat_deg)
        self._lag_ns = round(self._settings.lag_s * 1e9)
        self._site, self._rig, self._compass, self._eyes_z_m = SiteFrame(origin), rig, compass, eyes_z_m
        self._memory = memory
        self._admission = Admission(self._site)
        self._begin()

    def _begin(self) -> None:
        self._timeline = Timeline()
        compass = deepcopy(self._compass)
        self._engine = Engine(
            self._settings,
            self._site,
            self._rig,
            compass,
            self._gravity,
            self._earth_rad_s,
            self._eyes_z_m,
            self._memory,
        )
        self._blend = self._new_blend()
        self._free = FreeIntegral(self._gravity, self._lag_ns)

    def _new_blend(self) -> Blend:
        settings = self._settings
        return Blend(settings.blend_s, settings.blend_walking_s, settings.blend_turn_s, settings.lag_s)

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
        refused = refusal(measurement)
        if refused is not None:
            return refused
        newest_ns = self._timeline.newest_ns
        if newest_ns is not None and self._admission.refuses(measurement, newest_ns):
            return Outcome.REJECTED_GATE
        if (
            isinstance(measurement, ImuSample)
            and newest_ns is not None
            and measurement.t_ns > newest_ns + LONGEST_GAP_NS
        ):
            self._memory = self.memory() or self._memory
            self._begin()  # nobody knows what the rig has done in between
        if not self._timeline.add(measurement):
            if not isinstance(measurement, Sighting) or not self._engine.recalls(measurement):
                return Outcome.REJECTED_STALE
            self._take(measurement, None)  # somebody looked at the picture for a while
            return Outcome.USED
        if isinstance(measurement, VisualMotion):
            self._timeline.add(Keyframe(measurement.t_key_ns))
        if isinstance(measurement, ImuSample):
            self._free.add(measurement)
            self._catch_up()
        return Outcome.USED if self._engine.hypotheses is not None else Outcome.WAITING

    def _catch_up(self) -> None:
        last_ns = None
        for measurement, following in self._timeline.take(self._free.newest_ns - self._lag_ns):
            self._take(measurement, following)
            if isinstance(measurement, ImuSample):
                last_ns = measurement.t_ns
            if measurement.t_ns == last_ns and self._engine.hypotheses is not None:
                self._free.learn(last_ns, self._engine.best.biases)
        if last_ns is not None and self._engine.hypotheses is not None and not _is_walk(self._engine.best.nav):
            self._begin()  # lost: better to have no pose than that one

    def _take(self, measurement: Timed, following: ImuSample | None) -> None:
        """Let the engine take a measurement; where a sensor corrects it, what is shown goes on from where it was."""
        engine = self._engine
        if engine.hypotheses is None:
            engine.take(measurement, following)
            return
        before, corrections, had_place = engine.best.nav, engine.hypotheses.corrections, engine.fix_ns is not None
        engine.take(measurement, following)
        after = engine.best.nav
        self._blend.pace(after.t_ns, stands=engine.stands)
        is_said = isinstance(measurement, Sighting | Standpoint)  # who has asked for a correction wants to see it
        if is_said or (engine.fix_ns is not None and not had_place):
            self._blend = self._new_blend()
        elif engine.hypotheses.corrections != corrections:
            self._blend.corrected(self._free.carry(before, after.t_ns), after)

    # -- out ----------------------------------------------------------------------------------------------------------

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at t_ns; None while the filter has none, or where that is too long ago or too far ahead."""
        engine, free = self._engine, self._free
        if engine.hypotheses is None or (engine.fix_ns is None and engine.age_s < _WAIT_FOR_FIX_S):
            return None
        if not free.oldest_ns <= t_ns <= free.newest_ns + _LONGEST_PREDICTION_NS:
            return None
        start = self._blend.shown(engine.best.nav, t_ns)
        nav = free.carry(start, t_ns)
        cov = self._covariance(start, nav)
        if not _is_finite(nav) or not np.all(np.isfinite(cov)):
            return None
        is_seen = t_ns - free.newest_ns <= _HEADING_HOLDS_NS and not engine.is_after_gap
        known = is_seen and float(cov[5, 5]) < self._settings.heading_known_rad**2
        return Pose(t_ns, nav.p_m, nav.wxyz_site_body, nav.v_m_s, cov, engine.model, known)

    def _covariance(self, start: Navigation, end: Navigation) -> Matrix:
        """Return (6, 6): the filter's at its own time, carried on, with what is still to be faded in and what nobody foresees."""
        hypotheses = self._engine.hypotheses
        assert hypotheses is not None
        best, dt_s = hypotheses.best, (end.t_ns - start.t_ns) * 1e-9
        gained = np.array(end.v_m_s) - start.v_m_s
        gained[2] += self._gravity * dt_s
        Phi = inertial_transition(dt_s, best.R_site_body, gained)[_POSE]
        offset = Phi[:, :9] @ self._blend.offset(end.t_ns)
        cov: Matrix = Phi @ best.covariance[:15, :15] @ Phi.T + np.outer(offset, offset)
        p, _, tilt, turn = doubt(self._free.gaps_s(start.t_ns, end.t_ns))
        cov[_DIAGONAL] += (p, p, p, tilt, tilt, turn)
        ahead_s = max(0, end.t_ns - self._free.newest_ns) * 1e-9
        cov[:3, :3] += (0.5 * _UNFORESEEN_M_S2 * ahead_s**2) ** 2 * np.eye(3)
        cov[3:, 3:] += (0.5 * _UNFORESEEN_RAD_S2 * ahead_s**2) ** 2 * np.eye(3)
        cov[5, 5] += max(0.0, hypotheses.yaw_variance_rad2 - float(best.covariance[8, 8]))
        return cov

    def innovations(self) -> list[Innovation]:
        """Return nothing: these are the paper's filter error, of measurements m_P and m_R that this filter does not make."""
        return []

    def memory(self) -> Memory | None:
        """Return what is worth keeping for the next start of the same rig; None before the first fix."""
        engine = self._engine
        return remember(deepcopy(engine.best)) if engine.fix_ns is not None else None

    # -- state --------------------------------------------------------------------------------------------------------

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return deepcopy((self._admission, self._timeline, self._engine, self._blend, self._free, self._memory))

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._admission, self._timeline, self._engine, self._blend, self._free, self._memory = deepcopy(snapshot)


def _is_finite(nav: Navigation) -> bool:
    return isfinite(sum(nav.p_m) + sum(nav.v_m_s) + sum(nav.wxyz_site_body))


def _is_walk(nav: Navigation) -> bool:
    return _is_finite(nav) and hypot(*nav.v_m_s) <= FASTEST_M_S
