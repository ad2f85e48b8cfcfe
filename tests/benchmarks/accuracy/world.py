"""A walk and all that its sensors say, by scenario and seed; nothing of their noise is shared with the project's simulator."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.benchmarks.accuracy.alignment import point_out
from tests.benchmarks.accuracy.inertial_unit import measure
from tests.benchmarks.accuracy.magnetometer import sense
from tests.benchmarks.accuracy.receiver import receive
from tests.benchmarks.accuracy.scenarios import DURATION_S, SPELL_FROM_S, SPELL_REST_S, SPELL_S, Scenario
from tests.benchmarks.accuracy.terrain import Hills
from tests.benchmarks.accuracy.visitor import Visitor, visitor
from tracker.choreography import AGORA_TOUR, Tour
from tracker.estimator import Origin
from tracker.gait import Ground
from tracker.measurements import Measurement, VisualMotion
from tracker.precise.ground import EyeHeight
from tracker.simulate import AGORA_ORIGIN, START_NS, flat_ground

#: Faster than this over the ground is walking.
WALKING_M_S = 0.3


@dataclass(frozen=True)
class Place:
    """Where the walks are."""

    tour: Tour = AGORA_TOUR
    origin: Origin = AGORA_ORIGIN
    ground_z_m: Ground = flat_ground
    """Without the hills that are put on it."""
    motions: Callable[[Visitor], list[VisualMotion]] = field(default=lambda _: [])
    """What the camera's front end makes of a walk."""


@dataclass(frozen=True, eq=False)
class Recording:
    """One walk."""

    scenario: Scenario
    seed: int
    walk: Visitor
    measurements: list[Measurement]
    """In order of arrival, the camera's motions among them where they were asked for."""
    outage_s: tuple[float, float] | None
    """Seconds of the walk."""
    told_ns: list[int]
    """When each landmark or place that was pointed out arrived."""
    eyes_z_m: EyeHeight | None


def record(
    scenario: Scenario, seed: int, *, place: Place | None = None, duration_s: float = DURATION_S, camera: bool = False
) -> Recording:
    """Return a walk and its measurements; the same arguments give the same numbers.

    Args:
        scenario: What befalls it.
        seed: Of everything.
        place: Where it is.
        duration_s: How long.
        camera: Whether the camera's motions are wanted.
    """
    place = place or Place()
    hills = Hills(place.ground_z_m)
    walk = visitor(seed, duration_s, place.tour, place.origin, hills.ground_z_m)
    outage_s = busiest_s(walk) if scenario.outage else None
    told = list(point_out(walk, scenario.taps, scenario.stands_here))
    measurements: list[Measurement] = [
        *measure(walk),
        *sense(walk, scenario.magnetometer, scenario.disturbance),
        *receive(walk, scenario.understates, outage_s, walls=scenario.walls, wavers=scenario.wavers),
        *told,
        *(place.motions(walk) if camera else []),
        *walk.truth(),
    ]
    measurements.sort(key=lambda measurement: measurement.t_recv_ns)
    eyes_z_m = hills.eyes_z_m() if scenario.knows_ground else None
    return Recording(scenario, seed, walk, measurements, outage_s, [one.t_recv_ns for one in told], eyes_z_m)


def busiest_s(walk: Visitor) -> tuple[float, float]:
    """Return the minute in which the visitor stands least."""
    stamps = walk.stamps(10.0)
    v = walk.at(stamps).v_m_s
    walked = np.concatenate([[0.0], np.cumsum(np.hypot(v[:, 0], v[:, 1]) > WALKING_M_S)])
    t_s = (stamps - START_NS) * 1e-9
    length = round(SPELL_S * 10)
    first, last = round(SPELL_FROM_S * 10), len(t_s) - round(SPELL_REST_S * 10) - length
    if last <= first:
        raise ValueError(f"expected a walk of at least {SPELL_FROM_S + SPELL_S + SPELL_REST_S:g} s")
    starts = np.arange(first, last, 50)
    best = int(starts[int(np.argmax(walked[starts + length] - walked[starts]))])
    return float(t_s[best]), float(t_s[best]) + SPELL_S
