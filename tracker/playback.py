"""A recorded walk, played through an estimator: what was worked out once is kept, so that any place of it is shown at once.

Sans-I/O but for the log that it reads: no thread and no clock. The same log and the same commands give the same poses.
"""

from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

from tracker.estimator import Pose, Snapshot
from tracker.measurements import Frame, ImuSample, Measurement, Outcome, Said, Sighting
from tracker.pipeline import Pipeline
from tracker.upright import Upright

#: What a visitor says of a place re-runs the estimator from the last checkpoint before it: at most this much of the log.
CHECKPOINT_S = 5.0


class Recording(Protocol):
    """What playback needs of a log."""

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return the measurements that arrived at or after start_ns, in order of arrival."""
        ...

    def pictures(self, at_ns: int) -> Iterable[Frame]:
        """Return the pictures alone, from the one on that was the newest at at_ns; from the first, where none was there yet."""
        ...


@dataclass(frozen=True, slots=True)
class Shown:
    """A picture with the pose of its own capture, which is None before the estimator has one."""

    frame: Frame
    pose: Pose | None
    quarter_turns: int


@dataclass(frozen=True, slots=True)
class _Checkpoint:
    t_ns: int
    """Everything that arrived before this is in."""
    pipeline: Snapshot
    upright: Snapshot


class Playback:
    """One walk, one estimator, one place in time.

    The estimator only ever goes forward and may be far ahead of that place: what it said of each picture is kept.
    """

    def __init__(
        self, recording: Recording, t_start_ns: int, make_pipeline: Callable[[str], Pipeline], upright: Upright
    ) -> None:
        self._recording = recording
        self._t_start_ns = t_start_ns
        self._make_pipeline = make_pipeline
        self._upright = upright
        self._fresh_upright = upright.snapshot()
        self.pipeline: Pipeline
        self._checkpoints: list[_Checkpoint] = []
        self._ahead: Iterator[Measurement] = iter(())
        self._ahead_next: Measurement | None = None
        self._t_fed_ns = 0
        self._found: dict[int, tuple[int, Pose | None, int]] = {}
        """By picture, of those that the estimator has seen: its arrival, its pose, and how it stands upright."""
        self._pictures: Iterator[Frame] = iter(())
        self._next: Frame | None = None
        self._t_shown_ns = t_start_ns
        self._said: list[Said] = []
        """What visitors say of this walk, by when they said it: as if it were in the recording."""
        self._said_fed = 0

    def choose(self, estimator: str) -> None:
        """Begin anew with an estimator, at the start of the log."""
        self.pipeline = self._make_pipeline(estimator)
        self._found = {}
        self._checkpoints = [_Checkpoint(self._t_start_ns, self.pipeline.snapshot(), self._fresh_upright)]
        self._resume(self._checkpoints[0])
        self.go_to(self._t_start_ns)

    def go_to(self, t_ns: int) -> None:
        """Go to a place: the next picture is the one that was the newest there."""
        self._t_shown_ns = max(t_ns, self._t_start_ns)
        self._pictures = iter(self._recording.pictures(self._t_shown_ns))
        self._next = next(self._pictures, None)

    def _resume(self, checkpoint: _Checkpoint) -> None:
        self.pipeline.restore(checkpoint.pipeline)
        self._upright.restore(checkpoint.upright)
        self._t_fed_ns = checkpoint.t_ns
        self._said_fed = bisect_left(self._said, checkpoint.t_ns, key=_arrival)
        self._ahead = iter(self._recording.messages(start_ns=checkpoint.t_ns))
        self._ahead_next = next(self._ahead, None)

    def say(self, said: Said) -> Outcome:
        """Take what a visitor says here, now and whenever the walk comes by this place again; return what became of it."""
        t_ns = self._t_shown_ns
        self._run_to(t_ns)
        # a landmark was seen in its picture; everything else is said of now
        said = replace(said, t_recv_ns=t_ns) if isinstance(said, Sighting) else replace(said, t_ns=t_ns, t_recv_ns=t_ns)
        outcome = self.pipeline.step(said)
        if outcome in (Outcome.USED, Outcome.WAITING):
            self._checkpoints = [checkpoint for checkpoint in self._checkpoints if checkpoint.t_ns <= t_ns]
            self._found = {number: found for number, found in self._found.items() if found[0] <= t_ns}
            del self._said[self._said_fed :]  # what was said later on was said of another past
            self._said.append(said)
            self._said_fed += 1
        return outcome

    def _run_to(self, t_ns: int) -> None:
        """Bring the estimator to a place: all of its time is in, and nothing later."""
        if self._t_fed_ns > t_ns:
            self._resume(next(one for one in reversed(self._checkpoints) if one.t_ns <= t_ns))
        while self._ahead_next is not None and self._ahead_next.t_recv_ns <= t_ns:
            self.run_ahead()
        self._hear(t_ns + 1)

    def _hear(self, before_ns: int) -> None:
        """Feed the estimator what visitors said before a time: of what comes at one time that is always the last."""
        while self._said_fed < len(self._said) and self._said[self._said_fed].t_recv_ns < before_ns:
            self.pipeline.step(self._said[self._said_fed])
            self._said_fed += 1

    @property
    def t_next_ns(self) -> int | None:
        """When the next picture arrived; None at the end of the log."""
        return self._next.t_recv_ns if self._next else None

    @property
    def is_known(self) -> bool:
        """Whether the next picture can be shown without the estimator."""
        return self._next is None or self._next.frame_id in self._found

    @property
    def is_whole(self) -> bool:
        """Whether the estimator has come to the end of the log."""
        return self._ahead_next is None

    def peek(self) -> Shown | None:
        """Return the next picture without a pose, while that is being worked out; None at the end of the log."""
        return None if self._next is None else Shown(self._next, None, self._upright.quarter_turns)

    def step(self) -> Shown | None:
        """Return the next picture with its pose; None at the end of the log."""
        frame = self._next
        if frame is None:
            return None
        while not self.is_known and not self.is_whole:
            self.run_ahead()
        self._t_shown_ns = max(self._t_shown_ns, frame.t_recv_ns)
        self._next = next(self._pictures, None)
        _, pose, quarter_turns = self._found.get(frame.frame_id) or (0, None, self._upright.quarter_turns)
        return Shown(frame, pose, quarter_turns)

    def run_ahead(self) -> None:
        """Feed the estimator its next message; nothing happens at the end of the log."""
        measurement = self._ahead_next
        if measurement is None:
            return
        # never between two messages of one time: going back to that time would feed the first of them twice
        is_later = measurement.t_recv_ns > self._t_fed_ns
        self._hear(measurement.t_recv_ns)
        if is_later and measurement.t_recv_ns - self._checkpoints[-1].t_ns >= CHECKPOINT_S * 1e9:
            state = (self.pipeline.snapshot(), self._upright.snapshot())
            self._checkpoints.append(_Checkpoint(measurement.t_recv_ns, *state))
        self._t_fed_ns = measurement.t_recv_ns
        self.pipeline.step(measurement)
        self._ahead_next = next(self._ahead, None)
        if isinstance(measurement, ImuSample):
            self._upright.step(measurement)
        if isinstance(measurement, Frame):
            pose = self.pipeline.predict(measurement.t_ns)
            self._found[measurement.frame_id] = (measurement.t_recv_ns, pose, self._upright.quarter_turns)


def _arrival(said: Said) -> int:
    return said.t_recv_ns
