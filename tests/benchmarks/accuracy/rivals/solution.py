"""Solving a graph, and its values as the tracker's own types."""

from collections.abc import Sequence
from typing import TypeAlias

import gtsam
import numpy as np

from tests.benchmarks.accuracy.rivals.graph import bias_key, keys, pose_key, velocity_key
from tracker.geometry import matrix_from_wxyz, wxyz_from_matrix
from tracker.measurements import Matrix, Vector3
from tracker.precise.navigation import Biases, Navigation

MOST_ITERATIONS = 60
#: A node's variables in the order of `keys`: pose, velocity, biases, the receiver's error.
_PARTS, _SIZE = (slice(0, 6), slice(6, 9), slice(9, 15), slice(15, 24)), 24

State: TypeAlias = tuple[Navigation, Biases]


def solve(graph: gtsam.NonlinearFactorGraph, values: gtsam.Values) -> gtsam.Values:
    """Return the most likely values, by Levenberg and Marquardt from those given."""
    params = gtsam.LevenbergMarquardtParams()
    params.setMaxIterations(MOST_ITERATIONS)
    params.setRelativeErrorTol(1e-6)
    params.setLinearSolverType("SEQUENTIAL_CHOLESKY")
    return gtsam.LevenbergMarquardtOptimizer(graph, values, params).optimize()


def state_of(values: gtsam.Values, index: int, t_ns: int) -> State:
    """Return a node's state."""
    pose, bias = values.atPose3(pose_key(index)), values.atConstantBias(bias_key(index))
    nav = Navigation(
        t_ns,
        _vector(pose.translation()),
        _vector(values.atVector(velocity_key(index))),
        wxyz_from_matrix(pose.rotation().matrix()),
    )
    return nav, Biases(_vector(bias.gyroscope()), _vector(bias.accelerometer()))


def covariances(graph: gtsam.NonlinearFactorGraph, values: gtsam.Values, states: Sequence[State]) -> list[Matrix]:
    """Return (6, 6) of position and rotation in site of every node of a graph whose factors join neighbours at most.

    The information matrix is then one block after another along its diagonal, with one beside each, and what all before and all
    after say of a node is eliminated towards it. GTSAM's own `Marginals` eliminates several variables at once, and takes them for
    undetermined where one is known ten thousand times better than another, as a bias and a heading are in the first seconds.
    """
    own, beside = _information(graph.linearize(values), len(states))
    before, after = [own[0]], [own[-1]]
    for index in range(1, len(states)):
        before.append(own[index] - beside[index - 1].T @ np.linalg.solve(before[-1], beside[index - 1]))
    for index in range(len(states) - 2, -1, -1):
        after.append(own[index] - beside[index] @ np.linalg.solve(after[-1], beside[index].T))
    return [
        _in_site(np.linalg.inv(b + a - o)[:6, :6], state)
        for o, b, a, state in zip(own, before, reversed(after), states, strict=True)
    ]


def _information(linear: gtsam.GaussianFactorGraph, count: int) -> tuple[Matrix, Matrix]:
    """Return the information of each node, (n, 24, 24), and between it and the next, (n - 1, 24, 24)."""
    place = {key: (i, part) for i in range(count) for key, part in zip(keys(i), _PARTS, strict=True)}
    own, beside = np.zeros((count, _SIZE, _SIZE)), np.zeros((count - 1, _SIZE, _SIZE))
    for number in range(linear.size()):
        factor = linear.at(number)
        A, _ = factor.jacobian()
        parts, begin = [], 0
        for key in [*factor.keys()]:
            index, part = place[key]
            parts.append((index, part, A[:, begin : begin + part.stop - part.start]))
            begin += part.stop - part.start
        for i, row, left in parts:
            for j, column, right in parts:
                if i == j:
                    own[i, row, column] += left.T @ right
                elif j == i + 1:
                    beside[i, row, column] += left.T @ right
    return own, beside


def covariance_of(graph: gtsam.NonlinearFactorGraph, values: gtsam.Values, index: int) -> Matrix:
    """Return (6, 6) of position and rotation in site of one node: variables are eliminated one by one, its pose last."""
    ordering = gtsam.Ordering.ColamdConstrainedLastNonlinearFactorGraph(graph, [pose_key(index)])
    net = graph.linearize(values).eliminateSequential(ordering)
    assert net is not None
    R = net.at(net.size() - 1).R()
    return _in_site(np.asarray(np.linalg.inv(R.T @ R), float), state_of(values, index, 0))


def _in_site(cov: Matrix, state: State) -> Matrix:
    """Return (6, 6) of position and rotation in site, from GTSAM's of rotation and translation in the body's axes."""
    J = np.zeros((6, 6))
    J[:3, 3:] = J[3:, :3] = matrix_from_wxyz(state[0].wxyz_site_body)
    return np.asarray(J @ cov @ J.T, float)


def _vector(values: Matrix) -> Vector3:
    x, y, z = values.tolist()
    return (x, y, z)
