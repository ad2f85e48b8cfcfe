"""What ruins are made of: blocks, stacks, drums and broken walls. Each adds itself to a shape; the generator decides how."""

import numpy as np

from assets import parts
from assets.axes import Array
from assets.shape import Shape

Point = tuple[float, float]
COURSE_M = 0.42
"""Height of one course of a wall."""
DRUM_SIDES = 14


def blocks(
    shape: Shape, rng: np.random.Generator, centres_m: Array, sizes_m: Array, yaw_rad: Array, wear: float = 0.035
) -> None:
    """Add worn blocks: (k, 3) middles of their undersides, (k, 3) sizes, (k,) turns about z, corners off by `wear` of a side."""
    k = len(centres_m)
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 1.0)])
    worn = corners[None] * sizes_m[:, None] + rng.normal(0.0, wear, (k, 8, 3)) * np.minimum(sizes_m, 1.0)[:, None]
    worn[:, ::2, 2] -= 0.06
    sin, cos = np.sin(yaw_rad)[:, None], np.cos(yaw_rad)[:, None]
    x, y = worn[..., 0] * cos - worn[..., 1] * sin, worn[..., 0] * sin + worn[..., 1] * cos
    points = np.stack([x, y, worn[..., 2]], -1) + centres_m[:, None]
    faces = np.array([[1, 5, 7, 3], [0, 4, 5, 1], [4, 6, 7, 5], [6, 2, 3, 7], [2, 0, 1, 3]])
    tones = np.repeat(tone(rng, k), 5, axis=0)
    shape.polygons("stone", points[:, faces].reshape(-1, 4, 3), tones)


def tone(rng: np.random.Generator, count: int, spread: float = 0.09) -> Array:
    """Return tints (count, 3) of weathered stone: lighter and darker, greyer and warmer."""
    level = np.clip(rng.normal(0.84, spread, (count, 1)), 0.5, 1.0)
    warmth = rng.normal(0.0, 0.03, (count, 1))
    return np.asarray(np.clip(level * np.hstack([1.0 + warmth, np.ones((count, 1)), 1.0 - 1.6 * warmth]), 0.0, 1.0))


def stack(shape: Shape, rng: np.random.Generator, x: float, y: float, z: float, yaw_rad: float) -> None:
    """Add blocks laid up for safe keeping: a row of them, others on top."""
    longest = int(rng.integers(2, 6))
    for layer in range(int(rng.integers(1, min(longest, 3) + 1))):
        count = longest - layer
        along = (np.arange(count) - (count - 1) / 2.0) * 0.78 + rng.normal(0.0, 0.05, count)
        sizes = np.stack(
            [rng.uniform(0.5, 0.72, count), rng.uniform(0.7, 1.5, count), rng.uniform(0.38, 0.5, count)], -1
        )
        across = rng.normal(0.0, 0.08, count)
        cos, sin = np.cos(yaw_rad), np.sin(yaw_rad)
        middles = np.stack(
            [x + along * cos - across * sin, y + along * sin + across * cos, np.full(count, z + layer * 0.46)], -1
        )
        blocks(shape, rng, middles, sizes, yaw_rad + rng.normal(0.0, 0.05, count))


def scatter(shape: Shape, rng: np.random.Generator, middles_m: Array, largest_m: float) -> None:
    """Add fallen blocks of all sizes at (k, 3) places."""
    k = len(middles_m)
    size = largest_m * rng.beta(1.6, 3.0, k)[:, None] + 0.12
    sizes = size * np.stack([rng.uniform(0.7, 1.3, k), rng.uniform(0.6, 1.1, k), rng.uniform(0.35, 0.7, k)], -1)
    blocks(shape, rng, middles_m, sizes, rng.uniform(0.0, np.pi, k), 0.09)


def broken_wall(
    shape: Shape,
    rng: np.random.Generator,
    material: str,
    start: Point,
    end: Point,
    thick_m: float,
    heights_m: tuple[float, float],
    foot_m: float = 0.0,
) -> None:
    """Add a wall that stands to unequal heights between the two given, above `foot_m`; its middle runs from start to end."""
    run = np.subtract(end, start)
    length, yaw = float(np.hypot(*run)), float(np.arctan2(run[1], run[0]))
    count = max(3, round(length / 0.7))
    edges = np.linspace(0.0, length, count + 1)
    edges[1:-1] += rng.uniform(-0.3, 0.3, count - 1) * length / count
    walk = np.convolve(rng.normal(0.0, 1.0, count + 12), np.hanning(15)[1:-1] / 3.2, mode="valid")
    tops = heights_m[0] + (heights_m[1] - heights_m[0]) * np.clip(0.42 + 0.3 * walk, 0.0, 1.0)
    tops = np.maximum(np.floor(tops / COURSE_M + rng.uniform(0.35, 0.65, count)), 1.0) * COURSE_M
    tops += rng.normal(0.0, 0.04, count)
    half = thick_m / 2.0 + rng.uniform(-0.03, 0.03, count)
    low = np.stack([edges[:-1], -half, np.full(count, foot_m - 1.2)], -1)
    part = Shape()
    part.boxes(material, low, np.stack([edges[1:], half, foot_m + tops], -1), tone(rng, count, 0.05))
    shape.copies(part, np.array([[start[0], start[1], 0.0]]), np.array([yaw]))


def broken_walls(
    shape: Shape, rng: np.random.Generator, material: str, size_m: Point, thick_m: float, heights_m: tuple[float, float]
) -> None:
    """Add broken walls around a rectangle from the origin."""
    (x1, y1), t = size_m, thick_m / 2.0
    corners = [(t, t), (x1 - t, t), (x1 - t, y1 - t), (t, y1 - t)]
    for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
        broken_wall(shape, rng, material, start, end, thick_m, heights_m)


def drum(diameter_m: float, height_m: float) -> Shape:
    """Return an upright column drum at (0, 0, 0)."""
    shape, radius = Shape(), diameter_m / 2.0
    parts.revolved(
        shape, "stone", np.array([(radius, -0.1), (radius, 0.5 * height_m), (0.98 * radius, height_m)]), DRUM_SIDES
    )
    shape.polygons("stone", _disc(0.98 * radius, height_m))
    return shape


def _disc(radius_m: float, z_m: float) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, DRUM_SIDES, endpoint=False)
    return np.stack([radius_m * np.cos(angle), radius_m * np.sin(angle), np.full(DRUM_SIDES, z_m)], -1)


def lying_drum(diameter_m: float, length_m: float) -> Shape:
    """Return a drum that lies along x, on z = 0."""
    shape, radius = Shape(), diameter_m / 2.0
    angle = np.linspace(0.0, 2.0 * np.pi, DRUM_SIDES + 1)
    y, z = radius * np.cos(angle), radius * np.sin(angle) + 0.92 * radius
    halves = [np.stack([np.full_like(y, x), y, z], -1) for x in (-length_m / 2.0, length_m / 2.0)]
    shape.surface("stone", np.stack(halves, axis=1))
    shape.polygons("stone", halves[1][:-1])
    shape.polygons("stone", halves[0][:0:-1])
    return shape


def inside(rng: np.random.Generator, count: int, length_m: float, width_m: float, z_m: float) -> Array:
    """Return places (count, 3) all over a rectangle from the origin, at one level."""
    return np.stack(
        [rng.uniform(0.4, length_m - 0.4, count), rng.uniform(0.4, width_m - 0.4, count), np.full(count, z_m)], -1
    )


def stumps(shape: Shape, rng: np.random.Generator, places_m: Array, diameter_m: float, highest_m: float) -> None:
    """Add what is left of columns: a few drums, at most places nothing."""
    for place in places_m[rng.random(len(places_m)) < 0.45]:
        height = float(rng.uniform(0.25, 1.0) ** 2 * highest_m + 0.2)
        shape.copies(drum(diameter_m, height), place[None], rng.uniform(0.0, 6.0, 1))


def drums(shape: Shape, rng: np.random.Generator, places_m: Array, diameter_m: float) -> None:
    """Add lying drums at (k, 3) places."""
    for place in places_m:
        part = lying_drum(diameter_m * float(rng.uniform(0.85, 1.0)), float(rng.uniform(0.7, 1.9)))
        shape.copies(part, place[None], rng.uniform(0.0, np.pi, 1))


def row_of_blocks(
    shape: Shape, rng: np.random.Generator, start: Array, end: Array, size: tuple[float, float], z: float
) -> None:
    """Add a stylobate: blocks end to end, some of them missing."""
    length = float(np.hypot(*(end - start)))
    count = max(2, round(length / 1.15))
    share = (np.arange(count) + 0.5)[:, None] / count
    middles = np.column_stack([start + (end - start) * share, np.full(count, z) + rng.normal(0.0, 0.02, count)])
    kept = rng.random(count) > 0.14
    sizes = np.tile([length / count * 0.98, *size], (count, 1))
    yaw = np.full(count, np.arctan2(*(end - start)[::-1])) + rng.normal(0.0, 0.012, count)
    blocks(shape, rng, middles[kept], sizes[kept], yaw[kept])
