"""A server for many rigs and many viewers, without a walk of its own: what `agora serve` runs."""

import logging
from pathlib import Path
from types import TracebackType
from typing import Self

from assets.site import Site
from server.app import create_app
from server.auth import new_token
from server.configuration import Configuration
from server.site_facts import site_facts
from server.web_server import WebServer

_logger = logging.getLogger(__name__)


class Serving:
    """The server, its port bound. Use it as a context manager: leaving it says goodbye to all and frees the port."""

    def __init__(self, configuration: Configuration, site: Site, web: Path) -> None:
        """Put everything together; nothing is served yet but the port is taken.

        Raises:
            PortInUse, AddressUnavailable: The server cannot listen there.
        """
        models = site.folder / "built"
        self.token = new_token()
        """Lets rigs in, and viewers where strangers can reach the server."""
        app = create_app(
            web_folder=web,
            models_folder=models,
            site=site_facts(site, models),
            rig_tokens=[self.token],
            viewer_tokens=None if configuration.on_loopback else [self.token],
            allowed_hosts=configuration.hosts,
            max_sessions=configuration.max_sessions,
            max_viewers=configuration.max_viewers,
        )
        self._server = WebServer(app, configuration.host, configuration.port)

    @property
    def url(self) -> str:
        """The address of the pages on this machine, ending in a slash."""
        return self._server.url

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
