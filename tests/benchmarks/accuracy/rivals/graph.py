"""The factor graph of a walk: a pose, velocity, biases and the receiver's error at every node, the inertial samples between."""

from cmath import phase
from collections.abc import Sequence
from dataclasses import dataclass

import gtsam
import numpy as np

from tests.benchmarks.accuracy.rivals import factors
from tests.benchmarks.accuracy.rivals.alignment import Alignment
from tests.benchmarks.accuracy.rivals.nodes import Node
from tests.benchmarks.accuracy.rivals.track import InertialTrack
from tracker.geometry import multiply, normalise, wxyz_from_yaw
from tracker.measurements import ImuSample, Matrix, Vector3
from tracker.precise.settings import PreciseSettings
from tracker.rig import Rig

#: Of the first node, of whose pose no more is known than that a fix is not far: metres, metres a second, and rad about each axis.
UNKNOWN_M, UNKNOWN_M_S, UNKNOWN_RAD = 100.0, 3.0, 3.0
#: Where the receiver is silent: people walk no faster than about this, and hardly up or down.
WALK_M_S = (1.2, 1.2, 0.3)
#: Errors of scale and axes as shares of what was felt; smaller than those of `PreciseSettings`, as is best on simulated walks: here
#: one error holds for a second of samples, there each 20 ms have their own.
GYRO_SCALE, ACCEL_SCALE = 0.003, 0.0025
#: Of the integration itself.
INTEGRATION_M2_S = 1e-8
#: Of accelerometer biases, m/s2, in a factor that says nothing of them.
UNSAID_M_S2 = 1e3


def pose_key(index: int) -> int:
    """Return the key of a node's pose."""
    return int(gtsam.symbol("x", index))


def velocity_key(index: int) -> int:
    """Return the key of a node's velocity."""
    return int(gtsam.symbol("v", index))


def bias_key(index: int) -> int:
    """Return the key of a node's biases."""
    return int(gtsam.symbol("b", index))


def error_key(index: int) -> int:
    """Return the key of the receiver's error at a node."""
    return int(gtsam.symbol("e", index))


def keys(index: int) -> list[int]:
    """Return all keys of a node."""
    return [pose_key(index), velocity_key(index), bias_key(index), error_key(index)]


@dataclass(frozen=True)
class Believed:
    """What the graph takes for granted."""

    settings: PreciseSettings
    rig: Rig
    gravity_m_s2: float
    earth_rad_s: Vector3

    @property
    def lever_body_m(self) -> Matrix:
        """(3,) the antenna on the body."""
        return np.asarray(self.rig.T_body_gps[:3, 3], float)


def preintegrated(
    steps: Sequence[ImuSample], begin_ns: int, bias: gtsam.imuBias.ConstantBias, believed: Believed
) -> gtsam.PreintegratedCombinedMeasurements:
    """Return the motion that inertial samples felt between two nodes.

    Errors of scale and axes grow with what is felt, and always the same way: they add to the white noise of the interval.
    """
    settings = believed.settings
    gyro = np.array([step.gyro_rad_s for step in steps])
    accel = np.array([step.accel_m_s2 for step in steps])
    dt_s = np.diff([begin_ns, *(step.t_ns for step in steps)]) * 1e-9
    span_s = float(dt_s.sum())
    turned_rad = float(np.linalg.norm(dt_s @ (gyro - bias.gyroscope())))
    swing = accel - accel.mean(axis=0)
    shaken_m_s = float(np.abs(np.cumsum(dt_s[:, None] * swing, axis=0)).max())
    params = gtsam.PreintegrationCombinedParams.MakeSharedU(believed.gravity_m_s2)
    unit = np.eye(3)
    params.setGyroscopeCovariance(
        (settings.gyro_noise_rad_s_sqrt_hz**2 + (GYRO_SCALE * turned_rad) ** 2 / span_s) * unit
    )
    params.setAccelerometerCovariance(
        (settings.accel_noise_m_s2_sqrt_hz**2 + (ACCEL_SCALE * shaken_m_s) ** 2 / span_s) * unit
    )
    params.setOmegaCoriolis(np.array(believed.earth_rad_s))
    params.setIntegrationCovariance(INTEGRATION_M2_S * unit)
    params.setBiasOmegaCovariance(settings.gyro_bias_walk_rad_s2_sqrt_hz**2 * unit)
    params.setBiasAccCovariance(settings.accel_bias_walk_m_s3_sqrt_hz**2 * unit)
    motion = gtsam.PreintegratedCombinedMeasurements(params, bias)
    for w, f, step_s in zip(gyro, accel, dt_s.tolist(), strict=True):
        motion.integrateMeasurement(f, w, step_s)
    return motion


def start_factors(index: int, pose: gtsam.Pose3, believed: Believed) -> list[gtsam.NonlinearFactor]:
    """Return what is known of a first node, which is next to nothing."""
    settings, diagonal = believed.settings, gtsam.noiseModel.Diagonal.Sigmas
    biases = np.repeat([settings.accel_bias_m_s2, settings.gyro_bias_rad_s], 3)
    return [
        gtsam.PriorFactorPose3(pose_key(index), pose, diagonal(np.repeat([UNKNOWN_RAD, UNKNOWN_M], 3))),
        gtsam.PriorFactorVector(velocity_key(index), np.zeros(3), diagonal(np.full(3, UNKNOWN_M_S))),
        gtsam.PriorFactorConstantBias(bias_key(index), gtsam.imuBias.ConstantBias(), diagonal(biases)),
        factors.error_start(error_key(index), settings),
    ]


def motion_factors(
    index: int, last: Node, node: Node, motion: gtsam.PreintegratedCombinedMeasurements, believed: Believed
) -> list[gtsam.NonlinearFactor]:
    """Return what connects a node with the last one, before it."""
    before, after = keys(index - 1), keys(index)
    by = np.ones(3) if last.sigma_m is None or node.sigma_m is None else np.divide(last.sigma_m, node.sigma_m)
    return [
        gtsam.CombinedImuFactor(before[0], before[1], after[0], after[1], before[2], after[2], motion),
        factors.error_transition(before[3], after[3], (node.t_ns - last.t_ns) * 1e-9, by, believed.settings),
    ]


def node_factors(
    index: int, node: Node, track: InertialTrack, bias: gtsam.imuBias.ConstantBias, believed: Believed
) -> list[gtsam.NonlinearFactor]:
    """Return what was measured at a node."""
    settings, found = believed.settings, list[gtsam.NonlinearFactor]()
    if node.fix is not None:
        white = max(1.0 - sum(settings.gps_error_share), 0.02)
        found.append(
            factors.gps_position(
                pose_key(index),
                error_key(index),
                node.fix.p_site_m,
                node.fix.sigma_m,
                white * np.square(node.fix.sigma_m) + node.fix.noisier_m2,
                believed.lever_body_m,
            )
        )
    if node.v_site_m_s is not None:
        sigma = settings.gps_velocity_sigma_m_s * np.array([1.0, 1.0, 1.5])
        rate = np.array(track.rates_at(node.t_ns).gyro_rad_s) - bias.gyroscope()
        turning = np.cross(rate, believed.lever_body_m)
        found.append(factors.gps_velocity(pose_key(index), velocity_key(index), node.v_site_m_s, sigma, turning))
    return found + _gait_factors(index, node, track, settings)


def _gait_factors(
    index: int, node: Node, track: InertialTrack, settings: PreciseSettings
) -> list[gtsam.NonlinearFactor]:
    stands, rate = track.standing(node.t_ns)
    found: list[gtsam.NonlinearFactor] = []
    if stands:
        model = factors.huber(np.full(3, settings.still_sigma_m_s))
        found.append(gtsam.PriorFactorVector(velocity_key(index), np.zeros(3), model))
    elif node.v_site_m_s is None:
        model = gtsam.noiseModel.Diagonal.Sigmas(np.array(WALK_M_S))
        found.append(gtsam.PriorFactorVector(velocity_key(index), np.zeros(3), model))
    if rate is not None:
        sigmas = np.repeat([UNSAID_M_S2, settings.still_rate_sigma_rad_s], 3)
        offset = gtsam.imuBias.ConstantBias(np.zeros(3), np.array(rate))
        found.append(gtsam.PriorFactorConstantBias(bias_key(index), offset, gtsam.noiseModel.Diagonal.Sigmas(sigmas)))
    return found


def start_values(nodes: Sequence[Node], track: InertialTrack) -> gtsam.Values:
    """Return a first guess of every node: level attitudes turned as motion tells, fixes, and velocities as received."""
    alignment, values = Alignment(nodes, track), gtsam.Values()
    at = np.array([node.t_ns for node in nodes if node.fix is not None], float)
    fixes = np.array([node.fix.p_site_m for node in nodes if node.fix is not None]).reshape(-1, 3)
    for index, node in enumerate(nodes):
        wxyz = normalise(multiply(wxyz_from_yaw(phase(alignment.turn(node.t_ns))), track.level_at(node.t_ns)))
        p = [float(np.interp(node.t_ns, at, fixes[:, axis])) for axis in range(3)] if len(at) else [0.0] * 3
        values.insert(pose_key(index), gtsam.Pose3(gtsam.Rot3.Quaternion(*wxyz), np.array(p)))
        values.insert(velocity_key(index), np.array(node.v_site_m_s or (0.0, 0.0, 0.0)))
        values.insert(bias_key(index), gtsam.imuBias.ConstantBias())
        values.insert(error_key(index), np.zeros(9))
    return values


def motion_to(
    index: int, nodes: Sequence[Node], track: InertialTrack, bias: gtsam.imuBias.ConstantBias, believed: Believed
) -> gtsam.PreintegratedCombinedMeasurements:
    """Return the motion from the node before to a node."""
    before, node = nodes[index - 1], nodes[index]
    return preintegrated([*track.steps(before.t_ns, node.t_ns)], before.t_ns, bias, believed)


def whole(
    nodes: Sequence[Node],
    motions: Sequence[gtsam.PreintegratedCombinedMeasurements],
    track: InertialTrack,
    values: gtsam.Values,
    believed: Believed,
) -> gtsam.NonlinearFactorGraph:
    """Return the graph of all nodes; `motions` are those to the second node, the third and so on."""
    found = start_factors(0, values.atPose3(pose_key(0)), believed)
    for index, node in enumerate(nodes):
        if index > 0:
            found += motion_factors(index, nodes[index - 1], node, motions[index - 1], believed)
        found += node_factors(index, node, track, values.atConstantBias(bias_key(index)), believed)
    graph = gtsam.NonlinearFactorGraph()
    for factor in found:
        graph.push_back(factor)
    return graph


def next_values(index: int, values: gtsam.Values, motion: gtsam.PreintegratedCombinedMeasurements) -> gtsam.Values:
    """Return a first guess of a node from the one before it."""
    before = keys(index - 1)
    bias = values.atConstantBias(before[2])
    state = motion.predict(gtsam.NavState(values.atPose3(before[0]), values.atVector(before[1])), bias)
    guess = gtsam.Values()
    guess.insert(pose_key(index), state.pose())
    guess.insert(velocity_key(index), state.velocity())
    guess.insert(bias_key(index), bias)
    guess.insert(error_key(index), values.atVector(before[3]))
    return guess
