"""How far a fix moves the place: what has come to be doubted lately is corrected in full, what has long been doubted by less.

Most of a receiver's error stays for minutes, and a place that follows all that fixes say of it wanders about with that error, the
square with it. To move by a share s of what is most likely costs only (1 - s)^2 of what a fix would have gained, and the covariance
says so; the square moves by as much less as s says.

Reference:
    Brink, Partial-update Schmidt-Kalman filter, 2017.
"""

from math import exp

from tracker.measurements import Matrix
from tracker.precise.settings import PreciseSettings


class Doubt:
    """The variance of the place after the last fix, and how much of it is fresh."""

    def __init__(self, settings: PreciseSettings) -> None:
        self._settings = settings
        self.begin()

    def begin(self) -> None:
        """Take all of it for fresh: the place is another one."""
        self._then_ns, self._then_m2, self._fresh = 0, 0.0, 1.0

    def share(self, t_ns: int, covariance: Matrix) -> float:
        """Return by how much of what is most likely a fix of now may move the place, its covariance before that being this."""
        settings, now_m2 = self._settings, _level_m2(covariance)
        grown_m2 = max(0.0, now_m2 - self._then_m2)
        still_fresh = self._fresh * exp(-max(0, t_ns - self._then_ns) * 1e-9 / settings.fresh_s)
        self._then_ns, self._fresh = t_ns, (still_fresh * (now_m2 - grown_m2) + grown_m2) / now_m2
        return self._fresh + settings.settled_share * (1.0 - self._fresh)

    def corrected(self, covariance: Matrix) -> None:
        """Note the covariance after the fix."""
        self._then_m2 = _level_m2(covariance)


def _level_m2(covariance: Matrix) -> float:
    return float(covariance[0, 0] + covariance[1, 1])
