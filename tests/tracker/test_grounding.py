"""Feet on the ground."""

import numpy as np

from tracker.estimator import Pose
from tracker.grounding import SIGMA_M, on_ground


def test_the_height_is_the_grounds_and_nothing_else_changes() -> None:
    """Eyes above the slope, no vertical velocity, and a variance that says how well that is known."""
    cov = np.full((6, 6), 0.5) + np.eye(6)
    pose = Pose(5, (2.0, 3.0, 40.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.5, 0.3), cov, "P1R1", True)
    found = on_ground(pose, lambda e, n: 0.1 * e + n, 1.65)
    assert found.p_site_m == (2.0, 3.0, 0.2 + 3.0 + 1.65)
    assert found.v_site_m_s == (1.0, 0.5, 0.0)
    assert found.cov[2, 2] == SIGMA_M**2
    assert np.count_nonzero(found.cov[2]) == 1
    assert np.linalg.eigvalsh(found.cov).min() > 0.0
    assert (found.t_ns, found.wxyz_site_body, found.motion_model) == (5, (1.0, 0.0, 0.0, 0.0), "P1R1")
    assert (pose.cov == cov).all()
    assert pose.cov[2, 0] == 0.5
