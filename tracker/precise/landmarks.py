"""Landmarks that somebody has pointed out: each is a direction from where the rig was then, and is looked at again later.

The first one is taken with metres of doubt, and a line of sight seen so near is not straight in them: it counts for little. Once
others have told the place, it is worth its own sigma, and is taken again as seen from now: the way walked since is known well. So
each makes the others worth more, until all are worth what they can be.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from tracker.geometry import conjugate, multiply, normalise, rotate
from tracker.measurements import Matrix, Sighting, Vector3, Wxyz
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
#: One whose noise was raised by more than this factor was not worth what it could be,
DISCOUNTED = 1.5
#: and is taken again once it is raised by so much less: what was taken before then hardly counts.
WORTH_IT = 0.6
#: Rounds in which those that are remembered are taken again, at most.
_ROUNDS = 6


@dataclass
class _Seen:
    sighting: Sighting
    ray_body: Vector3
    walked_m: Vector3
    turned: Wxyz
    discount: float = inf
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

    def see(self, sighting: Sighting, ray_body: Vector3) -> Iterator[_Seen]:
        """Take a new one; yield it and those that are to be corrected by again, each after the one before was."""
        oldest_ns = sighting.t_ns - round(REMEMBERED_S * 1e9)
        self._seen = [one for one in self._seen if one.sighting.t_ns >= oldest_ns]
        new = _Seen(sighting, ray_body, self._walked_m, self._turned)
        self._seen.append(new)
        yield new
        for _ in range(_ROUNDS):
            before = [(one, one.discount) for one in self._seen if DISCOUNTED < one.discount < inf]
            yield from (one for one, _ in before)
            if all(one.discount == discount for one, discount in before):
                return

    def correct(self, filter_: ErrorState, seen: _Seen) -> Correction | None:
        """Take a sighting in, as it would be seen from the present pose; None where it is worth no more than it was before."""
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
        sigma_rad = seen.sighting.sigma_rad
        discount = float(np.hypot(1.0, _bend_rad(filter_.covariance[P, P], to) / sigma_rad))
        if discount > WORTH_IT * seen.discount:
            return None
        seen.discount = discount
        noise = (discount * sigma_rad) ** 2 * np.eye(2)
        return filter_.correct_far(lambda at: observations.bearing(at, (x, y, z), ray, lever), noise)


def _bend_rad(cov_m2: Matrix, to_m: Matrix) -> float:
    """Return by how much a line of sight is not straight within the doubt of a place: its second derivative is along and across."""
    distance_m = float(np.linalg.norm(to_m))
    sight = to_m / distance_m
    across = np.eye(3) - np.outer(sight, sight)
    along_m2 = float(sight @ cov_m2 @ sight)
    across_m2 = float(np.linalg.eigvalsh(across @ cov_m2 @ across)[-1])
    return sqrt(max(0.0, along_m2 * across_m2)) / distance_m**2
