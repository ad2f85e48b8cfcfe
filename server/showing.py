"""Server and replay in one process: what `agora demo` and `agora replay` run."""

from pathlib import Path
from types import TracebackType
from typing import Self

from assets.site import Site
from assets.terrain import build_terrain
from server.local import LocalServer
from server.replay import Replay, ReplaySettings
from server.sessions import session_name
from server.standing import eye_heights, origin_of
from tracker.errors import InputError
from tracker.log import Log


class Showing:
    """One log on one local server. Use it as a context manager: leaving it ends every thread and frees the ports."""

    def __init__(self, site: Site, log: Log, settings: ReplaySettings, *, port: int, web: Path) -> None:
        """Put everything together; nothing runs yet but the port is taken.

        Raises:
            InputError: The estimator cannot run on this log.
            PortInUse: The port is taken.
        """
        self._session = session_name(log.name)
        self._replay = Replay(
            log,
            settings,
            site_origin=origin_of(site),
            ground_z_m=build_terrain(site).ground_z_m,
            eyes_z_m=eye_heights(site),
            eye_height_m=site.eye_height_m,
        )
        self._server = LocalServer(site, port=port, web=web, logs={self._session: log.path})

    @property
    def url(self) -> str:
        """The address of the pages, ending in a slash."""
        return self._server.url

    @property
    def page(self) -> str:
        """The address of the replay's own page."""
        return f"{self.url}replay/{self._session}"

    def __enter__(self) -> Self:
        self._server.__enter__()
        self._replay.start(self._server.rig_url(self._session), self._server.rig_token(self._session))
        return self

    def check(self) -> None:
        """Raise what ended the replay, if anything did."""
        error = self._replay.error
        if error is not None:
            raise InputError(f"The replay stopped: {error}.") from error

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._replay.close()
        self._server.__exit__(kind, error, traceback)
