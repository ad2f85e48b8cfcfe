"""What a node's measurements say of its state, as GTSAM's factors: the receiver with its slow errors, and walkers that stand.

GTSAM's own GPS factors know no correlated error; these hold the state of `tracker/precise/error_model.py`: nine numbers in units of
what is usually claimed, three correlation times for each axis.
"""

from collections.abc import Callable
from typing import TypeAlias

import gtsam
import numpy as np

from tracker.measurements import Matrix, Vector3
from tracker.precise.error_model import skew
from tracker.precise.settings import PreciseSettings

#: Residuals beyond so many sigmas count for less: of standing, of fixes (reflections beside walls) and of velocities (spikes).
STANDING, FIX, VELOCITY = 1.345, 2.0, 3.0

ErrorFunction: TypeAlias = Callable[[gtsam.CustomFactor, gtsam.Values, gtsam.JacobianVector | None], Matrix]


def huber(sigmas: Matrix) -> gtsam.noiseModel.Base:
    """Return (n,) independent sigmas whose outliers pull with a constant force."""
    return gtsam.noiseModel.Robust.Create(
        gtsam.noiseModel.mEstimator.Huber.Create(STANDING), gtsam.noiseModel.Diagonal.Sigmas(sigmas)
    )


def cauchy(sigmas: Matrix, beyond: float) -> gtsam.noiseModel.Base:
    """Return (n,) independent sigmas whose outliers, beyond so many of them, pull less and less."""
    return gtsam.noiseModel.Robust.Create(
        gtsam.noiseModel.mEstimator.Cauchy.Create(beyond), gtsam.noiseModel.Diagonal.Sigmas(sigmas)
    )


def gps_position(
    pose: int, error: int, p_site_m: Vector3, sigma_m: Vector3, white_m2: Matrix, lever_body_m: Matrix
) -> gtsam.NonlinearFactor:
    """Return the factor of a fix of the antenna.

    Args:
        pose: Key of the body's pose.
        error: Key of the receiver's error, (9,).
        p_site_m: The fix.
        sigma_m: In units of which the error is.
        white_m2: (3,) variances of what is not in the error states.
        lever_body_m: (3,) the antenna on the body.
    """
    measured, sigma = np.array(p_site_m), np.array(sigma_m)
    by_error = np.hstack([np.diag(sigma)] * 3)
    lever_cross = skew(lever_body_m)

    def residual(this: gtsam.CustomFactor, values: gtsam.Values, jacobians: gtsam.JacobianVector | None) -> Matrix:
        T_site_body = values.atPose3(pose)
        R = T_site_body.rotation().matrix()
        if jacobians is not None:
            jacobians[0] = np.hstack([-R @ lever_cross, R])
            jacobians[1] = by_error
        return np.asarray(
            T_site_body.translation() + R @ lever_body_m + by_error @ values.atVector(error) - measured, float
        )

    return gtsam.CustomFactor(cauchy(np.sqrt(white_m2), FIX), [pose, error], residual)


def gps_velocity(
    pose: int, velocity: int, v_site_m_s: Vector3, sigma_m_s: Matrix, turning_body_m_s: Matrix
) -> gtsam.NonlinearFactor:
    """Return the factor of a velocity of the antenna, which `turning_body_m_s`, (3,), adds to the body's."""
    measured, cross = np.array(v_site_m_s), skew(turning_body_m_s)

    def residual(this: gtsam.CustomFactor, values: gtsam.Values, jacobians: gtsam.JacobianVector | None) -> Matrix:
        R = values.atPose3(pose).rotation().matrix()
        if jacobians is not None:
            jacobians[0] = np.hstack([-R @ cross, np.zeros((3, 3))])
            jacobians[1] = np.eye(3)
        return np.asarray(values.atVector(velocity) + R @ turning_body_m_s - measured, float)

    return gtsam.CustomFactor(cauchy(sigma_m_s, VELOCITY), [pose, velocity], residual)


def error_start(error: int, settings: PreciseSettings) -> gtsam.NonlinearFactor:
    """Return what is known of the receiver's error at first: its steady variance."""
    sigmas = np.sqrt(np.repeat(settings.gps_error_share, 3))
    return gtsam.PriorFactorVector(error, np.zeros(9), gtsam.noiseModel.Diagonal.Sigmas(sigmas))


def error_transition(
    before: int, after: int, dt_s: float, by: Matrix, settings: PreciseSettings
) -> gtsam.NonlinearFactor:
    """Return the first-order Gauss-Markov step of the receiver's error; linear, so that it costs no call of Python.

    `by`, (3,), is what the error before is multiplied by to be in units of what is claimed after: it is the same in metres.
    """
    kept = np.exp(-dt_s / np.repeat(settings.gps_error_s, 3))
    sigmas = np.sqrt(np.repeat(settings.gps_error_share, 3) * (1.0 - kept**2))
    origin = gtsam.Values()
    origin.insert(before, np.zeros(9))
    origin.insert(after, np.zeros(9))
    step = gtsam.JacobianFactor(
        before, -np.diag(kept * np.tile(by, 3)), after, np.eye(9), np.zeros(9), gtsam.noiseModel.Diagonal.Sigmas(sigmas)
    )
    return gtsam.LinearContainerFactor(step, origin)
