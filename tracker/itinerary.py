"""Walks by plan: way-points, and what the visitor looks at on the way and at each. Nothing in them is left to chance."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, hypot, radians

import numpy as np

from tracker.choreography import KNOT_S, Draft, nearest_turn_rad
from tracker.measurements import Vector3
from tracker.splines import slewed

PointEN = tuple[float, float]
#: Of somebody who looks at things at leisure; a glance of the walks by chance is faster.
TURN_RAD_S = radians(65.0)
#: Where the eyes go without a sight: ahead and a little down when walking.
AHEAD_NOSE_UP_RAD = radians(-3.0)
HIGHEST_NOSE_UP_RAD = radians(20.0)


@dataclass(frozen=True)
class Look:
    """Something to look at, and for how long; the turn of the head to it counts."""

    sight_m: Vector3 | None
    """Site frame; None is the way ahead."""
    duration_s: float


@dataclass(frozen=True)
class Leg:
    """Go straight to a place, looking at things on the way, and stand there looking at others."""

    to_en_m: PointEN
    speed_m_s: float
    on_the_way: tuple[Look, ...] = ()
    """One after another from the first step; then ahead."""
    there: tuple[Look, ...] = ()


@dataclass(frozen=True)
class Itinerary:
    """A whole walk."""

    start_en_m: PointEN
    first_sight_m: Vector3
    """Looked at from the start, without any movement while the rig calibrates."""
    legs: tuple[Leg, ...]


#: The demo: from the temple in the square eastwards along the Basilica, past the Prytaneion behind it, to the Odeon.
#: After OpenStreetMap footprints, (c) OpenStreetMap contributors, ODbL 1.0.
AGORA_DEMO = Itinerary(
    start_en_m=(-68.5, 4.9),
    first_sight_m=(-42.0, -4.0, 3.0),  # between the temple's corner and the Basilica
    legs=(
        Leg(
            to_en_m=(-58.4, 2.2),
            speed_m_s=1.1,
            on_the_way=(Look((-63.0, -12.0, 0.8), 5.0), Look((-54.0, -6.0, 1.0), 2.0)),  # the temple in the square
            there=(
                Look((-51.0, 42.0, 4.0), 4.0),  # the Prytaneion over the Basilica's ruins
                Look((-41.0, 41.0, 4.0), 2.0),
                Look((-62.0, -10.0, 1.0), 4.0),  # and the temple again, right behind
            ),
        ),
        Leg(to_en_m=(-46.8, -0.9), speed_m_s=1.2, on_the_way=(Look(None, 4.0), Look((-38.0, 38.0, 4.0), 3.0))),
        Leg(
            to_en_m=(-27.0, -3.5),
            speed_m_s=1.35,
            on_the_way=(Look(None, 4.0), Look((-24.0, 12.0, 4.0), 4.0), Look(None, 3.0)),
            there=(Look((-11.0, 12.5, 4.5), 4.5),),  # the columns of the Basilica
        ),
        Leg(
            to_en_m=(0.5, -8.8),
            speed_m_s=1.4,
            on_the_way=(Look(None, 3.0), Look((2.0, 10.0, 4.0), 5.0), Look(None, 2.5), Look((14.0, 24.0, 5.0), 9.5)),
            there=(
                Look((3.0, 30.0, 5.0), 3.0),
                Look((18.0, 28.0, 6.0), 4.0),
                Look((32.0, 22.0, 5.0), 3.0),
            ),  # the Odeon
        ),
    ),
)


def follow(itinerary: Itinerary, duration_s: float, still_s: float, eye_height_m: float) -> Draft:
    """Return the walk's draft: `still_s` without movement, then leg by leg, then standing until `duration_s`.

    Args:
        itinerary: The plan.
        duration_s: The least length of the draft; a plan that takes longer is not cut short.
        still_s: How long the visitor stands before the first leg.
        eye_height_m: The rig above the ground.
    """
    rows = [*_knots(itinerary, still_s)]
    rows += [rows[-1]] * max(0, round(duration_s / KNOT_S) - len(rows))
    e_m, n_m, course_rad = (np.array([row[k] for row in rows]) for k in range(3))
    yaws_rad, rises_rad = [course_rad[0]], []
    for e, n, course, sight in rows:
        yaw, rise = (course, AHEAD_NOSE_UP_RAD) if sight is None else _direction(e, n, sight, eye_height_m)
        yaws_rad.append(nearest_turn_rad(yaw, yaws_rad[-1]))
        rises_rad.append(rise)
    yaw_rad, nose_up_rad = (slewed(np.array(a), TURN_RAD_S, KNOT_S) for a in (yaws_rad[1:], rises_rad))
    return Draft(e_m, n_m, yaw_rad, course_rad, nose_up_rad)


def planned_s(itinerary: Itinerary, still_s: float) -> float:
    """Return how long the walk takes."""
    return sum(1 for _ in _knots(itinerary, still_s)) * KNOT_S


def _knots(itinerary: Itinerary, still_s: float) -> Iterator[tuple[float, float, float, Vector3 | None]]:
    """Yield east, north, course and sight of each knot."""
    e, n = itinerary.start_en_m
    course_rad = _course_rad(itinerary.start_en_m, itinerary.legs[0].to_en_m, 0.0)
    for _ in range(round(still_s / KNOT_S)):
        yield e, n, course_rad, itinerary.first_sight_m
    for leg in itinerary.legs:
        (e0, n0), (e1, n1) = (e, n), leg.to_en_m
        course_rad = _course_rad((e0, n0), (e1, n1), course_rad)
        count = max(1, round(hypot(e1 - e0, n1 - n0) / leg.speed_m_s / KNOT_S))
        sights = [look.sight_m for look in leg.on_the_way for _ in range(round(look.duration_s / KNOT_S))]
        for k in range(count):
            e, n = e0 + (e1 - e0) * (k + 1) / count, n0 + (n1 - n0) * (k + 1) / count
            yield e, n, course_rad, sights[k] if k < len(sights) else None
        for look in leg.there:
            for _ in range(round(look.duration_s / KNOT_S)):
                yield e, n, course_rad, look.sight_m


def _course_rad(a: PointEN, b: PointEN, near_rad: float) -> float:
    return nearest_turn_rad(atan2(b[1] - a[1], b[0] - a[0]), near_rad)


def _direction(e: float, n: float, sight_m: Vector3, eye_height_m: float) -> tuple[float, float]:
    """Return yaw and nose-up angle from a place to a sight."""
    de, dn = sight_m[0] - e, sight_m[1] - n
    return atan2(dn, de), min(atan2(sight_m[2] - eye_height_m, hypot(de, dn)), HIGHEST_NOSE_UP_RAD)
