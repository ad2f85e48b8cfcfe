"""Feet on the ground: a GPS height is off by metres, the height of the ground under a visitor is not."""

from collections.abc import Callable
from dataclasses import replace

from tracker.estimator import Pose

GroundHeight = Callable[[float, float], float]
"""Height of the ground, metres, at an east and a north in site."""
#: How well a terrain model and a person's eye height are known together, m.
SIGMA_M = 0.15


def on_ground(pose: Pose, ground_z_m: GroundHeight, eye_height_m: float) -> Pose:
    """Return the pose with its height replaced by the ground's plus the eyes' above it."""
    x, y, _ = pose.p_site_m
    cov = pose.cov.copy()
    cov[2, :] = cov[:, 2] = 0.0
    cov[2, 2] = SIGMA_M**2
    vx, vy, _ = pose.v_site_m_s
    return replace(pose, p_site_m=(x, y, ground_z_m(x, y) + eye_height_m), v_site_m_s=(vx, vy, 0.0), cov=cov)
