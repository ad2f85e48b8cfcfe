"""The server's errors, drawn as a tree.

ServerError
├── MalformedMessage     a message on a socket that is not what the wire format says
├── PortInUse            the port to listen on is taken (the command line exits 2)
├── AddressUnavailable   the address to listen on is not this machine's
├── UnknownSession       no session of that name
├── TokenRefused         a token that is not this server's, or whose time is over
├── ServerFull           as many viewers or sessions as the server will take
├── LogRefused           an uploaded file that is not kept, with the HTTP status that says why
├── ReplayRefused        an uploaded walk that cannot be replayed, or not with that estimator
├── LinkRefused          a server will not have this rig: wrong token, or another rig took the session
├── SensorMissing        a sensor that a calibration needs is not there (the command line exits 3)
└── ConsoleUnavailable   the operator's console cannot start; everything else goes on without it
"""


class ServerError(Exception):
    """Root of everything that the server raises on purpose. The message is one sentence with the remedy."""


class MalformedMessage(ServerError):
    """Bytes or text from a socket that do not parse."""


class PortInUse(ServerError):
    """Another program listens on the port."""


class AddressUnavailable(ServerError):
    """The host to listen on is not an address of this machine, or may not be bound."""


class UnknownSession(ServerError):
    """No rig has opened a session of that name."""


class TokenRefused(ServerError):
    """Whoever asks is not let in by what it shows."""


class ServerFull(ServerError):
    """A limit of the server is reached."""


class LogRefused(ServerError):
    """An uploaded file is not kept."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status = status
        """Of HTTP."""


class ReplayRefused(ServerError):
    """An uploaded walk cannot be replayed as it was asked."""


class LinkRefused(ServerError):
    """The server turned the rig away and will do so again."""


class ConsoleUnavailable(ServerError):
    """The operator's console cannot start."""


class SensorMissing(ServerError):
    """A live sensor is not there or says nothing."""

    exit_code = 3
