"""Lines to receivers that are nowhere, and a loop whose next turn is now, for the tests of this folder."""

from collections.abc import Callable


class Wire:
    """A line that is free as often as it is told."""

    def __init__(self, room: int = 1000) -> None:
        self.sent: list[str | bytes] = []
        self.on_free: Callable[[], None] = lambda: None
        self.took: Callable[[str | bytes], None] = lambda message: None
        """Called with each message that was sent."""
        self._room = room

    def free(self) -> bool:
        return self._room > 0

    def send(self, message: str | bytes) -> None:
        assert self._room > 0, "sent while the line was busy"
        self._room -= 1
        self.sent.append(message)
        self.took(message)

    def make_room(self, messages: int = 1000) -> None:
        self._room = messages
        self.on_free()


def at_once(call: Callable[[], None]) -> None:
    """Stand in for the event loop's next turn."""
    call()
