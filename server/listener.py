"""Who is told what becomes of sessions, and may take a decision on them away."""

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from server.session import Session


class Listener(Protocol):
    """Who wants to know what becomes of sessions, as servers do that have them in common (`cluster/relay.py`)."""

    def changed(self, session: "Session") -> None:
        """Note that what `describe` says has changed."""

    def fanned_out(self, session: "Session", frame: bool, pose: bool) -> None:
        """Note that a frame, a pose or both have gone to the viewers."""

    def watched(self, session: "Session") -> None:
        """Note that a viewer has come or gone."""

    def renames(self, session: "Session", title: str) -> bool:
        """Whether somebody else gives it that title."""

    def ends(self, session: "Session", reason: str) -> bool:
        """Whether somebody else ends it."""


class Nobody:
    """Listens to nothing."""

    def changed(self, session: "Session") -> None:
        pass

    def fanned_out(self, session: "Session", frame: bool, pose: bool) -> None:
        pass

    def watched(self, session: "Session") -> None:
        pass

    def renames(self, session: "Session", title: str) -> bool:
        return False

    def ends(self, session: "Session", reason: str) -> bool:
        return False
