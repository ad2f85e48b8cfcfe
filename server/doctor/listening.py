"""Listening to sensors for some seconds, all together, as a walk does: each on the supervisor's own thread."""

from collections import deque
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from math import hypot
from statistics import fmean, median
from threading import Lock
from time import monotonic, sleep, time_ns
from typing import TypeAlias

from server.doctor.facts import PictureFacts, SensorFacts, Stream
from tracker.errors import InputError, MalformedInput
from tracker.measurements import Frame, GpsFix, ImuSample, Measurement, Picture
from tracker.running.supervisor import SourceThread
from tracker.sources.source import Source, SourceStatus

#: A source that has neither said anything nor given up by then is not waited for: a serial port's rate takes up to 13 s to find.
PATIENCE_S = 16.0
_FAREWELL_S = 3.0
_LOOK_S = 0.1
_DAY_S = 86_400.0
#: Of so many pictures the mean size is taken.
_PICTURES = 5

Times: TypeAlias = tuple[int, int]
"""When something was measured, and when it arrived."""


@dataclass(frozen=True)
class Wanted:
    """A sensor that was asked for."""

    sensor: str
    spec: str
    """How it was asked for."""
    make: Callable[[], Source]
    is_there: bool = False
    """Whether its device was seen: then it is tried again where it does not attach at once."""


class Ear:
    """What one sensor says, from any thread. Of pictures the newest are kept, of everything else when it came."""

    def __init__(self, wanted: Wanted) -> None:
        self.wanted, self.source = wanted, wanted.make()
        self._lock = Lock()
        self._times_ns: dict[str, list[Times]] = {}
        self._pictures: deque[Picture] = deque(maxlen=_PICTURES)
        self._forces_m_s2: list[float] = []
        self._valid_fixes = 0
        self._trouble: str | None = None
        self._attached: SourceStatus | None = None
        self._utc_offset_s: float | None = None
        self._began_s: float | None = None

    def put(self, _sensor: str, measurement: Measurement) -> None:
        """Take a measurement."""
        with self._lock:
            if self._began_s is None:
                self._began_s, self._trouble = monotonic(), None
            kind = type(measurement).__name__
            self._times_ns.setdefault(kind, []).append((measurement.t_ns, measurement.t_recv_ns))
            match measurement:
                case Frame():
                    self._pictures.append(measurement.picture)
                case ImuSample():
                    self._forces_m_s2.append(hypot(*measurement.accel_m_s2))
                case GpsFix(valid=True):
                    self._valid_fixes += 1

    def tell(self, _sensor: str, what: str, reason: str) -> None:
        """Take news of the source; the first trouble is what counts, those that follow are of trying again."""
        with self._lock:
            if what != "opened" and self._trouble is None:
                self._trouble = reason

    def look(self) -> None:
        """Note how the source is, while it is attached."""
        status = self.source.status()
        if status.attached:
            self._attached = status
            if (offset_s := utc_offset_s(status, time_ns() * 1e-9)) is not None:
                self._utc_offset_s = offset_s

    def is_done(self, seconds: float, waited_s: float) -> bool:
        """Return whether there is nothing more to wait for."""
        with self._lock:
            if self._began_s is not None:
                return self._trouble is not None or monotonic() - self._began_s >= seconds
            return waited_s > PATIENCE_S or (self._trouble is not None and not self.wanted.is_there)

    def facts(self) -> SensorFacts:
        """Return what was heard."""
        with self._lock:
            return SensorFacts(
                self.wanted.sensor,
                self.wanted.spec,
                self._attached or self.source.status(),
                self._trouble,
                {kind: stream_of(times_ns) for kind, times_ns in self._times_ns.items()},
                self._valid_fixes,
                fmean(self._forces_m_s2) if self._forces_m_s2 else None,
                picture_of(self._pictures),
                self._utc_offset_s,
            )


def listen(sensors: Sequence[Wanted], seconds: float, progress: Callable[[float], None]) -> list[SensorFacts]:
    """Listen to every sensor for so long from its first word on; one that is not there is not waited for.

    Args:
        sensors: What was asked for.
        seconds: How long.
        progress: Called with the seconds so far.
    """
    found: dict[str, SensorFacts] = {}
    ears: list[Ear] = []
    for wanted in sensors:
        try:
            ears.append(Ear(wanted))
        except InputError as error:
            found[wanted.sensor] = SensorFacts(wanted.sensor, wanted.spec, trouble=str(error))
    threads = [SourceThread(ear.source, ear.put, ear.tell) for ear in ears]
    for thread in threads:
        thread.start()
    _wait(ears, seconds, progress)
    for thread in threads:
        thread.stop()
    for thread in threads:
        thread.join(_FAREWELL_S)
    found |= {ear.wanted.sensor: ear.facts() for ear in ears}
    return [found[wanted.sensor] for wanted in sensors]


def _wait(ears: Sequence[Ear], seconds: float, progress: Callable[[float], None]) -> None:
    began_s = monotonic()
    while not all(ear.is_done(seconds, monotonic() - began_s) for ear in ears):
        sleep(_LOOK_S)
        for ear in ears:
            ear.look()
        progress(monotonic() - began_s)


def stream_of(times_ns: Sequence[Times]) -> Stream:
    """Return how measurements of one kind came; there is at least one."""
    arrivals_ns = [t_recv_ns for _, t_recv_ns in times_ns]
    span_s = (arrivals_ns[-1] - arrivals_ns[0]) * 1e-9
    return Stream(
        len(times_ns),
        (len(times_ns) - 1) / span_s if span_s > 0.0 else 0.0,
        max((b - a for a, b in pairwise(arrivals_ns)), default=0) * 1e-9,
        median((t_recv_ns - t_ns) * 1e-9 for t_ns, t_recv_ns in times_ns),
    )


def picture_of(pictures: Collection[Picture]) -> PictureFacts | None:
    """Return what the pictures are like, newest last; None where there is none that decodes."""
    try:
        grays = [picture.gray() for picture in pictures][-1:]
        sizes = [len(picture.jpeg()) for picture in pictures]
    except MalformedInput:
        return None
    if not grays:
        return None
    height_px, width_px = grays[0].shape
    return PictureFacts(width_px, height_px, float(grays[0].mean()), fmean(sizes))


def utc_offset_s(status: SourceStatus, now_s: float) -> float | None:
    """Return how far a time of day, seconds since 1970, is ahead of a receiver's; None where it tells none."""
    utc, of_day_s = status.facts.get("utc"), status.facts.get("utc_time_of_day_s")
    if isinstance(utc, str):
        return now_s - datetime.fromisoformat(utc.removesuffix("Z")).replace(tzinfo=UTC).timestamp()
    if isinstance(of_day_s, float):
        return (now_s - of_day_s + _DAY_S / 2) % _DAY_S - _DAY_S / 2
    return None
