"""Solving a graph, and its values as the tracker's own types."""

from typing import TypeAlias

import gtsam
import numpy as np

from tests.benchmarks.accuracy.rivals.graph import bias_key, pose_key, velocity_key
from tracker.geometry import matrix_from_wxyz, wxyz_from_matrix
from tracker.measurements import Matrix, Vector3
from tracker.precise.navigation import Biases, Navigation

MOST_ITERATIONS = 60

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


def covariance_of(graph: gtsam.NonlinearFactorGraph, values: gtsam.Values, index: int) -> Matrix:
    """Return (6, 6) of position and rotation in site of one node.

    One variable is eliminated after another, the node's pose last. GTSAM's `Marginals` eliminates several at once, and takes them
    for undetermined where one is known ten thousand times better than another, as bias and heading are in the first seconds.
    """
    ordering = gtsam.Ordering.ColamdConstrainedLastNonlinearFactorGraph(graph, [pose_key(index)])
    net = graph.linearize(values).eliminateSequential(ordering)
    assert net is not None
    R = net.at(net.size() - 1).R()
    return in_site(np.asarray(np.linalg.inv(R.T @ R), float), state_of(values, index, 0))


def in_site(cov: Matrix, state: State) -> Matrix:
    """Return (6, 6) of position and rotation in site, from GTSAM's of rotation and translation in the body's axes."""
    J = np.zeros((6, 6))
    J[:3, 3:] = J[3:, :3] = matrix_from_wxyz(state[0].wxyz_site_body)
    return np.asarray(J @ cov @ J.T, float)


def _vector(values: Matrix) -> Vector3:
    x, y, z = values.tolist()
    return (x, y, z)
