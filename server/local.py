"""Server and console on this machine: what replays and live walks are shown by."""

from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from assets.site import Site
from server.access import Access
from server.app import create_app
from server.console.hosting import ConsoleHost, Link
from server.site_facts import site_facts
from server.web_server import WebServer

_YEAR_S: Final = 366 * 86_400


class LocalServer:
    """A server on loopback for the rigs of this program. Use it as a context manager: leaving it frees the ports."""

    def __init__(self, site: Site, *, port: int, web: Path, logs: Mapping[str, Path] | None = None) -> None:
        """Put everything together; nothing is served yet but the port is taken.

        Raises:
            PortInUse: The port is taken.
        """
        models = site.folder / "built"
        self._access = Access.for_loopback()
        app = create_app(
            web_folder=web,
            models_folder=models,
            site=site_facts(site, models),
            access=self._access,
            console=ConsoleHost(site.folder, lambda: Link(self.url)),
            logs=logs,
            site_folder=site.folder,
        )
        self._server = WebServer(app, "127.0.0.1", port)

    @property
    def url(self) -> str:
        """The address of the pages, ending in a slash."""
        return self._server.url

    def rig_url(self, session: str) -> str:
        """Return the address for `RigLink`."""
        return self._server.rig_url(session)

    def rig_token(self, session: str) -> str:
        """Return the token for `RigLink`: this server ends before it does."""
        signer = self._access.signer
        return signer.issue("rig", int(signer.now_s()) + _YEAR_S, session)

    def __enter__(self) -> Self:
        self._server.__enter__()
        return self

    def close(self) -> None:
        """Free the port, whether it was entered or not."""
        self._server.close()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()
