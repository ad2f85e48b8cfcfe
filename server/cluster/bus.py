"""What carries messages between servers: lossy ones by subject, and a few values that are kept. For one event loop.

`LocalBus` is inside one process, `nats_bus.NatsBus` between machines. No method here waits, and nobody hears itself.
"""

import asyncio
from collections.abc import Callable
from typing import Protocol

Take = Callable[[bytes], None]
End = Callable[[], None]


class Bus(Protocol):
    """One server's end of it."""

    @property
    def connected(self) -> bool:
        """Whether what is sent now can arrive."""

    def show(self, subject: str, data: bytes) -> None:
        """Send what a newer message of that subject may replace before it has gone."""

    def tell(self, subject: str, data: bytes) -> None:
        """Send in order; lost only where nobody listens, or the connection is away for long."""

    def hear(self, subject: str, take: Take) -> End:
        """Listen to a subject; returns what ends that."""

    def keep(self, key: str, value: bytes | None) -> None:
        """Keep a value where it outlives every server, None to keep it no more: done as soon as that is possible."""

    async def kept(self) -> dict[str, bytes]:
        """Return all that is kept; waits until it is known."""

    async def run(self) -> None:
        """Carry, until it is cancelled."""


class Hub:
    """What the ends inside one process share."""

    def __init__(self) -> None:
        self.ears: dict[str, list[tuple[LocalBus, Take]]] = {}
        self.kept: dict[str, bytes] = {}


class LocalBus:
    """A bus inside one process: that of a server which is alone, or of several in a test."""

    connected = True

    def __init__(self, hub: Hub | None = None) -> None:
        self._hub = hub or Hub()

    def show(self, subject: str, data: bytes) -> None:
        """See `Bus`."""
        self.tell(subject, data)

    def tell(self, subject: str, data: bytes) -> None:
        """See `Bus`."""
        for bus, take in self._hub.ears.get(subject, ()):
            if bus is not self:
                asyncio.get_running_loop().call_soon(take, data)

    def hear(self, subject: str, take: Take) -> End:
        """See `Bus`."""
        ear = (self, take)
        self._hub.ears.setdefault(subject, []).append(ear)
        return lambda: self._hub.ears[subject].remove(ear)

    def keep(self, key: str, value: bytes | None) -> None:
        """See `Bus`."""
        if value is None:
            self._hub.kept.pop(key, None)
        else:
            self._hub.kept[key] = value

    async def kept(self) -> dict[str, bytes]:
        """See `Bus`."""
        return dict(self._hub.kept)

    async def run(self) -> None:
        """See `Bus`: there is nothing to do."""
        await asyncio.Event().wait()
