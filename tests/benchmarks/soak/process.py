"""What a process takes, and what else runs on its machine: read from /proc, changed nowhere."""

import os
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep

_PROC = Path("/proc")
_TICKS_S = os.sysconf("SC_CLK_TCK")
_PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")
#: Of the first line of /proc/stat: user, nice, system, idle, iowait, irq, softirq, steal.
_IDLE = (3, 4)
_FIELDS = 8
_TIMER_S = 0.004
#: Of /proc/PID/stat after the name: user and system time.
_OWN = slice(11, 13)


@dataclass(frozen=True, slots=True)
class Usage:
    """A process and its machine at one moment."""

    rss_mb: float
    own_s: float
    """Processor time of the process so far."""
    busy_s: float
    """Processor time of everybody so far, all cores together."""


def usage(pid: int) -> Usage:
    """Return how a process is.

    Raises:
        OSError: There is none of that number.
    """
    pages = int((_PROC / str(pid) / "statm").read_text(encoding="ascii").split()[1])
    own = (_PROC / str(pid) / "stat").read_text(encoding="ascii").rpartition(")")[2].split()[_OWN]
    total = [
        int(word) for word in (_PROC / "stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1 : _FIELDS + 1]
    ]
    busy = sum(total) - sum(total[i] for i in _IDLE)
    return Usage(pages * _PAGE_BYTES / 1e6, sum(int(word) for word in own) / _TICKS_S, busy / _TICKS_S)


def load() -> str:
    """Return the machine's load averages over 1, 5 and 15 minutes."""
    return " ".join(f"{value:.1f}" for value in os.getloadavg())


def lateness_ms(seconds: float = 4.0) -> float:
    """Return how late a bare timer of 4 ms is on this machine now, the 99th percentile: no program can be better."""
    late_s = []
    end_s = monotonic() + seconds
    while (began_s := monotonic()) < end_s:
        sleep(_TIMER_S)
        late_s.append(monotonic() - began_s - _TIMER_S)
    return sorted(late_s)[round(0.99 * (len(late_s) - 1))] * 1e3
