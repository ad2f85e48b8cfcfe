"""What passed through the server, counted: how much was sent and dropped, and how long it took. Pure, for one event loop."""

from bisect import bisect_left
from collections import Counter
from dataclasses import dataclass
from typing import Final

#: Upper ends of the classes, seconds: about two in each doubling from half a millisecond to four seconds.
BOUNDS_S: Final = (
    0.0005,
    0.001,
    0.002,
    0.003,
    0.005,
    0.0075,
    0.01,
    0.015,
    0.02,
    0.03,
    0.05,
    0.1,
    0.2,
    0.5,
    1.0,
    2.0,
    4.0,
)


class Durations:
    """A histogram of durations."""

    def __init__(self) -> None:
        self._counts = [0] * (len(BOUNDS_S) + 1)
        self.sum_s = 0.0

    def add(self, seconds: float) -> None:
        """Count one."""
        self._counts[bisect_left(BOUNDS_S, seconds)] += 1
        self.sum_s += seconds

    def cumulative(self) -> list[tuple[str, float]]:
        """Return how many were at most as long as each bound, as Prometheus wants them."""
        total, rows = 0, []
        for bound, count in zip((*map(str, BOUNDS_S), "+Inf"), self._counts, strict=True):
            total += count
            rows.append((bound, float(total)))
        return rows


@dataclass
class Tally:
    """What one session's viewers were sent, and what newer ones took the place of before it could be."""

    frames_sent: int = 0
    frames_dropped: int = 0
    poses_sent: int = 0
    poses_dropped: int = 0


class Traffic:
    """Of the whole server."""

    def __init__(self) -> None:
        self.frames = Durations()
        """From a frame's arrival to its leaving for one viewer."""
        self.poses = Durations()
        self.refused: Counter[str] = Counter()
        """Connections and messages turned away, by reason."""
