"""A magnetometer among iron: in the rig, in posts that the way leads past, and for a minute all about it."""

from collections.abc import Iterator
from math import radians
from typing import Literal

import numpy as np

from tests.benchmarks.accuracy.scenarios import DISTURBED_FROM_S, SPELL_S, TURNED_S
from tests.benchmarks.accuracy.visitor import Visitor
from tracker.geomagnetism import magnetic_field
from tracker.measurements import MagSample, Matrix
from tracker.simulate import START_NS

RATE_HZ = 25.0
WHITE_T = 0.3e-6
HARD_IRON_T, SOFT_IRON = 3e-6, 0.05
#: How far the model of the Earth's field is off in declination, standard deviation.
DECLINATION_RAD = radians(0.4)
POSTS, POST_M, POST_T_M3 = 12, (1.0, 3.0), 15e-6
"""How many, how far from the way, and what field each makes at a metre to its side."""
#: Of the disturbance: strength, horizontal, and how long it takes to come and go.
DISTURBANCE_T, RAMP_S = 20e-6, 2.0
LATE_NS = 3_000_000
STREAM = 35


def posts_field_t(walk: Visitor, rng: np.random.Generator, p_m: Matrix) -> Matrix:
    """Return the field of upright magnets beside the way at (n, 3) places, (n, 3)."""
    passed_ns = rng.choice(walk.stamps(1.0), POSTS, replace=False)
    angle, apart_m = rng.uniform(0.0, 2.0 * np.pi, POSTS), rng.uniform(*POST_M, POSTS)
    # the middle of an upright post is below the eyes
    posts = walk.at(passed_ns).p_m + np.column_stack(
        [apart_m * np.cos(angle), apart_m * np.sin(angle), -0.7 + 0 * angle]
    )
    field = np.zeros_like(p_m)
    for post, pole in zip(posts, rng.choice([-1.0, 1.0], POSTS), strict=True):
        away = p_m - post
        distance_m = np.linalg.norm(away, axis=1, keepdims=True)
        towards, moment = away / distance_m, np.array([0.0, 0.0, pole * POST_T_M3])
        field += (3.0 * (towards @ moment)[:, None] * towards - moment) / distance_m**3
    return field


def disturbance_t(rng: np.random.Generator, t_s: Matrix) -> Matrix:
    """Return the field of something large and near for a minute, (n, 3), in site."""
    angle = rng.uniform(0.0, 2.0 * np.pi)
    in_s, out_s = t_s - DISTURBED_FROM_S, DISTURBED_FROM_S + SPELL_S - t_s
    share = np.clip(np.minimum(in_s, out_s) / RAMP_S, 0.0, 1.0)
    return np.asarray(share[:, None] * DISTURBANCE_T * np.array([np.cos(angle), np.sin(angle), 0.0]))


def sense(walk: Visitor, kind: Literal["there", "absent", "turned"], disturbed: bool) -> Iterator[MagSample]:
    """Yield samples in the body's axes; see `Scenario` for what `kind` and `disturbed` mean."""
    if kind == "absent":
        return
    rng = np.random.default_rng([walk.settings.seed, STREAM])
    stamps, origin = walk.stamps(RATE_HZ), walk.settings.origin
    motion, t_s = walk.at(stamps), np.asarray((stamps - START_NS) * 1e-9, np.float64)
    turn = rng.normal(0.0, DECLINATION_RAD)
    local = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    earth = local @ np.array(magnetic_field(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, START_NS).enu_t)
    field = earth + posts_field_t(walk, rng, motion.p_m) + disturbed * disturbance_t(rng, t_s)
    hard = rng.normal(0.0, HARD_IRON_T / np.sqrt(3.0), 3)
    soft = rng.normal(0.0, SOFT_IRON / np.sqrt(3.0), (3, 3))
    soft = np.eye(3) + (soft + soft.T) / 2.0
    if kind == "turned":
        field = field[t_s < TURNED_S] * [-1.0, -1.0, 1.0]
        stamps = stamps[t_s < TURNED_S]
    R = motion.R_site_body[: len(stamps)]
    body = np.einsum("nji,nj->ni", R, field) @ soft.T + hard + rng.normal(0.0, WHITE_T, (len(stamps), 3))
    for t, (x, y, z) in zip(stamps.tolist(), body.tolist(), strict=True):
        yield MagSample(t, t + LATE_NS, (x, y, z))
