"""The estimator `truth`: what goes in comes out, between its poses and a little beyond."""

from dataclasses import replace
from math import nan, pi

import numpy as np
import pytest

from tracker.estimators import build
from tracker.geometry import angle_between_rad, transform, wxyz_from_yaw
from tracker.measurements import GpsFix, Outcome, TruePose
from tracker.rig import Rig
from tracker.simulate import AGORA_ORIGIN
from tracker.truth import TruthEstimator

S = 1_000_000_000


def _pose(t_s: float, x_m: float, yaw_rad: float) -> TruePose:
    t_ns = int(t_s * S)
    q = wxyz_from_yaw(yaw_rad)
    return TruePose(t_ns, t_ns, (x_m, 0.0, 1.7), q, (1.0, 0.0, 0.0), True, True, True, True, 0.0)


def test_between_beyond_and_before() -> None:
    """Half way is half way; half a second on goes on; ten seconds on stops after one; before the first is the first."""
    estimator = TruthEstimator(np.eye(4))
    assert [estimator.step(_pose(t, t, 0.2 * t)) for t in (1.0, 2.0)] == [Outcome.USED] * 2
    for t_s, x_m, yaw in ((1.5, 1.5, 0.3), (2.5, 2.5, 0.4), (12.0, 3.0, 0.4), (0.5, 1.0, 0.2)):
        pose = estimator.predict(int(t_s * S))
        assert pose is not None
        assert pose.p_site_m == pytest.approx((x_m, 0.0, 1.7))
        assert angle_between_rad(pose.wxyz_site_body, wxyz_from_yaw(yaw)) < 1e-7


def test_a_map_that_is_not_the_site() -> None:
    """Position, attitude and velocity are carried over."""
    estimator = TruthEstimator(transform(wxyz_from_yaw(pi / 2), (10.0, 20.0, 5.0)))
    estimator.step(_pose(1.0, 2.0, 0.3))
    pose = estimator.predict(S)
    assert pose is not None
    assert pose.p_site_m == pytest.approx((10.0, 22.0, 6.7))
    assert pose.v_site_m_s == pytest.approx((0.0, 1.0, 0.0))
    assert angle_between_rad(pose.wxyz_site_body, wxyz_from_yaw(0.3 + pi / 2)) < 1e-7


def test_what_it_does_not_take() -> None:
    """Other sensors, unknown positions, NaN, the past."""
    estimator = TruthEstimator(np.eye(4))
    good = _pose(5.0, 0.0, 0.0)
    outcomes = [
        estimator.step(GpsFix(0, 0, 37.9, 27.3, 90.0, ())),
        estimator.step(replace(good, position_known=False)),
        estimator.step(replace(good, p_map_body_m=(nan, 0.0, 0.0))),
        estimator.step(good),
        estimator.step(good),
    ]
    assert outcomes == [
        Outcome.IGNORED,
        Outcome.REJECTED_WEAK,
        Outcome.REJECTED_NOT_FINITE,
        Outcome.USED,
        Outcome.REJECTED_STALE,
    ]


def test_unknown_parts_are_uncertain() -> None:
    """A heading that nobody measured has the variance of no knowledge, and a known one next to none."""
    estimator = build("truth", origin=AGORA_ORIGIN, rig=Rig(), declination_rad=0.0)
    estimator.step(replace(_pose(1.0, 0.0, 0.0), heading_known=False, height_known=False, sigma_h_m=0.3))
    pose = estimator.predict(S)
    assert pose is not None
    assert not pose.heading_known
    assert pose.cov[5, 5] == pytest.approx(pi**2 / 3.0)
    assert pose.cov[3, 3] < 1e-9
    assert pose.cov[0, 0] == pytest.approx(0.09)
    assert pose.cov[2, 2] > 1e3


def test_a_snapshot_is_exact() -> None:
    """What came later is gone after a restore."""
    estimator = TruthEstimator(np.eye(4))
    estimator.step(_pose(1.0, 1.0, 0.0))
    snapshot = estimator.snapshot()
    estimator.step(_pose(2.0, 50.0, 1.0))
    estimator.restore(snapshot)
    pose = estimator.predict(2 * S)
    assert pose is not None
    assert pose.p_site_m == pytest.approx((2.0, 0.0, 1.7))
