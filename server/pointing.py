"""What the visitor of a simulated walk points out: landmarks in sight, tapped a little beside them and a little late."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from assets.records import Landmark
from tracker import lens
from tracker.errors import InputError
from tracker.measurements import Sighting
from tracker.said import sighting
from tracker.simulate import Walk

#: How well a finger hits, px; what the page claims of it is more (`web/src/alignment.ts`).
_FINGER_PX, _CLAIMED_PX = 4.0, 6.0
#: A visitor taps, and then chooses which landmark it was.
_CHOOSING_NS = 2_000_000_000


@dataclass(frozen=True)
class Pointing:
    """A landmark, and when it is tapped."""

    landmark: str
    at_s: float
    """Of the picture, from the walk's start."""


#: On the demo's walk: two before the first step, two on the way, two where the Basilica's columns are near.
DEMO_POINTINGS = (
    Pointing("temple_corner_ne", 3.0),
    Pointing("basilica_column_west", 5.5),
    Pointing("temple_corner_se", 11.0),
    Pointing("prytaneion_column", 21.0),
    Pointing("odeon_wall_west", 46.0),
    Pointing("basilica_column_west", 56.0),
)


def pointed_out(walk: Walk, pointings: Sequence[Pointing], landmarks: Sequence[Landmark]) -> Iterator[Sighting]:
    """Yield what the visitor says, in order of arrival; the same for the same walk. What would be said after its end is left out.

    Raises:
        InputError: No such landmark, or it is not in the picture then.
    """
    points = {landmark.id: landmark.point_m for landmark in landmarks}
    times = [t_ns for t_ns, _ in walk.frame_times()]
    start_ns, end_ns = times[0], times[-1]
    for number, pointing in enumerate(sorted(pointings, key=lambda one: one.at_s)):
        if pointing.landmark not in points:
            raise InputError(f"There is no landmark {pointing.landmark}: there are {', '.join(sorted(points))}.")
        asked_ns = start_ns + round(pointing.at_s * 1e9)
        if asked_ns + _CHOOSING_NS > end_ns:
            return
        t_ns = min(times, key=partial(_apart_ns, asked_ns))
        rng = np.random.default_rng([walk.settings.seed, 5, number])
        yield _tap(walk, t_ns, pointing, points[pointing.landmark], rng)


def _apart_ns(a_ns: int, b_ns: int) -> int:
    return abs(a_ns - b_ns)


def _tap(
    walk: Walk, t_ns: int, pointing: Pointing, point_site_m: tuple[float, float, float], rng: np.random.Generator
) -> Sighting:
    camera = walk.rig.camera
    if camera is None:
        raise ValueError("a rig with a camera")
    T_site_cam = walk.T_site_cam(t_ns)
    p_cam_m = T_site_cam[:3, :3].T @ (np.array(point_site_m) - T_site_cam[:3, 3])
    not_seen = InputError(f"{pointing.landmark} is not in the picture {pointing.at_s:g} s after the start.")
    if p_cam_m[2] <= 0.0:
        raise not_seen
    u_px, v_px = lens.project(camera, (p_cam_m[:2] / p_cam_m[2])[None])[0] + rng.normal(0.0, _FINGER_PX, 2)
    try:
        return sighting(
            camera,
            (float(u_px), float(v_px)),
            _CLAIMED_PX,
            point_site_m,
            t_ns=t_ns,
            t_recv_ns=t_ns + _CHOOSING_NS,
            distance_m=float(np.linalg.norm(p_cam_m)),
        )
    except InputError:
        raise not_seen from None
