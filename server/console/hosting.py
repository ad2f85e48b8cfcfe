"""The console's process: started when an operator opens the page, ended when nobody has looked for a while. For one event loop."""

import asyncio
import logging
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Final

from server.confined import Process, ask, begin, end
from server.console.process import ConsoleAnswer, ConsoleJob
from server.errors import ConsoleUnavailable

_logger = logging.getLogger(__name__)

_START_S: Final = 60.0
_IDLE_S: Final = 300.0
#: Of address space, most of which is never touched: threads' stacks and libraries.
_MEMORY_BYTES: Final = 6_000_000_000
_SECRET_BYTES: Final = 32
_FAILED: Final = ConsoleAnswer(error="The console did not start.")


@dataclass(frozen=True)
class Link:
    """How the console reaches its own server."""

    url: str
    """Of the pages, ending in a slash."""
    token: str | None = None
    """An operator's; None where everybody may look."""
    trust: str | None = None
    """The certificate, PEM, that the server shows, where it has one."""


@dataclass(frozen=True)
class _Console:
    process: Process
    port: int
    secret: str


class ConsoleHost:
    """The one console of a server."""

    def __init__(self, site: Path, link: Callable[[], Link]) -> None:
        """Nothing runs yet; `link` is asked when the console starts."""
        self._site, self._link = site, link
        self._console: _Console | None = None
        self._starting = asyncio.Lock()
        self._watching = 0
        self._t_watched_s = 0.0

    async def open(self) -> tuple[str, str]:
        """Start the console where it does not run; return its address and the secret that it wants to be shown.

        Raises:
            ConsoleUnavailable: It does not start.
        """
        async with self._starting:
            if self._console is None or self._console.process.poll() is not None:
                self._console = await self._launch()
                _logger.info("the console began")
            self._t_watched_s = monotonic()
            return f"ws://127.0.0.1:{self._console.port}/", self._console.secret

    def enter(self) -> None:
        """Note that somebody looks."""
        self._watching += 1

    def leave(self) -> None:
        """Note that somebody has left."""
        self._watching -= 1
        self._t_watched_s = monotonic()

    def look_after(self) -> None:
        """End the console where nobody has looked for a while. To be called every second."""
        idle = not self._watching and monotonic() - self._t_watched_s > _IDLE_S
        if self._console is not None and idle and not self._starting.locked():
            self.close()
            _logger.info("the console ended: nobody looked")

    def close(self) -> None:
        """End the console, if it runs."""
        console, self._console = self._console, None
        if console is not None:
            end(console.process)

    async def _launch(self) -> _Console:
        link, secret = self._link(), secrets.token_urlsafe(_SECRET_BYTES)
        job = ConsoleJob(url=link.url, token=link.token, trust=link.trust, site=str(self._site), secret=secret)
        process = begin("server.console.process", str(_MEMORY_BYTES))
        try:
            answer = await ask(process, job, ConsoleAnswer, _START_S) or _FAILED
        except TimeoutError as exc:
            raise ConsoleUnavailable("The console took too long to start: try again.") from exc
        if answer.error is not None:
            end(process)
            raise ConsoleUnavailable(answer.error)
        return _Console(process, answer.port, secret)
