"""Covariances as ellipsoids."""

import numpy as np
import pytest

from server.console.ellipsoid import SIGMAS, ellipsoid
from tracker.geometry import transform


def test_the_axes_and_their_lengths_give_the_covariance_back() -> None:
    turned = transform((0.9, 0.1, -0.3, 0.3), (0.0, 0.0, 0.0))[:3, :3]
    covariance_m2 = turned @ np.diag([0.04, 1.0, 9.0]) @ turned.T
    axes_m, wxyz = ellipsoid(covariance_m2)
    R = transform(wxyz, (0.0, 0.0, 0.0))[:3, :3]
    assert np.linalg.det(R) == pytest.approx(1.0)
    np.testing.assert_allclose(R @ np.diag((np.array(axes_m) / SIGMAS) ** 2) @ R.T, covariance_m2, atol=1e-9)


def test_one_that_knows_all_or_nothing_can_still_be_drawn() -> None:
    assert min(ellipsoid(np.zeros((3, 3)))[0]) > 0.0
    assert max(ellipsoid(np.diag([1e12, 1.0, -1e-9]))[0]) == 60.0
