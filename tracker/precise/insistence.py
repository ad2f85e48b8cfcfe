"""A receiver whose fixes are refused one after another: when it is believed after all, and that it may come back.

It cannot be known which of the two is wrong, filter or receiver. One that insists for seconds is believed; where it had only leapt
(a reflection, a lost satellite) it returns to where the filter had been all along, and then it is believed at once.
"""

from math import hypot

from tracker.measurements import Vector3

#: Fixes are counted, and must be spread over as long as five of one a second are: a fast receiver is no better for being fast.
_INSISTS_NS = 4_000_000_000
#: Back is what lies within so many standard deviations of where the filter would be without the leap.
_BACK_SIGMAS = 5.0
#: After so long nothing is known any more of where that is.
_FORGOTTEN_NS = 300_000_000_000


class Insistence:
    """Counts refused fixes, and remembers the last leap that was believed."""

    def __init__(self, count: int) -> None:
        """So many fixes in a row must be refused before they are believed."""
        self._needed = count
        self._count = 0
        self._since_ns = 0
        self._leap: tuple[int, Vector3] | None = None

    def accepted(self) -> None:
        """Note that a fix was taken in."""
        self._count = 0

    def believes(self, t_ns: int, p_fix_m: Vector3, p_filter_m: Vector3, sigma_m: float) -> bool:
        """Take a refused fix; return whether the filter is to begin anew there."""
        if self._is_back(t_ns, p_fix_m, p_filter_m, sigma_m):
            self._count, self._leap = 0, None
            return True
        if self._count == 0:
            self._since_ns = t_ns
        self._count += 1
        if self._count < self._needed or t_ns - self._since_ns < _INSISTS_NS:
            return False
        self._count = 0
        self._leap = (t_ns, _difference(p_fix_m, p_filter_m))
        return True

    def _is_back(self, t_ns: int, p_fix_m: Vector3, p_filter_m: Vector3, sigma_m: float) -> bool:
        if self._leap is None or t_ns - self._leap[0] > _FORGOTTEN_NS:
            return False
        home_m = _difference(p_filter_m, self._leap[1])
        east_m, north_m, _ = _difference(p_fix_m, home_m)
        return hypot(east_m, north_m) <= _BACK_SIGMAS * sigma_m


def _difference(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
