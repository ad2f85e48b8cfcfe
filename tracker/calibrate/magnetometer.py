"""`agora calibrate mag`: the rig's own iron, from a turn through all directions: an ellipsoid made a sphere again. Numpy only.

Iron that is magnetic itself moves the sphere of readings (hard iron), iron that the Earth magnetises stretches it (soft iron).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tracker.errors import InputError
from tracker.geomagnetism import MagneticField
from tracker.measurements import ImuSample, MagSample, Matrix

LEAST_SAMPLES = 100
#: Of directions, each a sixtieth of the sphere.
DIRECTIONS = 60
LEAST_COVERAGE = 0.55
#: Spread of the strength after calibration, as a share of it.
LARGEST_RESIDUAL = 0.045
#: Standard error of the hard iron, as a share of the field.
LARGEST_SIGMA = 0.03
#: Ratio of what the sensor shows to what the model says; beyond it something is wrong, or the place is.
LARGEST_RATIO = 1.4
#: Soft iron that stretches the field more than this is no soft iron, but a fit gone astray.
LARGEST_STRETCH = 3.0
_STEPS = 60
#: Readings further from the sphere than this share of its radius lose their say: a post passed by, a shaken cable.
_CAUCHY = 0.03
#: Readings nearer than this to the one before, as a share of the field, say the same again: a rig that lay still for a minute
#: would outvote all directions.
_NEAREST = 0.03


@dataclass(frozen=True, eq=False)
class MagFit:
    """A magnetometer's errors, in the axes that it was given in."""

    hard_iron_t: Matrix
    """(3,)."""
    soft_iron: Matrix
    """(3, 3) symmetric."""
    strength_t: float
    """Of the field after calibration."""
    measured_t: float
    """Of the field as the sensor shows it, the rig's own taken off, before the model sets the scale."""
    residual: float
    """Spread of the strength after calibration, as a share of it."""
    coverage: float
    dip_rad: float | None
    """Measured, by the direction of gravity; None where no accelerometer says."""
    dip_spread_rad: float | None
    directions: Matrix
    """(N, 3) unit vectors, of all samples after calibration."""

    @property
    def verdict(self) -> str:
        """How good that is, in words."""
        return "excellent" if self.residual < 0.015 else "good" if self.residual < 0.035 else "usable"


def fit_magnetometer(
    samples: Sequence[MagSample], expected: MagneticField | None, inertial: Sequence[ImuSample] = ()
) -> MagFit:
    """Return the ellipsoid of readings that were taken in all directions.

    Args:
        samples: In any axes that are fixed to the sensor.
        expected: The field by the World Magnetic Model, which sets the scale; None keeps the sensor's own.
        inertial: In the same axes and by the same clock, for the dip.

    Raises:
        InputError: Too few directions, a field that changed while it turned, or one that no place has; with the remedy.
    """
    field = np.array([sample.field_body_t for sample in samples]).reshape(-1, 3)
    if len(field) < LEAST_SAMPLES:
        raise InputError(
            f"There are {len(field)} readings of the magnetometer, expected at least {LEAST_SAMPLES}: turn the rig for longer."
        )
    centre, spread = (
        np.median(field, axis=0),
        float(np.median(np.linalg.norm(field - np.median(field, axis=0), axis=1))),
    )
    seen = directions_seen(field)
    if spread <= 0.0 or seen < LEAST_COVERAGE:
        raise InputError(_too_few(seen))
    points = (field - centre) / spread
    offset, matrix, sigma, sizes = _ellipsoid(points[_moving(points)])
    sizes = np.linalg.norm((points - offset) @ matrix.T, axis=1)
    stretch = np.linalg.eigvalsh(matrix)
    if stretch[0] <= 0.0 or stretch[-1] / stretch[0] > LARGEST_STRETCH:
        raise InputError(_too_few(seen))
    residual = float(1.4826 * np.median(np.abs(sizes - 1.0)))
    directions = (points - offset) @ matrix.T / np.maximum(sizes, 1e-9)[:, None]
    coverage = float(np.mean(_bins(directions) > 0))
    if coverage < LEAST_COVERAGE or sigma > LARGEST_SIGMA:
        raise InputError(_too_few(coverage))
    if residual > LARGEST_RESIDUAL:
        raise InputError(
            f"The field's strength still differs by {residual:.0%} from direction to direction, expected {LARGEST_RESIDUAL:.0%} "
            "at most: go away from cars, fences and steel in walls, take off what is magnetic, and turn more slowly."
        )
    measured_t = spread / float(np.cbrt(np.linalg.det(matrix)))
    strength_t = measured_t if expected is None else expected.strength_t
    if not 1.0 / LARGEST_RATIO < measured_t / strength_t < LARGEST_RATIO:
        raise InputError(
            f"The sensor shows {measured_t * 1e6:.1f} µT, but here the Earth's field has {strength_t * 1e6:.1f}: "
            "go away from iron, and check the place and the sensor's units."
        )
    dip = _dip(samples, inertial, directions)
    return MagFit(
        centre + spread * offset,
        matrix * (strength_t / spread),
        strength_t,
        measured_t,
        residual,
        coverage,
        None if dip is None else dip[0],
        None if dip is None else dip[1],
        directions,
    )


def _too_few(share: float) -> str:
    return (
        f"The rig was turned through {share:.0%} of all directions, expected at least {LEAST_COVERAGE:.0%}: turn it slowly "
        "about each of its three axes, all the way round, as if to draw a ball."
    )


def _moving(points: Matrix) -> list[int]:
    """Return the places of the readings that differ from the last one kept."""
    kept = [0]
    for i in range(1, len(points)):
        if float(np.abs(points[i] - points[kept[-1]]).max()) > _NEAREST:
            kept.append(i)
    return kept


# -- the ellipsoid ----------------------------------------------------------------------------------------------------


def _ellipsoid(points: Matrix) -> tuple[Matrix, Matrix, float, Matrix]:
    """Return (offset, matrix, sigma, sizes) with |matrix (points - offset)| = sizes near 1.

    First by least squares on the quadric, then by Gauss-Newton on the distances with Cauchy's weights, so that an iron post
    passed by does not bend it.

    Args:
        points: (N, 3), of about unit size about zero.

    Returns:
        (3,), symmetric (3, 3), the standard error of the offset along its worst axis, (N,).
    """
    offset, matrix = _quadric(points)
    damping = 1e-6
    cost, slopes, left, weights = _misfit(points, offset, matrix)
    for _ in range(_STEPS):
        normal = (slopes * weights[:, None]).T @ slopes
        step = -np.linalg.solve(
            normal + damping * np.diag(np.diag(normal) + 1e-9), (slopes * weights[:, None]).T @ left
        )
        xx, yy, zz, xy, xz, yz = step[3:]
        trial = offset + step[:3], matrix + np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        trial_cost, *rest = _misfit(points, *trial)
        if not trial_cost < cost:
            damping *= 10.0
            if damping > 1e6:
                break
            continue
        done = cost - trial_cost < 1e-12 * cost
        (offset, matrix), cost, (slopes, left, weights) = trial, trial_cost, rest
        damping = max(1e-9, 0.1 * damping)
        if done:
            break
    normal = (slopes * weights[:, None]).T @ slopes
    # neighbouring readings share their error: about a fifth of them are independent
    variance = 5.0 * float(np.sum(weights * left**2) / np.sum(weights))
    covariance = np.linalg.inv(normal + 1e-9 * np.eye(9))[:3, :3] * variance
    return offset, matrix, float(np.sqrt(np.linalg.eigvalsh(covariance)[-1])), left + 1.0


def _misfit(points: Matrix, offset: Matrix, matrix: Matrix) -> tuple[float, Matrix, Matrix, Matrix]:
    """Return Cauchy's cost, the (N, 9) slopes, the (N,) distances from the unit sphere, and their weights."""
    moved = points - offset
    fixed = moved @ matrix.T
    sizes = np.linalg.norm(fixed, axis=1)
    x, y, z = moved.T
    a, b, c = (fixed / np.maximum(sizes, 1e-9)[:, None]).T
    by_matrix = np.stack([a * x, b * y, c * z, a * y + b * x, a * z + c * x, b * z + c * y], axis=1)
    slopes = np.column_stack([-np.stack([a, b, c], axis=1) @ matrix, by_matrix])
    left = sizes - 1.0
    weights = 1.0 / (1.0 + (left / _CAUCHY) ** 2)
    return float(np.sum(np.log1p((left / _CAUCHY) ** 2))), slopes, left, weights


def _quadric(points: Matrix) -> tuple[Matrix, Matrix]:
    """Return the ellipsoid of least squares, (3,) and (3, 3); a sphere about the median where there is none."""
    x, y, z = points.T
    design = np.column_stack([x * x, y * y, z * z, 2 * x * y, 2 * x * z, 2 * y * z, 2 * x, 2 * y, 2 * z])
    p, *_ = np.linalg.lstsq(design, np.ones(len(points)), rcond=None)
    A = np.array([[p[0], p[3], p[4]], [p[3], p[1], p[5]], [p[4], p[5], p[2]]])
    sphere = (np.zeros(3), np.eye(3) / float(np.median(np.linalg.norm(points, axis=1))))
    if np.linalg.matrix_rank(A) < 3:
        return sphere
    offset = -np.linalg.solve(A, p[6:])
    values, axes = np.linalg.eigh(A / (1.0 + offset @ A @ offset))
    if values[0] <= 0.0:
        return sphere
    return offset, axes @ np.diag(np.sqrt(values)) @ axes.T


# -- coverage and dip -------------------------------------------------------------------------------------------------


def sphere_points(count: int = DIRECTIONS) -> Matrix:
    """Return (count, 3) unit vectors that are evenly spread (Fibonacci's spiral)."""
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, np.pi * (1.0 + 5.0**0.5) * k
    ring = np.sqrt(1.0 - z * z)
    return np.column_stack([ring * np.cos(turn), ring * np.sin(turn), z])


def _bins(directions: Matrix) -> Matrix:
    """Return (60,) how many directions fall nearest to each of the evenly spread ones."""
    counts = np.bincount(np.argmax(directions @ sphere_points().T, axis=1), minlength=DIRECTIONS)
    return counts.astype(np.float64)


def directions_seen(field: Matrix) -> float:
    """Return the share of directions that (N, 3) raw readings show, about the middle of their range: for the way there."""
    middle = 0.5 * (field.min(axis=0) + field.max(axis=0)) if len(field) else np.zeros(3)
    off = field - middle
    sizes = np.linalg.norm(off, axis=1)
    good = sizes > 0.3 * float(np.median(sizes)) if len(field) else np.zeros(0, np.bool_)
    good &= sizes > 0.0
    return float(np.mean(_bins(off[good] / sizes[good, None]) > 0)) if np.any(good) else 0.0


def _dip(samples: Sequence[MagSample], inertial: Sequence[ImuSample], directions: Matrix) -> tuple[float, float] | None:
    """Return the dip below the horizon and its spread, by gravity while the rig was not shaken."""
    if len(inertial) < 2:
        return None
    t_ns = np.array([sample.t_ns for sample in inertial])
    accel = np.array([sample.accel_m_s2 for sample in inertial])
    nearest = np.clip(np.searchsorted(t_ns, [sample.t_ns for sample in samples]), 0, len(t_ns) - 1)
    lengths = np.linalg.norm(accel[nearest], axis=1)
    still = np.abs(lengths - 9.81) < 0.5
    if np.count_nonzero(still) < LEAST_SAMPLES:
        return None
    up = accel[nearest][still] / lengths[still, None]
    dips = np.arcsin(np.clip(-np.einsum("ni,ni->n", directions[still], up), -1.0, 1.0))
    middle = float(np.median(dips))
    return middle, 1.4826 * float(np.median(np.abs(dips - middle)))
