"""Rivals on short walks of the project's own simulator: sound, without knowledge of the future, and good for something."""

from dataclasses import dataclass, replace
from functools import cache
from math import nan

import numpy as np
import pytest

from tests.benchmarks.accuracy.rivals import RIVALS
from tracker import score
from tracker.estimator import Origin, Pose
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Matrix, Measurement, TruePose
from tracker.rig import Rig
from tracker.score import Track
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

SECONDS = 40.0
LIVE = [name for name in RIVALS if name != "gtsam/batch"]
PLACED = ["gtsam/batch", "gtsam/fixed-lag", "filterpy/imm"]
#: After this many seconds all of them have settled.
SETTLED_S = 20.0


@dataclass(frozen=True)
class Recorded:
    """A walk."""

    measurements: list[Measurement]
    truth: list[TruePose]
    origin: Origin
    rig: Rig

    @property
    def ticks(self) -> list[int]:
        """Fifty times a second, to the walk's last measurement."""
        return list(range(START_NS + 20_000_000, self.measurements[-1].t_recv_ns, 20_000_000))


@cache
def walked(seed: int) -> Recorded:
    """Return a walk that begins after three seconds, its antenna a little behind the sensors."""
    rig = replace(
        default_rig(), T_body_gps=np.block([[np.eye(3), np.array([[-0.1], [0.0], [0.15]])], [0.0, 0.0, 0.0, 1.0]])
    )
    walk = Walk(WalkSettings(seed=seed, duration_s=SECONDS, still_s=3.0), rig)
    said = list(simulate(walk))
    return Recorded(
        [m for m in said if not isinstance(m, TruePose)],
        [m for m in said if isinstance(m, TruePose)],
        walk.settings.origin,
        rig,
    )


@cache
def poses_of(name: str, seed: int) -> list[Pose]:
    """Return what a rival makes of a walk."""
    walk = walked(seed)
    return RIVALS[name](walk.measurements, walk.origin, walk.rig, walk.ticks)


def settled(name: str, seed: int) -> tuple[Track, Track]:
    """Return poses and truth at the same times, from when all have settled."""
    estimate = score.track(poses_of(name, seed))
    truth, known = score.true_track(walked(seed).truth, np.eye(4), estimate.t_ns)
    use = known & (estimate.t_ns > START_NS + SETTLED_S * 1e9)
    return estimate.at(use), truth.at(use)


def error_m(name: str, seed: int) -> Matrix:
    """Return the error of position, (n, 3)."""
    estimate, truth = settled(name, seed)
    return np.asarray(estimate.p_m - truth.p_m)


def raw_error_m(seed: int) -> Matrix:
    """Return the receiver's own error, (n, 3), lever arm included."""
    walk = walked(seed)
    site = SiteFrame(walk.origin)
    fixes = [m for m in walk.measurements if isinstance(m, GpsFix) and m.t_ns > START_NS + SETTLED_S * 1e9]
    truth, _ = score.true_track(walk.truth, np.eye(4), np.array([fix.t_ns for fix in fixes]))
    p = np.array([site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m) for fix in fixes])
    return np.asarray(p - truth.p_m)


@pytest.mark.parametrize("name", RIVALS)
def test_every_pose_is_at_a_tick_and_sound(name: str) -> None:
    poses = poses_of(name, 1)
    assert len(poses) > 0.9 * len(walked(1).ticks)
    assert {pose.t_ns for pose in poses} <= set(walked(1).ticks)
    track = score.track(poses)
    assert np.all(np.diff(track.t_ns) > 0)
    assert np.all(np.isfinite(track.p_m))
    assert np.linalg.norm(track.wxyz, axis=1) == pytest.approx(1.0, abs=1e-9)
    assert np.all(np.linalg.eigvalsh(track.cov) > -1e-9)


@pytest.mark.parametrize("name", LIVE)
def test_a_live_rival_knows_nothing_of_the_future(name: str) -> None:
    walk, until_ns = walked(1), START_NS + 25_000_000_000
    before = [m for m in walk.measurements if m.t_recv_ns <= until_ns]
    poses = RIVALS[name](before, walk.origin, walk.rig, [t for t in walk.ticks if t <= until_ns])
    for pose, known in zip(poses, poses_of(name, 1), strict=False):
        assert (pose.t_ns, pose.p_site_m, pose.wxyz_site_body) == (known.t_ns, known.p_site_m, known.wxyz_site_body)
        assert np.array_equal(pose.cov, known.cov)
    assert poses[-1].t_ns == until_ns


def test_the_batch_uses_what_comes_later() -> None:
    walk, until_ns = walked(1), START_NS + 25_000_000_000
    before = [m for m in walk.measurements if m.t_recv_ns <= until_ns]
    middle_ns = START_NS + 20_000_000_000
    (alone,) = RIVALS["gtsam/batch"](before, walk.origin, walk.rig, [middle_ns])
    whole = next(pose for pose in poses_of("gtsam/batch", 1) if pose.t_ns == middle_ns)
    assert np.linalg.norm(np.subtract(alone.p_site_m, whole.p_site_m)) > 0.01
    assert whole.cov[0, 0] < alone.cov[0, 0]


@pytest.mark.parametrize("seed", [1, 4])
def test_the_batch_is_better_than_the_smoother_and_that_than_the_receiver(seed: int) -> None:
    batch, smoother, raw = (
        score.ate_rmse_m(error)
        for error in (error_m("gtsam/batch", seed), error_m("gtsam/fixed-lag", seed), raw_error_m(seed))
    )
    assert batch < smoother < raw


@pytest.mark.parametrize("name", PLACED)
def test_the_shape_of_a_walk_is_far_better_than_its_place(name: str) -> None:
    error = error_m(name, 4)
    assert score.ate_rmse_m(error - error.mean(axis=0)) < 0.4 * score.ate_rmse_m(raw_error_m(4))


@pytest.mark.parametrize("name", PLACED)
def test_north_is_found(name: str) -> None:
    estimate, truth = settled(name, 1)
    heading = score.heading_rad(score.turns(estimate.wxyz, truth.wxyz))
    assert np.degrees(np.sqrt(np.mean(heading**2))) < 4.0


@pytest.mark.parametrize("name", ["gtsam/batch", "gtsam/fixed-lag"])
def test_gtsam_says_how_well_it_knows_north(name: str) -> None:
    estimate, truth = settled(name, 3)
    heading = score.heading_rad(score.turns(estimate.wxyz, truth.wxyz))
    assert np.degrees(np.sqrt(np.mean(heading**2))) < 4.0
    assert np.mean(heading**2 / estimate.cov[:, 5, 5]) < 2.5


@pytest.mark.parametrize(
    ("name", "most_deg"), [("gtsam/batch", 0.4), ("gtsam/fixed-lag", 0.6), ("vqf", 2.0), ("imufusion", 2.5)]
)
def test_tilt(name: str, most_deg: float) -> None:
    estimate, truth = settled(name, 1)
    tilt = score.tilt_rad(score.turns(estimate.wxyz, truth.wxyz))
    assert np.degrees(np.sqrt(np.mean(tilt**2))) < most_deg


@pytest.mark.parametrize("name", ["vqf", "imufusion"])
def test_what_knows_attitude_only_stands_at_the_origin(name: str) -> None:
    assert {pose.p_site_m for pose in poses_of(name, 1)} == {(0.0, 0.0, 0.0)}
    assert not any(pose.heading_known for pose in poses_of(name, 1))


@pytest.mark.parametrize("name", PLACED)
def test_without_a_fix_there_is_no_place(name: str) -> None:
    walk = walked(1)
    without = [m for m in walk.measurements if not isinstance(m, GpsFix)]
    assert RIVALS[name](without, walk.origin, walk.rig, walk.ticks) == []


@pytest.mark.parametrize("name", RIVALS)
def test_a_walk_of_nothing_has_no_poses(name: str) -> None:
    walk = walked(1)
    assert RIVALS[name]([], walk.origin, walk.rig, walk.ticks) == []


@pytest.mark.parametrize("name", RIVALS)
def test_what_is_not_a_number_is_left_out(name: str) -> None:
    walk = walked(1)
    broken: list[Measurement] = []
    for m in walk.measurements:
        match m:
            case ImuSample():
                broken.append(replace(m, t_ns=m.t_ns + 1, gyro_rad_s=(nan, 0.0, 0.0)))
            case GpsVelocity():
                broken.append(replace(m, v_enu_m_s=(nan, 0.0, 0.0)))
            case GpsFix():
                broken.append(replace(m, lat_deg=nan))
        broken.append(m)
    poses = RIVALS[name](broken, walk.origin, walk.rig, walk.ticks)
    assert [pose.p_site_m for pose in poses] == [pose.p_site_m for pose in poses_of(name, 1)]
