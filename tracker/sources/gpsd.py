"""A receiver that a running gpsd has: its TCP protocol, of which the NMEA sentences are read.

gpsd offers what a receiver says (`nmea`) and its own view of it (TPV and SKY as JSON). Of a receiver that speaks NMEA, the
sentences lose least: each is handed on when it is here, where TPV waits for what gpsd takes for an epoch's end, and quality,
dilutions and deviations come with the position that they are of. Of one that speaks a binary protocol, TPV does: see `gpsd_tpv`.
gpsd says which it is (`native`), and in JSON alone that receivers come and go. Sentences with a wrong checksum are refused by gpsd
and never seen.

Reference:
    gpsd_json(5): https://gpsd.gitlab.io/gpsd/gpsd_json.html
"""

import json
import socket
from threading import Event
from time import monotonic_ns
from typing import Any

from tracker.errors import InputError, SourceLost
from tracker.sources.gpsd_tpv import sentences

DEFAULT_HOST, DEFAULT_PORT = "localhost", 2947
_WATCH = b'?WATCH={"enable":true,"json":true,"nmea":true};\n'
_CONNECT_S, _WAIT_S = 5.0, 0.1
#: Longer than any line that gpsd writes (GPS_JSON_RESPONSE_MAX).
_LONGEST_LINE = 1 << 16
#: What gpsd's own sentences for a binary receiver are good for: the satellites.
_SATELLITES = (b"GSA", b"GSV")


class GpsdStream:
    """The NMEA sentences that gpsd hands on."""

    def __init__(self, host: str = DEFAULT_HOST, port: int = DEFAULT_PORT) -> None:
        """Name a gpsd."""
        self._host, self._port = host, port
        self._socket: socket.socket | None = None
        self._line = b""
        self._devices: dict[str, str] = {}
        self._native: set[str] = set()
        self._sky: dict[str, Any] = {}
        self._is_gpsd = False

    @classmethod
    def named(cls, words: str) -> "GpsdStream":
        """Return the gpsd of `HOST`, `HOST:PORT`, `[IPV6]:PORT` or nothing, which is this machine's.

        Raises:
            InputError: The port is no port.
        """
        host, port = words, ""
        if words.count(":") == 1 or "]:" in words:
            host, _, port = words.rpartition(":")
        if port and not (port.isdecimal() and 0 < int(port) < 65536):
            raise InputError(f"{port!r} is no port: gpsd's is {DEFAULT_PORT}.")
        return cls(host.strip("[]") or DEFAULT_HOST, int(port or DEFAULT_PORT))

    @property
    def detail(self) -> str:
        """Where gpsd is and what receivers it has."""
        devices = ", ".join(f"{path} ({driver})" if driver else path for path, driver in self._devices.items())
        return f"{self._where}: {devices or 'no receiver'}"

    @property
    def when_silent(self) -> str:
        """What may be wrong."""
        if not self._devices:
            return f"{self._where} has no receiver: plug it in, or name its device in /etc/default/gpsd."
        return f"{self.detail} says nothing: check the receiver's power, cable and rate, for instance with gpsmon."

    @property
    def _where(self) -> str:
        return f"gpsd at {self._host}:{self._port}"

    def open(self, stop: Event) -> None:
        """Connect, and ask for sentences."""
        self._line, self._devices, self._native, self._sky, self._is_gpsd = b"", {}, set(), {}, False
        try:
            self._socket = socket.create_connection((self._host, self._port), _CONNECT_S)
            self._socket.sendall(_WATCH)
            self._socket.settimeout(_WAIT_S)
        except OSError as error:
            raise SourceLost(
                f"{self._where} does not answer ({error.strerror or error}): start it with `sudo systemctl start gpsd`."
            ) from error

    def read(self) -> tuple[bytes, int]:
        """Return the next sentences and when they were here."""
        if self._socket is None:
            raise SourceLost(f"{self._where} is not connected.")
        try:
            data = self._socket.recv(65536)
        except TimeoutError:
            return b"", monotonic_ns()
        except OSError as error:
            raise SourceLost(f"{self._where} broke the connection ({error.strerror}): is it running?") from error
        t_recv_ns = monotonic_ns()
        if not data:
            raise SourceLost(f"{self._where} ended the connection: is it running?")
        return self._sentences(data), t_recv_ns

    def close(self) -> None:
        """Disconnect."""
        connection, self._socket = self._socket, None
        if connection is not None:
            connection.close()

    def _sentences(self, data: bytes) -> bytes:
        """Take gpsd's own lines out; what is left is the receiver's."""
        *lines, self._line = (self._line + data).split(b"\n")
        kept = []
        for line in lines:
            if line.startswith(b"{"):
                kept.append(self._take_notice(line))
            elif not self._native or line[3:6] in _SATELLITES:
                kept.append(line + b"\n")
        found = b"".join(kept)
        if len(self._line) > _LONGEST_LINE or (found and not self._is_gpsd):
            raise SourceLost(f"What answers at {self._host}:{self._port} is no gpsd: check host and port.")
        return found

    def _take_notice(self, line: bytes) -> bytes:
        """Learn which receivers there are; return what a binary one has said as sentences."""
        try:
            notice = json.loads(line)
        except (ValueError, RecursionError):
            return b""
        match notice:
            case {"class": "VERSION"}:
                self._is_gpsd = True
            case {"class": "DEVICES", "devices": list(devices)}:
                self._devices, self._native = {}, set()
                for device in devices:
                    self._take_device(device)
            case {"class": "DEVICE"}:
                self._take_device(notice)
            case {"class": "SKY"}:
                self._sky = notice
            case {"class": "TPV"} if self._native:
                return sentences(notice, self._sky)
            case _:
                pass
        return b""

    def _take_device(self, device: Any) -> None:
        """Note a receiver that came, or forget one that went: gpsd says that it was activated at no time."""
        if not isinstance(device, dict) or not isinstance(device.get("path"), str):
            return
        path = device["path"]
        self._devices.pop(path, None)
        self._native.discard(path)
        if device.get("activated") != 0:
            self._devices[path] = str(device.get("driver") or "")[:40]
            if device.get("native") == 1:
                self._native.add(path)
