"""What servers tell each other of a session: pure values, and which of two is the later one."""

from typing import Annotated, Literal

import msgspec
from msgspec import Meta, Struct

from server.errors import MalformedMessage
from server.messages import Name, Sentence, SessionFields

Count = Annotated[int, Meta(ge=0, le=2**62)]


class Entry(Struct, frozen=True, kw_only=True):
    """A session, as all servers know it: the one of the highest rank holds, in whatever order they come."""

    name: Name
    server: Name
    """Where its rig is, or was."""
    term: Count
    """Rises with each server that a rig takes it to: milliseconds of the wall clock then, or one more than the last."""
    version: Count
    """Rises with each change within a term."""
    connected: bool = False
    """Whether the rig is there."""
    title: Name | None = None
    fields: SessionFields = SessionFields()
    ended: Sentence | None = None
    """Why there is no such session any more."""

    @property
    def rank(self) -> tuple[int, int, str]:
        """The higher, the later."""
        return self.term, self.version, self.server


class Letter(Struct, frozen=True, kw_only=True):
    """From one server to another, about a session."""

    sender: Name
    session: Name
    kind: Literal["control", "answer", "want", "rename", "end"]
    """A request for the rig; what the rig says to who asked; the newest frame and pose, please; an operator's wishes."""
    text: str = ""


_ENTRY = msgspec.json.Decoder(Entry)
_LETTER = msgspec.json.Decoder(Letter)


def read_entry(data: bytes) -> Entry:
    """Read an entry; `MalformedMessage` where it is none."""
    try:
        return _ENTRY.decode(data)
    except (msgspec.MsgspecError, ValueError, RecursionError) as exc:
        raise MalformedMessage(f"no entry of a session: {exc}") from exc


def read_letter(data: bytes) -> Letter:
    """Read a letter; `MalformedMessage` where it is none."""
    try:
        return _LETTER.decode(data)
    except (msgspec.MsgspecError, ValueError, RecursionError) as exc:
        raise MalformedMessage(f"no letter: {exc}") from exc


def token(name: str) -> str:
    """Return a session's name as one part of a subject, and as a key: a dot would part it."""
    return name.replace(".", "=")
