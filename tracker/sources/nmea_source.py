"""An NMEA receiver as a source: whatever stream its bytes come by."""

from collections import Counter
from threading import Event
from time import monotonic_ns
from typing import Protocol

from tracker.errors import InputError, SourceLost
from tracker.sources.gpsd import GpsdStream
from tracker.sources.nmea import NmeaReader
from tracker.sources.serial_port import SerialStream
from tracker.sources.source import Put, SourceStatus

#: Receivers speak once a second or more; one that has said nothing for so long is not there.
_SILENCE_NS = 10_000_000_000
_STATUS_NS = 1_000_000_000
SPEC = "serial:/dev/ttyUSB0, serial:/dev/ttyUSB0:9600, gpsd or gpsd:HOST:PORT"
"""What `nmea_source` takes, for help texts."""


class ByteStream(Protocol):
    """Where the bytes come from."""

    @property
    def detail(self) -> str:
        """The device and how it is spoken to, for people."""
        ...

    @property
    def when_silent(self) -> str:
        """One sentence for when nothing comes: what may be wrong and what to do."""
        ...

    def open(self, stop: Event) -> None:
        """Open it; SourceLost or InputError where that does not do. Returns early once `stop` is set."""
        ...

    def read(self) -> tuple[bytes, int]:
        """Return the next bytes and when they were here; none after a fraction of a second without any. SourceLost at the end."""
        ...

    def close(self) -> None:
        """Close it, open or not."""
        ...


class NmeaSource:
    """Hands over the fixes and velocities of one receiver."""

    name = "gps"

    def __init__(self, stream: ByteStream, *, geoid_separation_m: float | None = None) -> None:
        """Make a source; nothing is opened before `run`.

        Args:
            stream: The way to the receiver.
            geoid_separation_m: For receivers that do not say it; see `NmeaReader`.
        """
        self._stream, self._geoid_separation_m = stream, geoid_separation_m
        self._counts: Counter[str] = Counter()
        self._status = SourceStatus(False, f"{stream.detail} is not opened yet")

    def run(self, put: Put, stop: Event) -> None:
        """Read until `stop`; see `Source`."""
        reader = NmeaReader(self._counts, geoid_separation_m=self._geoid_separation_m)
        detail = ""
        try:
            self._stream.open(stop)
            self._say(True, self._stream.detail, reader)
            self._read(reader, put, stop)
            detail = f"{self._stream.detail}, closed"
        except (SourceLost, InputError) as error:
            detail = str(error)
            raise
        finally:
            self._stream.close()
            for measurement in reader.close(monotonic_ns()):
                put(measurement)
            self._say(False, detail, reader)

    def status(self) -> SourceStatus:
        """Return how it is now: satellites, fix and what became of the sentences."""
        return self._status

    def _read(self, reader: NmeaReader, put: Put, stop: Event) -> None:
        understood, heard_ns, said_ns = self._counts["sentences"], monotonic_ns(), 0
        while not stop.is_set():
            data, t_recv_ns = self._stream.read()
            for measurement in reader.feed(data, t_recv_ns):
                put(measurement)
            if self._counts["sentences"] != understood:
                understood, heard_ns = self._counts["sentences"], t_recv_ns
            elif monotonic_ns() - heard_ns > _SILENCE_NS:
                raise SourceLost(self._stream.when_silent)
            if t_recv_ns - said_ns > _STATUS_NS:
                said_ns = t_recv_ns
                self._say(True, self._stream.detail, reader)

    def _say(self, attached: bool, detail: str, reader: NmeaReader) -> None:
        facts = reader.facts(monotonic_ns()) if attached else {}
        self._status = SourceStatus(attached, detail, dict(self._counts), facts)


def nmea_source(spec: str, *, geoid_separation_m: float | None = None) -> NmeaSource:
    """Return the source that a word of the command line names.

    Args:
        spec: `serial:PATH`, `serial:PATH:BAUD`, `gpsd`, `gpsd:HOST` or `gpsd:HOST:PORT`.
        geoid_separation_m: For receivers that do not say it; see `NmeaReader`.

    Raises:
        InputError: It names no such source.
    """
    kind, _, rest = spec.partition(":")
    if kind == "serial" and rest:
        return NmeaSource(SerialStream.named(rest), geoid_separation_m=geoid_separation_m)
    if kind == "gpsd":
        return NmeaSource(GpsdStream.named(rest), geoid_separation_m=geoid_separation_m)
    raise InputError(f"{spec!r} names no NMEA receiver: give {SPEC}.")
