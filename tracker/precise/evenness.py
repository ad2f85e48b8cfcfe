"""What a receiver's own path tells of its error: one that claims metres and goes evenly errs slowly.

A bare single-point solution states ten metres, and from one fix to the next it is off by a hand's breadth: nearly all of its error
stays for minutes. Who takes it at its word wanders about within these ten metres. How evenly it goes is seen without any filter:
by how far a fix lies from the line through the two before it. That holds the walker's own turns as well, so it is a bound.

Reference:
    Mehra, Approaches to adaptive filtering, 1972 (a noise's variance from what is seen of it).
"""

from collections import deque
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, sqrt
from statistics import median
from typing import TypeAlias

import numpy as np

from tracker.measurements import Vector3
from tracker.precise.settings import PreciseSettings

#: The fixes of a minute are looked at, four a second of those that come faster; so many over so long are enough.
_KEPT_NS, _EVERY_NS, _ENOUGH, _LEAST_NS = 60_000_000_000, 200_000_000, 12, 3_000_000_000
#: Level places nearer to each other than this are one: a receiver that tells the same again tells nothing, m.
_SAME_M = 1e-3
#: Fixes further apart than this say nothing of how evenly a receiver goes.
FAR_NS = 2_500_000_000
#: The medians of the sum of two squares of normal numbers, and of one.
MEDIANS = (1.386, 0.455)
#: No receiver is believed to err less: in white noise, and by the errors of the shorter correlation times, m.
_LEAST_WHITE_M, _LEAST_M = 0.15, (0.5, 1.0)
#: It must go so much more evenly than it claims before that is believed, and so much less evenly than is believed to lose that.
_EVEN, _UNEVEN = 0.5, 2.0

Timed: TypeAlias = tuple[int, Vector3]


@dataclass(frozen=True)
class Bounds:
    """Of a receiver's error on an axis."""

    white_m2: float
    """Variance of its white noise, at most."""
    grown_m2_s: float
    """By how much the variance of all that wanders grows in a second, at most."""

    def wander_m2(self, time_s: float) -> float:
        """Return the most that an error of this correlation time comes to, were it the only one."""
        return 0.5 * self.grown_m2_s * time_s


class Evenness:
    """The last fixes, how evenly they go, and what that makes of the receiver's error, in units of its stated variance."""

    def __init__(self, settings: PreciseSettings) -> None:
        self._settings = settings
        self._last: tuple[Timed, ...] = ()
        self._bends: deque[tuple[int, Bounds, Bounds]] = deque()
        self._error_m: float | None = None
        self._believe_claims()

    def _believe_claims(self) -> None:
        settings = self._settings
        self._error_m = None
        self.white_share = np.full(3, max(1.0 - sum(settings.gps_error_share), 0.02))
        """(3,) of the white noise."""
        self.errors = np.repeat([settings.gps_error_share, settings.gps_error_s], 3, axis=1)
        """(2, 9), see `ProcessNoise.receiver`."""

    def take(self, t_ns: int, p_site_m: Vector3, sigma_m: Vector3) -> bool:
        """Take a fix, and what it claims to be off by; return whether from now on the receiver is believed otherwise."""
        if self._last and not _goes_on(self._last[-1], (t_ns, p_site_m)):
            return False
        self._last = (*self._last[-2:], (t_ns, p_site_m))
        if len(self._last) < 3 or any(b[0] - a[0] > FAR_NS for a, b in pairwise(self._last)):
            return False
        bends = self._bends
        bends.append((t_ns, *_bend(self._last)))
        while t_ns - bends[0][0] > _KEPT_NS:
            bends.popleft()
        if len(bends) < _ENOUGH or t_ns - bends[0][0] < _LEAST_NS:
            return False
        level, up = _middle([bend[1] for bend in bends]), _middle([bend[2] for bend in bends])
        return self._judge(level, up, sigma_m)

    def _judge(self, level: Bounds, up: Bounds, sigma_m: Vector3) -> bool:
        """Believe what the fixes of a minute say of each axis, where it is another thing than is believed; return whether it is."""
        settings, before_m = self._settings, self._error_m
        error_m = max(sqrt(level.wander_m2(settings.gps_error_s[0])), _LEAST_M[0])
        if before_m is not None and _EVEN <= error_m / before_m <= _UNEVEN:
            return False
        stated = np.square(sigma_m)
        self._believe_claims()
        if error_m >= _EVEN * sqrt(settings.gps_error_share[0] * max(stated[:2])):
            return before_m is not None
        self._error_m = error_m
        axes = (level, level, up)
        white = [max(axis.white_m2, _LEAST_WHITE_M**2) for axis in axes]
        self.white_share = np.minimum(self.white_share, white / stated)
        shares, times_s = (part.reshape(3, 3) for part in self.errors)
        for share, time_s, least_m in zip(shares, settings.gps_error_s, _LEAST_M, strict=False):
            share[:] = np.minimum(share, [max(axis.wander_m2(time_s), least_m**2) for axis in axes] / stated)
        shares[2] = 1.0 - self.white_share - shares[0] - shares[1]
        # so that it wanders no faster than the quickest of the others
        times_s[2] = np.maximum(times_s[2], shares[2] / shares[0] * settings.gps_error_s[0])
        return True


def _goes_on(last: Timed, now: Timed) -> bool:
    """Whether a fix tells more than the one before it did."""
    (t_ns, (x, y, _)), (then_ns, (p, q, _)) = now, last
    return t_ns - then_ns >= _EVERY_NS and hypot(x - p, y - q) > _SAME_M


def _bend(fixes: tuple[Timed, ...]) -> tuple[Bounds, Bounds]:
    """Return what three fixes in a row bound, level and upwards, were all of it noise of the one kind or of the other."""
    (t0, a), (t1, b), (t2, c) = fixes
    first_s, second_s = (t1 - t0) * 1e-9, (t2 - t1) * 1e-9
    by = second_s / first_s
    x, y, z = (r - q - by * (q - p) for p, q, r in zip(a, b, c, strict=True))
    white, grown = 1.0 + (1.0 + by) ** 2 + by**2, second_s + first_s * by**2
    level, up = (x * x + y * y) / MEDIANS[0], z * z / MEDIANS[1]
    return Bounds(level / white, level / grown), Bounds(up / white, up / grown)


def _middle(all_: list[Bounds]) -> Bounds:
    return Bounds(median(b.white_m2 for b in all_), median(b.grown_m2_s for b in all_))
