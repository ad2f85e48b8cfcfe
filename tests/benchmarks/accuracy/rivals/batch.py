"""`gtsam/batch`: the whole walk in one graph, solved once it is over: the ceiling, and nothing that can be shown live."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import gtsam

from tests.benchmarks.accuracy.rivals.graph import Believed, bias_key, motion_to, start_values, whole
from tests.benchmarks.accuracy.rivals.nodes import Node, Nodes
from tests.benchmarks.accuracy.rivals.solution import State, covariances, solve, state_of
from tests.benchmarks.accuracy.rivals.track import InertialTrack
from tracker.estimator import NO_MOTION_MODEL, Origin, Pose
from tracker.geodesy import earth_rate_rad_s, gravity_m_s2
from tracker.geometry import conjugate, exp, log, multiply, normalise
from tracker.measurements import ImuSample, Matrix, Measurement, Vector3
from tracker.precise.navigation import Navigation
from tracker.precise.settings import PreciseSettings
from tracker.rig import Rig

#: The motions between nodes are integrated anew with the biases found, and the graph solved again.
ROUNDS = 2
#: Of the gyroscope's scale: its standard deviation, what is tried to either side, and the most that is believed.
TURN_SCALE, TRIED_SCALE, LARGEST_SCALE = 0.01, 0.005, 0.03


@dataclass(frozen=True)
class Solved:
    """The most likely walk."""

    nodes: list[Node]
    track: InertialTrack
    graph: gtsam.NonlinearFactorGraph
    values: gtsam.Values


def by_batch(measurements: Sequence[Measurement], origin: Origin, rig: Rig, ticks: Sequence[int]) -> list[Pose]:
    """Return the poses at ticks between the first node and the last inertial sample; none of a walk without a fix."""
    ordered = sorted(measurements, key=_measured)
    believed = Believed(
        PreciseSettings(), rig, gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m), earth_rate_rad_s(origin.lat_deg)
    )
    nodes, _ = _gathered(0.0, ordered, origin, believed)
    if not any(node.fix is not None for node in nodes):
        return []
    scale = _turn_scale(ordered, origin, believed)
    solved = solved_with(scale, ordered, origin, believed, ROUNDS)
    states = [state_of(solved.values, index, node.t_ns) for index, node in enumerate(solved.nodes)]
    covs = covariances(solved.graph, solved.values, states)
    return [*_between_nodes(states, covs, solved.track, sorted(ticks))]


def _turn_scale(measurements: Sequence[Measurement], origin: Origin, believed: Believed) -> float:
    """Return by which share the gyroscope tells too much of turns about the body's z, which is most of a walk's turning.

    GTSAM's inertial factors know no scale. The graph's error as a function of it, all else being at its best, is a parabola, whose
    lowest point three solutions tell.
    """
    low, middle, high = (
        _error(solved_with(scale, measurements, origin, believed, rounds=1)) + 0.5 * (scale / TURN_SCALE) ** 2
        for scale in (-TRIED_SCALE, 0.0, TRIED_SCALE)
    )
    curvature = low - 2.0 * middle + high
    if curvature <= 0.0:
        return 0.0
    best = 0.5 * TRIED_SCALE * (low - high) / curvature
    return min(max(best, -LARGEST_SCALE), LARGEST_SCALE)


def _error(solved: Solved) -> float:
    return float(solved.graph.error(solved.values))


def solved_with(
    scale: float, measurements: Sequence[Measurement], origin: Origin, believed: Believed, rounds: int
) -> Solved:
    """Return the most likely walk if the gyroscope's z tells too much by a share; `measurements` in order of measuring."""
    nodes, track = _gathered(scale, measurements, origin, believed)
    values = start_values(nodes, track)
    for _ in range(rounds):
        biases = [values.atConstantBias(bias_key(index)) for index in range(len(nodes))]
        motions = [motion_to(i, nodes, track, biases[i - 1], believed) for i in range(1, len(nodes))]
        graph = whole(nodes, motions, track, values, believed)
        values = solve(graph, values)
    return Solved(nodes, track, graph, values)


def _gathered(
    scale: float, measurements: Sequence[Measurement], origin: Origin, believed: Believed
) -> tuple[list[Node], InertialTrack]:
    gathered, nodes = Nodes(believed.settings, origin), list[Node]()
    for measurement in measurements:
        if isinstance(measurement, ImuSample):
            x, y, z = measurement.gyro_rad_s
            measurement = replace(measurement, gyro_rad_s=(x, y, z / (1.0 + scale)))
        nodes += gathered.add(measurement)
    return nodes, gathered.track


def _measured(measurement: Measurement) -> tuple[int, bool]:
    # what the receiver says of an instant comes before the inertial sample that closes it
    return measurement.t_ns, isinstance(measurement, ImuSample)


def _between_nodes(
    states: Sequence[State], covs: Sequence[Matrix], track: InertialTrack, ticks: Sequence[int]
) -> Iterator[Pose]:
    """Yield poses at ticks: carried on from the node before, and what is off at the node after spread over the way there."""
    for index, ((nav, _), (after, _)) in enumerate(pairwise(states)):
        wanted = ticks[bisect_left(ticks, nav.t_ns) : bisect_left(ticks, after.t_ns)]
        *carried, end = _carried(states[index], track, [*wanted, after.t_ns])
        dp, dv = _minus(after.p_m, end.p_m), _minus(after.v_m_s, end.v_m_s)
        turn = log(multiply(after.wxyz_site_body, conjugate(end.wxyz_site_body)))
        for one in carried:
            share = (one.t_ns - nav.t_ns) / (after.t_ns - nav.t_ns)
            moved = Navigation(
                one.t_ns,
                _plus(one.p_m, _times(share, dp)),
                _plus(one.v_m_s, _times(share, dv)),
                normalise(multiply(exp(_times(share, turn)), one.wxyz_site_body)),
            )
            yield _pose(moved, (1.0 - share) * covs[index] + share * covs[index + 1])
    last_ns, newest_ns = states[-1][0].t_ns, track.newest_ns or 0
    rest = ticks[bisect_left(ticks, last_ns) : bisect_right(ticks, newest_ns)]
    yield from (_pose(one, covs[-1]) for one in _carried(states[-1], track, rest))


def _carried(state: State, track: InertialTrack, times_ns: Sequence[int]) -> list[Navigation]:
    """Return the state at each of the times, which ascend."""
    nav, biases = state
    found = []
    for t_ns in times_ns:
        nav = track.carried(nav, biases, t_ns)
        found.append(nav)
    return found


def _pose(nav: Navigation, cov: Matrix) -> Pose:
    return Pose(nav.t_ns, nav.p_m, nav.wxyz_site_body, nav.v_m_s, cov, NO_MOTION_MODEL, heading_known=True)


def _plus(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def _minus(a: Vector3, b: Vector3) -> Vector3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _times(factor: float, v: Vector3) -> Vector3:
    return (factor * v[0], factor * v[1], factor * v[2])
