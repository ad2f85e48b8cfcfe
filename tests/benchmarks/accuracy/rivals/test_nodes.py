"""Where the graph has nodes, and what of the inertial samples lies between."""

import numpy as np
import pytest

from tests.benchmarks.accuracy.rivals.nodes import Node, Nodes
from tests.benchmarks.accuracy.rivals.track import InertialTrack
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Measurement
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings
from tracker.simulate import AGORA_ORIGIN

G = 9.8
LATE_NS = 200_000_000


def imu(t_s: float, gyro_z: float = 0.0, accel_x: float = 0.0) -> ImuSample:
    t_ns = round(t_s * 1e9)
    return ImuSample(t_ns, t_ns, (0.0, 0.0, gyro_z), (accel_x, 0.0, G))


def gps(t_s: float) -> list[Measurement]:
    t_ns = round(t_s * 1e9)
    lat, lon, h = AGORA_ORIGIN.lat_deg, AGORA_ORIGIN.lon_deg, AGORA_ORIGIN.h_ellipsoid_m
    cov = (4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0)
    return [GpsFix(t_ns, t_ns + LATE_NS, lat, lon, h, cov), GpsVelocity(t_ns, t_ns + LATE_NS, (1.0, 0.0, 0.0))]


def nodes_of(seconds: float, fixes_s: list[float]) -> list[Node]:
    """Return the nodes of an inertial sensor of 100 Hz and fixes that come late."""
    arriving: list[Measurement] = [imu(0.01 * k) for k in range(round(100 * seconds))]
    arriving += [one for t_s in fixes_s for one in gps(t_s)]
    gathered = Nodes(PreciseSettings(), AGORA_ORIGIN)
    return [node for one in sorted(arriving, key=lambda m: m.t_recv_ns) for node in gathered.add(one)]


def stamps_s(nodes: list[Node]) -> list[float]:
    return [node.t_ns * 1e-9 for node in nodes]


def test_a_node_at_every_fix_with_what_the_receiver_said() -> None:
    nodes = nodes_of(4.0, [1.0, 2.0, 3.0])
    assert stamps_s(nodes) == pytest.approx([0.5, 1.0, 2.0, 3.0])
    assert [node.fix is not None and node.v_site_m_s == (1.0, 0.0, 0.0) for node in nodes] == [False, True, True, True]


def test_the_stated_variance_is_taken_larger() -> None:
    fix = nodes_of(4.0, [1.0])[1].fix
    assert fix is not None
    inflation = PreciseSettings().gps_inflation
    assert np.square(fix.sigma_m) == pytest.approx([4.0 * inflation, 4.0 * inflation, 9.0 * inflation])
    assert fix.p_site_m == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_where_the_receiver_is_silent_there_is_a_node_every_second() -> None:
    nodes = nodes_of(6.0, [1.0, 4.3])
    assert stamps_s(nodes) == pytest.approx([0.5, 1.0, 2.0, 3.0, 4.3, 5.3])
    assert [node.fix is not None for node in nodes] == [False, True, False, False, True, False]


def test_a_fast_receiver_is_thinned() -> None:
    times = np.diff(stamps_s(nodes_of(6.0, [1.0 + 0.1 * k for k in range(40)])))
    assert times[1:] == pytest.approx(0.5)


def track(gyro_z: float, accel_x: float) -> InertialTrack:
    found = InertialTrack(G)
    for k in range(301):
        assert found.add(imu(0.01 * k, gyro_z, accel_x))
    return found


def test_steps_reach_from_one_time_to_the_other_and_no_further() -> None:
    steps = [*track(0.0, 0.0).steps(1_003_000_000, 1_045_000_000)]
    assert [step.t_ns for step in steps] == [1_010_000_000, 1_020_000_000, 1_030_000_000, 1_040_000_000, 1_045_000_000]


def test_a_state_is_carried_on_by_what_was_felt() -> None:
    start = Navigation(500_000_000, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    end = track(0.0, 0.4).carried(start, Biases(accel_m_s2=(0.1, 0.0, 0.0)), 2_505_000_000)
    assert end.v_m_s == pytest.approx((1.0 + 0.3 * 2.005, 0.0, 0.0))
    assert end.p_m == pytest.approx((2.005 + 0.15 * 2.005**2, 0.0, 0.0))


def test_a_second_sample_of_one_stamp_is_refused() -> None:
    found = track(0.0, 0.0)
    assert not found.add(imu(3.0))
    assert not found.add(imu(2.0))


def test_a_rig_that_lies_still_stands_and_tells_its_offset() -> None:
    stands, rate = track(0.001, 0.0).standing(2_000_000_000)
    assert stands
    assert rate == pytest.approx((0.0, 0.0, 0.001))
    assert track(1.0, 0.0).standing(2_000_000_000)[1] is None
