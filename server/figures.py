"""What operators see of a tracker at work: its filter's innovations and what it refused, about once a second."""

from collections.abc import Callable, Iterable, Mapping
from math import dist
from typing import Final

from server.messages import Figures, Update, encode
from tracker.estimator import Innovation

_EVERY_NS: Final = 1_000_000_000
#: An hour and a half of updates, four a second.
_KEPT: Final = 20_000
#: A message with more of them would be too long.
_AT_ONCE: Final = 256
_NOWHERE: Final = (0.0, 0.0, 0.0)


class FigureTeller:
    """Tells the figures of one walk once somebody asks, and all of them to whoever asks later. For one thread, but for `ask`."""

    def __init__(self, send: Callable[[str], None], t_start_ns: int, now_ns: Callable[[], int]) -> None:
        """`send` takes texts for the server; times are told from `t_start_ns`; `now_ns` is any clock that does not jump."""
        self._send, self._t_start_ns, self._now_ns = send, t_start_ns, now_ns
        self._updates: list[Update] = []
        self._told = 0
        """So many of those were sent."""
        self._t_due_ns = 0
        self._is_wanted = self._is_asked = False

    def ask(self) -> None:
        """Have all of them sent at the next look, and from then on what is new."""
        self._is_wanted = self._is_asked = True

    def begin(self) -> None:
        """Forget all: another estimator has begun."""
        self._updates, self._is_asked = [], self._is_wanted

    def look(self, news: Iterable[Innovation], rejected: Mapping[str, int]) -> None:
        """Take what an estimator has seen since the last look and has refused by now; send both when their time has come."""
        for innovation in news:
            self._take(self._update(innovation))
        now_ns = self._now_ns()
        if not self._is_wanted or (not self._is_asked and now_ns < self._t_due_ns):
            return
        anew, self._is_asked = self._is_asked, False
        self._t_due_ns = now_ns + _EVERY_NS
        waiting = self._updates[0 if anew else self._told :]
        for i in range(0, max(1, len(waiting)), _AT_ONCE):
            part = waiting[i : i + _AT_ONCE]
            self._send(encode(Figures(anew=anew and i == 0, updates=part, rejected=dict(rejected))))
        self._told = len(self._updates)

    def _take(self, update: Update) -> None:
        while self._updates and self._updates[-1].t_s >= update.t_s:
            self._updates.pop()  # the estimator was taken back, and works that time out once more
        self._told = min(self._told, len(self._updates))
        self._updates.append(update)
        if len(self._updates) > _KEPT:
            del self._updates[0]
            self._told = max(0, self._told - 1)

    def _update(self, innovation: Innovation) -> Update:
        return Update(
            t_s=(innovation.t_ns - self._t_start_ns) * 1e-9,
            position_m=dist(_NOWHERE, innovation.position_m),
            rotation_rad=dist(_NOWHERE, innovation.rotation_rad),
            motion_model=innovation.motion_model,
        )
