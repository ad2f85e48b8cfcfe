"""Makes the sessions of several servers one: those whose rig is here are told to all, those of others are mirrored here.

A session's rig, its newest frame and pose, and the word on it are on one server. The others hold its entry (`entry.py`), listen to
its frames and poses while somebody watches there, and have in the rig's place a mailbox whose letters go to that server. A rig that
comes to another server takes its session along: its entry then has a higher term. Entries are told at every change and again each
second, so what was lost comes with the next; they are kept in the bus as well, for servers that start.
"""

import asyncio
import logging
from collections import OrderedDict
from collections.abc import Callable
from time import monotonic, time_ns
from typing import Any, Final

import msgspec

from server.cluster.bus import Bus
from server.cluster.entry import Entry, Letter, read_entry, read_letter, token
from server.cluster.mirrored import AnswerLine, Mirrored
from server.errors import MalformedMessage, UnknownSession
from server.fanout import Mailbox
from server.messages import SessionFields, parse_control
from server.session import Session
from server.sessions import ENDED, Sessions

_logger = logging.getLogger(__name__)

ENTRIES: Final = "agora.entries"
HERE: Final = "agora.here"
_EVERY_S: Final = 0.5
#: A server that was not heard for so long is gone.
_GONE_S: Final = 2.5
_MOST_ENDED: Final = 1000


class Relay:
    """One server's part of it."""

    def __init__(
        self,
        sessions: Sessions,
        bus: Bus,
        server: str,
        now_s: Callable[[], float] = monotonic,
        wall_ns: Callable[[], int] = time_ns,
    ) -> None:
        """Listen to the sessions and to the bus.

        Args:
            sessions: Of this server.
            bus: This server's end of it.
            server: What no other server is called, nor this one when it is started anew.
            now_s: A clock that does not jump.
            wall_ns: The one that all servers share, more or less.
        """
        self.ready = False
        """Whether all sessions are known that others have kept."""
        self.bus, self.server = bus, server
        self._sessions, self._now_s, self._wall_ns = sessions, now_s, wall_ns
        self._own: dict[str, Entry] = {}
        self._mirrored: dict[str, Mirrored] = {}
        self._ended: OrderedDict[str, Entry] = OrderedDict()
        self.peers: dict[str, float] = {}
        """The other servers that are there, and when each was heard last."""
        self._askers: dict[tuple[str, str], Mailbox] = {}
        sessions.listener = self
        bus.hear(ENTRIES, self._take_entry)
        bus.hear(HERE, self._take_here)
        bus.hear(_letters_of(server), self._take_letter)

    async def run(self) -> None:
        """Learn what there is, then say again and again what is here, until it is cancelled."""
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self.bus.run())
            tasks.create_task(self._learn())
            tasks.create_task(self._repeat())

    # -- what happens here --------------------------------------------------------------------------------------------

    def changed(self, session: Session) -> None:
        """Tell everybody of a session whose rig is, or was, here."""
        name = session.name
        if session.elsewhere or name not in self._sessions or self._sessions.get(name) is not session:
            return  # the change came from there; or the session has ended, and its rig leaves
        before = self._own.get(name)
        if before is None:
            self._announce(self._entry_of(session, self._new_term(name), 0))
        else:
            self._announce(self._entry_of(session, before.term, before.version + 1))

    def _new_term(self, name: str) -> int:
        """Take a session over, and return the term that makes it this server's."""
        mirrored = self._mirrored.pop(name, None)
        if mirrored is not None:
            mirrored.end()
        known = self._ended.pop(name, None) if mirrored is None else mirrored.entry
        return max(self._wall_ns() // 1_000_000, 0 if known is None else known.term + 1)

    def fanned_out(self, session: Session, frame: bool, pose: bool) -> None:
        """Hand the newest frame and pose of a session whose rig is here to the servers that listen."""
        if self.peers and session.name in self._own:
            self._show(session, frame, pose)

    def watched(self, session: Session) -> None:
        """Listen to the frames of a session for as long as somebody watches it here."""
        if (mirrored := self._mirrored.get(session.name)) is not None:
            self._listen(session, mirrored)

    def renames(self, session: Session, title: str) -> bool:
        """Whether another server does it; a session whose server is gone becomes this one's."""
        if self._passed_on(session, "rename", title):
            return True
        session.elsewhere = False
        return False

    def ends(self, session: Session, reason: str) -> bool:
        """Whether another server does it; else all are told that it is over."""
        name = session.name
        if self._passed_on(session, "end", reason):
            return True
        mirrored = self._mirrored.pop(name, None)
        if mirrored is not None:
            mirrored.end()
        before = self._own.pop(name, None) or (mirrored.entry if mirrored is not None else None)
        if before is not None:  # else nobody was ever told of it
            self._tell_end(msgspec.structs.replace(before, version=before.version + 1, connected=False, ended=reason))
        return False

    def _passed_on(self, session: Session, kind: Any, text: str) -> bool:
        mirrored = self._mirrored.get(session.name)
        if mirrored is None or mirrored.entry.server not in self.peers:
            return False
        self._write(mirrored.entry.server, session.name, kind, text)
        return True

    # -- what comes from others ---------------------------------------------------------------------------------------

    def _take_here(self, data: bytes) -> None:
        server = data.decode(errors="replace")[:64]
        if server not in self.peers:
            _logger.info("another server is there", extra={"server": server})
            self._tell_all()
        self.peers[server] = self._now_s()

    def _take_entry(self, data: bytes) -> None:
        try:
            entry = read_entry(data)
        except MalformedMessage as exc:
            _logger.warning("another server tells nonsense: %s", exc)
            return
        own, mirrored = self._own.get(entry.name), self._mirrored.get(entry.name)
        known = own or (None if mirrored is None else mirrored.entry) or self._ended.get(entry.name)
        if known is not None and entry.rank < known.rank:
            return
        if known is not None and entry.rank == known.rank:
            if mirrored is not None and entry.connected and not mirrored.there and entry.server in self.peers:
                self._mirror(entry)  # it was thought to be gone
            return
        if entry.ended is not None:
            self._forget(entry)
        else:
            self._own.pop(entry.name, None)
            self._mirror(entry)

    def _take_letter(self, data: bytes) -> None:
        try:
            letter = read_letter(data)
            session = self._sessions.get(letter.session)
            if letter.kind == "answer":
                if letter.session in self._mirrored:
                    session.take_text(letter.text)
            elif letter.session not in self._own:
                return  # its rig has gone to another server meanwhile
            elif letter.kind == "control":
                session.control(self._asker(letter), parse_control(letter.text))
            elif letter.kind == "want":
                self._show(session, frame=True, pose=True)
            elif letter.kind == "rename":
                session.rename(letter.text)
            else:
                self._sessions.end(letter.session, ENDED, letter.text)
        except MalformedMessage as exc:
            _logger.warning("another server tells nonsense: %s", exc)
        except UnknownSession:
            pass  # it has ended meanwhile

    def _asker(self, letter: Letter) -> Mailbox:
        """Return the mailbox that brings answers to a server's viewers; who may ask for what was decided there."""
        key = (letter.sender, letter.session)
        if key not in self._askers:
            self._askers[key] = mailbox = Mailbox()
            mailbox.role = "admin"
            mailbox.open(AnswerLine(lambda text: self._write(letter.sender, letter.session, "answer", text)))
        return self._askers[key]

    # -- mirroring ----------------------------------------------------------------------------------------------------

    def _mirror(self, entry: Entry) -> None:
        """Have a session here as it is there."""
        name = entry.name
        session = self._sessions.mirror(name)
        mirrored = self._mirrored.get(name)
        if mirrored is None or mirrored.entry.server != entry.server:
            if mirrored is not None:
                mirrored.end()
            mirrored = Mirrored(entry, lambda text: self._write(entry.server, name, "control", text))
            self._mirrored[name] = mirrored
        mirrored.entry = entry
        mirrored.there = entry.connected and entry.server in self.peers
        session.mirror(entry.title, entry.fields.given(), mirrored.rig if mirrored.there else None)
        self._listen(session, mirrored)

    def _listen(self, session: Session, mirrored: Mirrored) -> None:
        """Listen to what the viewers here may see: whole frames where one of them may, else as they are for everybody."""
        wanted = (
            None
            if not session.viewers
            else "whole"
            if any(v.sees and v.frames_wanted is None for v in session.viewers)
            else "open"
        )
        if wanted == mirrored.listens:
            return
        mirrored.listens = wanted
        mirrored.stop_listening()
        if wanted is None:
            return

        def take(data: bytes) -> None:
            try:
                session.take_binary(data, self._sessions.now_ns())
            except MalformedMessage as exc:
                _logger.warning("another server tells nonsense: %s", exc)

        mirrored.ears = [
            self.bus.hear(_frames_of(session.name, wanted), take),
            self.bus.hear(_poses_of(session.name), take),
        ]
        self._write(mirrored.entry.server, session.name, "want")

    def _show(self, session: Session, frame: bool, pose: bool) -> None:
        name = session.name
        if frame and (whole := session.newest_frame(sees=True)) is not None:
            self.bus.show(_frames_of(name, "whole"), whole)
            self.bus.show(_frames_of(name, "open"), session.newest_frame(sees=False) or whole)
        if pose and session.newest_pose is not None:
            self.bus.show(_poses_of(name), session.newest_pose)

    def _forget(self, entry: Entry) -> None:
        """End a session here that has ended elsewhere."""
        self._own.pop(entry.name, None)
        if (mirrored := self._mirrored.pop(entry.name, None)) is not None:
            mirrored.end()
        self._note_end(entry)
        if entry.name in self._sessions:
            self._sessions.forget(entry.name, ENDED, entry.ended or "This walk has ended.")

    # -- telling ------------------------------------------------------------------------------------------------------

    def _entry_of(self, session: Session, term: int, version: int) -> Entry:
        return Entry(
            name=session.name,
            server=self.server,
            term=term,
            version=version,
            connected=session.connected,
            title=session.title,
            fields=msgspec.convert(session.fields, SessionFields),
        )

    def _announce(self, entry: Entry) -> None:
        self._own[entry.name] = entry
        data = msgspec.json.encode(entry)
        self.bus.tell(ENTRIES, data)
        self.bus.keep(token(entry.name), data)

    def _tell_end(self, entry: Entry) -> None:
        self._note_end(entry)
        self.bus.tell(ENTRIES, msgspec.json.encode(entry))
        self.bus.keep(token(entry.name), None)

    def _note_end(self, entry: Entry) -> None:
        self._ended[entry.name] = entry
        while len(self._ended) > _MOST_ENDED:
            self._ended.popitem(last=False)

    def _tell_all(self) -> None:
        for entry in self._own.values():
            self.bus.tell(ENTRIES, msgspec.json.encode(entry))

    def _write(self, server: str, session: str, kind: Any, text: str = "") -> None:
        letter = Letter(sender=self.server, session=session, kind=kind, text=text)
        self.bus.tell(_letters_of(server), msgspec.json.encode(letter))

    # -- by itself ----------------------------------------------------------------------------------------------------

    async def _learn(self) -> None:
        for data in (await self.bus.kept()).values():
            self._take_entry(data)
        self.ready = True

    async def _repeat(self) -> None:
        turn = 0
        while True:
            self.bus.show(HERE, self.server.encode())
            if turn % 2 == 0 and self.peers:
                self._tell_all()
            self._miss()
            turn += 1
            await asyncio.sleep(_EVERY_S)

    def _miss(self) -> None:
        """Note which servers are gone, and that the rigs of their sessions are."""
        gone = {server for server, t_s in self.peers.items() if self._now_s() - t_s > _GONE_S}
        for server in gone:
            _logger.warning("another server is gone", extra={"server": server})
            del self.peers[server]
        self._askers = {key: mailbox for key, mailbox in self._askers.items() if key[0] not in gone}
        for name, mirrored in self._mirrored.items():
            if mirrored.there and mirrored.entry.server in gone:
                mirrored.there = False
                self._sessions.get(name).mirror(mirrored.entry.title, mirrored.entry.fields.given(), None)


def _letters_of(server: str) -> str:
    return f"agora.to.{server}"


def _frames_of(name: str, kind: str) -> str:
    return f"agora.frames.{kind}.{token(name)}"


def _poses_of(name: str) -> str:
    return f"agora.poses.{token(name)}"
