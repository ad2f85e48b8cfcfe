"""What a visitor points out: landmarks in the picture, and a surveyed point to stand on."""

from collections.abc import Iterator
from math import radians

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.accuracy.scenarios import LOOK_FROM_S
from tests.benchmarks.accuracy.visitor import Visitor
from tracker.measurements import Sighting, Standpoint
from tracker.simulate import START_NS

SIGMA_RAD = radians(0.5)
STANDING_SIGMA_M = 0.15
NEAR_M, FAR_M = 20.0, 40.0
#: How far a landmark lies from the middle of the picture, at most; aside, and up or down.
ASIDE_RAD, RISE_RAD = radians(20.0), radians(8.0)
#: The head is turned to both sides in these seconds (see `visitor.LOOKS`).
LOOK_S = 11.0
#: One tap reaches the tracker so long after its picture.
LATE_NS = 150_000_000
STREAM = 36


def looks(walk: Visitor) -> NDArray[np.int64]:
    """Return the stamps at which the visitor looks furthest to the left, midway and furthest to the right, in order of time."""
    begin_ns = START_NS + round(LOOK_FROM_S * 1e9)
    stamps = begin_ns + (np.arange(round(LOOK_S * 10)) * 100_000_000)
    forward = walk.at(stamps).R_site_body[:, :, 0]
    yaw = np.unwrap(np.arctan2(forward[:, 1], forward[:, 0]))
    left, right = int(np.argmax(yaw)), int(np.argmin(yaw))
    first, last = min(left, right), max(left, right)
    middle = first + int(np.argmin(np.abs(yaw[first : last + 1] - (yaw[left] + yaw[right]) / 2.0)))
    return np.asarray(stamps[[first, middle, last]])


def point_out(walk: Visitor, count: int, stands_here: bool) -> Iterator[Sighting | Standpoint]:
    """Yield what is pointed out: three landmarks as the head turns, or one, after the visitor's place where it is told."""
    rng = np.random.default_rng([walk.settings.seed, STREAM])
    stamps = looks(walk)[: max(count, int(stands_here))] if count else looks(walk)[:0]
    motion, T_body_cam = walk.at(stamps), walk.rig.T_body_cam
    for number, t in enumerate(stamps.tolist()):
        R_site_cam = motion.R_site_body[number] @ T_body_cam[:3, :3]
        p_cam = motion.p_m[number] + motion.R_site_body[number] @ T_body_cam[:3, 3]
        if stands_here and number == 0:
            x, y, z = (motion.p_m[number] + rng.normal(0.0, STANDING_SIGMA_M, 3)).tolist()
            yield Standpoint(t, t + LATE_NS, (x, y, z), STANDING_SIGMA_M)
        aside, down = rng.uniform(-ASIDE_RAD, ASIDE_RAD), rng.uniform(-RISE_RAD, RISE_RAD)
        ray = np.array([np.tan(aside), np.tan(down), 1.0])
        ray /= np.linalg.norm(ray)
        px, py, pz = (p_cam + rng.uniform(NEAR_M, FAR_M) * (R_site_cam @ ray)).tolist()
        seen = ray + SIGMA_RAD * _across(rng, ray)
        rx, ry, rz = (seen / np.linalg.norm(seen)).tolist()
        yield Sighting(t, t + LATE_NS, (px, py, pz), (rx, ry, rz), SIGMA_RAD)


def _across(rng: np.random.Generator, ray: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a random vector across a unit one, of deviation one in each of its two directions."""
    any_way = rng.normal(0.0, 1.0, 3)
    return np.asarray(any_way - (any_way @ ray) * ray)
