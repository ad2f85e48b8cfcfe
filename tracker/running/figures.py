"""How fast a walk runs: rates, and times from a sample to the pose that knows of it. Written by one thread, read by any."""

from collections import deque

import numpy as np

#: Times are counted in bins of 50 microseconds, up to half a second.
_BIN_S, _BINS = 50e-6, 10_000
_RATE_S = 2.0


class Latencies:
    """Times as a histogram: it holds a whole day in the same memory as a minute."""

    def __init__(self) -> None:
        self._bins = np.zeros(_BINS, np.int64)
        self.longest_s = 0.0

    def add(self, time_s: float) -> None:
        """Count a time."""
        self._bins[min(max(int(time_s / _BIN_S), 0), _BINS - 1)] += 1
        self.longest_s = max(self.longest_s, time_s)

    def percentile_s(self, percent: float) -> float | None:
        """Return the time that so many per cent are at most, to a bin; None before the first."""
        counts = np.cumsum(self._bins)
        total = int(counts[-1])
        if total == 0:
            return None
        return float(np.searchsorted(counts, percent * 0.01 * total) + 1) * _BIN_S


class Rate:
    """How often something happens, over the last two seconds."""

    def __init__(self) -> None:
        self._times_ns: deque[int] = deque(maxlen=1024)
        self.count = 0
        """Since the beginning."""

    def note(self, now_ns: int) -> None:
        """Note that it has happened."""
        self._times_ns.append(now_ns)
        self.count += 1

    def at(self, now_ns: int) -> float:
        """Return the rate in hertz."""
        recent = [t_ns for t_ns in self._times_ns.copy() if now_ns - t_ns <= _RATE_S * 1e9]
        return len(recent) / max((now_ns - recent[0]) * 1e-9, 1e-3) if len(recent) > 1 else 0.0
