"""Landmarks that somebody has pointed out: each is a direction from where the rig was then, and is looked at again later.

The first one is taken with metres of doubt, and a line of sight seen so near is not straight in them: it counts for little. Once
others have told the place, it is worth its own sigma, and is taken again as seen from now: the way walked since is known well. So
each makes the others worth more, until all are worth what they can be. One that is told late, because somebody looked at a picture
for a while before pointing at it, is taken in the same way: as seen from now.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import dist, hypot, inf, sqrt

import numpy as np

from tracker.geometry import conjugate, multiply, rotate
from tracker.measurements import Matrix, Sighting, Vector3, Wxyz
from tracker.precise import observations
from tracker.precise.error_model import P
from tracker.precise.error_state import ErrorState
from tracker.precise.update import Correction
from tracker.precise.way import KEPT_S, Way

#: Sightings older than this are not taken again: the way since is not known well enough.
REMEMBERED_S = KEPT_S
#: Nearer than this, m, a direction is that of a step.
NEAREST_M = 0.5
#: Where the heading is known as well as this, rad, nobody points at what is behind them.
FACING_RAD = 0.5
#: One whose noise was raised by more than this factor was not worth what it could be,
DISCOUNTED = 1.5
#: and is taken again once it is raised by so much less: what was taken before then hardly counts.
WORTH_IT = 0.6
#: The way walked since a sighting is known to about this share of it.
WAY_SHARE = 0.05
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

    def __init__(self, lever_body_m: Vector3, way: Way) -> None:
        self._lever = lever_body_m
        self._seen: list[_Seen] = []
        self._way = way

    def recalls(self, sighting: Sighting) -> bool:
        """Whether the way since a sighting is known, and it is a new one."""
        told = {(one.sighting.t_ns, one.sighting.point_site_m) for one in self._seen}
        return (sighting.t_ns, sighting.point_site_m) not in told and self._way.at(sighting.t_ns) is not None

    def see(self, sighting: Sighting, ray_body: Vector3) -> Iterator[_Seen]:
        """Take one of now, or one that is recalled; yield it and those to be corrected by again, each after the one before was."""
        oldest_ns = sighting.t_ns - round(REMEMBERED_S * 1e9)
        self._seen = [one for one in self._seen if one.sighting.t_ns >= oldest_ns]
        way = self._way
        _, walked_m, turned = way.at(sighting.t_ns) or (0, way.walked_m, way.turned)
        new = _Seen(sighting, ray_body, walked_m, turned)
        self._seen.append(new)
        yield new
        for _ in range(_ROUNDS):
            before = [(one, one.discount) for one in self._seen if DISCOUNTED < one.discount < inf]
            yield from (one for one, _ in before)
            if all(one.discount == discount for one, discount in before):
                return

    def correct(self, filter_: ErrorState, seen: _Seen) -> Correction | None:
        """Take a sighting in, as it would be seen from the present pose; None where it is worth no more than it was before."""
        since = multiply(conjugate(self._way.turned), seen.turned)
        ray, lever = rotate(since, seen.ray_body), rotate(since, self._lever)
        x, y, z = (
            point + now - then
            for point, now, then in zip(seen.sighting.point_site_m, self._way.walked_m, seen.walked_m, strict=True)
        )
        to = np.array((x, y, z)) - filter_.nav.p_m
        distance_m = float(np.linalg.norm(to))
        behind = float(to @ np.array(rotate(filter_.nav.wxyz_site_body, ray))) < 0.0
        if distance_m < NEAREST_M or (behind and float(filter_.covariance[8, 8]) < FACING_RAD**2):
            # a slip of the finger, or of the name
            reject_nis = filter_.settings.reject_nis
            return Correction(reject_nis, -reject_nis, used=False)
        sigma_rad = seen.sighting.sigma_rad
        walked_m = dist(self._way.walked_m, seen.walked_m)
        way_rad = WAY_SHARE * walked_m / distance_m
        discount = hypot(1.0, _bend_rad(filter_.covariance[P, P], to) / sigma_rad, way_rad / sigma_rad)
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
