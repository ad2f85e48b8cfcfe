"""A session whose rig is at another server, as this one holds it, and the lines that lead between the two."""

from collections.abc import Callable

from server.cluster.bus import End
from server.cluster.entry import Entry
from server.fanout import Mailbox


class AnswerLine:
    """A `fanout.Line` whose text messages are handed to a function, and which carries nothing else."""

    def __init__(self, send_text: Callable[[str], None]) -> None:
        self.on_free: Callable[[], None] = lambda: None
        self._send_text = send_text

    def free(self) -> bool:
        """Always: the bus has its own limits."""
        return True

    def send(self, message: str | bytes) -> None:
        """Pass a text on."""
        if isinstance(message, str):
            self._send_text(message)


class Mirrored:
    """What belongs to it beside the session."""

    def __init__(self, entry: Entry, ask: Callable[[str], None]) -> None:
        """`ask` brings a request to the rig's server."""
        self.entry = entry
        self.there = False
        """Whether its rig is, as far as is known."""
        self.rig = Mailbox()
        """In the place of the rig's."""
        self.rig.open(AnswerLine(ask))
        self.listens: str | None = None
        """To which kind of frames."""
        self.ears: list[End] = []

    def stop_listening(self) -> None:
        """Listen to no frames and poses."""
        for end in self.ears:
            end()
        self.ears = []

    def end(self) -> None:
        """Let go of it."""
        self.stop_listening()
        self.listens = None
