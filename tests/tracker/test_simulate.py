"""The simulator against physics: what it says of the sensors must integrate back to what it says of the walk."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.geomagnetism import declination_rad
from tracker.geometry import exp, matrix_from_wxyz, multiply, rotate, wxyz_from_matrix
from tracker.heading import StartHeading
from tracker.measurements import GpsFix, ImuSample, MagSample, TruePose
from tracker.simulate import AGORA_ORIGIN, START_NS, SensorNoise, Walk, WalkSettings, default_rig, simulate

PERFECT = SensorNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, (0.0,) * 3, 60.0, (0.0,) * 3, 0.0)


def _walk(seed: int = 3, seconds: float = 40.0, noise: SensorNoise | None = None, dataset: int = 0) -> Walk:
    chosen = WalkSettings(seed=seed, duration_s=seconds, noise=noise or SensorNoise(), dataset=dataset)
    return Walk(chosen, default_rig())


def test_a_perfect_imu_integrates_to_the_walk() -> None:
    """Strapdown integration of 30 s of walking ends within centimetres and hundredths of a degree."""
    walk = _walk(noise=PERFECT)
    samples = [m for m in simulate(walk) if isinstance(m, ImuSample)]
    start = walk.at(np.array([samples[0].t_ns]))
    q, p, v = wxyz_from_matrix(start.R_site_body[0]), start.p_m[0], start.v_m_s[0]
    gravity = np.array([0.0, 0.0, gravity_m_s2(AGORA_ORIGIN.lat_deg, AGORA_ORIGIN.h_ellipsoid_m)])
    for a, b in pairwise(samples):
        dt = (b.t_ns - a.t_ns) * 1e-9
        gyro = np.add(a.gyro_rad_s, b.gyro_rad_s) * 0.5 * dt
        force_a = np.array(rotate(q, a.accel_m_s2))
        q = multiply(q, exp((float(gyro[0]), float(gyro[1]), float(gyro[2]))))
        accel = 0.5 * (force_a + np.array(rotate(q, b.accel_m_s2))) - gravity
        p, v = p + v * dt + 0.5 * accel * dt * dt, v + accel * dt
    end = walk.at(np.array([samples[-1].t_ns]))
    assert np.linalg.norm(p - end.p_m[0]) < 0.03
    turn = matrix_from_wxyz(q).T @ end.R_site_body[0]
    assert np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))) < 0.05


def test_at_rest_the_accelerometer_reads_gravity_up() -> None:
    """The first seconds are the calibration at rest: nothing turns, the force points up."""
    first = next(m for m in simulate(_walk(noise=PERFECT)) if isinstance(m, ImuSample))
    assert first.gyro_rad_s == (0.0, 0.0, 0.0)
    gravity = gravity_m_s2(AGORA_ORIGIN.lat_deg, AGORA_ORIGIN.h_ellipsoid_m)
    assert first.accel_m_s2 == pytest.approx((0.0, 0.0, gravity), abs=1e-9)


def test_the_magnetometer_knows_true_north_by_declination() -> None:
    """The tracker's start heading finds the true yaw."""
    walk = _walk(noise=PERFECT)
    heading = StartHeading(declination_rad(AGORA_ORIGIN, START_NS))
    for sample in (m for m in simulate(walk) if isinstance(m, MagSample)):
        wxyz = wxyz_from_matrix(walk.at(np.array([sample.t_ns])).R_site_body[0])
        heading.magnetometer(sample.t_ns, sample.field_body_t, wxyz)
    assert heading.yaw_offset_rad == pytest.approx(0.0, abs=1e-6)


def test_gps_errs_as_it_claims_and_slowly() -> None:
    """Over many seeds the error has the stated variance, and keeps its sign for most of a minute."""
    site = SiteFrame(AGORA_ORIGIN)
    errors = []
    for seed in range(40):
        # the receiver draws its errors by itself: whatever the other sensors' rates, they are the same
        walk = Walk(WalkSettings(seed=seed, duration_s=60.0, imu_hz=5.0, mag_hz=1.0, truth_hz=1.0), default_rig())
        fixes = [m for m in simulate(walk) if isinstance(m, GpsFix)]
        truth = walk.at(np.array([f.t_ns for f in fixes])).p_m
        errors.append(np.array([site.site_from_geodetic(f.lat_deg, f.lon_deg, f.h_ellipsoid_m) for f in fixes]) - truth)
    error = np.array(errors)
    noise = SensorNoise()
    stated = np.hypot(noise.gps_slow_m, noise.gps_white_m)
    np.testing.assert_allclose(np.sqrt(np.mean(error**2, axis=(0, 1))), stated, rtol=0.2)
    lagged = np.mean(error[:, :-30] * error[:, 30:] / np.array(noise.gps_slow_m) ** 2)
    assert lagged == pytest.approx(np.exp(-0.5), abs=0.2)


def test_the_same_seed_walks_the_same_walk() -> None:
    """Bit for bit; another seed walks another."""
    assert list(simulate(_walk(7, 15.0))) == list(simulate(_walk(7, 15.0)))
    assert list(simulate(_walk(7, 15.0))) != list(simulate(_walk(8, 15.0)))


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), dataset=st.integers(0, 5))
def test_a_visitor_moves_like_one(seed: int, dataset: int) -> None:
    """Never faster than a brisk walk, no wilder than a person, on the square, in order of arrival."""
    walk = _walk(seed, 60.0, dataset=dataset)
    motion = walk.at(walk.stamps(50.0))
    assert np.hypot(motion.v_m_s[:, 0], motion.v_m_s[:, 1]).max() < 2.0
    assert np.abs(motion.a_m_s2).max() < 8.0
    assert np.degrees(np.linalg.norm(motion.omega_body_rad_s, axis=1)).max() < 260.0
    assert (np.abs(motion.p_m[:, 0]) < 120.0).all()
    assert (np.abs(motion.p_m[:, 1]) < 70.0).all()


def test_the_stationary_dataset_stands() -> None:
    """Dataset 3 is the paper's stationary one."""
    motion = (walk := _walk(5, 30.0, dataset=3)).at(walk.stamps(10.0))
    assert np.ptp(motion.p_m, axis=0).max() < 1e-6


def test_messages_come_in_order_of_arrival() -> None:
    """And none before it was measured; truth and stamps agree with the walk."""
    walk = _walk(2, 20.0)
    measurements = list(simulate(walk))
    arrivals = [m.t_recv_ns for m in measurements]
    assert arrivals == sorted(arrivals)
    assert all(m.t_recv_ns >= m.t_ns for m in measurements)
    truth = next(m for m in measurements if isinstance(m, TruePose))
    assert truth.p_map_body_m == pytest.approx(tuple(walk.at(np.array([truth.t_ns])).p_m[0]))
