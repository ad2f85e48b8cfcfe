"""An inertial unit like a Phidget Spatial, with all that is wrong with one: matrices, drifting biases, spikes, lost samples."""

from collections.abc import Iterator
from math import radians

import numpy as np

from tests.benchmarks.accuracy.visitor import Visitor
from tracker.geodesy import EARTH_RAD_S, gravity_m_s2
from tracker.measurements import ImuSample, Matrix

RATE_HZ = 250.0
GYRO_RAD_S, ACCEL_M_S2 = 0.0017, 0.010
"""White, each sample."""
GYRO_BIAS_RAD_S, ACCEL_BIAS_M_S2 = radians(0.3), 5e-3 * 9.80665
"""Largest of each axis when switched on;"""
WARMING_SHARE, WARMING_S = 0.15, 150.0
""" so much of it goes while the unit warms,"""
GYRO_WALK_RAD_S_SQRT_S, ACCEL_WALK_M_S2_SQRT_S = 3e-5, 2e-4
""" and it walks at random."""
SCALE, AXIS_RAD = 0.005, radians(0.3)
"""Error of scale, and how far each axis leans."""
SPIKE_EVERY_S, SPIKE_RAD_S, SPIKE_M_S2 = 40.0, 0.5, 5.0
LOST_SHARE = 0.001
LATE_S, JITTER_S = 0.002, 0.001
STREAM = 34


def axes(rng: np.random.Generator) -> Matrix:
    """Return what a triad makes of a vector, (3, 3): each axis with a scale of its own, leaning any way."""
    lean = rng.normal(0.0, AXIS_RAD / np.sqrt(2.0), (3, 3))
    np.fill_diagonal(lean, rng.normal(0.0, SCALE, 3))
    return np.asarray(np.eye(3) + lean)


def bias(rng: np.random.Generator, t_s: Matrix, largest: float, walk_sqrt_s: float) -> Matrix:
    """Return a bias at (n,) evenly spaced instants, (n, 3)."""
    start = rng.uniform(-largest, largest, 3)
    warming = WARMING_SHARE * largest * rng.normal(0.0, 1.0, 3) * (1.0 - np.exp(-t_s / WARMING_S))[:, None]
    step_s = float(t_s[1] - t_s[0])
    walked = np.cumsum(rng.normal(0.0, walk_sqrt_s * np.sqrt(step_s), (len(t_s), 3)), axis=0)
    return np.asarray(start + warming + walked)


def spikes(rng: np.random.Generator, count: int, size: float) -> Matrix:
    """Return single samples that are wrong, (n, 3), zero elsewhere."""
    hit = rng.random(count) < 1.0 / (SPIKE_EVERY_S * RATE_HZ)
    return np.asarray(hit[:, None] * rng.normal(0.0, size, (count, 3)))


def measure(walk: Visitor) -> Iterator[ImuSample]:
    """Yield samples; two at a time arrive together."""
    rng = np.random.default_rng([walk.settings.seed, STREAM])
    stamps, origin = walk.stamps(RATE_HZ), walk.settings.origin
    t_s, count, motion = np.arange(len(stamps)) / RATE_HZ, len(stamps), walk.at(stamps)
    gravity = np.array([0.0, 0.0, gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m)])
    lat_rad = radians(origin.lat_deg)
    earth = EARTH_RAD_S * np.array([0.0, np.cos(lat_rad), np.sin(lat_rad)])
    rate = motion.omega_body_rad_s + np.einsum("nji,j->ni", motion.R_site_body, earth)
    force = np.einsum("nji,nj->ni", motion.R_site_body, motion.a_m_s2 + gravity)
    gyro = rate @ axes(rng).T + bias(rng, t_s, GYRO_BIAS_RAD_S, GYRO_WALK_RAD_S_SQRT_S)
    accel = force @ axes(rng).T + bias(rng, t_s, ACCEL_BIAS_M_S2, ACCEL_WALK_M_S2_SQRT_S)
    gyro += rng.normal(0.0, GYRO_RAD_S, (count, 3)) + spikes(rng, count, SPIKE_RAD_S)
    accel += rng.normal(0.0, ACCEL_M_S2, (count, 3)) + spikes(rng, count, SPIKE_M_S2)
    # a pair arrives when its second sample has been made
    made_ns = (
        np.repeat(stamps[1::2], 2)[:count] if count % 2 == 0 else np.append(np.repeat(stamps[1::2], 2), stamps[-1])
    )
    late_ns = np.repeat((1e9 * (LATE_S + JITTER_S * rng.random((count + 1) // 2))).astype(np.int64), 2)[:count]
    kept = rng.random(count) >= LOST_SHARE
    for t, t_recv, w, f in zip(
        stamps[kept].tolist(),
        (made_ns + late_ns)[kept].tolist(),
        gyro[kept].tolist(),
        accel[kept].tolist(),
        strict=True,
    ):
        yield ImuSample(t, t_recv, (w[0], w[1], w[2]), (f[0], f[1], f[2]))
