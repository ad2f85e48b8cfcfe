"""Where a path of its own making lies in the site: the mean of what many fixes say, not the last one's word.

A receiver's error has a part that is new with every fix and a part that lasts for minutes. A path that is good over some seconds
(the camera's, with the IMU where it sees nothing) carries every fix of those seconds to one place, where the first part averages
out; the second stays.
"""

from math import exp

from tracker.measurements import Vector3


class Anchor:
    """The offset from a path to the site, a mean that forgets."""

    def __init__(self, memory_s: float) -> None:
        self._memory_s = memory_s
        self._t_ns: int | None = None
        self._count = 0
        self.offset_m: Vector3 = (0.0, 0.0, 0.0)
        """What is to be added to the path's place, m."""

    def fix(self, t_ns: int, p_site_m: Vector3, path_m: Vector3) -> None:
        """Take a fix and where the path was at its stamp. The first counts wholly; after a silence of the memory's length, most."""
        if self._t_ns is None:
            self._count = 0
            forgotten = 1.0
        else:
            forgotten = 1.0 - exp(-max(0.0, (t_ns - self._t_ns) * 1e-9) / self._memory_s)
        self._t_ns = t_ns
        self._count += 1
        share = max(1.0 / self._count, forgotten)
        x, y, z = (o + share * (p - a - o) for o, p, a in zip(self.offset_m, p_site_m, path_m, strict=True))
        self.offset_m = (x, y, z)

    def forget(self) -> None:
        """Begin anew with the next fix."""
        self._t_ns, self._count = None, 0
