"""Covariances of nodes against GTSAM's own, where those can be had."""

import gtsam
import numpy as np
import pytest

from tests.benchmarks.accuracy.rivals import graph as walk
from tests.benchmarks.accuracy.rivals.nodes import Node, Nodes
from tests.benchmarks.accuracy.rivals.solution import covariance_of, covariances, solve, state_of
from tracker.geodesy import earth_rate_rad_s, gravity_m_s2
from tracker.precise.settings import PreciseSettings
from tracker.simulate import Walk, WalkSettings, default_rig, simulate


def test_covariances_are_gtsams_turned_to_site() -> None:
    settings = PreciseSettings()
    whole = Walk(WalkSettings(seed=5, duration_s=15.0, still_s=1.0, imu_hz=50.0), default_rig())
    origin = whole.settings.origin
    gathered, nodes = Nodes(settings, origin), list[Node]()
    for measurement in simulate(whole):
        nodes += gathered.add(measurement)
    believed = walk.Believed(
        settings, whole.rig, gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m), earth_rate_rad_s(origin.lat_deg)
    )
    no_bias = gtsam.imuBias.ConstantBias()
    motions = [walk.motion_to(i, nodes, gathered.track, no_bias, believed) for i in range(1, len(nodes))]
    values = walk.start_values(nodes, gathered.track)
    graph = walk.whole(nodes, motions, gathered.track, values, believed)
    values = solve(graph, values)
    states = [state_of(values, index, node.t_ns) for index, node in enumerate(nodes)]
    found = covariances(graph, values, states)
    for index in (0, 7, len(nodes) - 1):
        key = walk.pose_key(index)
        ordering = gtsam.Ordering.ColamdConstrainedLastNonlinearFactorGraph(graph, [key])
        net = graph.linearize(values).eliminateSequential(ordering)
        assert net is not None
        R = net.at(net.size() - 1).R()
        by_gtsam = np.linalg.inv(R.T @ R)
        turn = values.atPose3(key).rotation().matrix()
        assert turn @ by_gtsam[3:, 3:] @ turn.T == pytest.approx(found[index][:3, :3], rel=1e-3, abs=1e-6)
        assert turn @ by_gtsam[:3, :3] @ turn.T == pytest.approx(found[index][3:, 3:], rel=1e-3, abs=1e-8)
        assert covariance_of(graph, values, index) == pytest.approx(found[index], rel=1e-3, abs=1e-6)
