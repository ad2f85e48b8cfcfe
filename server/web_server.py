"""uvicorn on a thread of its own: started and stopped with the rest of the program."""

import asyncio
import errno
import socket
from threading import Thread
from time import monotonic, sleep
from types import TracebackType
from typing import Final, Self

import uvicorn
from fastapi import FastAPI

from server.connections import protocols
from server.errors import AddressUnavailable, PortInUse, ServerError
from server.limits import Limits, Visitors
from server.sessions import Sessions
from server.tls import Tls
from server.wire import MAX_FRAME_BYTES

_START_S: Final = 20.0
#: How long connections may take to say goodbye before they are cut.
_GOODBYE_S: Final = 1
#: How long those who read have to hear why.
_HEARD_S: Final = 0.5


class WebServer:
    """Serves an application while its context is open.

    The port is bound when the object is made, so `port` and `url` are known before anything runs.
    """

    def __init__(self, app: FastAPI, host: str = "127.0.0.1", port: int = 0, tls: Tls | None = None) -> None:
        """Bind.

        Raises:
            PortInUse: Another program has the port.
            AddressUnavailable: The host is not this machine's, or the port may not be bound.
        """
        self.app = app
        self._socket = _bind(host, port)
        self._host, self._secure = host, "" if tls is None else "s"
        self.port: int = self._socket.getsockname()[1]
        # a page of another kind, as a calibration's, has nobody at the door but for this
        visitors: Visitors = getattr(app.state, "visitors", None) or Visitors(Limits(), monotonic)
        config = uvicorn.Config(
            app,
            **protocols(visitors),
            forwarded_allow_ips=sorted(visitors.limits.proxies),
            ws_max_size=MAX_FRAME_BYTES,
            ws_per_message_deflate=False,  # pictures are compressed already
            access_log=False,
            log_config=None,
            log_level="warning",
            server_header=False,
            timeout_graceful_shutdown=_GOODBYE_S,
            ssl_certfile=None if tls is None else tls.certificate,
            ssl_keyfile=None if tls is None else tls.key,
        )
        self._server = _Server(config, getattr(app.state, "sessions", None))
        self._thread = Thread(target=self._server.run, args=([self._socket],), name="web-server", daemon=True)

    @property
    def url(self) -> str:
        """The address for a browser on this machine, with a slash at its end."""
        return f"http{self._secure}://{self._netloc}/"

    def rig_url(self, session: str) -> str:
        """Return the address for `RigLink`."""
        return f"ws{self._secure}://{self._netloc}/ws/rig/{session}"

    @property
    def _netloc(self) -> str:
        host = {"0.0.0.0": "127.0.0.1", "::": "::1", "": "127.0.0.1"}.get(self._host, self._host)
        return f"[{host}]:{self.port}" if ":" in host else f"{host}:{self.port}"

    def __enter__(self) -> Self:
        """Start; return once requests are answered."""
        self._thread.start()
        deadline = monotonic() + _START_S
        while not self._server.started:
            if not self._thread.is_alive() or monotonic() > deadline:
                self.close()
                raise ServerError("The web server did not start: see the log for its error.")
            sleep(0.01)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop."""
        self.close()

    def close(self) -> None:
        """Stop serving, cut what is still connected, and give the port back. May be called twice."""
        self._server.should_exit = True
        if self._thread.is_alive():
            self._thread.join()
        self._socket.close()


class _Server(uvicorn.Server):
    """Says goodbye before it hangs up."""

    def __init__(self, config: uvicorn.Config, sessions: Sessions | None) -> None:
        super().__init__(config)
        self._sessions = sessions

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Tell everybody why, wait a little for them to hear it, and stop."""
        for server in self.servers:
            server.close()  # a rig told to go would come back at once
        if self._sessions is not None:
            self._sessions.say_goodbye()
            deadline = monotonic() + _HEARD_S
            while not self._sessions.quiet and monotonic() < deadline:
                await asyncio.sleep(0.01)
        await super().shutdown(sockets)
        for connection in list(self.server_state.connections):
            connection.transport.abort()  # a peer that reads nothing would keep its socket open
        await asyncio.sleep(0)


def _bind(host: str, port: int) -> socket.socket:
    if not 0 <= port <= 65535:
        raise AddressUnavailable(f"Port {port} does not exist: choose one from 0 to 65535 with --port.")
    try:
        family = socket.getaddrinfo(host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0][0]
        return socket.create_server((host, port), family=family, backlog=128)
    except OSError as exc:
        if exc.errno == errno.EADDRINUSE:
            raise PortInUse(f"Port {port} on {host} is taken by another program: choose another with --port.") from exc
        raise AddressUnavailable(f"Cannot listen on {host} port {port}: choose another --host or --port.") from exc
