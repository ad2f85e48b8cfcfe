"""Madgwick's filter: its laws, and ahrs as the second implementation."""

import numpy as np
import pytest
from ahrs.filters import Madgwick as AhrsMadgwick

from tracker.attitude import Madgwick
from tracker.geometry import angle_between_rad, conjugate, exp, multiply, rotate, wxyz_from_rpy

G = 9.81


def test_agrees_with_ahrs_on_a_turning_rig() -> None:
    """Ours integrates exactly and ahrs to first order: at 250 Hz the first-order errors of 20 s add up to 0.2 degrees."""
    rng = np.random.default_rng(3)
    t = np.arange(5000) * 0.004
    gyro = np.stack([0.4 * np.sin(t), 0.3 * np.sin(1.3 * t), 0.8 * np.sin(0.5 * t)], axis=1)
    q = wxyz_from_rpy((0.1, -0.2, 0.0))
    ours, theirs = Madgwick(), AhrsMadgwick(frequency=250.0, gain=0.033)
    worst = 0.0
    reference = np.array(ours.update((0.0, 0.0, 0.0), rotate(conjugate(q), (0.0, 0.0, G)), 0.0))
    for rate in gyro:
        w = (float(rate[0]), float(rate[1]), float(rate[2]))
        q = multiply(q, exp((w[0] * 0.004, w[1] * 0.004, w[2] * 0.004)))
        ax, ay, az = (float(a) for a in np.array(rotate(conjugate(q), (0.0, 0.0, G))) + rng.normal(0, 0.05, 3))
        estimate = ours.update(w, (ax, ay, az), 0.004)
        reference = theirs.updateIMU(reference, gyr=np.array(w), acc=np.array([ax, ay, az]))
        rw, rx, ry, rz = (float(c) for c in reference)
        worst = max(worst, angle_between_rad(estimate, (rw, rx, ry, rz)))
    assert np.degrees(worst) < 0.3
    assert np.degrees(angle_between_rad(ours.update((0, 0, 0), rotate(conjugate(q), (0, 0, G)), 0.0), q)) < 0.5


def test_gravity_undoes_a_wrong_tilt() -> None:
    filter_ = Madgwick(beta=0.1)
    filter_.wxyz_level_body = wxyz_from_rpy((0.2, 0.1, 0.5))
    for _ in range(4000):
        filter_.update((0.0, 0.0, 0.0), (0.0, 0.0, G), 0.004)
    assert filter_.wxyz_level_body is not None
    up = rotate(filter_.wxyz_level_body, (0.0, 0.0, 1.0))
    assert up[2] == pytest.approx(1.0, abs=1e-5)


def test_free_fall_leaves_the_gyro_alone() -> None:
    filter_ = Madgwick()
    filter_.update((0.0, 0.0, 0.0), (0.0, 0.0, G), 0.0)
    q = filter_.update((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 0.5)
    assert angle_between_rad(q, exp((0.0, 0.0, 0.5))) < 1e-7
