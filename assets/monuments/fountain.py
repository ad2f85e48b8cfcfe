"""Great fountains: the arch of Domitian's before its apse, and the Hydrekdocheion with its two storeys of little columns."""

import numpy as np

from assets import parts, statues
from assets.building import Building
from assets.entablature import PAINT_BLUE, PAINT_RED, entablature
from assets.orders import column
from assets.shape import Shape


def arch_fountain(b: Building) -> None:
    """A great arch to the west, an apse behind it, water at its foot, the Polyphemus group before the water."""
    w, d = b.face(3)
    span, crown, top = b.measure("span_m"), b.measure("crown_m"), b.monument.height_m
    pier, spring = (w - span) / 2.0, crown - span / 2.0
    body = b.element()
    body.box("ashlar", (0.0, 0.0, -parts.FOUNDATION_M), (w, d, 0.0))
    for x in (0.0, w - pier):
        body.box("marble", (x, 0.0, 0.0), (x + pier, d, top - 0.6))
        parts.moulded(body, "marble", (x, x + pier, 0.0, 1.6), (0.0, spring), 0.8)
        body.box("painted", (x + 0.2 * pier, -0.03, 1.2), (x + 0.8 * pier, 0.0, spring - 0.8), (0.95, 0.92, 0.85))
    arch = b.element("arch", evidence="inferred", source="SIGN")
    parts.arch(arch, "marble", w / 2.0, span, 0.0, 1.6, spring, top - 0.6, (24, 14, 8)[b.level])
    _archivolt(arch, w / 2.0, span, spring, (24, 14, 8)[b.level])
    arch.slab("marble", (-0.15, -0.15, top - 0.6), (w + 0.15, d + 0.15, top - 0.3), PAINT_RED)
    arch.slab("marble", (-0.25, -0.25, top - 0.3), (w + 0.25, d + 0.25, top))
    body.box("ashlar", (pier, d - 1.0, 0.0), (w - pier, d, top - 0.6))
    arch.slab("ashlar", (pier, 1.6, crown + 0.2), (w - pier, d - 1.0, top - 0.6))
    _apse(body, w / 2.0, d - 1.0, span / 2.0, spring)
    body.box("marble", (pier, 0.3, 0.0), (w - pier, 0.7, 0.9))
    water = [(pier, 0.7, 0.75), (w - pier, 0.7, 0.75), (w - pier, d - 1.0, 0.75), (pier, d - 1.0, 0.75)]
    body.polygons("water", water)
    _polyphemus(b, w / 2.0, d)


def _archivolt(shape: Shape, centre_x: float, span_m: float, spring_m: float, sides: int) -> None:
    """Add the moulded band around the front of an arch."""
    angle = np.linspace(np.pi, 0.0, sides + 1)
    for r0, r1, y in ((0.0, 0.35, -0.05), (0.35, 0.6, -0.1)):
        rows = [
            np.stack(
                [
                    centre_x + (span_m / 2.0 + r) * np.cos(angle),
                    np.full_like(angle, y),
                    spring_m + (span_m / 2.0 + r) * np.sin(angle),
                ],
                -1,
            )
            for r in (r0, r1)
        ]
        shape.polygons(
            "marble", np.stack([rows[0][:-1], rows[0][1:], rows[1][1:], rows[1][:-1]], axis=1), 1.0 - 0.06 * (y < -0.07)
        )


def _apse(part: Shape, centre_x: float, back_y: float, radius_m: float, spring_m: float) -> None:
    """Add the hollow of an apse that looks to -y, with its half dome."""
    angle = np.linspace(0.0, np.pi, 17)
    front_y = max(back_y - radius_m, 1.6)
    deep = back_y - front_y
    ring = np.stack([centre_x + radius_m * np.cos(angle), front_y + deep * np.sin(angle)], -1)
    rows = [np.column_stack([ring, np.full(17, z)]) for z in (0.0, spring_m)]
    for rise in np.linspace(0.2, 1.0, 6) * np.pi / 2.0:
        at = (centre_x, front_y) + (ring - (centre_x, front_y)) * max(np.cos(rise), 1e-3)
        rows.append(np.column_stack([at, np.full(17, spring_m + radius_m * np.sin(rise))]))
    part.surface("plaster", np.stack(rows), 0.75)


def _polyphemus(b: Building, x_m: float, d: float) -> None:
    """The giant, reclining, and those who came to blind him; what survives of the group is in the museum."""
    group = b.element("statues", evidence="attested", source="SIGN")
    group.box("marble", (x_m - 2.4, d - 3.4, 0.0), (x_m + 2.4, d - 1.6, 1.1), 0.85)
    lying = Shape()
    parts.revolved(
        lying, "marble", np.array([(0.02, 0.0), (0.42, 0.3), (0.55, 1.1), (0.3, 1.9), (0.25, 2.7), (0.05, 3.0)]), 10
    )
    tilted = Shape()
    tilted.copies(lying, np.zeros((1, 3)))
    for batch in tilted.batches:
        batch.points[:] = batch.points[:, [2, 0, 1]]
        batch.normals[:] = batch.normals[:, [2, 0, 1]]
    group.copies(tilted, np.array([[x_m - 1.6, d - 2.4, 1.55]]))
    at = np.array([(x_m + s, d - 2.9 - 0.2 * abs(s), 1.1) for s in (-1.9, 1.2, 2.0)])
    b.many("statues", statues.standing(1.7, "marble", b.level), at)


def nymphaeum(b: Building) -> None:
    """Two storeys of little columned bays on three sides of a basin, open to the west."""
    w, d = b.face(3)
    top, diameter, lower = b.monument.height_m, b.measure("column_diameter_m"), b.measure("column_height_m")
    beam, podium = 0.55, 1.2
    upper = top - podium - lower - 2.0 * beam
    body = b.element()
    body.box("marble", (0.0, 0.0, -parts.FOUNDATION_M), (w, d, 0.0))
    walls = b.element("walls", by="height_m")
    walls.box("ashlar", (0.0, d - 1.0, 0.0), (w, d, top - beam))
    for x in (0.0, w - 1.0):
        walls.box("ashlar", (x, 4.0, 0.0), (x + 1.0, d - 1.0, top - beam))
    runs = (
        ((1.3, d - 2.1), (w - 1.3, d - 2.1), 10),
        ((2.1, 4.35), (2.1, d - 3.8), 5),
        ((w - 2.1, 4.35), (w - 2.1, d - 3.8), 5),
    )
    boxes = ((1.0, w - 1.0, d - 2.5, d - 1.0), (1.0, 2.5, 4.0, d - 2.5), (w - 2.5, w - 1.0, 4.0, d - 2.5))
    for (start, end, count), box in zip(runs, boxes, strict=True):
        _bays(b, parts.row(start, end, count), box, (podium, lower, beam, upper), diameter)
    _pediment(b, w, d, podium + lower + beam)
    _basin(body, w, d)


def _bays(
    b: Building, places: np.ndarray, box: tuple[float, float, float, float], rise: tuple[float, ...], diameter: float
) -> None:
    (x0, x1, y0, y1), (podium, lower, beam, upper) = box, rise
    body, beams = b.element(), b.guess("entablature")
    body.box("marble", (x0, y0, 0.0), (x1, y1, podium))
    b.guess("columns")
    second = podium + lower + beam
    b.many("columns", column("corinthian", diameter, lower, b.level, fluted=False), np.add(places, (0.0, 0.0, podium)))
    b.many(
        "columns",
        column("corinthian", 0.8 * diameter, upper, max(b.level, 1), "marble_grey", fluted=False),
        np.add(places, (0.0, 0.0, second)),
    )
    entablature(beams, "ionic", box, podium + lower, beam, max(b.level, 1))
    entablature(beams, "ionic", box, second + upper, beam, max(b.level, 1))
    if x1 - x0 > 3.0:
        b.element("statues", evidence="inferred", source="BAS")
        middles = (places[:-1:2] + places[1::2]) / 2.0 + (0.0, 0.5, 0.0)
        figure = statues.standing(1.7, "marble", b.level)
        for z in (podium, second):
            b.many("statues", figure, np.add(middles, (0.0, 0.0, z)))


def _pediment(b: Building, w: float, d: float, second: float) -> None:
    """A flat arch of colour over the middle bay's niches, below the cornice."""
    shape = b.guess("entablature")
    for x in np.linspace(2.2, w - 2.2, 5):
        shape.box("painted", (x - 0.5, d - 1.05, 1.5), (x + 0.5, d - 1.0, 3.8), PAINT_BLUE)
        shape.box("painted", (x - 0.5, d - 1.05, second + 0.3), (x + 0.5, d - 1.0, second + 2.2), PAINT_BLUE)


def _basin(body: Shape, w: float, d: float) -> None:
    body.box("marble", (0.0, 0.0, 0.0), (w, 0.5, 0.95), 0.97)
    body.slab("marble", (-0.05, -0.06, 0.95), (w + 0.05, 0.55, 1.05))
    for x in (0.0, w - 0.5):
        body.box("marble", (x, 0.5, 0.0), (x + 0.5, 4.0, 1.0))
    body.polygons("water", [(0.5, 0.5, 0.8), (w - 0.5, 0.5, 0.8), (w - 0.5, d - 2.5, 0.8), (0.5, d - 2.5, 0.8)])
