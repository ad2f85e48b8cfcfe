"""Which fixes are out of the question: positions that nobody can have walked to, until the receiver insists."""

from math import hypot

from tracker.measurements import Vector3

#: A jump up to this is a receiver's ordinary error, m;
ORDINARY_M = 50.0
#: beyond it, what needs more speed than this is refused, m/s,
FASTEST_M_S = 40.0
#: unless so many in a row say so: then the receiver had lied before.
BELIEVED = 5


class FixGate:
    """Compares each fix with the last one that was let through."""

    def __init__(self) -> None:
        self._refused = 0

    def refuses(self, old_m: Vector3, new_m: Vector3, dt_s: float) -> bool:
        """Return whether a fix must be left out."""
        jump_m = hypot(*(new - old for new, old in zip(new_m, old_m, strict=True)))
        if jump_m > ORDINARY_M + FASTEST_M_S * dt_s and self._refused < BELIEVED:
            self._refused += 1
            return True
        return False

    def insisted(self) -> bool:
        """Return whether the fix just let through had been refused until it was believed; begin anew."""
        insisted, self._refused = self._refused == BELIEVED, 0
        return insisted
