"""Walks by plan: where they lead, when, and what is looked at."""

from itertools import pairwise
from math import atan2, hypot, pi, radians

import numpy as np
import pytest

from tracker.choreography import AGORA_TOUR, KNOT_S
from tracker.itinerary import AGORA_DEMO, TURN_RAD_S, Itinerary, Leg, Look, follow, planned_s
from tracker.measurements import Matrix
from tracker.simulate import DEMO_WALK, START_NS, Walk, WalkSettings, default_rig, simulate

NORTH, EAST = (0.0, 100.0, 1.65), (100.0, 0.0, 1.65)
PLAN = Itinerary((0.0, 0.0), NORTH, (Leg((10.0, 0.0), 1.0, (Look(NORTH, 4.0),), (Look((10.0, 20.0, 1.65), 3.0),)),))
STILL_S = 4.0


def at(values: Matrix, t_s: float) -> float:
    return float(values[round(t_s / KNOT_S)])


def test_a_plan_is_walked_and_looked_at_as_it_says() -> None:
    """North at rest and for four seconds of the way, then ahead, then at the sight beside its end."""
    draft = follow(PLAN, 0.0, STILL_S, 1.65)
    assert planned_s(PLAN, STILL_S) == pytest.approx(len(draft.e_m) * KNOT_S) == pytest.approx(17.0)
    assert np.ptp(draft.e_m[:40]) == np.ptp(draft.yaw_rad[:40]) == np.ptp(draft.nose_up_rad[:40]) == 0.0
    assert at(draft.yaw_rad, 2.0) == pytest.approx(pi / 2)
    assert at(draft.yaw_rad, 7.0) == pytest.approx(atan2(98.35, -3.1), abs=0.03)
    assert at(draft.yaw_rad, 12.0) == pytest.approx(0.0, abs=1e-9)
    assert at(draft.e_m, 9.0) == pytest.approx(5.1)
    assert (draft.e_m[-1], draft.n_m[-1]) == pytest.approx((10.0, 0.0))
    assert draft.yaw_rad[-1] == pytest.approx(pi / 2)
    assert not draft.course_rad.any()


def test_a_head_turns_no_faster_than_at_leisure_and_the_short_way() -> None:
    behind = Itinerary((0.0, 0.0), (-100.0, 1.0, 1.65), (Leg((1.0, 0.0), 1.0, (), (Look((-100.0, -9.0, 1.65), 4.0),)),))
    yaw_rad = follow(behind, 0.0, 2.0, 1.65).yaw_rad
    assert np.abs(np.diff(yaw_rad)).max() <= TURN_RAD_S * KNOT_S + 1e-9
    assert np.ptp(yaw_rad) < 2.0 * pi


def test_a_walk_stands_at_its_end_when_it_is_to_last_longer() -> None:
    draft = follow(PLAN, 30.0, STILL_S, 1.65)
    assert len(draft.e_m) == 300
    assert np.ptp(draft.e_m[-130:]) == 0.0


def test_the_demo_lasts_75_to_90_seconds_and_walks_like_a_visitor() -> None:
    assert 75.0 <= DEMO_WALK.duration_s <= 90.0
    walk = Walk(DEMO_WALK, default_rig())
    stamps = walk.stamps(10.0)
    motion = walk.at(stamps)
    speed = np.hypot(motion.v_m_s[:, 0], motion.v_m_s[:, 1])
    assert not speed[stamps - START_NS < 7e9].any()
    assert 1.0 < np.median(speed[speed > 0.5]) < 1.4
    assert speed.max() < 1.5
    stands = speed < 0.1
    assert 0.25 < stands.mean() < 0.5
    assert np.count_nonzero(np.diff(stands.astype(int)) == 1) == 3  # stops after the first rest


@pytest.mark.parametrize(
    ("name", "east_m", "north_m", "near_m", "least_s"),
    [
        ("temple", -63.2, -11.9, 18.0, 5.0),
        ("Prytaneion", -46.0, 41.0, 42.0, 4.0),
        ("Basilica", -8.0, 14.0, 30.0, 4.0),
        ("Odeon", 17.9, 27.0, 41.0, 6.0),
    ],
)
def test_the_demo_passes_and_looks_at(name: str, east_m: float, north_m: float, near_m: float, least_s: float) -> None:
    """Each is within the middle two thirds of the picture for so long while the visitor is that near."""
    walk = Walk(DEMO_WALK, default_rig())
    motion = walk.at(walk.stamps(10.0))
    away = np.array([east_m, north_m]) - motion.p_m[:, :2]
    ahead = motion.R_site_body[:, :2, 0]
    off_rad = np.abs(np.arctan2(ahead[:, 0] * away[:, 1] - ahead[:, 1] * away[:, 0], (ahead * away).sum(axis=1)))
    seen = (off_rad < radians(20.0)) & (np.linalg.norm(away, axis=1) < near_m)
    assert seen.sum() / 10.0 >= least_s, name


def test_the_demo_keeps_to_the_ways_of_the_tour() -> None:
    """Within half a metre of the ring, or inside the open loop: nothing stands there."""
    points = np.array([AGORA_DEMO.start_en_m, *(leg.to_en_m for leg in AGORA_DEMO.legs)])
    walked = np.concatenate([a + np.linspace(0.0, 1.0, 50)[:, None] * (b - a) for a, b in pairwise(points)])
    ring = np.array([*AGORA_TOUR.ring_en_m, AGORA_TOUR.ring_en_m[0]])
    a, legs = ring[:-1], np.diff(ring, axis=0)
    share = np.clip(((walked[:, None] - a) * legs).sum(axis=2) / (legs**2).sum(axis=1), 0.0, 1.0)
    off_m = np.linalg.norm(walked[:, None] - a - share[..., None] * legs, axis=2).min(axis=1)
    loop = np.array([*AGORA_TOUR.loop_en_m, AGORA_TOUR.loop_en_m[0]])
    away = walked[:, None] - loop[:-1]
    sides = np.diff(loop, axis=0)
    turns = sides[:, 0] * away[..., 1] - sides[:, 1] * away[..., 0]
    inside = (turns >= -0.5 * np.linalg.norm(sides, axis=1)).all(axis=1)
    assert (inside | (off_m < 0.5)).all()


def test_the_same_plan_is_the_same_walk_and_another_seed_only_another_noise() -> None:
    short = WalkSettings(duration_s=3.0, itinerary=PLAN, still_s=1.0)
    assert list(simulate(Walk(short, default_rig()))) == list(simulate(Walk(short, default_rig())))
    other = Walk(WalkSettings(seed=9, duration_s=3.0, itinerary=PLAN, still_s=1.0), default_rig())
    stamps = other.stamps(10.0)
    np.testing.assert_array_equal(other.at(stamps).p_m, Walk(short, default_rig()).at(stamps).p_m)
    assert hypot(*other.at(stamps).v_m_s[-1, :2]) > 0.5
