"""Which way the camera's travel points beside the path's: the error of the start heading, seen by the camera while walking.

The essential matrix gives the direction of travel in the camera's axes, attitude turns it to the site, and with the attitude comes
the error of a heading that was found once, at the start. The inertial path follows the receiver's own velocity, which knows north.
The angle between the two, over all steps of the last half minute, is that error.
"""

from math import atan2, cos, exp, hypot, sin

#: Steps shorter than this have no direction, m.
LEAST_STEP_M = 0.05
MEMORY_S = 30.0
#: So much way must have been compared before the angle is believed, m.
LEAST_WAY_M = 3.0


class VisualCourse:
    """The angle from the camera's directions to the path's, a mean over way that forgets."""

    def __init__(self) -> None:
        self._t_ns: int | None = None
        self._dot_m = self._cross_m = self._way_m = 0.0

    def step(self, t_ns: int, seen: tuple[float, float], moved_m: tuple[float, float]) -> None:
        """Take a step: its direction by the camera, horizontal in site, and what the path says of it, m."""
        if self._t_ns is not None:
            keep = exp(-max(0.0, (t_ns - self._t_ns) * 1e-9) / MEMORY_S)
            self._dot_m, self._cross_m, self._way_m = keep * self._dot_m, keep * self._cross_m, keep * self._way_m
        self._t_ns = t_ns
        size, way_m = hypot(*seen), hypot(*moved_m)
        if size < 0.5 or way_m < LEAST_STEP_M:
            return  # straight up or down, or on the spot
        (sx, sy), (mx, my) = seen, moved_m
        self._dot_m += (sx * mx + sy * my) / size
        self._cross_m += (sx * my - sy * mx) / size
        self._way_m += way_m

    @property
    def turn_rad(self) -> float | None:
        """What is to be added to the camera's course; None until enough way agrees on it."""
        if self._way_m < LEAST_WAY_M or hypot(self._dot_m, self._cross_m) < 0.5 * self._way_m:
            return None
        return atan2(self._cross_m, self._dot_m)

    def turn(self, yaw_rad: float) -> None:
        """Take it that what the camera sees has been turned, steps past and to come: north has become better known."""
        c, s = cos(yaw_rad), sin(yaw_rad)
        self._dot_m, self._cross_m = c * self._dot_m + s * self._cross_m, c * self._cross_m - s * self._dot_m

    def turned(self, seen: tuple[float, float]) -> tuple[float, float] | None:
        """Return a direction by the camera as the path's north has it; None while that is not known."""
        turn_rad = self.turn_rad
        if turn_rad is None:
            return None
        c, s = cos(turn_rad), sin(turn_rad)
        return c * seen[0] - s * seen[1], s * seen[0] + c * seen[1]
