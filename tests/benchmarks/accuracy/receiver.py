"""A GPS receiver whose error has two time scales, and which now and then is badly wrong about its speed."""

from collections.abc import Iterator

import numpy as np

from tests.benchmarks.accuracy.visitor import Visitor
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, GpsVelocity, Matrix

#: Correlation time and size of each part of the error, each horizontal axis.
SLOW_S, SLOW_M = (20.0, 400.0), (0.8, 1.6)
WHITE_M = 0.3
UP = 1.8
"""How much larger it is upwards."""
VELOCITY_M_S, VELOCITY_UP_M_S = 0.09, 0.15
SPIKE_SHARE, SPIKE_M_S = 0.02, 0.5
LATE_S = (0.15, 0.35)
RATE_HZ = 1.0
STREAM = 33
AXES = np.array([1.0, 1.0, UP])
#: Beside a wall it hears a satellite by way of that wall: metres off at once, its speed by some tenths, and after a while neither.
ECHO_EVERY_S, ECHO_S = 45.0, (3.0, 14.0)
ECHO_M, ECHO_M_S = 4.0, 0.22
ECHO_STREAM = 34
#: A claim that wavers: by a fifth, for some seconds, and in spells by half or double; what it is about does not.
WAVER_SHARE, WAVER_S = 0.2, 5.0
WAVER_EVERY_S, WAVER_SPELL_S, WAVER_BY = 60.0, (10.0, 40.0), 2.0
WAVER_STREAM = 35


def claimed_m() -> Matrix:
    """Return the error's true standard deviation, (3,)."""
    return np.asarray(np.sqrt(sum(size**2 for size in SLOW_M) + WHITE_M**2) * AXES)


def position_error_m(rng: np.random.Generator, count: int) -> Matrix:
    """Return the error of `count` fixes, (n, 3), from its steady state on."""
    error = rng.normal(0.0, WHITE_M, (count, 3))
    for time_s, size_m in zip(SLOW_S, SLOW_M, strict=True):
        keep = np.exp(-1.0 / (RATE_HZ * time_s))
        part = rng.normal(0.0, size_m, 3)
        for row in error:
            row += part
            part = keep * part + np.sqrt(1.0 - keep**2) * rng.normal(0.0, size_m, 3)
    return np.asarray(error * AXES)


def velocity_error_m_s(rng: np.random.Generator, count: int) -> Matrix:
    """Return the error of `count` velocities, (n, 3)."""
    error = rng.normal(0.0, 1.0, (count, 3)) * [VELOCITY_M_S, VELOCITY_M_S, VELOCITY_UP_M_S]
    spikes = rng.random(count) < SPIKE_SHARE
    direction = rng.normal(0.0, 1.0, (count, 3))
    direction *= SPIKE_M_S / np.linalg.norm(direction, axis=1, keepdims=True)
    return np.asarray(error + spikes[:, None] * direction)


def echoes(rng: np.random.Generator, count: int) -> tuple[Matrix, Matrix]:
    """Return what walls add to `count` fixes, m, and velocities, m/s: (n, 3) each, spell after spell."""
    fixes, velocities = np.zeros((count, 3)), np.zeros((count, 3))
    at_s = rng.exponential(ECHO_EVERY_S)
    while (first := round(at_s * RATE_HZ)) < count:
        end_s = at_s + rng.uniform(*ECHO_S)
        spell = slice(first, round(end_s * RATE_HZ))
        fixes[spell] = rng.normal(0.0, ECHO_M, 3) * AXES
        velocities[spell] = rng.normal(0.0, ECHO_M_S, 3)
        at_s = end_s + rng.exponential(ECHO_EVERY_S)
    return fixes, velocities


def wavering(rng: np.random.Generator, count: int) -> Matrix:
    """Return what a receiver's claims of `count` fixes are multiplied by, (n,)."""
    keep = np.exp(-1.0 / (RATE_HZ * WAVER_S))
    off, found = rng.normal(), np.zeros(count)
    for number in range(count):
        found[number] = off
        off = keep * off + np.sqrt(1.0 - keep**2) * rng.normal()
    factors = np.exp(WAVER_SHARE * found)
    at_s = rng.exponential(WAVER_EVERY_S)
    while (first := round(at_s * RATE_HZ)) < count:
        end_s = at_s + rng.uniform(*WAVER_SPELL_S)
        factors[first : round(end_s * RATE_HZ)] *= WAVER_BY ** rng.choice([-1.0, 1.0])
        at_s = end_s + rng.exponential(WAVER_EVERY_S)
    return np.asarray(factors)


def receive(
    walk: Visitor,
    understates: float,
    silent_s: tuple[float, float] | None,
    *,
    walls: bool = False,
    wavers: bool = False,
) -> Iterator[GpsFix | GpsVelocity]:
    """Yield fixes and velocities of the antenna.

    Args:
        walk: The truth.
        understates: By how much the claimed sigma is too small.
        silent_s: From when to when, in seconds of the walk, nothing is received.
        walls: Whether some are near enough to throw back what is received.
        wavers: Whether it claims now more and now less.
    """
    rng = np.random.default_rng([walk.settings.seed, STREAM])
    stamps, site = walk.stamps(RATE_HZ), SiteFrame(walk.settings.origin)
    motion, lever_m = walk.at(stamps), walk.rig.T_body_gps[:3, 3]
    p = motion.p_m + motion.R_site_body @ lever_m + position_error_m(rng, len(stamps))
    swing = np.einsum("nij,nj->ni", motion.R_site_body, np.cross(motion.omega_body_rad_s, lever_m))
    v = motion.v_m_s + swing + velocity_error_m_s(rng, len(stamps))
    if walls:
        of_fixes, of_velocities = echoes(np.random.default_rng([walk.settings.seed, ECHO_STREAM]), len(stamps))
        p, v = p + of_fixes, v + of_velocities
    late_ns = (rng.uniform(*LATE_S, len(stamps)) * 1e9).astype(np.int64)
    claims_m = np.tile(claimed_m() / understates, (len(stamps), 1))
    if wavers:
        claims_m *= wavering(np.random.default_rng([walk.settings.seed, WAVER_STREAM]), len(stamps))[:, None]
    for number, t in enumerate(stamps.tolist()):
        if silent_s is not None and silent_s[0] <= number / RATE_HZ < silent_s[1]:
            continue
        (x, y, z), (vx, vy, vz) = p[number].tolist(), v[number].tolist()
        arrived = t + int(late_ns[number])
        cov = tuple(np.diag(claims_m[number] ** 2).ravel().tolist())
        yield GpsFix(t, arrived, *site.geodetic_from_site((x, y, z)), cov)
        yield GpsVelocity(t, arrived, (vx, vy, vz))
