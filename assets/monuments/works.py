"""Stairs, walls, socles, chambers, gates and basins of the ancient square."""

import numpy as np

from assets import parts, roofs
from assets.building import Building
from assets.entablature import entablature
from assets.orders import column


def stairs(b: Building) -> None:
    """Steps that rise from the first edge of the footprint."""
    length, width = b.face(0)
    count, shape = int(b.measure("steps")), b.element()
    shape.box("marble", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    for i in range(count):
        top, low = (b.monument.height_m * (i + k) / count for k in (1, 0))
        y = width * i / count
        if b.level == 0:
            shape.box("marble", (0.0, y + 0.03, low), (length, width, top - 0.05), 0.86)
            shape.box("marble", (0.0, y, top - 0.05), (length, width, top), 1.0 - 0.03 * (i % 2))
        else:
            shape.box("marble", (0.0, y, low), (length, width, top), 1.0 - 0.05 * (i % 2))


def wall(b: Building) -> None:
    """A retaining wall of bossed blocks with a coping."""
    length, width = b.face(0)
    top, shape = b.monument.height_m, b.element()
    shape.box("rustic", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    shape.box("rustic", (0.0, 0.0, 0.0), (length, width, top - 0.25))
    shape.slab("marble", (-0.1, -0.1, top - 0.25), (length + 0.1, width + 0.1, top))


def socle(b: Building) -> None:
    """A block of masonry clad in marble, with a foot and a cornice."""
    length, width = b.face(0)
    top, shape = b.monument.height_m, b.element()
    shape.box("ashlar", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    parts.moulded(shape, "ashlar", (0.0, length, 0.0, width), (0.0, top), 0.75)


def chambers(b: Building) -> None:
    """A row of vaulted rooms, open to the west."""
    w, d = b.face(3)
    count, top, part = int(b.measure("chambers")), b.monument.height_m, b.element()
    bay = w / count
    span = bay * 0.62
    pier = (bay - span) / 2.0
    part.box("rustic", (0.0, 0.0, -parts.FOUNDATION_M), (w, d, 0.0))
    part.box("rustic", (0.0, d - 0.8, 0.0), (w, d, top - 0.4))
    for i in range(count):
        for x in (i * bay, (i + 1) * bay - pier):
            part.box("rustic", (x, 0.0, 0.0), (x + pier, d - 0.8, top - 0.4))
        spring = top - 0.9 - span / 2.0
        parts.arch(part, "rustic", (i + 0.5) * bay, span, 0.0, d - 0.8, spring, top - 0.4, (14, 10, 6)[b.level])
    part.slab("marble", (-0.15, -0.2, top - 0.4), (w + 0.15, d, top))


def gate(b: Building) -> None:
    """A columned gateway: two walls, two columns between them at either end, a gable roof along the passage."""
    w, d = b.face(1)
    height, diameter = b.measure("column_height_m"), b.measure("column_diameter_m")
    eave, body = height + 1.3, b.element()
    parts.floor(body, w, d)
    for y in (0.0, d - 0.9):
        body.box("ashlar", (0.0, y, 0.0), (w, y + 0.9, height))
    b.guess("columns")
    places = np.concatenate([parts.row((x, 0.33 * d), (x, 0.67 * d), 2) for x in (0.6, w - 0.6)])
    b.many("columns", column(b.order("doric"), diameter, height, b.level), places)
    beam = b.guess("entablature")
    faces = (0.1, w - 0.1, 0.1, d - 0.1)
    entablature(beam, "doric", faces, height, eave - height, b.level, (0, 1, 2, 3), hollow_m=0.9)
    roofs.gable(b.guess("roof"), beam, faces, eave, b.monument.height_m, b.level)


def basin(b: Building) -> None:
    """A street fountain: a basin with a wall behind it."""
    length, width = b.face(0)
    top, shape = b.monument.height_m, b.element()
    shape.box("marble", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    parts.walls(shape, "marble", 0.0, length, 0.0, width, 0.0, 0.9, 0.4)
    shape.box("ashlar", (0.0, 0.0, 0.0), (0.8, width, top - 0.2))
    shape.slab("marble", (0.0, 0.0, top - 0.2), (0.95, width, top))
    corners = [(0.8, 0.4, 0.7), (length - 0.4, 0.4, 0.7), (length - 0.4, width - 0.4, 0.7), (0.8, width - 0.4, 0.7)]
    shape.polygons("water", corners)
