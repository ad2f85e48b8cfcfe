"""Scores against hand-made errors, and against evo, the field's own tool."""

import numpy as np
import pytest
from evo.core import metrics
from evo.core.trajectory import PoseTrajectory3D

from tracker import score
from tracker.estimator import Pose
from tracker.geometry import multiply, wxyz_from_yaw
from tracker.measurements import TruePose

STEP_NS = 20_000_000
KNOWN = score.Known(True, True, True, True)


def _tracks(seconds: float = 60.0) -> tuple[score.Track, score.Track]:
    """A circle, and an estimate of it with a slow and a fast error."""
    t = np.arange(0.0, seconds, 0.02)
    p = np.stack([10 * np.cos(0.1 * t), 10 * np.sin(0.1 * t), 0 * t], axis=1)
    error = np.stack([1.0 + 0.5 * np.sin(0.05 * t), 0.3 * np.cos(0.07 * t), 0.2 * np.sin(0.1 * t)], axis=1)
    yaws = 0.1 * t
    q = np.array([wxyz_from_yaw(yaw) for yaw in yaws])
    q_off = np.array([multiply(wxyz_from_yaw(0.02), wxyz_from_yaw(yaw)) for yaw in yaws])
    cov = np.broadcast_to(np.eye(6), (len(t), 6, 6)).copy()
    times = (t * 1e9).round().astype(np.int64)
    return score.Track(times, p + error, q_off, cov), score.Track(times, p, q, cov)


def _evo(track: score.Track) -> PoseTrajectory3D:
    flat = track.p_m * np.array([1.0, 1.0, 0.0])
    level = np.tile([1.0, 0.0, 0.0, 0.0], (len(flat), 1))  # evo turns displacements by the attitude; ours stay in ENU
    return PoseTrajectory3D(positions_xyz=flat, orientations_quat_wxyz=level, timestamps=track.t_ns * 1e-9)


def test_evo_agrees_on_ate_and_rpe() -> None:
    """Horizontal, unaligned, 10 s apart."""
    estimate, truth = _tracks()
    figures = score.truth_figures(estimate, truth, KNOWN)
    assert figures is not None
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((_evo(truth), _evo(estimate)))
    assert figures["ate_rmse_m"] == pytest.approx(ape.get_statistic(metrics.StatisticsType.rmse), rel=1e-9)
    rpe = metrics.RPE(metrics.PoseRelation.translation_part, 500, metrics.Unit.frames, all_pairs=True)
    rpe.process_data((_evo(truth), _evo(estimate)))
    assert figures["rpe_10s_m"] == pytest.approx(rpe.get_statistic(metrics.StatisticsType.rmse), rel=1e-6)


def test_angles_and_pixels() -> None:
    """A heading 0.02 rad off moves a point 20 m ahead by about 0.02 f, whatever the distance."""
    estimate, truth = _tracks()
    turned_only = score.Track(estimate.t_ns, truth.p_m, estimate.wxyz, estimate.cov)
    figures = score.truth_figures(turned_only, truth, KNOWN)
    assert figures is not None
    assert figures["heading_rmse_deg"] == pytest.approx(np.degrees(0.02))
    assert figures["tilt_rmse_deg"] == pytest.approx(0.0, abs=1e-6)
    assert figures["registration_px"]["at_20m"]["median"] == pytest.approx(score.FOCAL_PX * np.tan(0.02))
    assert figures["registration_px"]["at_50m"]["median"] == pytest.approx(score.FOCAL_PX * np.tan(0.02))
    assert figures["nees_heading"] == pytest.approx(0.02**2)


def test_jitter_is_what_is_fast() -> None:
    """A slow error is none; a 5 Hz shake of 1 cm is 7 mm RMS."""
    estimate, truth = _tracks()
    slow = score.truth_figures(estimate, truth, KNOWN)
    shake = np.zeros_like(truth.p_m)
    shake[:, 0] = 0.01 * np.sin(2 * np.pi * 5 * truth.t_ns * 1e-9)
    shaken = score.truth_figures(
        score.Track(truth.t_ns, truth.p_m + shake, truth.wxyz, truth.cov + np.eye(6)), truth, KNOWN
    )
    assert slow is not None
    assert shaken is not None
    assert slow["jitter_rms_m"] < 1e-3
    assert shaken["jitter_rms_m"] == pytest.approx(0.01 / np.sqrt(2), rel=0.01)


def test_what_truth_does_not_know_is_none_not_zero() -> None:
    """Position without attitude or height, and no position at all."""
    estimate, truth = _tracks()
    figures = score.truth_figures(estimate, truth, score.Known(True, False, False, False))
    assert figures is not None
    unknown = ("height_rmse_m", "heading_rmse_deg", "tilt_rmse_deg", "orientation_rmse_deg", "jitter_rms_deg")
    assert all(figures[name] is None for name in (*unknown, "nees_heading", "registration_px"))
    assert score.truth_figures(estimate, truth, score.Known(False, True, True, True)) is None


def test_no_covariance_is_no_consistency() -> None:
    """One that is told for position alone judges position alone."""
    estimate, truth = _tracks()
    cov = np.zeros_like(estimate.cov)
    for known, told in ((False, (None, None)), (True, (pytest.approx(0.7, abs=0.5), None))):
        cov[:, :2, :2] = np.eye(2) if known else 0.0
        figures = score.truth_figures(score.Track(estimate.t_ns, estimate.p_m, estimate.wxyz, cov), truth, KNOWN)
        assert figures is not None
        assert (figures["nees_per_dim"], figures["nees_heading"]) == told


def test_the_fast_part_is_told_between_gaps_only() -> None:
    """A stretch shorter than four seconds tells no 1 Hz."""
    t_ns = np.arange(500, dtype=np.int64) * STEP_NS
    t_ns[150:] += 1_000_000_000
    shake = 0.01 * np.sin(2 * np.pi * 5 * t_ns * 1e-9)[:, None]
    fast, told = score.fast_part(t_ns, shake + 3.0)
    assert not told[:150].any()
    assert told[150:].all()
    assert np.all(fast[:150] == 0.0)
    assert fast[200:450] == pytest.approx(shake[200:450], abs=1e-3)


def test_gaps_in_truth_are_left_out() -> None:
    """Nothing is interpolated across a second without truth, nor beyond its ends."""

    def true_pose(t_s: float) -> TruePose:
        t_ns = int(t_s * 1e9)
        return TruePose(t_ns, t_ns, (t_s, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), None, True, True, True, True, 0.0)

    poses = [true_pose(t) for t in (1.0, 1.25, 1.5, 2.6, 2.8)]
    t_ns = (np.array([0.5, 1.1, 1.5, 2.0, 2.7, 3.0]) * 1e9).astype(np.int64)
    truth, known = score.true_track(poses, np.eye(4), t_ns)
    assert known.tolist() == [False, True, True, False, True, False]
    np.testing.assert_allclose(truth.p_m[known, 0], [1.1, 1.5, 2.7])


def test_poses_become_arrays() -> None:
    """No pose gives arrays of no rows."""
    pose = Pose(5, (1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0), np.eye(6), "-", True)
    assert score.track([pose]).p_m.tolist() == [[1.0, 2.0, 3.0]]
    assert score.track([]).cov.shape == (0, 6, 6)
