"""A receiver at a serial port, USB adapter or pseudo-terminal, at the rate that it turns out to speak."""

import errno
import termios
from collections import Counter, deque
from threading import Event
from time import monotonic_ns

from serial import Serial

from tracker.errors import InputError, SourceLost
from tracker.sources.nmea_lines import NmeaLines

#: Tried in this order where none is given: NMEA's usual ones by how usual they are, then the rest.
RATES_BAUD = (9600, 38400, 115200, 4800, 57600, 19200, 230400, 460800, 921600)
#: A receiver speaks once a second at least.
_LISTEN_NS = 1_400_000_000
#: Noise at a wrong rate makes one right checksum in 256 at most; it takes two sentences to be believed.
_SENTENCES = 2
_WAIT_S = 0.1
_SLOWEST_BAUD = 1200


class SerialStream:
    """The bytes of a serial port."""

    def __init__(self, path: str, rate_baud: int | None = None) -> None:
        """Name a port.

        Args:
            path: `/dev/ttyUSB0`, `/dev/serial/by-id/…`.
            rate_baud: None to find it out.
        """
        self._path, self._asked_baud = path, rate_baud
        self._found_baud: int | None = None
        self._port: Serial | None = None
        self._heard: deque[tuple[bytes, int]] = deque()

    @classmethod
    def named(cls, words: str) -> "SerialStream":
        """Return the port of `PATH` or `PATH:BAUD`; paths may hold colons themselves."""
        path, _, rate = words.rpartition(":")
        if path and rate.isdecimal() and int(rate) >= _SLOWEST_BAUD:
            return cls(path, int(rate))
        return cls(words)

    @property
    def detail(self) -> str:
        """The port and its rate."""
        rate_baud = self._asked_baud or self._found_baud
        return self._path if rate_baud is None else f"{self._path} at {rate_baud} baud"

    @property
    def when_silent(self) -> str:
        """What may be wrong."""
        return (
            f"{self.detail} says no NMEA: check the receiver's power, its cable, its rate and that it is set to NMEA."
        )

    def open(self, stop: Event) -> None:
        """Open the port, and find the rate out where none was given."""
        self._heard.clear()
        try:
            self._port = Serial(self._path, self._asked_baud or RATES_BAUD[0], timeout=_WAIT_S, exclusive=True)
        except (OSError, termios.error) as error:
            raise self._lost(error) from error
        except ValueError as error:
            raise InputError(f"{self._path} cannot be set to {self._asked_baud} baud: give a usual rate.") from error
        if self._asked_baud is None:
            self._find_rate(self._port, stop)

    def read(self) -> tuple[bytes, int]:
        """Return the next bytes and when they were here."""
        if self._heard:
            return self._heard.popleft()
        if self._port is None:
            raise SourceLost(f"{self._path} is not open.")
        try:
            first = self._port.read(1)
            t_recv_ns = monotonic_ns()
            return first + self._port.read(self._port.in_waiting) if first else b"", t_recv_ns
        except (OSError, termios.error) as error:
            raise self._lost(error) from error

    def close(self) -> None:
        """Close the port."""
        port, self._port = self._port, None
        if port is not None:
            port.close()

    def _find_rate(self, port: Serial, stop: Event) -> None:
        """Set the first rate at which sentences come; what was heard at it is kept for `read`."""
        known = self._found_baud
        for rate_baud in RATES_BAUD if known is None else (known, *RATES_BAUD):
            try:
                port.baudrate = rate_baud
                port.reset_input_buffer()
            except (OSError, ValueError, termios.error):
                continue  # not every port goes at every rate
            heard = self._listen(stop)
            if heard or stop.is_set():
                self._found_baud = rate_baud
                self._heard.extend(heard)
                return
        self._found_baud = None
        raise SourceLost(self.when_silent)

    def _listen(self, stop: Event) -> list[tuple[bytes, int]]:
        """Return what is heard up to the sentences that it takes, or nothing."""
        lines, found, heard = NmeaLines(Counter()), 0, []
        end_ns = monotonic_ns() + _LISTEN_NS
        while monotonic_ns() < end_ns and not stop.is_set():
            data, t_recv_ns = self.read()
            heard.append((data, t_recv_ns))
            found += sum(1 for _ in lines.feed(data, t_recv_ns))
            if found >= _SENTENCES:
                return heard
        return []

    def _lost(self, error: Exception) -> SourceLost:
        """Return what is wrong with the port and what to do."""
        path, number = self._path, error.errno if isinstance(error, OSError) else None
        if number == errno.ENOENT:
            return SourceLost(f"There is no {path}: plug the receiver in, and see /dev/serial/by-id for its name.")
        if number in (errno.EACCES, errno.EPERM):
            return SourceLost(f"{path} may not be opened: run `sudo usermod -aG dialout $USER` and log in again.")
        if number in (errno.EBUSY, errno.EAGAIN) or "exclusively lock" in str(error):
            return SourceLost(f"{path} is in use by another program: end it, or, if it is gpsd, give --gps gpsd.")
        if self._port is None:
            return SourceLost(f"{path} is no serial port that can be opened ({error}): see /dev/serial/by-id.")
        return SourceLost(f"{path} is gone: plug the receiver in again.")
