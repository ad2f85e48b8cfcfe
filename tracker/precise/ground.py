"""Which height of the ground a rig stands on: the one below it, or one beside it where its place is not known so well."""

from collections.abc import Callable
from math import cos, pi, sin
from typing import TypeAlias

from tracker.measurements import Vector3

EyeHeight: TypeAlias = Callable[[float, float], float]
"""Height of the rig in site, m, above an east and a north, where it stands on the ground; infinite where nobody can stand."""

_AROUND = tuple((cos(i * pi / 4), sin(i * pi / 4)) for i in range(8))


def standing_z_m(eyes_z_m: EyeHeight, p_site_m: Vector3, within_m: float, off_m: float) -> float | None:
    """Return the height of a rig that stands on the ground.

    A step in the ground is met by the estimate before or after it is met by the feet. So where the ground just below does not fit,
    the best of eight places around is taken: the height that a rig has is a better witness of the step than its place.

    Args:
        eyes_z_m: What is known of the ground.
        p_site_m: Where the rig is by the estimate.
        within_m: How far off its place may be.
        off_m: How far off its height may be.

    Returns:
        The height, or None where the rig is off the ground: on stairs or walls that nobody told of, or where nobody can stand.
    """
    east_m, north_m, up_m = p_site_m
    z_m = eyes_z_m(east_m, north_m)
    if not abs(z_m - up_m) <= off_m:
        around = (eyes_z_m(east_m + within_m * x, north_m + within_m * y) for x, y in _AROUND)
        z_m = min(around, key=lambda z: abs(z - up_m))
    return z_m if abs(z_m - up_m) <= off_m else None
