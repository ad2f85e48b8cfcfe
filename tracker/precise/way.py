"""The way that a rig has come, corrections left out: so a direction of some seconds ago can be told as it would be from here."""

from bisect import bisect_left
from typing import TypeAlias

from tracker.geometry import conjugate, multiply, normalise, slerp
from tracker.measurements import Vector3, Wxyz
from tracker.precise.navigation import Navigation

#: How far back it is known: as long as sightings are remembered.
KEPT_S = 60.0
#: Places are kept this often: in so short a time a head turns evenly to within 0.03 degrees.
_EVERY_NS = 20_000_000

Place: TypeAlias = tuple[int, Vector3, Wxyz]
"""A time, the way walked by then in site axes, and how the body has turned since the beginning."""


class Way:
    """The way so far, and where on it the rig was in the last minute."""

    def __init__(self) -> None:
        self.walked_m: Vector3 = (0.0, 0.0, 0.0)
        self.turned: Wxyz = (1.0, 0.0, 0.0, 0.0)
        self._places: list[Place] = []

    def __deepcopy__(self, memo: object) -> "Way":
        # places never change, and there are thousands: a copy shares them
        copied = Way()
        copied.walked_m, copied.turned, copied._places = self.walked_m, self.turned, self._places.copy()
        return copied

    def moved(self, before: Navigation, after: Navigation) -> None:
        """Take a step of the strapdown integral."""
        (ax, ay, az), (bx, by, bz), (x, y, z) = before.p_m, after.p_m, self.walked_m
        self.walked_m = (x + bx - ax, y + by - ay, z + bz - az)
        step = multiply(conjugate(before.wxyz_site_body), after.wxyz_site_body)
        self.turned = normalise(multiply(self.turned, step))
        places = self._places
        if not places or after.t_ns - places[-1][0] >= _EVERY_NS:
            places.append((after.t_ns, self.walked_m, self.turned))
            oldest_ns = after.t_ns - round(KEPT_S * 1e9)
            # in one go now and then: at the front of a list it is dear
            if places[0][0] < oldest_ns - round(KEPT_S * 1e8):
                del places[: bisect_left(places, oldest_ns, key=_stamp)]

    def at(self, t_ns: int) -> Place | None:
        """Return where it was at a time between two that are kept; None for other times."""
        after = bisect_left(self._places, t_ns, key=_stamp)
        if after == len(self._places):
            return None
        t1_ns, (bx, by, bz), q1 = self._places[after]
        if t1_ns == t_ns:
            return self._places[after]
        if after == 0:
            return None
        t0_ns, (ax, ay, az), q0 = self._places[after - 1]
        share = (t_ns - t0_ns) / (t1_ns - t0_ns)
        walked = (ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az))
        return t_ns, walked, slerp(q0, q1, share)


def _stamp(place: Place) -> int:
    return place[0]
