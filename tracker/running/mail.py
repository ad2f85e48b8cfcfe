"""The mailboxes between threads, each with its own rule: nothing lost, or the newest wins. Putting never waits and never raises."""

from collections import Counter, deque
from dataclasses import dataclass
from threading import Condition, Event
from typing import Generic, TypeVar

from tracker.measurements import Frame, Measurement, VisualMotion

T = TypeVar("T")
#: Measurements that may wait: twenty seconds of a 250 Hz unit. Fusion that is further behind than this is dead.
_MOST_WAITING = 5000
#: Pictures are large, and an old one is of no use to anyone.
_MOST_FRAMES = 4


@dataclass(frozen=True, slots=True)
class Look:
    """A picture that vision has looked at."""

    frame: Frame
    motion: VisualMotion | None
    is_repeated: bool
    """Whether it is the same, to the last pixel, as those of the last seconds."""


@dataclass(frozen=True, slots=True)
class Batch:
    """What was waiting, each in order of arrival."""

    measurements: list[tuple[str, Measurement]]
    frames: list[tuple[str, Frame]]
    looks: list[Look]


class Intake:
    """What sensors and vision have for fusion."""

    def __init__(self) -> None:
        self._queue: deque[tuple[str, Measurement]] = deque()
        self._frames: deque[tuple[str, Frame]] = deque()
        self._looks: deque[Look] = deque()
        self._bell = Event()
        self.lost: Counter[str] = Counter()
        """Measurements for which there was no place, by sensor. Of pictures the oldest has to go, of others the newest."""

    def put(self, sensor: str, measurement: Measurement) -> None:
        """Take a measurement; from any thread."""
        if isinstance(measurement, Frame):
            if len(self._frames) >= _MOST_FRAMES:
                self.lost[sensor] += 1
                self._frames.popleft()
            self._frames.append((sensor, measurement))
        elif len(self._queue) >= _MOST_WAITING:
            self.lost[sensor] += 1
        else:
            self._queue.append((sensor, measurement))
        self.ring()

    def put_look(self, look: Look) -> None:
        """Take what vision made of a picture: at most one for each that it was given."""
        self._looks.append(look)
        self.ring()

    def ring(self) -> None:
        """Wake fusion up."""
        if not self._bell.is_set():
            self._bell.set()

    def wait(self, timeout_s: float) -> None:
        """Wait until something is there, at most so long."""
        self._bell.wait(timeout_s)
        self._bell.clear()

    def take(self) -> Batch:
        """Return all that is there."""
        return Batch(_emptied(self._queue), _emptied(self._frames), _emptied(self._looks))


def _emptied(queue: deque[T]) -> list[T]:
    """Take what is in a queue now; others may go on putting."""
    return [queue.popleft() for _ in range(len(queue))]


class Slot(Generic[T]):
    """One place; what is put in takes the place of what waits."""

    def __init__(self) -> None:
        self._changed = Condition()
        self._content: T | None = None
        self._closed = False
        self.replaced = 0
        """How often something waited in vain."""

    def put(self, content: T) -> None:
        """Put something in."""
        with self._changed:
            self.replaced += self._content is not None
            self._content = content
            self._changed.notify()

    @property
    def closed(self) -> bool:
        """Whether the waiting is over."""
        return self._closed

    def take(self, timeout_s: float | None = None) -> T | None:
        """Wait for something and take it out; None where nothing has come in time, and once the slot is closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._content is not None or self._closed, timeout_s)
            content, self._content = self._content, None
            return None if self._closed else content

    def close(self) -> None:
        """End the waiting."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
