"""A live walk without its threads: what sensors say in, what the estimator is fed and how the sensors are out.

Sans-I/O: no thread and no clock; the same measurements at the same times give the same poses. What `record` is handed is what
the estimator is fed, in that order, so that a replay of it gives these poses again, bit for bit.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import hypot, isfinite

from tracker.estimator import Pose
from tracker.measurements import Frame, GpsFix, ImuSample, Measurement, Outcome, Said, Sighting, VisualMotion
from tracker.pipeline import Pipeline
from tracker.rig import Rig
from tracker.running.guard import Guard
from tracker.running.health import Health, Watch
from tracker.sources.source import SourceStatus
from tracker.upright import Upright

#: The camera sees nothing when its pictures were of no use for so long;
_BLIND_NS = 2_000_000_000
#: the receiver has no fix when it has said so for so long.
_NO_FIX_NS = 2_000_000_000

MakePipeline = Callable[[GpsFix | None], Pipeline]
"""Makes the walk's pipeline; the fix is the walk's first where the walk's own place was asked for, else None."""


class WalkCore:
    """One walk: guard, estimator and the watches of its sensors. One owner, no lock."""

    def __init__(
        self,
        make_pipeline: MakePipeline,
        rig: Rig,
        sensors: Mapping[str, int],
        *,
        waits_for_fix: bool = False,
        correct: Callable[[Measurement], Measurement] = lambda measurement: measurement,
        record: Callable[[Measurement], None] = lambda measurement: None,
    ) -> None:
        """Prepare a walk.

        Args:
            make_pipeline: See `MakePipeline`. Its front end, if it has one, is for the caller to run (`front_end`).
            rig: As the recording's reader will return it (`recorder.as_read`).
            sensors: Names of the sensors, and when each was opened.
            waits_for_fix: Nothing is fed before the first fix, which then lays the site.
            correct: Applied to every measurement first: the rig's calibration.
            record: Takes what is fed, at once.
        """
        self._make_pipeline, self._correct, self._record = make_pipeline, correct, record
        self._pipeline = None if waits_for_fix else make_pipeline(None)
        self._first_fix: GpsFix | None = None
        self._guard = Guard()
        self._upright = Upright(rig)
        self._t_fed_ns = 0
        self._frames = 0
        self._motion_ns: int | None = None
        self._no_fix_ns: int | None = None
        self.watches = {name: Watch(name, opened_ns) for name, opened_ns in sensors.items()}

    @property
    def pipeline(self) -> Pipeline | None:
        """The estimator and its counts; None while the first fix is waited for."""
        return self._pipeline

    @property
    def quarter_turns(self) -> int:
        """Clockwise turns that make pictures upright."""
        return self._upright.quarter_turns

    @property
    def newest_ns(self) -> int:
        """Arrival of what was fed last."""
        return self._t_fed_ns

    # -- in -----------------------------------------------------------------------------------------------------------

    def take(self, sensor: str, measurement: Measurement, now_ns: int) -> Measurement | None:
        """Take what a sensor says; return it as it was fed and recorded, or None where it was withheld."""
        self.watches[sensor].arrived(now_ns)
        measurement = self._in_order(self._correct(measurement))
        self._note_fix(measurement, now_ns)
        is_withheld = self._guard.withholds(measurement, self._speed_m_s(measurement))
        self._note_stuck()
        if is_withheld or not self._is_placed(measurement):
            return None
        if isinstance(measurement, Frame):
            measurement = replace(measurement, frame_id=self._frames)
            self._frames += 1
        self._t_fed_ns = measurement.t_recv_ns
        self._feed(measurement)
        return measurement

    def take_look(self, frame: Frame, motion: VisualMotion | None, now_ns: int, *, is_repeated: bool = False) -> None:
        """Take what the front end made of a picture."""
        watch = self.watches["camera"]
        if motion is not None or self._motion_ns is None:
            self._motion_ns = now_ns
        watch.is_stuck, watch.is_unusable = is_repeated, now_ns - self._motion_ns > _BLIND_NS
        if self._pipeline is None:
            return
        if motion is None:
            self._pipeline.step_vision(None)
            return
        motion = replace(motion, t_recv_ns=max(self._t_fed_ns + 1, now_ns))
        if not self._guard.withholds(motion, 0.0):
            self._t_fed_ns = motion.t_recv_ns
            self._feed(motion)

    def say(self, said: Said, now_ns: int) -> Outcome:
        """Take what a visitor says; before the walk has a pipeline nobody can have seen anything."""
        if self._pipeline is None:
            return Outcome.REJECTED_WEAK
        t_ns = max(self._t_fed_ns + 1, now_ns)
        # a landmark was seen in its picture; everything else is said of now
        said = replace(said, t_recv_ns=t_ns) if isinstance(said, Sighting) else replace(said, t_ns=t_ns, t_recv_ns=t_ns)
        self._t_fed_ns = t_ns
        self._record(said)
        return self._pipeline.step(said)

    def note(self, sensor: str, what: str, reason: str, now_ns: int) -> None:
        """Take news of a source: it was `opened`, is `lost`, or has `failed` for good, and why."""
        watch = self.watches[sensor]
        match what:
            case "opened":
                watch.opened(now_ns)
            case "lost":
                watch.lost(reason)
            case _:
                watch.failed(reason)

    def begin_anew(self) -> None:
        """Begin with a new estimator, where the old one has failed."""
        if self._pipeline is not None:
            self._pipeline = self._make_pipeline(self._first_fix)

    def _in_order(self, measurement: Measurement) -> Measurement:
        """Return it with an arrival after all that was fed before: a log keeps the order by nothing else."""
        t_recv_ns = max(self._t_fed_ns + 1, measurement.t_recv_ns)
        return measurement if t_recv_ns == measurement.t_recv_ns else replace(measurement, t_recv_ns=t_recv_ns)

    def _feed(self, measurement: Measurement) -> None:
        self._record(measurement)
        if isinstance(measurement, Frame):
            return  # the front end's caller has it, and the estimator gets what it makes of it
        if isinstance(measurement, ImuSample):
            self._upright.step(measurement)
        assert self._pipeline is not None
        self._pipeline.step(measurement)

    def _is_placed(self, measurement: Measurement) -> bool:
        """Return whether there is a pipeline; the walk's first fix makes it."""
        if self._pipeline is not None:
            return True
        if isinstance(measurement, GpsFix) and measurement.valid and isfinite(sum(_place(measurement))):
            self._first_fix = measurement
            self._pipeline = self._make_pipeline(measurement)
        return self._pipeline is not None

    def _speed_m_s(self, measurement: Measurement) -> float:
        """Return how fast the rig goes, for a fix; nobody asks at other times."""
        pose = self.pose(measurement.t_recv_ns) if isinstance(measurement, GpsFix) else None
        return 0.0 if pose is None else hypot(*pose.v_site_m_s)

    # -- out ----------------------------------------------------------------------------------------------------------

    def pose(self, t_ns: int) -> Pose | None:
        """Return the pose at a time."""
        return None if self._pipeline is None else self._pipeline.predict(t_ns)

    def health(self, now_ns: int, statuses: Mapping[str, SourceStatus] | None = None) -> dict[str, Health]:
        """Return how the sensors are; `statuses` is what their sources say."""
        known = statuses or {}
        return {name: watch.read(now_ns, known.get(name)) for name, watch in self.watches.items()}

    @property
    def withheld(self) -> dict[str, int]:
        """What the guard withheld, by reason."""
        return dict(self._guard.withheld)

    # -- watching -----------------------------------------------------------------------------------------------------

    def _note_fix(self, measurement: Measurement, now_ns: int) -> None:
        if not isinstance(measurement, GpsFix):
            return
        if measurement.valid:
            self._no_fix_ns = None
        elif self._no_fix_ns is None:
            self._no_fix_ns = now_ns
        self.watches["gps"].is_unusable = self._no_fix_ns is not None and now_ns - self._no_fix_ns > _NO_FIX_NS

    def _note_stuck(self) -> None:
        for name, is_stuck in (("imu", self._guard.imu_stuck), ("gps", self._guard.gps_stuck)):
            if name in self.watches:
                self.watches[name].is_stuck = is_stuck


def _place(fix: GpsFix) -> tuple[float, float, float]:
    return fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m
