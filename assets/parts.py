"""Parts that ancient buildings share: rows of columns, steps, arches, vaults, doors. Each adds itself to a shape."""

import numpy as np

from assets.axes import Array
from assets.shape import Shape

STEPS_OUT_M = 1.0
"""How far the steps of a temple may stand out from its stylobate."""
FOUNDATION_M = 1.6
"""How far walls and floors go on below their level, so that no slope of the ground shows a gap."""
Faces = tuple[float, float, float, float]
"""x from and to, y from and to."""


def revolved(shape: Shape, material: str, profile: Array, sides: int, tint: float = 1.0) -> None:
    """Add a surface turned about z through `profile`, (n, 2) radius and height from bottom to top."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    points = np.concatenate(
        [ring[:, None] * profile[None, :, :1], np.broadcast_to(profile[:, 1:], (sides + 1, len(profile), 1))], axis=2
    )
    shape.surface(material, points, tint)


def row(start: tuple[float, float], end: tuple[float, float], count: int, z_m: float = 0.0) -> Array:
    """Return `count` points (count, 3) from `start` to `end`, both included."""
    share = np.linspace(0.0, 1.0, count)[:, None]
    line = np.asarray(start) * (1.0 - share) + np.asarray(end) * share
    return np.concatenate([line, np.full((count, 1), z_m)], axis=1)


def ring(x0: float, x1: float, y0: float, y1: float, across: int, along: int) -> Array:
    """Return the column places (n, 3) of a peristyle: `along` on the sides of x, `across` on the sides of y, corners once."""
    xs, ys = np.linspace(x0, x1, along), np.linspace(y0, y1, across)
    places = [(x, y, 0.0) for x in xs for y in (y0, y1)] + [(x, y, 0.0) for y in ys[1:-1] for x in (x0, x1)]
    return np.array(places)


def steps(shape: Shape, x0: float, x1: float, y0: float, y1: float, rise_m: float, count: int) -> None:
    """Add a platform whose top is at z = 0 with `count` steps down all around; they stand out less than `STEPS_OUT_M`."""
    for i in range(count):
        out, top = i * min(0.33, STEPS_OUT_M / count), -i * rise_m / count
        shape.box("marble", (x0 - out, y0 - out, -rise_m - 1.0), (x1 + out, y1 + out, top), 1.0 - 0.03 * (i % 2))


def walls(
    shape: Shape, material: str, x0: float, x1: float, y0: float, y1: float, z0: float, z1: float, thick_m: float = 0.7
) -> None:
    """Add four walls around a rectangle."""
    t = thick_m
    low = np.array([(x0, y0, z0), (x0, y1 - t, z0), (x0, y0 + t, z0), (x1 - t, y0 + t, z0)])
    high = np.array([(x1, y0 + t, z1), (x1, y1, z1), (x0 + t, y1 - t, z1), (x1, y1 - t, z1)])
    shape.boxes(material, low, high)


def arch(
    shape: Shape,
    material: str,
    centre_x: float,
    span_m: float,
    y0: float,
    y1: float,
    spring_m: float,
    top_m: float,
    sides: int = 14,
) -> None:
    """Add what stands over a round opening from y0 to y1: spandrels to `top_m` and the curved underside."""
    angle = np.linspace(np.pi, 0.0, sides + 1)
    x, z = centre_x + span_m / 2.0 * np.cos(angle), spring_m + span_m / 2.0 * np.sin(angle)
    low, high = np.stack([x, z], -1), np.stack([x, np.full_like(x, top_m)], -1)
    outline = np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)
    front = np.insert(outline, 1, y0, axis=2)
    shape.polygons(material, front)
    shape.polygons(material, np.insert(outline[:, ::-1], 1, y1, axis=2))
    curve = np.stack([np.stack([x, np.full_like(x, y), z], -1) for y in (y0, y1)])
    shape.surface(material, curve, 0.8)
    left, right = centre_x - span_m / 2.0, centre_x + span_m / 2.0
    shape.polygons(material, [(left, y0, top_m), (right, y0, top_m), (right, y1, top_m), (left, y1, top_m)])


def vault(
    shape: Shape, material: str, x0: float, x1: float, y0: float, y1: float, spring_m: float, crown_m: float, end: str
) -> None:
    """Add a barrel vault along y, seen from outside, with end walls of `end`."""
    angle = np.linspace(0.0, np.pi, 13)
    x = (x0 + x1) / 2.0 + (x1 - x0) / 2.0 * np.cos(angle)
    z = spring_m + (crown_m - spring_m) * np.sin(angle)
    points = np.stack([np.stack([x, np.full_like(x, y), z], -1) for y in (y0, y1)], axis=1)
    shape.surface(material, points[:, ::-1])
    shape.polygons(end, points[:, 0])
    shape.polygons(end, points[::-1, 1])


def prism(shape: Shape, material: str, outline: Array, low_m: float, high_m: float) -> None:
    """Add a solid with vertical sides over a convex outline (n, 2), counter-clockwise, with its top."""
    shape.polygons(material, _sides(outline, low_m, high_m))
    shape.polygons(material, np.column_stack([outline, np.full(len(outline), high_m)]))


def ring_wall(shape: Shape, material: str, outline: Array, thick_m: float, low_m: float, high_m: float) -> None:
    """Add a wall along the inside of a convex outline (n, 2), counter-clockwise, with its top."""
    inner = offset(outline, -thick_m)
    shape.polygons(material, _sides(outline, low_m, high_m))
    shape.polygons(material, _sides(inner[::-1], low_m, high_m), 0.92)
    top = np.full((len(outline), 1), high_m)
    a, b = np.hstack([outline, top]), np.hstack([inner, top])
    shape.polygons(material, np.stack([a, np.roll(a, -1, axis=0), np.roll(b, -1, axis=0), b], axis=1))


def _sides(outline: Array, low_m: float, high_m: float) -> Array:
    following = np.roll(outline, -1, axis=0)
    low, high = np.full(len(outline), low_m), np.full(len(outline), high_m)
    bottom = [np.column_stack([outline, low]), np.column_stack([following, low])]
    top = [np.column_stack([following, high]), np.column_stack([outline, high])]
    return np.stack([*bottom, *top], axis=1)


def offset(outline: Array, out_m: float) -> Array:
    """Return a convex outline (n, 2), counter-clockwise, with every edge moved out by `out_m`."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.stack([edges[:, 1], -edges[:, 0]], -1) / np.linalg.norm(edges, axis=1, keepdims=True)
    before = np.roll(normals, 1, axis=0)
    return np.asarray(outline + out_m * (normals + before) / (1.0 + (normals * before).sum(axis=1, keepdims=True)))


def floor(shape: Shape, length_m: float, width_m: float) -> None:
    """Add a paved floor at z = 0 on a foundation edged with marble."""
    corners = np.array([(0.0, 0.0), (length_m, 0.0), (length_m, width_m), (0.0, width_m)])
    shape.polygons("marble", _sides(corners, -FOUNDATION_M, 0.0), 0.96)
    shape.polygons("paving", np.column_stack([corners, np.zeros(4)]))


def pierced(
    shape: Shape, material: str, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float],
    openings: list[tuple[float, float, float, float]],
) -> None:  # fmt: skip
    """Add a wall along x with openings of (middle, width, sill, head), from left to right."""
    at = x[0]
    for middle, width, sill, head in sorted(openings):
        left, right = middle - width / 2.0, middle + width / 2.0
        shape.box(material, (at, y[0], z[0]), (left, y[1], z[1]))
        if sill > z[0]:
            shape.box(material, (left, y[0], z[0]), (right, y[1], sill))
        shape.box(material, (left, y[0], head), (right, y[1], z[1]))
        shape.polygons(
            material, [(left, y[1], head), (right, y[1], head), (right, y[0], head), (left, y[0], head)], 0.8
        )
        at = right
    shape.box(material, (at, y[0], z[0]), (x[1], y[1], z[1]))


def surround(
    shape: Shape, x_m: float, y_m: float, size_m: tuple[float, float], facing: float, z_m: float = 0.0
) -> None:
    """Add the marble frame of a door of width and height on a wall along x at `y_m` that looks to -y (-1) or +y (1)."""
    half, height = size_m[0] / 2.0, size_m[1]
    low, high = sorted((y_m, y_m + 0.14 * facing))
    for side in (-half - 0.16, half + 0.16):
        shape.box("marble", (x_m + side - 0.16, low, z_m), (x_m + side + 0.16, high, z_m + height + 0.3))
    shape.box("marble", (x_m - half, low, z_m + height), (x_m + half, high, z_m + height + 0.3), 0.96)
    low, high = sorted((y_m, y_m + 0.3 * facing))
    shape.slab("marble", (x_m - half - 0.45, low, z_m + height + 0.38), (x_m + half + 0.45, high, z_m + height + 0.56))


def leaves(shape: Shape, x_m: float, y_m: float, size_m: tuple[float, float], facing: float, z_m: float = 0.0) -> None:
    """Add the two panelled leaves of a closed door."""
    half, height = size_m[0] / 2.0, size_m[1]
    low, high = sorted((y_m, y_m + 0.03 * facing))
    shape.box("wood", (x_m - half, low, z_m), (x_m + half, high, z_m + height))
    low, high = sorted((y_m, y_m + 0.08 * facing))
    for side in (-0.5, 0.5):
        for share in (0.27, 0.74):
            middle, tall = x_m + side * half, z_m + share * height
            shape.box(
                "wood",
                (middle - 0.34 * half, low, tall - 0.19 * height),
                (middle + 0.34 * half, high, tall + 0.19 * height),
                0.8,
            )


def door(shape: Shape, x_m: float, y_m: float, size_m: tuple[float, float], facing: float, z_m: float = 0.0) -> None:
    """Add a closed wooden door in its marble frame."""
    surround(shape, x_m, y_m, size_m, facing, z_m)
    leaves(shape, x_m, y_m, size_m, facing, z_m)


def pilasters(shape: Shape, x: Array, y_m: float, z: tuple[float, float], width_m: float, out_m: float) -> None:
    """Add flat pillars with foot and capital on a wall that looks to -y, along x at each of `x`."""
    o = np.ones_like(x)
    low, high, half = z[0], z[1], width_m / 2.0
    for a, b, wide, out in (
        (low, low + 0.35 * width_m, half * 1.2, out_m * 1.5),
        (low + 0.35 * width_m, high - 0.55 * width_m, half, out_m),
        (high - 0.55 * width_m, high - 0.2 * width_m, half * 1.12, out_m * 1.3),
        (high - 0.2 * width_m, high, half * 1.3, out_m * 1.8),
    ):
        shape.boxes(
            "marble",
            np.stack([x - wide, o * (y_m - out), o * a], -1),
            np.stack([x + wide, o * y_m, o * b], -1),
        )


def moulded(shape: Shape, material: str, faces: Faces, z: tuple[float, float], foot_m: float = 0.5) -> None:
    """Add a block with a foot, a dado and a cornice."""
    x0, x1, y0, y1 = faces
    low, high = z
    rows = ((low, low + 0.6 * foot_m, 0.15), (low + 0.6 * foot_m, low + foot_m, 0.07), (low + foot_m, high - 0.5, 0.0),
            (high - 0.5, high - 0.25, 0.1), (high - 0.25, high, 0.25))  # fmt: skip
    for a, b, out in rows:
        shape.slab(material if out == 0.0 else "marble", (x0 - out, y0 - out, a), (x1 + out, y1 + out, b))
