"""A server for many rigs and many viewers, without a walk of its own: what `agora serve` runs."""

import logging
from pathlib import Path
from time import monotonic_ns, time_ns
from types import TracebackType
from typing import Final, Self

from assets.site import Site
from server.access import Access
from server.app import create_app
from server.configuration import Configuration
from server.grants import Grant
from server.log_store import LogStore
from server.replays import Replays
from server.secret_file import secret_of
from server.sessions import Sessions
from server.site_facts import site_facts
from server.web_server import WebServer

_logger = logging.getLogger(__name__)


_FIRST_STAY_S: Final = 12 * 3600
_YEAR_S: Final = 366 * 86_400
_MB: Final = 10**6


class Serving:
    """The server, its port bound. Use it as a context manager: leaving it says goodbye to all and frees the port."""

    def __init__(self, configuration: Configuration, site: Site, web: Path) -> None:
        """Put everything together; nothing is served yet but the port is taken.

        Raises:
            PortInUse, AddressUnavailable: The server cannot listen there.
            InputError: The secret cannot be kept.
        """
        models = site.folder / "built"
        # on loopback too: a proxy may stand there, and behind it everybody
        self._access = Access.with_secret(secret_of(configuration.data_folder))
        sessions = Sessions(monotonic_ns, configuration.max_sessions, configuration.max_viewers)
        store = LogStore(
            configuration.data_folder,
            max_bytes=configuration.max_upload_mb * _MB,
            max_total_bytes=configuration.max_stored_mb * _MB,
            keep_days=configuration.keep_days,
            now_s=lambda: time_ns() * 1e-9,
        )
        replays = Replays(
            sessions,
            store,
            site=site.folder,
            link=self._link,
            most=configuration.max_replays,
            idle_s=configuration.replay_idle_s,
            memory_bytes=configuration.replay_memory_mb * _MB,
        )
        app = create_app(
            web_folder=web,
            models_folder=models,
            site=site_facts(site, models),
            access=self._access,
            allowed_hosts=configuration.hosts,
            any_address=not configuration.on_loopback,
            sessions=sessions,
            store=store,
            replays=replays,
        )
        self._server = WebServer(app, configuration.host, configuration.port)

    @property
    def url(self) -> str:
        """The address of the pages on this machine, ending in a slash."""
        return self._server.url

    def _link(self, session: str) -> tuple[str, str]:
        """Return a session's address for a rig of our own, and its token."""
        signer = self._access.signer
        return self._server.rig_url(session), signer.issue("rig", int(signer.now_s()) + _YEAR_S, session)

    def first_url(self) -> str:
        """Return an address that makes whoever opens it first, within ten minutes, an administrator for twelve hours."""
        t_end_s = int(self._access.signer.now_s()) + _FIRST_STAY_S
        return f"{self.url}enter?code={self._access.codes.new(Grant('admin', None, t_end_s))}"

    def __enter__(self) -> Self:
        self._server.__enter__()
        _logger.info("serving", extra={"url": self.url})
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        _logger.info("stopping")
        self._server.close()
        _logger.info("stopped")
