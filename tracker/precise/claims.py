"""What a receiver claims to be off by: what it usually claims, and how much noisier a fix is that claims more.

Most of a receiver's error stays for minutes, in metres, whatever it claims from one fix to the next. The errors that last go by the
middle of its last claims; one that is worse than that, of a moment with fewer satellites, only makes its own fix noisier.
"""

from collections import deque
from math import sqrt

import numpy as np

from tracker.fixes import variance_m2
from tracker.measurements import GpsFix, Matrix, Vector3
from tracker.precise.settings import PreciseSettings

#: So many claims have a middle: two fixes that are worse than the others leave it where it was.
_LAST = 5
#: Who claims to be off by more than this tells nothing, however much more.
_NOTHING_M = 1000.0


def claimed_m(fix: GpsFix, settings: PreciseSettings) -> Vector3:
    """Return what a receiver claims of a fix, as far as it is believed: standard deviations, east, north, up."""
    x, y, z = settings.gps_sigma_m
    var = variance_m2(fix, settings.gps_floor_m, (x * x, y * y, z * z))
    sx, sy, sz = (min(sqrt(v * settings.gps_inflation), _NOTHING_M) for v in var)
    return sx, sy, sz


class Claims:
    """The last standard deviations that were claimed."""

    def __init__(self) -> None:
        self._last: deque[Vector3] = deque(maxlen=_LAST)

    def take(self, sigma_m: Vector3) -> tuple[Vector3, Matrix]:
        """Take a fix's; return the usual ones, and (3,) variances, m², by which this fix is noisier than it usually is."""
        self._last.append(sigma_m)
        middle = np.median(np.array(self._last), axis=0)
        x, y, z = middle.tolist()
        return (x, y, z), np.maximum(0.0, np.square(sigma_m) - np.square(middle))
