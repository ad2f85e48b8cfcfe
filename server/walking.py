"""A live rig, alone, with a server on this machine or with one elsewhere: what `agora walk`, `track` and `record` run."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from types import TracebackType
from typing import Self
from urllib.parse import quote, urlsplit

from assets.site import Site
from assets.terrain import build_terrain
from server.live_rig import LiveRig
from server.local import LocalServer
from server.placing import Anchor, Height, Placing
from server.sessions import NAME
from server.standing import eye_heights, origin_of
from server.status_screen import as_json
from tracker.errors import InputError
from tracker.measurements import Measurement
from tracker.rig import Rig
from tracker.rig_file import DEFAULT_PLACE
from tracker.running.walk import WalkState
from tracker.sources.source import Source

#: The session's name where nobody gives one.
SESSION = "walk"


@dataclass(frozen=True)
class WalkSettings:
    """How a walk is tracked and recorded."""

    estimator: str | None = None
    """None for the best that the sensors allow."""
    anchor: Anchor = "site"
    height: Height = "ground"
    record: Path | None = None
    """The file to write."""
    tracks: bool = True
    """Whether there is an estimator at all."""
    about: Mapping[str, str] | None = None
    """What else goes to the recording's head."""
    rig_file: Path | None = None
    """Beside it is kept what the rig learns of itself; None to keep nothing."""


class Walking:
    """One live walk. Use it as a context manager: leaving it ends every thread, closes the recording and frees the ports."""

    def __init__(
        self,
        site: Site,
        sources: Sequence[Source],
        rig: Rig,
        settings: WalkSettings,
        *,
        correct: Callable[[Measurement], Measurement],
        web: Path | None = None,
        port: int = 0,
        server_url: str | None = None,
        token: str = "",
        session: str = SESSION,
    ) -> None:
        """Put everything together.

        Args:
            site: Where the walk is.
            sources: The sensors.
            rig: Extrinsics and camera.
            settings: How.
            correct: What a calibration makes of a measurement.
            web: The built pages, where a server is to run here.
            port: Of that server.
            server_url: `wss://HOST` of a server elsewhere, where there is one.
            token: Of that server.
            session: The walk's name there.

        Raises:
            InputError: What is asked for cannot be.
            PortInUse: The port is taken.
        """
        self._rig_url = None if server_url is None else rig_url(server_url, session)
        placing = Placing(
            origin_of(site),
            build_terrain(site).ground_z_m,
            eye_heights(site),
            site.eye_height_m,
            settings.anchor,
            settings.height,
        )
        self._server = None
        if web is not None:
            self._server = LocalServer(site, port=port, web=web)
            self._rig_url, token = self._server.rig_url(session), self._server.rig_token(session)
        self._token, self._session = token, session
        try:
            self.rig = LiveRig(
                sources,
                rig,
                placing,
                correct=correct,
                estimator=settings.estimator,
                tracks=settings.tracks,
                record=settings.record,
                about={"agora": version("agora"), **(settings.about or {})},
                rig_file=settings.rig_file,
            )
        except BaseException:
            if self._server is not None:
                self._server.close()
            raise
        self._stack = ExitStack()

    @property
    def url(self) -> str | None:
        """The address of this machine's pages, ending in a slash; None where it serves none."""
        return None if self._server is None else self._server.url

    @property
    def page(self) -> str | None:
        """The address of the walk's page here."""
        return None if self.url is None else f"{self.url}ar?session={self._session}"

    @property
    def connected(self) -> bool | None:
        """Whether the server is there; None where there is none to be."""
        return None if self.rig.link is None else self.rig.link.connected

    @property
    def refused(self) -> str | None:
        """Why the server will not have this rig, where it will not: nobody asks it again."""
        link = self.rig.link
        return None if link is None or link.refused is None else str(link.refused)

    @property
    def state(self) -> WalkState:
        """How it is now."""
        return self.rig.state

    def as_json(self) -> dict[str, object]:
        """Return how it is now, for programs."""
        return as_json(self.state, estimator=self.rig.estimator, connected=self.connected, refused=self.refused)

    def check(self) -> None:
        """Raise what ended the tracker, if anything did."""
        if (error := self.rig.error) is not None:
            raise InputError(f"The tracker stopped: {error}.") from error

    def __enter__(self) -> Self:
        if self._server is not None:
            self._stack.enter_context(self._server)
        self._stack.callback(self.rig.close)
        self.rig.start(self._rig_url, self._token)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._stack.close()


def rig_url(server_url: str, session: str) -> str:
    """Return the address of a session's rig on a server.

    Raises:
        InputError: It is no address of a server, or no session can have that name.
    """
    schemes = {"wss": "wss", "ws": "ws", "https": "wss", "http": "ws"}
    try:
        parts = urlsplit(server_url)
        scheme, netloc = schemes[parts.scheme], parts.netloc
        if not parts.hostname or parts.port == 0:
            raise ValueError
    except (KeyError, ValueError) as error:
        raise InputError(f"{server_url!r} is no server's address: write wss://HOST or wss://HOST:PORT.") from error
    if not NAME.fullmatch(session):
        raise InputError(
            f"No walk can be named {session!r}: take up to 64 letters, digits, dots, dashes or underscores."
        )
    return f"{scheme}://{netloc}{parts.path.rstrip('/')}/ws/rig/{quote(session)}"


def recording_in(folder: Path) -> Path:
    """Return a new recording's file in a folder, named after the time, UTC."""
    return folder / f"walk-{datetime.now(UTC):%Y%m%d-%H%M%S}.mcap"


def known_rig(path: Path | None) -> Path | None:
    """Return the rig file, named or in its usual place; None where there is none, and then no rig is known from another."""
    place = DEFAULT_PLACE.expanduser() if path is None else path
    return place if place.is_file() else None


def rig_text(path: Path | None) -> str:
    """Return the rig file's text for a recording's head; empty where there is none."""
    place = known_rig(path)
    return "" if place is None else place.read_text(encoding="utf-8")
