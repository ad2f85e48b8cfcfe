"""The way so far: where the rig was and how it had turned at any time of the last minute; sightings that are told late."""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.precise.stream import NAMES, S, estimator, stream, walk
from tracker.geometry import angle_between_rad, multiply, wrap_rad, wxyz_from_yaw, yaw_of
from tracker.measurements import Measurement, Outcome, Sighting, Standpoint
from tracker.precise.navigation import Navigation
from tracker.precise.way import KEPT_S, Way
from tracker.simulate import START_NS


def _nav(t_ns: int) -> Navigation:
    """A walk to the east at 1 m/s that turns by half a radian a second."""
    t_s = t_ns / S
    return Navigation(t_ns, (t_s, 0.0, 1.6), (1.0, 0.0, 0.0), wxyz_from_yaw(0.3 + 0.5 * t_s))


def _walked(seconds: float) -> Way:
    way, step_ns = Way(), 4_000_000
    for index in range(round(seconds * S / step_ns)):
        way.moved(_nav(index * step_ns), _nav((index + 1) * step_ns))
    return way


def test_between_the_places_that_are_kept_it_is_told_too() -> None:
    way = _walked(3.0)
    for t_s in (0.5, 1.2345, 2.9):
        place = way.at(round(t_s * S))
        assert place is not None
        t_ns, (x, y, z), turned = place
        assert t_ns == round(t_s * S)
        assert (x, y, z) == pytest.approx((t_s, 0.0, 0.0), abs=1e-9)
        assert angle_between_rad(turned, wxyz_from_yaw(0.5 * t_s)) < 1e-6


def test_what_is_not_known_is_not_told() -> None:
    way = _walked(3.0)
    assert way.at(-1) is None
    assert way.at(4 * S) is None
    assert Way().at(0) is None
    long = _walked(KEPT_S * 1.2 + 1.0)
    assert long.at(S // 2) is None
    assert long.at(round((KEPT_S * 0.3) * S)) is not None


def test_a_copy_goes_its_own_way() -> None:
    way = _walked(2.0)
    copy = deepcopy(way)
    way.moved(_nav(2 * S), _nav(3 * S))
    assert copy.at(round(2.5 * S)) is None
    assert copy.walked_m == pytest.approx((2.0, 0.0, 0.0))
    assert angle_between_rad(multiply(copy.turned, wxyz_from_yaw(0.5)), way.turned) < 1e-9


def _sighting(of_s: float, told_s: float, right_m: float = 2.0, far_m: float = 15.0) -> Sighting:
    t_ns = START_NS + round(of_s * S)
    to = np.array([right_m, -1.0, far_m])
    px, py, pz = (walk().T_site_cam(t_ns) @ np.array([*to, 1.0]))[:3].tolist()
    x, y, z = (to / np.linalg.norm(to)).tolist()
    return Sighting(t_ns, START_NS + round(told_s * S), (px, py, pz), (x, y, z), 0.003)


def _end(told: list[Sighting], until_s: float) -> tuple[float, float]:
    """Return how far off the heading is at last, and one sigma of it, radians."""
    silent = [m for m in stream() if not isinstance(m, Sighting | Standpoint)]
    fed: list[Measurement] = sorted([*silent, *told], key=lambda m: m.t_recv_ns)
    one, end_ns = estimator(NAMES[0]), START_NS + round(until_s * S)
    for measurement in fed:
        if measurement.t_recv_ns > end_ns:
            break
        outcome = one.step(measurement)
        if isinstance(measurement, Sighting):
            assert outcome is Outcome.USED
    pose = one.predict(end_ns)
    assert pose is not None
    R = walk().at(np.array([end_ns])).R_site_body[0]
    off = yaw_of(pose.wxyz_site_body) - float(np.arctan2(R[1, 0], R[0, 0]))
    return abs(wrap_rad(off)), float(pose.cov[5, 5]) ** 0.5


def test_a_picture_that_was_looked_at_for_long_corrects_as_one_of_just_now() -> None:
    """While the head has turned and the visitor has walked on."""
    taps = ((24.0, -12.0, 4.0), (24.5, 0.0, 25.0), (25.0, 15.0, 3.0))
    soon = _end([_sighting(at_s, at_s + 0.1, *to_m) for at_s, *to_m in taps], 38.0)
    late = _end([_sighting(at_s, at_s + 9.0, *to_m) for at_s, *to_m in taps], 38.0)
    never = _end([], 38.0)
    turned = walk().at(np.array([START_NS + 24 * S, START_NS + 33 * S])).R_site_body
    assert np.arccos((np.trace(turned[0].T @ turned[1]) - 1.0) / 2.0) > 0.2, "else nothing is to be carried"
    assert late[1] < 0.8 * never[1]
    assert late[1] < 1.6 * soon[1]
    assert late[0] < 3.0 * late[1]


def test_one_that_nobody_remembers_and_one_told_twice_are_refused() -> None:
    one, end_ns = estimator(NAMES[0]), START_NS + 40 * S
    for measurement in stream():
        if measurement.t_recv_ns < end_ns:
            one.step(measurement)
    seen = replace(_sighting(30.0, 40.0), t_recv_ns=end_ns)
    assert one.step(replace(seen, t_ns=START_NS - S)) is Outcome.REJECTED_STALE
    assert one.step(seen) is Outcome.USED
    assert one.step(seen) is Outcome.REJECTED_STALE
