"""`gtsam/fixed-lag`: the same graph, live: a node at every fix, the last ten seconds solved anew, the inertial samples on to now.

Until motion has told north the graph of the whole walk so far is solved at every fix; what is marginalised with a wrong heading
would stay wrong.
"""

from collections.abc import Sequence
from typing import SupportsFloat, SupportsIndex, SupportsInt

import gtsam

from tests.benchmarks.accuracy.rivals import graph as walk
from tests.benchmarks.accuracy.rivals.nodes import Node, Nodes
from tests.benchmarks.accuracy.rivals.online import follow
from tests.benchmarks.accuracy.rivals.solution import State, covariance_of, solve, state_of
from tracker.estimator import NO_MOTION_MODEL, Origin, Pose
from tracker.geodesy import earth_rate_rad_s, gravity_m_s2
from tracker.measurements import Matrix, Measurement
from tracker.precise.settings import PreciseSettings
from tracker.rig import Rig

LAG_S = 10.0
#: North is told when its standard deviation is below this, rad; a walk of more nodes than this goes on without.
TOLD_RAD, MOST_NODES = 0.1, 120
#: So many nodes are solved all together at every new one, twice as many at every second one, and so on.
OFTEN = 30


class FixedLag:
    """The smoother, its newest node, and that node's state carried on."""

    def __init__(self, origin: Origin, rig: Rig) -> None:
        self._settings = PreciseSettings()
        self._gathered = Nodes(self._settings, origin)
        gravity = gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m)
        self._believed = walk.Believed(self._settings, rig, gravity, earth_rate_rad_s(origin.lat_deg))
        self._nodes: list[Node] = []
        self._has_fix = False
        self._motions: list[gtsam.PreintegratedCombinedMeasurements] = []
        """Between the nodes, without biases; only until north is told."""
        self._smoother: gtsam.IncrementalFixedLagSmoother | None = None
        self._values = gtsam.Values()
        """Of the newest node at least."""
        self._state: State | None = None
        """The newest node's, carried on to the newest inertial sample."""
        self._cov: Matrix | None = None

    def add(self, measurement: Measurement) -> None:
        """Take the next measurement to arrive."""
        for node in self._gathered.add(measurement):
            self._nodes.append(node)
            self._has_fix |= node.fix is not None
            if self._smoother is not None:
                self._extend(self._smoother)
            elif self._has_fix and len(self._nodes) % (1 + len(self._nodes) // OFTEN) == 0:
                self._solve_all()
        newest_ns = self._gathered.track.newest_ns
        if self._state is not None and newest_ns is not None:
            nav, biases = self._state
            self._state = self._gathered.track.carried(nav, biases, newest_ns), biases

    def pose(self, t_ns: int) -> Pose | None:
        """Return the pose at a time, which is now; None before the first fix."""
        if self._state is None or self._cov is None:
            return None
        nav = self._gathered.track.carried(*self._state, t_ns)
        told = self._smoother is not None
        return Pose(t_ns, nav.p_m, nav.wxyz_site_body, nav.v_m_s, self._cov, NO_MOTION_MODEL, told)

    def _solve_all(self) -> None:
        nodes, track, believed = self._nodes, self._gathered.track, self._believed
        no_bias = gtsam.imuBias.ConstantBias()
        for index in range(len(self._motions) + 1, len(nodes)):
            self._motions.append(walk.motion_to(index, nodes, track, no_bias, believed))
        values = walk.start_values(nodes, track)
        graph = walk.whole(nodes, self._motions, track, values, believed)
        self._values = solve(graph, values)
        self._show(graph, self._values)
        assert self._cov is not None
        if self._cov[5, 5] > TOLD_RAD**2 and len(nodes) < MOST_NODES:
            return
        # once more with the biases that were found: what the smoother forgets it cannot integrate again
        biases = [self._values.atConstantBias(walk.bias_key(index)) for index in range(len(nodes))]
        motions = [walk.motion_to(i, nodes, track, biases[i - 1], believed) for i in range(1, len(nodes))]
        graph = walk.whole(nodes, motions, track, self._values, believed)
        self._smoother = _smoother()
        self._smoother.update(graph, self._values, self._stamps(range(len(nodes))))
        self._values = self._smoother.calculateEstimate()

    def _extend(self, smoother: gtsam.IncrementalFixedLagSmoother) -> None:
        index, track, old = len(self._nodes) - 1, self._gathered.track, self._values
        before, node = self._nodes[-2:]
        bias = old.atConstantBias(walk.bias_key(index - 1))
        motion = walk.motion_to(index, self._nodes, track, bias, self._believed)
        graph = gtsam.NonlinearFactorGraph()
        for factor in walk.motion_factors(index, before, node, motion, self._believed):
            graph.push_back(factor)
        for factor in walk.node_factors(index, node, track, bias, self._believed):
            graph.push_back(factor)
        smoother.update(graph, walk.next_values(index, old, motion), self._stamps([index]))
        smoother.update()  # what moved far is linearised again
        self._values = smoother.calculateEstimate()
        self._show(smoother.getFactors(), self._values)

    def _stamps(self, indices: Sequence[int]) -> dict[SupportsInt | SupportsIndex, SupportsFloat | SupportsIndex]:
        begin_ns = self._nodes[0].t_ns
        return {key: (self._nodes[i].t_ns - begin_ns) * 1e-9 for i in indices for key in walk.keys(i)}

    def _show(self, graph: gtsam.NonlinearFactorGraph, values: gtsam.Values) -> None:
        index = len(self._nodes) - 1
        self._state = state_of(values, index, self._nodes[index].t_ns)
        self._cov = covariance_of(graph, values, index)


def _smoother() -> gtsam.IncrementalFixedLagSmoother:
    params = gtsam.ISAM2Params()
    params.setFactorization("QR")  # Cholesky refuses what is known ill beside what is known well (see `covariances`)
    params.setRelinearizeThreshold(0.01)
    params.relinearizeSkip = 1
    return gtsam.IncrementalFixedLagSmoother(LAG_S, params)


def by_fixed_lag(measurements: Sequence[Measurement], origin: Origin, rig: Rig, ticks: Sequence[int]) -> list[Pose]:
    """Return the poses at ticks from the first fix on."""
    return follow(FixedLag(origin, rig), measurements, ticks)
