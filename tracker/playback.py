"""A recorded walk, played through an estimator: forward as live, and to any place by checkpoints.

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

#: A seek re-runs the estimator from the last checkpoint before its target: at most this much of the log.
CHECKPOINT_S = 5.0


class Recording(Protocol):
    """What playback needs of a log."""

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return the measurements that arrived at or after start_ns, in order of arrival."""
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
    """One walk, one estimator, one place in time."""

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
        self._messages: Iterator[Measurement] = iter(())
        self._next: Measurement | None = None
        self._t_fed_ns = 0
        self._said: list[Said] = []
        """What visitors say of this walk, by when they said it: as if it were in the recording."""
        self._said_fed = 0

    def choose(self, estimator: str) -> None:
        """Begin anew with an estimator, at the start of the log."""
        self.pipeline = self._make_pipeline(estimator)
        self._checkpoints = [_Checkpoint(self._t_start_ns, self.pipeline.snapshot(), self._fresh_upright)]
        self._resume(self._checkpoints[0])

    def rewind_to(self, t_ns: int) -> None:
        """Go to the last checkpoint at or before t_ns; `step` from there on reaches t_ns itself."""
        self._resume(next(c for c in reversed(self._checkpoints) if c.t_ns <= max(t_ns, self._t_start_ns)))

    def _resume(self, checkpoint: _Checkpoint) -> None:
        self.pipeline.restore(checkpoint.pipeline)
        self._upright.restore(checkpoint.upright)
        self._t_fed_ns = checkpoint.t_ns
        self._said_fed = bisect_left(self._said, checkpoint.t_ns, key=_arrival)
        self._messages = iter(self._recording.messages(start_ns=checkpoint.t_ns))
        self._next = next(self._messages, None)

    def say(self, said: Said) -> Outcome:
        """Take what a visitor says here, now and whenever the walk comes by this place again; return what became of it."""
        t_ns = self._t_fed_ns
        while self.t_next_ns == t_ns:
            self.step()  # what is said comes after all of its time, as it will when it is said again
        # a landmark was seen in its picture; everything else is said of now
        said = replace(said, t_recv_ns=t_ns) if isinstance(said, Sighting) else replace(said, t_ns=t_ns, t_recv_ns=t_ns)
        outcome = self.pipeline.step(said)
        if outcome in (Outcome.USED, Outcome.WAITING):
            self._checkpoints = [checkpoint for checkpoint in self._checkpoints if checkpoint.t_ns <= t_ns]
            del self._said[self._said_fed :]  # what was said later on was said of another past
            self._said.append(said)
            self._said_fed += 1
        return outcome

    @property
    def t_next_ns(self) -> int | None:
        """When the next message arrived; None at the end of the log."""
        return self._next.t_recv_ns if self._next else None

    def step(self) -> Shown | None:
        """Feed the next message; return a picture and its pose when it was one."""
        measurement = self._next
        if measurement is None:
            return None
        # never between two messages of one time: going back to that time would feed the first of them twice
        is_later = measurement.t_recv_ns > self._t_fed_ns
        while self._said_fed < len(self._said) and self._said[self._said_fed].t_recv_ns < measurement.t_recv_ns:
            self.pipeline.step(self._said[self._said_fed])
            self._said_fed += 1
        if is_later and measurement.t_recv_ns - self._checkpoints[-1].t_ns >= CHECKPOINT_S * 1e9:
            state = (self.pipeline.snapshot(), self._upright.snapshot())
            self._checkpoints.append(_Checkpoint(measurement.t_recv_ns, *state))
        self._t_fed_ns = measurement.t_recv_ns
        self.pipeline.step(measurement)
        self._next = next(self._messages, None)
        if isinstance(measurement, ImuSample):
            self._upright.step(measurement)
        if not isinstance(measurement, Frame):
            return None
        return Shown(measurement, self.pipeline.predict(measurement.t_ns), self._upright.quarter_turns)


def _arrival(said: Said) -> int:
    return said.t_recv_ns
