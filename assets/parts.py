"""Parts that ancient buildings share: columns, steps, roofs, arches, vaults. Each adds itself to a shape."""

import numpy as np

from assets.axes import Array
from assets.shape import Shape

COLUMN_SIDES = 12
ROOF_SLOPE = np.tan(np.radians(17.5))
EAVE_M = 0.5
"""How far a roof stands out."""
STEPS_OUT_M = 1.0
"""How far the steps of a temple may stand out from its stylobate."""


def column(diameter_m: float, height_m: float, plain: bool = False, sides: int = COLUMN_SIDES) -> Shape:
    """Return one column at (0, 0, 0): plinth, torus, tapering shaft, capital; `plain` is Doric, without plinth."""
    radius = diameter_m / 2.0
    base = 0.0 if plain else 0.35 * diameter_m
    capital = 0.5 * diameter_m if plain else 0.8 * diameter_m
    profile = [
        (1.0, base),
        (0.97, base + 0.35 * height_m),
        (0.84, height_m - capital),
        (1.28, height_m - 0.4 * capital),
    ]
    if not plain:
        profile = [(1.3, 0.5 * base), (1.3, 0.8 * base), *profile]
    shape = Shape()
    revolved(shape, "marble", np.array(profile) * (radius, 1.0), sides)
    half = radius * 1.36
    shape.box("marble", (-half, -half, height_m - 0.4 * capital), (half, half, height_m))
    if not plain:
        shape.box("marble", (-half, -half, 0.0), (half, half, 0.5 * base))
    return shape


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


def gable(
    shape: Shape, x0: float, x1: float, y0: float, y1: float, eave_m: float, ridge_m: float, wall: str = "marble"
) -> None:
    """Add a tiled roof with its ridge along x, gables of `wall` at both ends and a cornice all around."""
    middle, out = (y0 + y1) / 2.0, EAVE_M
    ends = np.array(
        [
            [(x1, y0, eave_m), (x1, y1, eave_m), (x1, middle, ridge_m)],
            [(x0, y1, eave_m), (x0, y0, eave_m), (x0, middle, ridge_m)],
        ]
    )
    shape.polygons(wall, ends, 0.92)
    drop = out * (ridge_m - eave_m) / (middle - y0)
    low, a, b = eave_m - drop, x0 - out, x1 + out
    south = [(a, y0 - out, low), (b, y0 - out, low), (b, middle, ridge_m), (a, middle, ridge_m)]
    north = [(b, y1 + out, low), (a, y1 + out, low), (a, middle, ridge_m), (b, middle, ridge_m)]
    shape.polygons("tiles", np.array([south, north]))
    shape.polygons("wood", np.array([south[::-1], north[::-1]]) - (0.0, 0.0, 0.12), 0.7)
    for x in (a, b):
        rim = [
            (x, y0 - out, low - 0.22),
            (x, middle, ridge_m - 0.22),
            (x, middle, ridge_m + 0.03),
            (x, y0 - out, low + 0.08),
        ]
        other = [
            (x, middle, ridge_m - 0.22),
            (x, y1 + out, low - 0.22),
            (x, y1 + out, low + 0.08),
            (x, middle, ridge_m + 0.03),
        ]
        shape.polygons("marble", np.array([rim, other]))
    for y in (y0 - out, y1 + out):
        shape.box("marble", (a, y - 0.04, low - 0.3), (b, y + 0.04, low + 0.06))


def lean_to(shape: Shape, x0: float, x1: float, y_low: float, y_high: float, z_low: float, z_high: float) -> None:
    """Add a tiled roof that rises from y_low to y_high along all of x."""
    corners = np.array([(x0, y_low, z_low), (x1, y_low, z_low), (x1, y_high, z_high), (x0, y_high, z_high)])
    corners = corners if y_low < y_high else corners[::-1]
    shape.polygons("tiles", corners)
    shape.polygons("wood", corners[::-1] - (0.0, 0.0, 0.12), 0.7)
    for x in (x0, x1):
        shape.polygons(
            "plaster", [(x, y_low, z_low - 0.4), (x, y_high, z_low - 0.4), (x, y_high, z_high), (x, y_low, z_low)], 0.9
        )


def beam(shape: Shape, x0: float, x1: float, y0: float, y1: float, z_m: float, height_m: float) -> None:
    """Add an entablature with its underside: architrave, frieze a little back, cornice a little out."""
    third = height_m / 3.0
    shape.polygons("marble", [(x0, y0, z_m), (x0, y1, z_m), (x1, y1, z_m), (x1, y0, z_m)], 0.8)
    shape.box("marble", (x0, y0, z_m), (x1, y1, z_m + third))
    shape.box("marble", (x0 + 0.05, y0 + 0.05, z_m + third), (x1 - 0.05, y1 - 0.05, z_m + 2 * third), 0.88)
    lip = 0.18
    shape.box("marble", (x0 - lip, y0 - lip, z_m + 2 * third), (x1 + lip, y1 + lip, z_m + height_m))


def frame(
    shape: Shape, x0: float, x1: float, y0: float, y1: float, thick_m: float, z_m: float, height_m: float
) -> None:
    """Add an entablature on all four sides of a rectangle of centre lines."""
    t = thick_m / 2.0
    for y in (y0, y1):
        beam(shape, x0 - t, x1 + t, y - t, y + t, z_m, height_m)
    for x in (x0, x1):
        beam(shape, x - t, x + t, y0 + t, y1 - t, z_m, height_m)


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
    shape.surface(material, curve[::-1], 0.8)
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


def door(shape: Shape, x_m: float, y_m: float, width_m: float, height_m: float, facing: float) -> None:
    """Add a wooden door with a marble frame on a wall along x at `y_m`; `facing` is -1 for a wall that looks to -y, else 1."""
    depth = 0.12 * facing
    low, high = sorted((y_m, y_m + depth))
    half = width_m / 2.0
    for side in (-half - 0.15, half + 0.15):
        shape.box("marble", (x_m + side - 0.15, low, 0.0), (x_m + side + 0.15, high, height_m))
    shape.box(
        "marble", (x_m - half - 0.4, low, height_m), (x_m + half + 0.4, high + 0.05 * (facing > 0), height_m + 0.4)
    )
    inner_low, inner_high = sorted((y_m, y_m + 0.04 * facing))
    shape.box("wood", (x_m - half, inner_low, 0.0), (x_m + half, inner_high, height_m))
