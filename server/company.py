"""Who watches one session, and from where: numbers and places, nothing that tells who somebody is. Pure: times come in.

A lossy plane, as poses are: of each viewer the newest look alone is kept, and what is told replaces what was told before. Nothing
here has a clock: the session asks for news whenever poses, frames or looks come, which is often enough.
"""

from collections import OrderedDict
from collections.abc import Hashable
from itertools import count, islice
from typing import Final

from server.messages import Companion, Company, Look, encode

#: Looks of one viewer that come sooner after each other than this are passed over: ten a second.
_SOONEST_NS: Final = 100_000_000
#: A viewer whose page sleeps is not there any more: pages that are seen repeat their look every two seconds.
FORGOTTEN_NS: Final = 10_000_000_000
#: A change is told this long after the last, and with many viewers so much later for each of them.
_TOLD_NS: Final = 250_000_000
_TOLD_EACH_NS: Final = 5_000_000
#: More than this would hide the square.
MOST_TOLD: Final = 32


class Watchers:
    """The viewers of a session, each by whatever stands for it."""

    def __init__(self) -> None:
        self._numbers: dict[Hashable, int] = {}
        self._looks: OrderedDict[int, tuple[Look, int]] = OrderedDict()
        self._told_ns = -(1 << 62)
        self._changed = False

    def join(self, viewer: Hashable) -> int:
        """Count one more and return its number, the smallest that is free."""
        taken = set(self._numbers.values())
        self._numbers[viewer] = number = next(i for i in count(1) if i not in taken)
        self._changed = True
        return number

    def leave(self, viewer: Hashable) -> None:
        """Forget one; nothing where it is not known."""
        number = self._numbers.pop(viewer, None)
        if number is not None:
            self._looks.pop(number, None)
            self._changed = True

    def take(self, viewer: Hashable, look: Look, now_ns: int) -> None:
        """Note where one of them looks from."""
        number = self._numbers[viewer]
        if look.eye is None:
            self._changed |= self._looks.pop(number, None) is not None
            return
        before = self._looks.get(number)
        if before is not None and now_ns - before[1] < _SOONEST_NS:
            return
        self._changed |= before is None or before[0] != look
        self._looks[number] = (look, now_ns)
        self._looks.move_to_end(number)

    def news(self, now_ns: int) -> str | None:
        """Return what all are to be told, if there is something new and it is time for it."""
        if now_ns - self._told_ns < max(_TOLD_NS, _TOLD_EACH_NS * len(self._numbers)):
            return None
        self._forget(now_ns)
        if not self._changed:
            return None
        self._changed, self._told_ns = False, now_ns
        return self.message()

    def message(self) -> str:
        """Return what there is to tell now."""
        newest = islice(reversed(self._looks.items()), MOST_TOLD)
        seen = [Companion(number, look.eye) for number, (look, _) in newest if look.eye is not None]
        return encode(Company(len(self._numbers), seen))

    def _forget(self, now_ns: int) -> None:
        """Forget the looks of viewers that have been silent for long; the oldest are first."""
        while self._looks:
            number, (_, t_ns) = next(iter(self._looks.items()))
            if now_ns - t_ns < FORGOTTEN_NS:
                return
            del self._looks[number]
            self._changed = True
