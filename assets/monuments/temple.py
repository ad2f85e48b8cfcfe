"""Temples with columns all around: steps, a windowless cella with its door to the east, pediments at both ends."""

import numpy as np

from assets import parts, roofs, rubble, statues
from assets.axes import Array
from assets.building import Building
from assets.entablature import entablature
from assets.orders import column
from assets.shape import Shape

ABSENT = "absent"
"""The rival reading by which the temple had gone by the time that is shown."""


def temple(b: Building) -> None:
    """Add a peripteral temple; where scholars disagree whether it stood, also what a ruin of it looks like."""
    length, width = b.face(0)
    steps_m, inset = b.measure("steps_m"), 0.75 * b.measure("column_diameter_m")
    body = b.element()
    parts.steps(body, 0.0, length, 0.0, width, steps_m, round(steps_m / 0.3) + 1)
    across, along = int(b.measure("columns_short")), int(b.measure("columns_long"))
    places = parts.ring(inset, length - inset, inset, width - inset, across, along)
    for rival in b.rivals():
        if rival is None or rival.id != ABSENT:
            _standing(b, (length, width), places, inset, rival.id if rival else None)
        else:
            _ruined(b, (length, width), places, rival.id)


def _standing(b: Building, size: tuple[float, float], places: Array, inset: float, variant: str | None) -> None:
    (length, width), level = size, b.level
    height, diameter = b.measure("column_height_m"), b.measure("column_diameter_m")
    b.element("columns", by="columns_long", variant=variant)
    b.many("columns", column(b.order("corinthian"), diameter, height, level), places)
    eave = 1.2 * height
    t = 0.9 * diameter
    beam = b.guess("entablature", variant)
    faces = (inset - t / 2.0, length - inset + t / 2.0, inset - t / 2.0, width - inset + t / 2.0)
    entablature(beam, "ionic", faces, height, eave - height, level, (0, 1, 2, 3), hollow_m=t)
    _cella(b, size, inset, variant)
    roof = b.guess("roof", variant)
    ceiling = [(inset, inset), (inset, width - inset), (length - inset, width - inset), (length - inset, inset)]
    roof.polygons("wood", [(*p, height + 0.3) for p in ceiling], 0.8)
    out = 0.36 * (eave - height)
    roofs.gable(roof, beam, faces, eave, b.monument.height_m, level, out_m=out)
    if level == 0:
        _finials(beam, faces, b.monument.height_m, out)


def _cella(b: Building, size: tuple[float, float], inset: float, variant: str | None) -> None:
    (length, width), height = size, b.measure("column_height_m")
    across, along = int(b.measure("columns_short")), int(b.measure("columns_long"))
    bay_x, bay_y = (length - 2.0 * inset) / (along - 1), (width - 2.0 * inset) / (across - 1)
    x0, x1 = inset + bay_x, length - inset - 1.6 * bay_x
    y0, y1 = inset + 1.2 * bay_y, width - inset - 1.2 * bay_y
    walls = b.element("cella", by="columns_long", variant=variant)
    parts.walls(walls, "ashlar", x0, x1, y0, y1, 0.0, height + 0.3)
    out = 0.07
    parts.walls(walls, "marble_grey", x0 - out, x1 + out, y0 - out, y1 + out, 0.0, 1.3, 0.7 + 2 * out)
    entrance = Shape()
    opening = (0.26 * (y1 - y0), 0.58 * height)
    parts.door(entrance, (y1 - y0) / 2.0, -out, opening, -1.0)
    walls.copies(entrance, np.array([[x1, y0, 0.0]]), np.array([np.pi / 2.0]))


def _finials(shape: Shape, faces: tuple[float, float, float, float], ridge: float, out: float) -> None:
    """Plain finials over the pediments: that there were some is the rule, nothing is known of them here."""
    middle = (faces[2] + faces[3]) / 2.0
    for x in (faces[0] - out + 0.2, faces[1] + out - 0.2):
        for half, low, high in ((0.3, -0.3, -0.08), (0.16, -0.08, 0.0)):
            shape.box("marble", (x - half, middle - half, ridge + low), (x + half, middle + half, ridge + high))


def _ruined(b: Building, size: tuple[float, float], places: Array, variant: str | None) -> None:
    """A few stumps and lying drums on the steps."""
    length, width = size
    rng = np.random.default_rng(7)
    shape = b.guess("ruin", variant)
    diameter = b.measure("column_diameter_m")
    rubble.stumps(shape, rng, places, diameter, 0.4 * b.measure("column_height_m"))
    rubble.scatter(shape, rng, rubble.inside(rng, 50, length, width, 0.0), 1.2)
    rubble.drums(shape, rng, rubble.inside(rng, 14, length, width, 0.0), diameter)


def altar(b: Building) -> None:
    """A U of low walls on steps around the table, open to the temple's side."""
    length, width = b.face(0)
    top, shape = b.monument.height_m, b.element()
    shape.box("paving", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    for i in range(3):
        shape.box("marble", (0.4 * i, 0.4 * i, 0.0), (length - 0.4 * i, width - 0.4 * i, 0.25 * (i + 1)))
    wall = 0.8
    for low, high in (
        ((1.6, 1.2), (length - 1.2, 1.2 + wall)),
        ((1.6, width - 1.2 - wall), (length - 1.2, width - 1.2)),
        ((length - 1.2 - wall, 1.2 + wall), (length - 1.2, width - 1.2 - wall)),
    ):
        shape.box("marble", (*low, 0.75), (*high, top - 0.25))
        shape.slab("marble", (low[0] - 0.15, low[1] - 0.15, top - 0.25), (high[0] + 0.15, high[1] + 0.15, top))
    table = ((length / 2.0 - 0.8, length / 2.0 + 0.8, width / 2.0 - 1.6, width / 2.0 + 1.6), (0.75, 2.0))
    parts.moulded(shape, "marble", *table, foot_m=0.3)
    b.guess("statues")
    at = np.array([[length - 2.2, 0.28 * width, 0.75], [length - 2.2, 0.72 * width, 0.75]])
    b.many("statues", statues.standing(1.9, "marble", b.level), at, np.pi / 2.0)
