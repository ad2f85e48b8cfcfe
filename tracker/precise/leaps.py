"""Fixes that leap aside and back: what a wall throws back, for as long as the rig is beside it.

A receiver that hears a satellite by way of a wall is metres off from one second to the next, and its velocity some tenths, for the
echo's way grows or shrinks by walking. That is not white: ten seconds of it carry the place along for metres, and turn north. The
leap gives it away, for nobody walks like that and the inertial unit felt nothing; so does the leap back.
"""

from collections import deque
from math import inf, sqrt
from statistics import median

import numpy as np

from tracker.measurements import Matrix
from tracker.precise.evenness import FAR_NS, MEDIANS

#: So many steps are looked at to learn how long they usually are, and so many are enough.
_KEPT, _ENOUGH = 60, 12
#: No receiver is believed to step less, m.
_LEAST_M = 0.3
#: Chance makes a step so many times as long as usual once in tens of thousands.
_LEAPS = 5.5
#: No wall throws further aside; what does is refused by the filter, and believed where it insists, level, m.
_FURTHEST_M = 20.0
#: Who steps against the leap by so much, and by this share of it, is back.
_BACK, _BACK_SHARE = 2.5, 0.5
#: Who has not leapt back after this long is at another place.
_STAYS_NS = 15_000_000_000
_NONE = np.zeros(3)


class Leaps:
    """How a receiver's error usually steps from one fix to the next, and the leap that it has not come back from."""

    def __init__(self) -> None:
        self._level_m2: deque[float] = deque(maxlen=_KEPT)
        self._up_m2: deque[float] = deque(maxlen=_KEPT)
        self._last_m, self._last_ns = _NONE, 0
        self._leap, self._leapt_ns = _NONE, 0

    def is_aside(self, t_ns: int) -> bool:
        """Whether it has leapt, and not back yet, as far as fixes of late can tell."""
        return bool(self._leap.any()) and t_ns - self._last_ns <= FAR_NS

    def take(self, t_ns: int, error_m: Matrix) -> Matrix:
        """Take a fix; return by how much it leaps, (3,) in site, m: zeros for an ordinary step.

        Args:
            t_ns: When it was made.
            error_m: (3,) its place less where the rig's own way has the antenna, wherever that way began.
        """
        step_m, since_ns = error_m - self._last_m, t_ns - self._last_ns
        self._last_m, self._last_ns = error_m, t_ns
        if not 0 < since_ns <= FAR_NS:
            self._leap = _NONE
            return _NONE
        usual_m = self._usual_m()
        self._level_m2.append(float(step_m[0] ** 2 + step_m[1] ** 2))
        self._up_m2.append(float(step_m[2] ** 2))
        step = step_m / usual_m
        leaps = float(np.linalg.norm(step)) > _LEAPS and float(np.hypot(*step_m[:2])) < _FURTHEST_M
        if self._is_back(step):
            self._leap = _NONE
        elif leaps:
            self._leap, self._leapt_ns = step, t_ns
        elif t_ns - self._leapt_ns > _STAYS_NS:
            self._leap = _NONE
        return step_m if leaps else _NONE

    def _is_back(self, step: Matrix) -> bool:
        """Whether a step, in units of the usual one, undoes the leap."""
        length = float(np.linalg.norm(self._leap))
        return length > 0.0 and float(step @ self._leap) / length < -max(_BACK, _BACK_SHARE * length)

    def _usual_m(self) -> Matrix:
        if len(self._level_m2) < _ENOUGH:
            return np.full(3, inf)
        level_m, up_m = (
            max(sqrt(median(squares) / usual), _LEAST_M)
            for squares, usual in zip((self._level_m2, self._up_m2), MEDIANS, strict=True)
        )
        return np.array([level_m, level_m, up_m])
