"""Halls of the Roman square: colonnades, the Basilica, plain halls, the platform in the west. Each adds itself to a shape."""

import numpy as np

from assets import parts
from assets.shape import Shape, size_m, turned
from assets.site import Monument

FOUNDATION_M = 1.6
"""How far walls and floors go on below their level, so that no slope of the ground shows a gap."""


def floor(shape: Shape, length_m: float, width_m: float) -> None:
    """Add a paved floor at z = 0 on a foundation."""
    shape.box("paving", (0.0, 0.0, -FOUNDATION_M), (length_m, width_m, 0.0))


def stoa(monument: Monument, shape: Shape) -> None:
    """One open side with columns, a wall at the back and at both ends, a gable roof along it, a bench."""
    length, width = size_m(monument)
    side = int(monument.measure("open_side"))
    w, d = (length, width) if side % 2 == 0 else (width, length)
    part = Shape()
    floor(part, w, d)
    column_h, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    eave, front = monument.measure("eave_m"), 0.5
    places = parts.row((0.6, front), (w - 0.6, front), int(monument.measure("front_columns")))
    part.copies(parts.column(diameter, column_h, plain=True), places)
    parts.beam(part, 0.0, w, front - 0.32, front + 0.32, column_h, eave - column_h)
    if d > 8.0:
        inner = parts.row((3.0, d / 2.0), (w - 3.0, d / 2.0), len(places) // 2)
        part.copies(parts.column(0.9 * diameter, column_h + 0.9, sides=8), inner)
    part.box("plaster", (0.0, d - 0.7, 0.0), (w, d, eave))
    for x in (0.0, w - 0.6):
        part.box("plaster", (x, 0.9, 0.0), (x + 0.6, d - 0.7, eave))
    part.box("marble", (0.6, d - 1.25, 0.0), (w - 0.6, d - 0.7, 0.45))
    parts.gable(part, 0.0, w, 0.1, d, eave, monument.height_m, "plaster")
    turned(shape, part, side, length, width)


def basilica(monument: Monument, shape: Shape) -> None:
    """Three aisles: columns to the square, two inner rows, the nave's windows above the aisles' roofs, a closed back."""
    length, width = size_m(monument)
    aisle, eave = monument.measure("aisle_m"), monument.measure("aisle_eave_m")
    column_h, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    count = int(monument.measure("front_columns"))
    front, south = 0.45, 0.45 + aisle
    north = width - 0.35 - aisle
    floor(shape, length, width)
    shape.copies(parts.column(diameter, column_h), parts.row((0.6, front), (length - 0.6, front), count))
    parts.beam(shape, 0.0, length, front - 0.38, front + 0.38, column_h, eave - column_h)
    for y in (south, north):
        inner = parts.row((2.4, y), (length - 2.4, y), count // 2)
        shape.copies(parts.column(0.75, 6.6, sides=8), inner)
        parts.beam(shape, 0.0, length, y - 0.35, y + 0.35, 6.6, 0.9)
    nave_eave = monument.measure("nave_eave_m")
    parts.walls(shape, "plaster", 0.0, length, south - 0.35, north + 0.35, 7.5, nave_eave)
    _windows(shape, length, south - 0.35, count // 2, 9.3, nave_eave - 0.4)
    for y_low, y_high in ((-0.4, south - 0.3), (width + 0.4, north + 0.3)):
        parts.lean_to(shape, -0.4, length + 0.4, y_low, y_high, eave, eave + abs(y_high - y_low) * parts.ROOF_SLOPE)
    parts.gable(shape, 0.0, length, south - 0.35, north + 0.35, nave_eave, monument.height_m, "plaster")
    shape.box("ashlar", (0.0, width - 0.7, 0.0), (length, width, eave))
    for x in (0.0, length - 0.6):
        shape.box("ashlar", (x, 0.9, 0.0), (x + 0.6, width - 0.7, 7.5))
    for x in np.linspace(14.0, length - 14.0, 6):
        parts.door(shape, float(x), width, 2.2, 3.8, 1.0)


def _windows(shape: Shape, length_m: float, y_m: float, count: int, low_m: float, high_m: float) -> None:
    """Add dark windows in marble frames on a wall along x that looks to -y."""
    x = np.linspace(2.4, length_m - 2.4, count)
    level = np.ones(count)

    def corners(half_m: float, out_m: float, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
        return (
            np.stack([x - half_m, (y_m - out_m) * level, low * level], -1),
            np.stack([x + half_m, y_m * level, high * level], -1),
        )

    shape.boxes("marble", *corners(0.95, 0.06, low_m - 0.2, high_m + 0.1))
    shape.boxes("wood", *corners(0.75, 0.08, low_m, high_m - 0.05), 0.35)


def hall(monument: Monument, shape: Shape) -> None:
    """Four walls, three doors on a long side, a gable roof along it."""
    length, width = size_m(monument)
    side = 0 if length >= width else 3
    w, d = max(length, width), min(length, width)
    eave, part = monument.measure("eave_m"), Shape()
    floor(part, w, d)
    parts.walls(part, "ashlar", 0.0, w, 0.0, d, 0.0, eave)
    for share in (0.2, 0.5, 0.8):
        parts.door(part, share * w, 0.0, 1.7, 3.1, -1.0)
    parts.gable(part, 0.0, w, 0.0, d, eave, monument.height_m, "ashlar")
    turned(shape, part, side, length, width)


def platform_hall(monument: Monument, shape: Shape) -> None:
    """A hall with half-columns and three doors to the west on a platform of bossed blocks."""
    length, width = size_m(monument)
    top, ridge = monument.measure("platform_m"), monument.height_m
    eave = ridge - (width / 2.0) * parts.ROOF_SLOPE
    shape.box("rustic", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    shape.box("rustic", (0.0, 0.0, 0.0), (length, width, top - 0.3))
    shape.box("marble", (-0.12, -0.12, top - 0.3), (length + 0.12, width + 0.12, top))
    parts.walls(shape, "ashlar", 2.4, length, 0.6, width - 0.6, top, eave - 0.7)
    parts.frame(shape, 2.75, length - 0.35, 0.95, width - 0.95, 0.8, eave - 0.7, 0.7)
    front, span = Shape(), width - 1.2
    for share in (0.2, 0.5, 0.8):
        parts.door(front, share * span, 0.0, 2.4, 3.6, -1.0)
    half = parts.column(0.6, eave - 0.7 - top)
    lifted = Shape()
    lifted.copies(front, np.array([[0.0, 0.0, top]]))
    lifted.copies(half, parts.row((0.4, -0.2), (span - 0.4, -0.2), 6, top))
    shape.copies(lifted, np.array([[2.4, width - 0.6, 0.0]]), np.array([-np.pi / 2.0]))
    parts.gable(shape, 2.4, length, 0.1, width - 0.1, eave, ridge, "ashlar")
