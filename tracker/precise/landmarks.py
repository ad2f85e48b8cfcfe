"""Landmarks that somebody has pointed out: each is a direction from where the rig was then, and is looked at again later.

The first one is taken with metres of doubt, and a line of sight seen so near is not straight in them: it counts for little. Once
others have told the place, it is worth its own sigma, and is taken again as seen from now: the way walked since is known well.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import conjugate, multiply, normalise, rotate
from tracker.measurements import Sighting, Vector3, Wxyz
from tracker.precise import observations
from tracker.precise.error_model import P
from tracker.precise.error_state import Correction, ErrorState
from tracker.precise.navigation import Navigation

#: Sightings older than this are not taken again: the way since is not known well enough.
REMEMBERED_S = 60.0
#: Nearer than this, m, a direction is that of a step.
NEAREST_M = 0.5
#: Where the heading is known as well as this, rad, nobody points at what is behind them.
FACING_RAD = 0.5
#: One whose noise was raised by more than this factor was not worth what it could be.
DISCOUNTED = 2.0


@dataclass
class _Seen:
    sighting: Sighting
    ray_body: Vector3
    walked_m: Vector3
    turned: Wxyz
    discount: float = 1.0
    """By how much its noise was raised, when it was taken last."""


class Landmarks:
    """The recent sightings, and the way since each."""

    def __init__(self, lever_body_m: Vector3) -> None:
        self._lever = lever_body_m
        self._seen: list[_Seen] = []
        self._walked_m: Vector3 = (0.0, 0.0, 0.0)
        self._turned: Wxyz = (1.0, 0.0, 0.0, 0.0)

    def moved(self, before: Navigation, after: Navigation) -> None:
        """Take a step of the strapdown integral, corrections left out."""
        (ax, ay, az), (bx, by, bz), (x, y, z) = before.p_m, after.p_m, self._walked_m
        self._walked_m = (x + bx - ax, y + by - ay, z + bz - az)
        step = multiply(conjugate(before.wxyz_site_body), after.wxyz_site_body)
        self._turned = normalise(multiply(self._turned, step))

    def see(self, sighting: Sighting, ray_body: Vector3) -> list[_Seen]:
        """Take a new one; return it and those before it that are to be taken again, the new one first."""
        oldest_ns = sighting.t_ns - round(REMEMBERED_S * 1e9)
        self._seen = [one for one in self._seen if one.sighting.t_ns >= oldest_ns]
        self._seen.append(_Seen(sighting, ray_body, self._walked_m, self._turned))
        return [self._seen[-1], *(one for one in self._seen if one.discount > DISCOUNTED)]

    def correct(self, filter_: ErrorState, seen: _Seen) -> Correction:
        """Take a sighting in, as it would be seen from the present pose."""
        since = multiply(conjugate(self._turned), seen.turned)
        ray, lever = rotate(since, seen.ray_body), rotate(since, self._lever)
        x, y, z = (
            point + now - then
            for point, now, then in zip(seen.sighting.point_site_m, self._walked_m, seen.walked_m, strict=True)
        )
        to = np.array((x, y, z)) - filter_.nav.p_m
        distance_m = float(np.linalg.norm(to))
        behind = float(to @ np.array(rotate(filter_.nav.wxyz_site_body, ray))) < 0.0
        if distance_m < NEAREST_M or (behind and float(filter_.covariance[8, 8]) < FACING_RAD**2):
            # a slip of the finger, or of the name
            reject_nis = filter_.settings.reject_nis
            return Correction(reject_nis, -reject_nis, used=False)
        bend_rad = float(np.trace(filter_.covariance[P, P])) / (2.0 * distance_m**2)
        sigma_rad = seen.sighting.sigma_rad
        seen.discount = float(np.hypot(sigma_rad, bend_rad)) / sigma_rad
        noise = (seen.discount * sigma_rad) ** 2 * np.eye(2)
        return filter_.correct_far(lambda at: observations.bearing(at, (x, y, z), ray, lever), noise)
