"""The paper's estimators on simulated walks: same answer twice, pure predictions, faults, and errors within what GPS allows."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest

from tracker import rotations, score
from tracker.errors import UnknownEstimator
from tracker.estimator import Estimator, Pose
from tracker.estimators import ESTIMATORS, build
from tracker.geodesy import SiteFrame
from tracker.geomagnetism import declination_rad
from tracker.geometry import matrix_from_wxyz
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, MagSample, Measurement, Outcome, TruePose, VisualMotion
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

SITE = SiteFrame(AGORA_ORIGIN)
PAPER = [name for name in ESTIMATORS if name != "truth"]
DECLINATION_RAD = declination_rad(AGORA_ORIGIN, START_NS)


@pytest.fixture(scope="module")
def walk() -> Walk:
    """Half a minute on the square."""
    return Walk(WalkSettings(seed=4, duration_s=35.0), default_rig())


@pytest.fixture(scope="module")
def measurements(walk: Walk) -> list[Measurement]:
    """What the sensors say of it."""
    return list(simulate(walk))


def _build(name: str) -> Estimator:
    return build(
        name, origin=AGORA_ORIGIN, rig=default_rig(), declination_rad=DECLINATION_RAD, truth_origin=AGORA_ORIGIN
    )


def _poses(estimator: Estimator, measurements: list[Measurement]) -> list[Pose | None]:
    poses = []
    for index, measurement in enumerate(measurements):
        estimator.step(measurement)
        if index % 50 == 0:
            poses.append(estimator.predict(measurement.t_recv_ns))
    return poses


def _row(pose: Pose) -> tuple[object, ...]:
    """Everything but the covariance."""
    return pose.t_ns, pose.p_site_m, pose.wxyz_site_body, pose.v_site_m_s, pose.motion_model, pose.heading_known


def _same(a: list[Pose | None], b: list[Pose | None]) -> bool:
    return all(
        (p is None and q is None)
        or (p is not None and q is not None and _row(p) == _row(q) and np.array_equal(p.cov, q.cov))
        for p, q in zip(a, b, strict=True)
    )


@pytest.mark.parametrize("name", PAPER)
def test_stays_within_what_gps_allows(name: str, walk: Walk, measurements: list[Measurement]) -> None:
    """The error is the receiver's, at most a quarter more; tilt within 2 degrees and heading within 8."""
    estimator, poses, fixes = _build(name), [], []
    for measurement in measurements:
        estimator.step(measurement)
        if isinstance(measurement, GpsFix) and measurement.t_ns > START_NS + 15_000_000_000:
            pose = estimator.predict(measurement.t_recv_ns)
            assert pose is not None
            assert pose.heading_known
            poses.append(pose)
            fixes.append(SITE.site_from_geodetic(measurement.lat_deg, measurement.lon_deg, measurement.h_ellipsoid_m))
    estimate = score.track(poses)
    truths = [m for m in measurements if isinstance(m, TruePose)]
    truth, known = score.true_track(truths, np.eye(4), estimate.t_ns)
    figures = score.truth_figures(estimate.at(known), truth.at(known), score.Known(True, True, True, True))
    assert figures is not None
    raw_m = score.ate_rmse_m(np.array(fixes)[known] - truth.p_m[known])
    assert figures["ate_rmse_m"] < 1.25 * raw_m
    assert figures["tilt_rmse_deg"] < 2.0
    assert figures["heading_rmse_deg"] < 8.0


@pytest.mark.parametrize("name", ESTIMATORS)
def test_the_same_answer_twice_and_after_a_restore(name: str, measurements: list[Measurement]) -> None:
    """run(A + B) equals run(A), snapshot, go astray, restore, run(B), bit for bit."""
    half = len(measurements) // 2
    whole, estimator = _poses(_build(name), measurements), _build(name)
    first = _poses(estimator, measurements[:half])
    snapshot = estimator.snapshot()
    _poses(estimator, measurements[half : half + 500])
    estimator.restore(snapshot)
    first_of_second = next(i for i in range(half, len(measurements)) if i % 50 == 0) - half
    for measurement in measurements[half : half + first_of_second]:
        estimator.step(measurement)
    second = _poses(estimator, measurements[half + first_of_second :])
    assert _same(whole, first + second)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_predictions_are_pure(name: str, measurements: list[Measurement]) -> None:
    """Asking for poses, past and future, changes none that follow."""
    asked = _build(name)
    for measurement in measurements[:6000]:
        asked.step(measurement)
        asked.predict(measurement.t_ns - 300_000_000)
        asked.predict(measurement.t_ns + 200_000_000)
    silent = _build(name)
    for measurement in measurements[:6000]:
        silent.step(measurement)
    t_ns = measurements[6000].t_ns
    assert _same([asked.predict(t_ns)], [silent.predict(t_ns)])


def test_truth_is_the_walk(walk: Walk, measurements: list[Measurement]) -> None:
    """Between two truths the interpolated pose is within a millimetre and a hundredth of a degree."""
    estimator = _build("truth")
    for measurement in measurements[:8000]:
        estimator.step(measurement)
    t_ns = measurements[7900].t_recv_ns - 5_003_000
    pose = estimator.predict(t_ns)
    assert pose is not None
    motion = walk.at(np.array([t_ns]))
    np.testing.assert_allclose(pose.p_site_m, motion.p_m[0], atol=1e-3)
    estimate = score.track([pose])
    assert abs(float(np.trace(rotations.matrices(estimate.wxyz)[0].T @ motion.R_site_body[0])) - 3.0) < 1e-6


def test_bad_measurements_are_outcomes(measurements: list[Measurement]) -> None:
    """NaN, the past, no fix, a jump across the country, a sensor of no concern: each has its answer, none an exception."""
    estimator = _build("gps-imu/famm")
    for measurement in measurements[:3000]:
        estimator.step(measurement)
    imu = next(m for m in reversed(measurements[:3000]) if isinstance(m, ImuSample))
    fix = next(m for m in reversed(measurements[:3000]) if isinstance(m, GpsFix))
    later = fix.t_ns + 1_000_000_000
    outcomes = [
        estimator.step(replace(imu, t_ns=imu.t_ns + 1, gyro_rad_s=(nan, 0.0, 0.0))),
        estimator.step(imu),
        estimator.step(replace(imu, t_ns=imu.t_ns + 10**13)),
        estimator.step(replace(fix, t_ns=later, valid=False, lat_deg=nan)),
        estimator.step(replace(fix, t_ns=later, lat_deg=nan)),
        estimator.step(replace(fix, t_ns=later, lat_deg=fix.lat_deg + 1.0)),
        estimator.step(replace(fix, t_ns=fix.t_ns + 10**13)),
        estimator.step(GpsVelocity(later, later, (nan, 0.0, 0.0))),
        estimator.step(GpsVelocity(later, later, (900.0, 0.0, 0.0))),
        estimator.step(GpsVelocity(later + 10**13, later, (1.0, 0.0, 0.0))),
        estimator.step(GpsVelocity(0, later, (1.0, 0.0, 0.0))),
        estimator.step(VisualMotion(0, 0, 0, 0, np.eye(3), (0.0, 0.0, 0.0), 0, 0.0, False)),
    ]
    assert outcomes == [
        Outcome.REJECTED_NOT_FINITE,
        Outcome.REJECTED_STALE,
        Outcome.REJECTED_GATE,
        Outcome.REJECTED_WEAK,
        Outcome.REJECTED_NOT_FINITE,
        Outcome.REJECTED_GATE,
        Outcome.REJECTED_GATE,
        Outcome.REJECTED_NOT_FINITE,
        Outcome.REJECTED_GATE,
        Outcome.REJECTED_GATE,
        Outcome.REJECTED_STALE,
        Outcome.IGNORED,
    ]


def test_a_fix_that_stays_far_away_is_believed(measurements: list[Measurement]) -> None:
    """A receiver that lay with its first fixes must not be locked out for good."""
    estimator = _build("gps-imu/cmm")
    for measurement in measurements:
        moved = (
            replace(measurement, lat_deg=measurement.lat_deg + 0.01) if isinstance(measurement, GpsFix) else measurement
        )
        estimator.step(moved if measurement.t_recv_ns > START_NS + 20_000_000_000 else measurement)
    pose = estimator.predict(measurements[-1].t_recv_ns)
    assert pose is not None
    assert pose.p_site_m[1] > 1000.0


def test_without_gps_the_outage_grows_the_covariance(measurements: list[Measurement]) -> None:
    """Fifteen seconds without a fix: the pose goes on, and says that it is worth less."""
    estimator = _build("gps-imu/famm")
    cut_ns = START_NS + 20_000_000_000
    for measurement in measurements:
        if not (isinstance(measurement, GpsFix) and measurement.t_ns > cut_ns):
            estimator.step(measurement)
    before, after = (estimator.predict(t) for t in (cut_ns + 10**9, measurements[-1].t_recv_ns))
    assert before is not None
    assert after is not None
    assert after.cov[0, 0] > 10.0 + before.cov[0, 0]


def _errors_m(poses: list[Pose], walk: Walk) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    truth = walk.at(np.array([pose.t_ns for pose in poses])).p_m[:, :2]
    return np.asarray(np.hypot(*(np.array([pose.p_site_m[:2] for pose in poses]) - truth).T))


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("name", ["gps-imu/cmm", "gps-imu/famm"])
def test_an_outage_is_walked_through(name: str, seed: int) -> None:
    """Fifteen seconds of silence: better than standing still at the last fix, and no leap when the receiver comes back."""
    walk = Walk(WalkSettings(seed=seed, duration_s=70.0, imu_hz=100.0), default_rig())
    estimator, during, after, held, last = _build(name), [], [], [], (0.0, 0.0, 0.0)
    for index, m in enumerate(simulate(walk)):
        t_s = (m.t_recv_ns - START_NS) * 1e-9
        if isinstance(m, GpsFix | GpsVelocity) and 40.0 < t_s < 55.0:
            continue
        if isinstance(m, GpsFix):
            last = SITE.site_from_geodetic(m.lat_deg, m.lon_deg, m.h_ellipsoid_m)
        estimator.step(m)
        pose = estimator.predict(m.t_recv_ns)
        if pose is None or index % 20:
            continue
        if 42.0 < t_s < 55.0:
            during.append(pose)
            held.append(replace(pose, p_site_m=last))
        elif 58.0 < t_s < 68.0:
            after.append(pose)
    assert np.mean(_errors_m(during, walk)) < np.mean(_errors_m(held, walk))
    assert np.max(_errors_m(after, walk)) < 7.0
    assert max(np.hypot(*pose.v_site_m_s[:2]) for pose in after) < 2.5


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_north_without_a_magnetometer(seed: int) -> None:
    """A minute and a half of walking tells it to a few degrees, from a start that knew nothing; until then it says so."""
    walk = Walk(WalkSettings(seed=seed, duration_s=90.0, imu_hz=100.0), default_rig())
    estimator = _build("gps-imu/famm")
    stepped = [m for m in simulate(walk) if not isinstance(m, MagSample | TruePose)]
    for index, m in enumerate(stepped):
        estimator.step(m)
        pose = estimator.predict(m.t_recv_ns)
        if index == 900:
            assert pose is not None
            assert not pose.heading_known
    assert pose is not None
    assert pose.heading_known
    truth = walk.at(np.array([pose.t_ns])).R_site_body[0]
    turn = truth.T @ matrix_from_wxyz(pose.wxyz_site_body)
    assert np.degrees(np.arccos(np.clip((np.trace(turn) - 1.0) / 2.0, -1.0, 1.0))) < 12.0


def test_motion_models(measurements: list[Measurement]) -> None:
    """CMM keeps P1R1; FAMM starts at rest and moves among models; every update is reported once."""
    constant, fuzzy = _build("gps-imu/cmm"), _build("gps-imu/famm")
    for measurement in measurements:
        constant.step(measurement)
        fuzzy.step(measurement)
    assert {i.motion_model for i in constant.innovations()} == {"P1R1"}
    models = [i.motion_model for i in fuzzy.innovations()]
    assert models[0] == "P0R0"
    assert len(set(models)) > 2
    assert 4 * 33 < len(models) <= 4 * 35
    assert fuzzy.innovations() == []


def test_an_unknown_estimator_is_named() -> None:
    """With the names that there are."""
    with pytest.raises(UnknownEstimator, match=r"'kalman'.*gps-imu/famm"):
        _build("kalman")
