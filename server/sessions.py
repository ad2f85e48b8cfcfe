"""All sessions of a server, by name: which there may be, and how they end. For one event loop, no locks, no I/O."""

import re
from collections.abc import Callable, Iterator
from typing import Final

from server.errors import ServerFull, UnknownSession
from server.listener import Listener, Nobody
from server.session import MAX_VIEWERS, Later, Session, next_turn
from server.traffic import Traffic

MAX_SESSIONS: Final = 16
#: Close code of our own: an operator has ended the session, or it had to make room.
ENDED: Final = 4410
#: RFC 6455's registry: "service restart".
RESTART: Final = 1012
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


def session_name(text: str) -> str:
    """Return the name that a session of this title has: what a name cannot hold becomes a dash."""
    return re.sub(r"[^A-Za-z0-9._-]+", "-", text).strip("._-")[:64] or "walk"


class Sessions:
    """All sessions, oldest first."""

    def __init__(
        self,
        now_ns: Callable[[], int],
        max_sessions: int = MAX_SESSIONS,
        max_viewers: int = MAX_VIEWERS,
        later: Later = next_turn,
    ) -> None:
        self.now_ns = now_ns
        """The clock that frames are stamped with."""
        self.traffic = Traffic()
        self.listener: Listener = Nobody()
        """Set before there are sessions."""
        self.stopping = False
        """Whether goodbye was said: the server takes nobody any more."""
        self._max_sessions, self._max_viewers, self._later = max_sessions, max_viewers, later
        self._sessions: dict[str, Session] = {}

    def __iter__(self) -> Iterator[Session]:
        return iter(self._sessions.values())

    def __contains__(self, name: object) -> bool:
        return name in self._sessions

    def end(self, name: str, code: int, reason: str) -> None:
        """End a session: viewers and rig are told why, and it is forgotten; `UnknownSession` where there is none."""
        if not self.listener.ends(self.get(name), reason):
            self.forget(name, code, reason)

    def forget(self, name: str, code: int, reason: str) -> None:
        """End it here, whoever has it."""
        self._sessions.pop(name).end(code, reason)

    def get(self, name: str) -> Session:
        """Return a session; `UnknownSession` where no rig ever opened it."""
        if name not in self._sessions:
            raise UnknownSession(f"There is no session {name[:64]!r}: see /api/sessions for those that there are.")
        return self._sessions[name]

    def open(self, name: str) -> Session:
        """Return the session, new if need be; the oldest one without a rig makes room.

        Raises:
            UnknownSession: The name is not one that a session can have.
            ServerFull: Every place is taken by a rig.
        """
        if not NAME.fullmatch(name):
            raise UnknownSession("A session's name is 1 to 64 letters, digits, dots, dashes or underscores.")
        if name not in self._sessions or self._sessions[name].elsewhere:
            self._make_room()
        return self._sessions.setdefault(name, self._new(name))

    def mirror(self, name: str) -> Session:
        """Return the session of a rig that is at another server, new if need be; it takes no place of those that rigs have here."""
        return self._sessions.setdefault(name, self._new(name))

    def _new(self, name: str) -> Session:
        return Session(name, self._max_viewers, self._sent, self._later, self.listener)

    def say_goodbye(self) -> None:
        """Tell every viewer and every rig that the server stops; they may come again."""
        self.stopping = True
        for session in self:
            session.end(RESTART, "The server is being stopped: this page connects again when it is back.")

    @property
    def quiet(self) -> bool:
        """Whether nobody is connected."""
        return not any(session.connected or session.viewers for session in self)

    def _sent(self, is_frame: bool, t_ns: int) -> None:
        durations = self.traffic.frames if is_frame else self.traffic.poses
        durations.add((self.now_ns() - t_ns) * 1e-9)

    def _make_room(self) -> None:
        here = [session for session in self if not session.elsewhere]
        if len(here) < self._max_sessions:
            return
        idle = next((session for session in here if not session.connected), None)
        if idle is None:
            raise ServerFull(f"{self._max_sessions} rigs are connected already: try again when one has left.")
        self.end(idle.name, ENDED, "This walk has ended, and another has its place.")
