"""The Basilica Stoa: three aisles, columns to the square, bulls' heads inside, windows above the aisles' roofs."""

import numpy as np

from assets import parts, roofs
from assets.building import Building
from assets.entablature import PAINT_RED, entablature
from assets.orders import column
from assets.shape import Shape

ORTHOSTAT_M = 1.15
INNER_D_M, INNER_H_M, BEAM_M = 0.75, 6.6, 0.9
FRONT_Y_M = 0.45


def basilica(b: Building) -> None:
    """Add the whole hall."""
    length, width = b.face(0)
    aisle = b.measure("aisle_m")
    south, north = FRONT_Y_M + aisle, width - 0.35 - aisle
    _body(b.element(), length, width, b.measure("aisle_eave_m"))
    _columns(b, length, (south, north))
    _entablatures(b, length, (south, north))
    _nave(b, length, (south, north))
    _roof(b, length, width, (south, north))


def _body(body: Shape, length: float, width: float, eave: float) -> None:
    parts.floor(body, length, width)
    walls = (
        ((0.0, width - 0.7), (length, width)),
        ((0.0, 0.9), (0.6, width - 0.7)),
        ((length - 0.6, 0.9), (length, width - 0.7)),
    )
    for low, high in walls:
        body.box("ashlar", (*low, 0.0), (*high, eave))
        out = 0.06
        body.box("marble_grey", (low[0] - out, low[1] - out, 0.0), (high[0] + out, high[1] + out, ORTHOSTAT_M))


def _columns(b: Building, length: float, rows_y: tuple[float, float]) -> None:
    height, diameter = b.measure("column_height_m"), b.measure("column_diameter_m")
    count = int(b.measure("front_columns"))
    b.element("columns", by="front_columns")
    front = parts.row((0.6, FRONT_Y_M), (length - 0.6, FRONT_Y_M), count)
    b.many("columns", column(b.order("ionic"), diameter, height, b.level), front)
    b.element("inner_columns", evidence="attested", source="VICI")
    inner = np.concatenate([parts.row((2.4, y), (length - 2.4, y), count // 2) for y in rows_y])
    b.many("inner_columns", column("bull", INNER_D_M, INNER_H_M, b.level, fluted=False), inner)


def _entablatures(b: Building, length: float, rows_y: tuple[float, float]) -> None:
    shape, height = b.guess("entablature"), b.measure("column_height_m")
    top = b.measure("aisle_eave_m") - 0.05
    entablature(shape, "ionic", (0.2, length - 0.2, FRONT_Y_M - 0.3, FRONT_Y_M + 0.3), height, top - height, b.level)
    for y in rows_y:
        entablature(shape, "ionic", (0.6, length - 0.6, y - 0.33, y + 0.33), INNER_H_M, BEAM_M, max(b.level, 1))


def _nave(b: Building, length: float, rows_y: tuple[float, float]) -> None:
    """The nave's upper walls with their windows between pilasters, and the doors to the Clivus."""
    walls, (south, north) = b.guess("upper_walls"), rows_y
    low, eave = INNER_H_M + BEAM_M, b.measure("nave_eave_m")
    parts.walls(walls, "plaster", 0.0, length, south - 0.33, north + 0.33, low, eave)
    count = int(b.measure("front_columns")) // 2
    x = np.linspace(2.4, length - 2.4, count)
    for turn, y in ((0.0, south - 0.33), (np.pi, north + 0.33)):
        part = Shape()
        middles = (x[:-1] + x[1:]) / 2.0
        sill, head = 9.2, eave - 0.5
        _windows(part, middles, sill, head, b.level)
        if b.level < 2:
            parts.pilasters(part, x, 0.0, (8.9, eave - 0.3), 0.5, 0.08)
        part.slab("marble", (0.0, -0.12, eave - 0.3), (length, 0.0, eave), PAINT_RED if b.level == 0 else 1.0)
        walls.copies(part, np.array([[0.0 if turn == 0.0 else length, y, 0.0]]), np.array([turn]))
    width = b.face(0)[1]
    for at in np.linspace(14.0, length - 14.0, 6):
        parts.door(walls, float(at), width, (2.2, 3.8), 1.0)


def _windows(part: Shape, x: np.ndarray, sill: float, head: float, level: int) -> None:
    o = np.ones_like(x)

    def boxes(material: str, half: float, out: float, low: float, high: float, tint: float) -> None:
        part.boxes(
            material, np.stack([x - half, -out * o, low * o], -1), np.stack([x + half, 0.0 * o, high * o], -1), tint
        )

    boxes("marble", 0.98, 0.06, sill - 0.16, head + 0.12, 1.0)
    boxes("wood", 0.78, 0.075, sill, head, 0.3)
    if level == 0:
        for share in (-0.34, 0.34):
            low, high = (
                np.stack([x + share - 0.03, -0.11 * o, sill * o], -1),
                np.stack([x + share + 0.03, 0.0 * o, head * o], -1),
            )
            part.boxes("marble", low, high, 0.85)


def _roof(b: Building, length: float, width: float, rows_y: tuple[float, float]) -> None:
    roof, walls, (south, north) = b.guess("roof"), b.guess("upper_walls"), rows_y
    eave = b.measure("aisle_eave_m")
    x = (-0.4, length + 0.4)
    for low, high in ((-0.4, south - 0.3), (width + 0.4, north + 0.3)):
        rise = abs(high - low) * roofs.SLOPE
        roofs.lean_to(roof, walls, x, (low, eave), (high, eave + rise), b.level)
    faces = (0.0, length, south - 0.33, north + 0.33)
    roofs.gable(roof, walls, faces, b.measure("nave_eave_m"), b.monument.height_m, b.level, "plaster")
    for y in ((FRONT_Y_M, south), (south, north), (north, width - 0.4)):
        roofs.rafters(
            roof, (0.6, length - 0.6), y, eave - 0.35 if y[0] != south else b.measure("nave_eave_m") - 0.4, b.level
        )
