"""A live walk's threads: sensors, vision, fusion, the recorder, and what shows the pictures.

As in the paper's "Multi-threaded approach": each hands over through one mailbox (`mail`). Fusion owns the estimator and drains
its mailbox in batches; the newest pose is published by binding a name anew, so nobody waits for it with a lock. A picture goes out
with the pose of its own capture as soon as it is there; what vision makes of it comes later and corrects what follows.
"""

import logging
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from threading import Event, Thread
from time import monotonic, monotonic_ns
from types import MappingProxyType

from tracker.blank import blank_picture
from tracker.errors import MalformedInput
from tracker.estimator import Innovation, Pose
from tracker.measurements import Frame, ImuSample, Outcome, Said
from tracker.pipeline import FrontEnd
from tracker.playback import Shown
from tracker.running.core import WalkCore
from tracker.running.figures import Latencies, Rate
from tracker.running.health import Health
from tracker.running.mail import Batch, Intake, Look, Slot
from tracker.running.recorder import Recorder, RecorderState
from tracker.running.supervisor import SourceThread
from tracker.sources.source import Source

_logger = logging.getLogger(__name__)

#: A pose is published at least this often, whether a sensor says anything or not.
_PERIOD_S = 0.01
#: How often the sensors' health is worked out.
_HEALTH_NS = 200_000_000
#: A walk without a camera is shown over an empty picture, so often.
_BLANK_NS = 100_000_000
#: The newest pose is shown this often, whatever pictures come: who watches from beside sees thirty steps a second.
_POSE_S = 1.0 / 30.0
#: The camera repeats itself when so many pictures, for so long, are the same to the last byte.
_SAMES, _SAME_NS = 10, 2_000_000_000
#: A source has so long to close its device before it is left behind.
_FAREWELL_S = 3.0
#: Updates of the filter that are kept for whoever asks: a minute of them.
_INNOVATIONS = 240
#: An estimator that fails more often than this in a row is not begun anew.
_MOST_FAILURES = 5


@dataclass(frozen=True, slots=True)
class WalkState:
    """How a walk is, at one moment."""

    t_ns: int
    pose: Pose | None
    poses_hz: float
    looks_hz: float
    """Pictures that vision has looked at, each second."""
    latency_p50_ms: float | None
    latency_p99_ms: float | None
    """From an inertial sample's arrival to the pose that knows of it."""
    latency_longest_ms: float
    sensors: Mapping[str, Health]
    lost: Mapping[str, int]
    """Measurements that no mailbox had a place for."""
    withheld: Mapping[str, int]
    """What was not fed, by reason."""
    rejected: Mapping[str, int]
    """What the estimator refused, by reason."""
    recorder: RecorderState | None


_NO_COUNTS: Mapping[str, int] = MappingProxyType({})
_NOBODY: Mapping[str, Health] = MappingProxyType({})


class LiveWalk:
    """One walk with live sensors. Use `start` and `close`, or both at once as a context manager."""

    def __init__(
        self,
        core: WalkCore,
        sources: Sequence[Source],
        *,
        show: Callable[[Shown], None] = lambda shown: None,
        show_pose: Callable[[Pose | None], None] = lambda pose: None,
        recorder: Recorder | None = None,
    ) -> None:
        """Prepare a walk.

        Args:
            core: Used by the fusion thread alone from now on.
            sources: One for each of the core's sensors.
            show: Takes each picture with the pose of its capture, on a thread of its own; the newest wins where it is slow.
            show_pose: Takes the newest pose, or None, thirty times a second, on the same thread.
            recorder: Is given what the core records by whoever made the core; closed here, last.
        """
        self._core, self._show, self._show_pose, self._recorder = core, show, show_pose, recorder
        self._intake = Intake()
        self._news: deque[tuple[str, str, str]] = deque()
        self._said: deque[tuple[Said, Future[Outcome]]] = deque()
        self._sources = [SourceThread(source, self._intake.put, self._tell) for source in sources]
        self._has_camera = any(source.name == "camera" for source in sources)
        self._stop = Event()
        self._vision: _LiveVision | None = None
        self._shown: Slot[Shown] = Slot()
        self._latencies, self._poses = Latencies(), Rate()
        self._innovations: deque[Innovation] = deque(maxlen=_INNOVATIONS)
        self._health: Mapping[str, Health] = _NOBODY
        self._health_due_ns = self._blank_due_ns = 0
        self._blanks = self._failures = 0
        self.pose: Pose | None = None
        """The newest pose; rebound as a whole."""
        self.error: BaseException | None = None
        """What ended fusion, where it was not `close`."""
        self._fusion = Thread(target=self._run, name="fusion", daemon=True)
        self._showing = Thread(target=self._show_all, name="show", daemon=True)

    def start(self) -> None:
        """Start every thread."""
        self._fusion.start()
        self._showing.start()
        for source in self._sources:
            source.start()

    def close(self) -> None:
        """End every thread, sources first, and close the recording."""
        for source in self._sources:
            source.stop()
        for source in self._sources:
            if source.source.name and not source.join(_FAREWELL_S):
                _logger.warning("the source %s does not end: it is left behind", source.source.name)
        self._stop.set()
        self._intake.ring()
        self._fusion.join()
        if self._vision is not None:
            self._vision.close()
        self._shown.close()
        self._showing.join()
        while self._said:
            self._said.popleft()[1].cancel()
        if self._recorder is not None:
            self._recorder.close()

    def __enter__(self) -> "LiveWalk":
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    @property
    def state(self) -> WalkState:
        """How it is now; from any thread."""
        now_ns, core = monotonic_ns(), self._core
        rejected = core.pipeline.rejected.copy() if core.pipeline else _NO_COUNTS
        return WalkState(
            now_ns,
            self.pose,
            self._poses.at(now_ns),
            0.0 if self._vision is None else self._vision.rate.at(now_ns),
            _ms(self._latencies.percentile_s(50.0)),
            _ms(self._latencies.percentile_s(99.0)),
            self._latencies.longest_s * 1e3,
            self._health,
            dict(self._intake.lost),
            core.withheld,
            rejected,
            None if self._recorder is None else self._recorder.state,
        )

    def innovations(self) -> list[Innovation]:
        """Return the filter's updates since the last call, oldest first; from any one thread."""
        return [self._innovations.popleft() for _ in range(len(self._innovations))]

    def _tell(self, sensor: str, what: str, reason: str) -> None:
        """Take news of a source, on its own thread, for fusion."""
        self._news.append((sensor, what, reason))
        self._intake.ring()

    def say(self, said: Said) -> "Future[Outcome]":
        """Take what a visitor says, on any thread, for fusion; the result is what became of it."""
        future: Future[Outcome] = Future()
        self._said.append((said, future))
        self._intake.ring()
        return future

    # -- fusion -------------------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                self._intake.wait(_PERIOD_S)
                self._turn(self._intake.take(), monotonic_ns())
                self._failures = 0
            except Exception as error:
                _logger.exception("fusion failed; the estimator begins anew")
                self._failures += 1
                if self._failures > _MOST_FAILURES:
                    self.error = error
                    return
                self._core.begin_anew()
                self._take_front_end()

    def _turn(self, batch: Batch, now_ns: int) -> None:
        core = self._core
        while self._news:
            core.note(*self._news.popleft(), now_ns)
        for sensor, measurement in batch.measurements:
            core.take(sensor, measurement, now_ns)
        for look in batch.looks:
            core.take_look(look.frame, look.motion, now_ns, is_repeated=look.is_repeated)
        while self._said:
            said, future = self._said.popleft()
            future.set_result(core.say(said, now_ns))
        frames = [core.take(sensor, frame, now_ns) for sensor, frame in batch.frames]
        t_ns = monotonic_ns()
        self.pose = core.pose(t_ns)
        if self.pose is not None:
            self._poses.note(t_ns)
        if core.pipeline is not None:
            self._innovations.extend(core.pipeline.innovations())
        for _, measurement in batch.measurements:
            if isinstance(measurement, ImuSample):
                self._latencies.add((t_ns - measurement.t_recv_ns) * 1e-9)
        self._take_front_end()
        for frame in frames:
            if isinstance(frame, Frame):
                self._hand_out(frame)
        if not self._has_camera and now_ns >= self._blank_due_ns:
            self._hand_out_blank(now_ns)
        if now_ns >= self._health_due_ns:
            self._health_due_ns = now_ns + _HEALTH_NS
            statuses = {thread.source.name: thread.source.status() for thread in self._sources}
            self._health = MappingProxyType(core.health(now_ns, statuses))

    def _take_front_end(self) -> None:
        """Give the pipeline's front end to vision, once there is one."""
        pipeline = self._core.pipeline
        if pipeline is None or pipeline.front_end is None:
            return
        front_end, pipeline.front_end = pipeline.front_end, None
        if self._vision is not None:
            self._vision.close()
        self._vision = _LiveVision(front_end, self._intake.put_look)

    def _hand_out(self, frame: Frame) -> None:
        if self._vision is not None:
            self._vision.slot.put(frame)
        self._shown.put(Shown(frame, self._core.pose(frame.t_ns), self._core.quarter_turns))

    def _hand_out_blank(self, now_ns: int) -> None:
        self._blank_due_ns = now_ns + _BLANK_NS
        frame = Frame(now_ns, now_ns, self._blanks, blank_picture())
        self._blanks += 1
        self._shown.put(Shown(frame, self._core.pose(now_ns), 0))

    # -- showing ------------------------------------------------------------------------------------------------------

    def _show_all(self) -> None:
        due_s = monotonic()
        while not self._shown.closed:
            shown = self._shown.take(max(0.0, due_s - monotonic()))
            try:
                if shown is not None:
                    self._show(shown)
                if monotonic() >= due_s:
                    due_s = monotonic() + _POSE_S
                    self._show_pose(self.pose)
            except Exception:
                _logger.exception("a picture could not be shown")


class _LiveVision:
    """A front end on its own thread: the newest picture is looked at, others are left out."""

    def __init__(self, front_end: FrontEnd, put_look: Callable[[Look], None]) -> None:
        self.slot: Slot[Frame] = Slot()
        self.rate = Rate()
        self._front_end, self._put_look = front_end, put_look
        self._same: tuple[bytes, int, int] | None = None
        self._thread = Thread(target=self._look, name="vision", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self.slot.close()
        self._thread.join()

    def _look(self) -> None:
        while not self.slot.closed:
            frame = self.slot.take()
            if frame is None:
                continue
            try:
                motion = self._front_end.step(frame)
            except Exception:
                _logger.exception("vision failed at a picture")
                motion = None
            self.rate.note(monotonic_ns())
            self._put_look(Look(frame, motion, self._is_repeated(frame)))

    def _is_repeated(self, frame: Frame) -> bool:
        try:
            data = frame.picture.jpeg()
        except MalformedInput:
            return False
        if self._same is None or data != self._same[0]:
            self._same = (data, frame.t_ns, 0)
        first, since_ns, count = self._same
        self._same = (first, since_ns, count + 1)
        return count >= _SAMES and frame.t_ns - since_ns >= _SAME_NS


def _ms(time_s: float | None) -> float | None:
    return None if time_s is None else round(time_s * 1e3, 3)
