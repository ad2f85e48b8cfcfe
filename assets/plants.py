"""Plants as clouds of leaves: small triangles that take the light of the crown they belong to."""

import numpy as np

from assets import parts
from assets.axes import Array
from assets.shape import Shape, unit


def crown(
    shape: Shape, rng: np.random.Generator, middle_m: Array, radii_m: Array, leaves: int, leaf_m: float, tint: Array
) -> None:
    """Add an ellipsoid of leaves about `middle_m` (3,); light falls on them as on the ellipsoid."""
    towards = unit(rng.normal(0.0, 1.0, (leaves, 3)))
    depth = rng.uniform(0.72, 1.08, (leaves, 1))
    lumps = 1.0 + 0.16 * np.sin(towards @ rng.normal(0.0, 3.0, (3, 3)) + rng.uniform(0.0, 6.0, 3)).sum(
        axis=1, keepdims=True
    )
    places = middle_m + towards * radii_m * depth * lumps
    corners = places[:, None] + rng.normal(0.0, leaf_m, (leaves, 3, 3))
    shade = np.clip(0.62 + 0.34 * towards[:, 2:] + 0.5 * (depth - 0.9), 0.3, 1.1) * rng.uniform(0.75, 1.1, (leaves, 1))
    shape.leaves("leaves", corners, unit(towards / radii_m), shade * tint)


def core(shape: Shape, middle_m: Array, radii_m: Array, tint: Array, sides: int) -> None:
    """Add the dark inside of a crown, so that nothing shows through it."""
    rise = np.linspace(-0.9, 1.5, 3)
    profile = np.stack([radii_m[0] * np.cos(rise), middle_m[2] + radii_m[2] * np.sin(rise)], -1)
    part = Shape()
    parts.revolved(part, "leaves", profile, sides, float(tint.mean()) * 0.62)
    shape.copies(part, np.array([[middle_m[0], middle_m[1], 0.0]]))


SHARE = (1.0, 0.5, 0.0)
"""By level: how many of a crown's leaves are drawn; fewer are larger."""


def _foliage(
    shape: Shape,
    rng: np.random.Generator,
    middle: Array,
    radii: Array,
    leaves: tuple[int, float],
    tint: Array,
    level: int,
) -> None:
    """Add a crown of so many leaves of that size in metres, and its dark inside, which alone is left at the coarsest level."""
    count, leaf_m = leaves
    share = SHARE[level]
    if share > 0.0:
        crown(shape, rng, middle, radii, round(count * share), leaf_m / np.sqrt(share), tint)
    core(
        shape,
        middle,
        radii * (0.62 if share > 0.0 else 0.95),
        tint * (1.0 if share > 0.0 else 1.25),
        5 if count > 10 else 4,
    )


def bush(rng: np.random.Generator, level: int = 0) -> Shape:
    """Return a shrub of about a metre."""
    shape = Shape()
    tint = _green(rng)
    for _ in range(3):
        middle = np.array([*rng.normal(0.0, 0.28, 2), rng.uniform(0.25, 0.45)])
        radii = np.array([0.5, 0.5, 0.42]) * rng.uniform(0.7, 1.1)
        _foliage(shape, rng, middle, radii, (62, 0.085), tint, level)
    return shape


def slope_bush(rng: np.random.Generator, level: int = 0) -> Shape:
    """Return a shrub of about a metre to be seen from thirty metres and more."""
    shape, tint = Shape(), _green(rng)
    middle = np.array([*rng.normal(0.0, 0.1, 2), rng.uniform(0.3, 0.4)])
    _foliage(shape, rng, middle, np.array([0.7, 0.6, 0.45]) * rng.uniform(0.8, 1.1), (40, 0.12), tint, level)
    return shape


def far_bush(rng: np.random.Generator, level: int = 0) -> Shape:
    """Return a shrub of about a metre for the slopes: few leaves, large ones."""
    shape, tint = Shape(), _green(rng)
    radii = np.array([0.6, 0.6, 0.45]) * rng.uniform(0.8, 1.1)
    _foliage(shape, rng, np.array([0.0, 0.0, 0.3]), radii, (5, 0.3), tint, level)
    return shape


def _green(rng: np.random.Generator) -> Array:
    """A tint between the grey of thyme and the green of mastic."""
    return np.array([0.92, 0.92, 0.80]) * rng.uniform(0.7, 1.05) + np.array([0.08, 0.03, -0.06]) * rng.normal()


def tree(rng: np.random.Generator, level: int = 0) -> Shape:
    """Return a broad tree (pine, olive, fig) of about six metres."""
    shape = Shape()
    parts.revolved(shape, "wood", np.array([(0.24, -0.3), (0.17, 1.4), (0.1, 3.4)]), 6, 0.75)
    tint = np.array([0.80, 0.86, 0.66]) * rng.uniform(0.8, 1.05)
    for _ in range(6):
        middle = np.array([*rng.normal(0.0, 1.0, 2), rng.uniform(2.9, 4.7)])
        radii = np.array([1.3, 1.3, 0.95]) * rng.uniform(0.7, 1.1)
        _foliage(shape, rng, middle, radii, (48, 0.27), tint, level)
    return shape


def cypress(rng: np.random.Generator, level: int = 0) -> Shape:
    """Return a slender tree of about nine metres."""
    shape = Shape()
    parts.revolved(shape, "wood", np.array([(0.2, -0.3), (0.14, 1.0)]), 6, 0.7)
    tint = np.array([0.58, 0.70, 0.50]) * rng.uniform(0.85, 1.05)
    for share in np.linspace(0.0, 1.0, 6):
        radius = 0.95 * (1.0 - 0.72 * share) * rng.uniform(0.9, 1.1)
        middle = np.array([*rng.normal(0.0, 0.06, 2), 1.4 + 6.6 * share])
        radii = np.array([radius, radius, 1.15])
        _foliage(shape, rng, middle, radii, (32, 0.2), tint, level)
    return shape


def clump(rng: np.random.Generator) -> Shape:
    """Return a handful of tufts of dry grass about (0, 0, 0)."""
    shape, count = Shape(), 8
    places = np.column_stack([rng.normal(0.0, 0.42, (count, 2)), np.zeros(count)])
    tufts(shape, rng, places, rng.uniform(0.08, 0.3, count))
    return shape


def tufts(shape: Shape, rng: np.random.Generator, places_m: Array, height_m: Array) -> None:
    """Add tufts of dry grass at (k, 3) places with blades up to (k,) high."""
    blades = 6
    k = len(places_m)
    lean = rng.normal(0.0, 0.42, (k, blades, 2))
    turn = rng.uniform(0.0, np.pi, (k, blades))
    half = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], -1) * rng.uniform(0.008, 0.024, (k, blades, 1))
    root = places_m[:, None] + np.concatenate(
        [rng.normal(0.0, 0.07, (k, blades, 2)), np.full((k, blades, 1), -0.02)], -1
    )
    tall = height_m[:, None, None] * rng.uniform(0.6, 1.0, (k, blades, 1))
    tip = root + tall * np.concatenate([lean, np.ones((k, blades, 1))], -1)
    corners = np.stack([root - half, root + half, tip], axis=2).reshape(-1, 3, 3)
    greenness = rng.beta(1.0, 2.6, (k, 1, 1))
    straw, green = np.array([0.95, 0.93, 0.86]), np.array([0.62, 0.72, 0.50])
    tint = (straw * (1.0 - greenness) + green * greenness) * rng.uniform(0.72, 1.05, (k, blades, 1))
    normals = np.tile((0.0, 0.0, 1.0), (len(corners), 1))
    shape.leaves("straw", corners, normals, tint.reshape(-1, 3))
