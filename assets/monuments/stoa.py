"""Colonnades along the square: one open side, a wall at the back and at both ends, a gable roof, a bench."""

from assets import parts, roofs
from assets.building import Building
from assets.entablature import entablature
from assets.orders import column

FRONT_Y_M = 0.5


def stoa(b: Building) -> None:
    """Add a Doric stoa; a deep one has an Ionic row inside."""
    w, d = b.face(int(b.measure("open_side")))
    height, diameter, eave = b.measure("column_height_m"), b.measure("column_diameter_m"), b.measure("eave_m")
    body = b.element()
    parts.floor(body, w, d)
    body.box("plaster", (0.0, d - 0.7, 0.0), (w, d, eave))
    for x in (0.0, w - 0.6):
        body.box("plaster", (x, 0.9, 0.0), (x + 0.6, d - 0.7, eave))
    _bench(b, w, d)
    count = int(b.measure("front_columns"))
    b.element("columns", by="column_height_m")
    places = parts.row((0.6, FRONT_Y_M), (w - 0.6, FRONT_Y_M), count)
    b.many("columns", column(b.order("doric"), diameter, height, b.level), places)
    shape = b.guess("entablature")
    faces = (0.25, w - 0.25, FRONT_Y_M - 0.27, FRONT_Y_M + 0.27)
    entablature(shape, "doric", faces, height, eave - height, b.level)
    if d > 8.0:
        inner = parts.row((3.0, d / 2.0), (w - 3.0, d / 2.0), count // 2)
        b.many("columns", column("ionic", 0.9 * diameter, eave - 0.5, max(b.level, 1), fluted=False), inner)
        entablature(shape, "ionic", (0.6, w - 0.6, d / 2.0 - 0.25, d / 2.0 + 0.25), eave - 0.5, 0.5, 2)
    roof, ends = b.guess("roof"), b.guess("entablature")
    roofs.gable(roof, ends, (0.0, w, 0.1, d), eave, b.monument.height_m, b.level)
    roofs.rafters(roof, (0.6, w - 0.6), (FRONT_Y_M, d - 0.7), eave - 0.3, b.level)


def _bench(b: Building, w: float, d: float) -> None:
    """The marble bench along the wall, and a painted band above it where people leaned."""
    body = b.element()
    body.slab("marble", (0.6, d - 1.2, 0.38), (w - 0.6, d - 0.7, 0.46))
    body.box("marble", (0.6, d - 1.1, 0.0), (w - 0.6, d - 0.7, 0.38), 0.85)
    if b.level < 2:
        body.box("painted", (0.6, d - 0.74, 0.46), (w - 0.6, d - 0.7, 2.46))
