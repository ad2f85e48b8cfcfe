"""The connection to a running gpsd."""

import socket
from threading import Event
from time import monotonic_ns

from tracker.errors import InputError, MalformedInput, SourceLost
from tracker.sources.gpsd_protocol import WATCH, GpsdProtocol

DEFAULT_HOST, DEFAULT_PORT = "localhost", 2947
_CONNECT_S, _WAIT_S = 5.0, 0.1


class GpsdStream:
    """The NMEA sentences that gpsd hands on."""

    def __init__(self, host: str = DEFAULT_HOST, port: int = DEFAULT_PORT) -> None:
        """Name a gpsd."""
        self._host, self._port = host, port
        self._socket: socket.socket | None = None
        self._protocol = GpsdProtocol()

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
        devices = ", ".join(f"{path} ({driver})" if driver else path for path, driver in self._protocol.devices.items())
        return f"{self._where}: {devices or 'no receiver'}"

    @property
    def when_silent(self) -> str:
        """What may be wrong."""
        if not self._protocol.devices:
            return f"{self._where} has no receiver: plug it in, or name its device in /etc/default/gpsd."
        return f"{self.detail} says nothing: check the receiver's power, cable and rate, for instance with gpsmon."

    @property
    def _where(self) -> str:
        return f"gpsd at {self._host}:{self._port}"

    def open(self, stop: Event) -> None:
        """Connect, and ask for sentences."""
        self._protocol = GpsdProtocol()
        try:
            self._socket = socket.create_connection((self._host, self._port), _CONNECT_S)
            self._socket.sendall(WATCH)
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
        try:
            return self._protocol.feed(data), t_recv_ns
        except MalformedInput as error:
            raise SourceLost(f"What answers at {self._host}:{self._port} is no gpsd: check host and port.") from error

    def close(self) -> None:
        """Disconnect."""
        connection, self._socket = self._socket, None
        if connection is not None:
            connection.close()
