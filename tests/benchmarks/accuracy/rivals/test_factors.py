"""The receiver's factors: derivatives against numeric ones, what pulls, and what of the receiver's error is left over time."""

import gtsam
import numpy as np
import pytest

from tests.benchmarks.accuracy.rivals.factors import error_start, error_transition, gps_position, gps_velocity
from tracker.measurements import Matrix, Vector3
from tracker.precise.settings import PreciseSettings

POSE, VELOCITY, ERROR, LATER = 1, 2, 3, 4
LEVER_M = np.array([-0.3, 0.1, 0.4])
TURNING_M_S = np.array([0.2, -0.4, 0.1])
SIGMA_M: Vector3 = (2.0, 3.0, 5.0)


def values() -> gtsam.Values:
    """Return a pose, a velocity, and the receiver's error at two times."""
    rng, found = np.random.default_rng(3), gtsam.Values()
    found.insert(POSE, gtsam.Pose3(gtsam.Rot3.RzRyRx(0.3, -0.5, 2.0), np.array([4.0, -2.0, 1.0])))
    found.insert(VELOCITY, np.array([1.0, 0.4, -0.1]))
    found.insert(ERROR, rng.normal(0.0, 0.5, 9))
    found.insert(LATER, rng.normal(0.0, 0.5, 9))
    return found


def antenna_m(at: gtsam.Values) -> Matrix:
    """Return where the receiver must say the antenna is."""
    pose, error = at.atPose3(POSE), at.atVector(ERROR)
    return np.asarray(pose.transformFrom(LEVER_M) + np.array(SIGMA_M) * (error[0:3] + error[3:6] + error[6:9]))


def antenna_m_s(at: gtsam.Values) -> Matrix:
    """Return what velocity the receiver must tell."""
    return np.asarray(at.atVector(VELOCITY) + at.atPose3(POSE).rotation().rotate(TURNING_M_S))


def position_factor(p_m: Matrix) -> gtsam.NonlinearFactor:
    x, y, z = p_m.tolist()
    return gps_position(POSE, ERROR, (x, y, z), SIGMA_M, 0.06 * np.square(SIGMA_M), LEVER_M)


def velocity_factor(v_m_s: Matrix) -> gtsam.NonlinearFactor:
    x, y, z = v_m_s.tolist()
    return gps_velocity(POSE, VELOCITY, (x, y, z), np.array([0.1, 0.1, 0.2]), TURNING_M_S)


def weighted(factor: gtsam.NonlinearFactor, at: gtsam.Values) -> Matrix:
    """Return the factor's residual as it pulls."""
    _, b = factor.linearize(at).jacobian()
    return np.asarray(-b, float)


def numeric(factor: gtsam.NonlinearFactor, at: gtsam.Values) -> Matrix:
    """Return the derivatives by the factor's variables, one column after another."""
    columns = []
    for key in [*factor.keys()]:
        for axis in range(len(at.zeroVectors().at(key))):
            sides = []
            for step in (1e-6, -1e-6):
                delta, moved = at.zeroVectors(), np.zeros(len(at.zeroVectors().at(key)))
                moved[axis] = step
                part = gtsam.VectorValues()
                part.insert(key, moved)
                delta.update(part)
                sides.append(weighted(factor, at.retract(delta)))
            columns.append((sides[0] - sides[1]) / 2e-6)
    return np.array(columns).T


@pytest.mark.parametrize("which", ["position", "velocity"])
def test_derivatives(which: str) -> None:
    at = values()
    factor = position_factor(antenna_m(at)) if which == "position" else velocity_factor(antenna_m_s(at))
    A, b = factor.linearize(at).jacobian()
    assert b == pytest.approx(0.0, abs=1e-9)
    assert pytest.approx(numeric(factor, at), abs=1e-4) == A


def test_a_spike_of_the_receiver_hardly_pulls() -> None:
    at = values()
    ordinary, spike = (
        np.abs(weighted(velocity_factor(antenna_m_s(at) + off * np.eye(3)[0]), at)).max() for off in (0.1, 5.0)
    )
    assert ordinary == pytest.approx(1.0, abs=0.1)
    assert spike < 5.0


def test_the_receivers_error_keeps_its_variance_and_forgets_by_its_times() -> None:
    settings = PreciseSettings()
    graph, at = gtsam.NonlinearFactorGraph(), values()
    graph.push_back(error_start(ERROR, settings))
    graph.push_back(error_transition(ERROR, LATER, 60.0, np.ones(3), settings))
    joint = gtsam.Marginals(graph, at).jointMarginalCovariance([ERROR, LATER])
    share = np.repeat(settings.gps_error_share, 3)
    assert np.diag(joint.at(LATER, LATER)) == pytest.approx(share)
    assert np.diag(joint.at(ERROR, LATER)) == pytest.approx(share * np.exp(-60.0 / np.repeat(settings.gps_error_s, 3)))


def test_in_metres_what_lasts_of_the_receivers_error_is_the_same_whatever_it_claims() -> None:
    settings, by = PreciseSettings(), np.tile([0.5, 2.0, 1.0], 3)
    graph, at = gtsam.NonlinearFactorGraph(), values()
    graph.push_back(error_start(ERROR, settings))
    graph.push_back(error_transition(ERROR, LATER, 60.0, by[:3], settings))
    joint = gtsam.Marginals(graph, at).jointMarginalCovariance([ERROR, LATER])
    share, kept = np.repeat(settings.gps_error_share, 3), np.exp(-60.0 / np.repeat(settings.gps_error_s, 3))
    assert np.diag(joint.at(ERROR, LATER)) == pytest.approx(share * kept * by)
    assert np.diag(joint.at(LATER, LATER)) == pytest.approx(share * ((kept * by) ** 2 + 1.0 - kept**2))
