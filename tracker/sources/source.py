"""What the runner knows of a sensor: something that runs on a thread of its own and says measurements until it is stopped."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from threading import Event
from types import MappingProxyType
from typing import Protocol, TypeAlias

from tracker.measurements import Measurement

Put: TypeAlias = Callable[[Measurement], None]
"""Hands a measurement over: from any thread, never waits, never raises."""

_NOTHING: Mapping[str, int] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class SourceStatus:
    """How a source is, for people and for `agora doctor`; replaced as a whole, so any thread may read it."""

    attached: bool
    """Whether its device or stream is there now."""
    detail: str
    """The device's name and serial number, or one sentence on what is missing and what to do."""
    counts: Mapping[str, int] = field(default_factory=lambda: _NOTHING)
    """What was received and what was refused, by reason."""
    facts: Mapping[str, object] = field(default_factory=lambda: MappingProxyType({}))
    """What else a person wants to see, as JSON values: satellites in view, the camera's mode, the clock's offset."""


class Source(Protocol):
    """A sensor, a receiver, a camera or a file that stands in for one.

    Stamps are of the local clock, `time.monotonic_ns`: `t_recv_ns` is when the bytes were here, `t_ns` when the quantity was
    measured, the device's own clock mapped by `DeviceClock` where it has one.
    """

    @property
    def name(self) -> str:
        """One word for people and for health: `gps`, `imu`, `camera`."""
        ...

    def run(self, put: Put, stop: Event) -> None:
        """Open the device and hand over what it says until `stop` is set; returns with everything closed.

        It may be called again after it has ended, by whatever.

        Raises:
            SourceLost: The device or stream is not there or has ended; the message says what to do. The runner tries again.
            InputError: The way it was asked for can never work (a file that is no video); the runner gives up and says so.
        """
        ...

    def status(self) -> SourceStatus:
        """Return how it is now; from any thread."""
        ...
