"""What the Phidget sources share: a channel of the real library, opened, listened to, and closed.

The library calls back on threads of its own, one at a time for each channel; what a handler reads of its channel is of the event
that it is called for, however late it is called (measured on Phidget22 1.26: handlers that sleep through ten epochs of a GPS).
So handlers stamp what they are given, put it into a queue and do nothing else; `run` makes measurements of it on its own thread.
When more events wait for a slow handler than the library's queue holds, it drops them and says so by an error event (measured).
A device that says nothing for half a second is taken for gone: it detaches, and attaches again as soon as it speaks (measured).
"""

import logging
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from queue import Empty, SimpleQueue
from threading import Event, Lock
from time import monotonic_ns
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from Phidget22.ErrorEventCode import ErrorEventCode
from Phidget22.PhidgetException import PhidgetException

from tracker.errors import InputError, SourceLost
from tracker.measurements import Measurement
from tracker.sources.phidget_library import load_libusb
from tracker.sources.source import Put, SourceStatus

#: How long a device may take to attach before it is said to be missing; those here take 0.01 to 0.3 s.
ATTACH_S = 3.0
#: Events that may wait for `run`: a minute of an inertial unit.
_WAITING = 15_000
#: How long `run` sleeps where nothing comes, and how often it looks after the device.
_LOOK_UP_S = 0.1
_LOOK_NS = 1_000_000_000

_logger = logging.getLogger(__name__)

Said = TypeVar("Said")
"""What a handler puts into the queue."""


class PhidgetSource(ABC, Generic[Said]):
    """One channel as a `Source`. When the device is pulled out it waits: the library attaches it again by itself."""

    #: What the device is called where it is missing.
    _KIND = "Phidget"

    def __init__(
        self, name: str, serial: int | None, *, attach_s: float = ATTACH_S, clock_ns: Callable[[], int] = monotonic_ns
    ) -> None:
        """Prepare; nothing is opened before `run`.

        Args:
            name: For people and for health.
            serial: Which device; None for any.
            attach_s: How long it may take to attach at the start.
            clock_ns: The local clock.
        """
        self.name = name
        self._serial, self._attach_s, self._clock_ns = serial, attach_s, clock_ns
        self._inbox: SimpleQueue[Said | None] = SimpleQueue()
        self._counts: Counter[str] = Counter()
        self._lock = Lock()
        self._device: str | None = None
        self._detail = f"{self._title()} is not opened yet."
        self._device_facts: Mapping[str, object] = {}
        self._last_errors: dict[str, str] = {}
        self._t_heard_ns: int | None = None

    @abstractmethod
    def _create(self) -> Any:
        """Return a new channel with the handlers for its data."""

    @abstractmethod
    def _prepare(self, channel: Any) -> Mapping[str, object]:
        """Set what the device forgets when it is pulled out, in the attach handler; return facts about it."""

    @abstractmethod
    def _restart(self) -> None:
        """Begin anew: a device was attached, whose clock is another."""

    @abstractmethod
    def _measure(self, said: Said) -> Iterator[Measurement]:
        """Yield what one event says."""

    @abstractmethod
    def _facts(self) -> Mapping[str, object]:
        """Return what else is known now."""

    def _look(self, channel: Any) -> Iterator[Measurement]:
        """Look after the device, once a second while it is attached; yield what that says."""
        return iter(())

    def status(self) -> SourceStatus:
        """Return how it is now; from any thread."""
        with self._lock:
            counts, errors = dict(self._counts), dict(self._last_errors)
        device = self._device
        heard = self._t_heard_ns
        silent_s = None if heard is None else round((self._clock_ns() - heard) / 1e9, 1)
        facts = {**self._device_facts, **self._facts(), "silent_s": silent_s, **errors}
        return SourceStatus(
            device is not None, device or self._detail, MappingProxyType(counts), MappingProxyType(facts)
        )

    def run(self, put: Put, stop: Event) -> None:
        """Listen until told to stop.

        Raises:
            SourceLost: No such device has attached in time.
            InputError: The library cannot be loaded on this machine.
        """
        self._inbox = SimpleQueue()
        channel = self._open()
        try:
            self._hand_over(channel, put, stop)
        except SourceLost as error:
            self._detail = str(error)
            raise
        finally:
            with suppress(PhidgetException):
                channel.close()
            self._device = None
        self._detail = f"{self._title()} is closed."

    def _open(self) -> Any:
        libusb = load_libusb()
        try:
            channel = self._create()
            if self._serial is not None:
                channel.setDeviceSerialNumber(self._serial)
            channel.setOnAttachHandler(self._guarded(self._on_attach))
            channel.setOnDetachHandler(self._guarded(self._on_detach))
            channel.setOnErrorHandler(self._guarded(self._on_error))
            channel.open()
        except OSError as error:
            raise InputError(f"The Phidget22 library cannot be loaded here (libusb from {libusb}): {error}") from error
        except PhidgetException as error:
            raise SourceLost(f"{self._title()} cannot be opened: {error.description}") from error
        self._detail = f"{self._title()} has not attached yet."
        return channel

    def _hand_over(self, channel: Any, put: Put, stop: Event) -> None:
        was_attached = False
        t_start_ns = t_look_ns = self._clock_ns()
        while not stop.is_set():
            with suppress(Empty):
                said = self._inbox.get(timeout=_LOOK_UP_S)
                if said is None:
                    self._restart()
                else:
                    for measurement in self._measure(said):
                        put(measurement)
            t_ns = self._clock_ns()
            was_attached = was_attached or self._device is not None
            if not was_attached and t_ns - t_start_ns > self._attach_s * 1e9:
                raise SourceLost(self._missing())
            if self._device is not None and t_ns - t_look_ns >= _LOOK_NS:
                t_look_ns = t_ns
                with suppress(PhidgetException):  # pulled out while it is asked
                    for measurement in self._look(channel):
                        put(measurement)

    def _guarded(self, handler: Callable[..., None]) -> Callable[..., None]:
        """Return a handler whose exceptions are counted and shown, and the first logged: the library would lose them."""

        def guarded(*arguments: Any) -> None:
            try:
                handler(*arguments)
            except Exception as error:
                self._count("handler_errors")
                if "last_handler_error" not in self._last_errors:
                    _logger.warning("%s: a handler failed: %r", self.name, error, exc_info=error)
                with self._lock:
                    self._last_errors["last_handler_error"] = _one_line(error)

        return guarded

    def _receive(self, said: Said | None, t_recv_ns: int) -> None:
        """Put into the queue what a handler was told, and when; None for a new beginning."""
        self._t_heard_ns = t_recv_ns
        if self._inbox.qsize() < _WAITING:
            self._inbox.put(said)
        else:
            self._count("overrun")

    def _count(self, reason: str) -> None:
        with self._lock:
            self._counts[reason] += 1

    def _on_attach(self, channel: Any) -> None:
        self._count("attached")
        self._receive(None, self._clock_ns())
        self._device = f"{channel.getDeviceName()}, serial number {channel.getDeviceSerialNumber()}"
        self._device_facts = {
            "model": channel.getDeviceSKU(),
            "firmware": channel.getDeviceVersion(),
            **self._prepare(channel),
        }

    def _on_detach(self, channel: Any) -> None:
        self._count("detached")
        self._detail = (
            f"{self._device or self._title()} was pulled out or fell silent: put it back, it goes on by itself."
        )
        self._device = None

    def _on_error(self, channel: Any, code: int, description: str) -> None:
        name = ErrorEventCode(code).name.removeprefix("EEPHIDGET_").lower()
        self._count(f"error_{name}")
        with self._lock:
            self._last_errors["last_error"] = description

    def _title(self) -> str:
        return self._KIND if self._serial is None else f"{self._KIND} {self._serial}"

    def _missing(self) -> str:
        return (
            f"No {self._title()} was found: plug it in, end other programs that use it, and on Linux let users open it by "
            "Phidgets' udev rule (99-libphidget22.rules)."
        )


def _one_line(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())
