"""Plain halls with a gable roof, and the one on a platform in the west."""

import numpy as np

from assets import parts, roofs, statues
from assets.building import Building
from assets.orders import column
from assets.shape import Shape


def hall(b: Building) -> None:
    """Four walls, three doors on a long side, a gable roof along it."""
    length, width = b.face(0)
    w, d = b.face(0 if length >= width else 3)
    eave, body = b.measure("eave_m"), b.element()
    parts.floor(body, w, d)
    openings = [(share * w, 1.7, 0.0, 3.1) for share in (0.2, 0.5, 0.8)]
    parts.pierced(body, "ashlar", (0.0, w), (0.0, 0.7), (0.0, eave), openings)
    for low, high in (((0.0, d - 0.7), (w, d)), ((0.0, 0.7), (0.7, d - 0.7)), ((w - 0.7, 0.7), (w, d - 0.7))):
        body.box("ashlar", (*low, 0.0), (*high, eave))
    for at_x, wide, _, head in openings:
        parts.surround(body, at_x, 0.0, (wide, head), -1.0)
    if b.level < 2:
        parts.pilasters(body, np.array([0.45, 0.35 * w, 0.65 * w, w - 0.45]), 0.0, (0.0, eave - 0.1), 0.6, 0.1)
    roof = b.guess("roof")
    roofs.gable(roof, roof, (0.0, w, 0.0, d), eave, b.monument.height_m, b.level, "ashlar")
    if "statue_height_m" in b.monument.figures:
        b.element("statues", by="statue_height_m", evidence="attested")
        at = np.array([(0.42 * w, d - 1.7, 0.0), (0.58 * w, d - 1.7, 0.0)])
        b.many("statues", statues.seated(b.measure("statue_height_m"), b.level), at)


def platform_hall(b: Building) -> None:
    """A hall with half-columns and three doors to the west on a platform of bossed blocks."""
    length, width = b.face(0)
    top, ridge = b.measure("platform_m"), b.monument.height_m
    eave = ridge - (width / 2.0) * roofs.SLOPE
    body = b.element()
    body.box("rustic", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    body.box("rustic", (0.0, 0.0, 0.0), (length, width, top - 0.3))
    body.slab("marble", (-0.12, -0.12, top - 0.3), (length + 0.12, width + 0.12, top))
    walls = b.element("walls", evidence="inferred", source="SHO")
    parts.walls(walls, "ashlar", 2.4, length, 0.6, width - 0.6, top, eave - 0.7)
    frame = ((2.6, length - 0.2, 0.8, width - 0.8), eave - 0.7)
    walls.slab(
        "marble", (frame[0][0] - 0.4, frame[0][2] - 0.4, eave - 0.7), (frame[0][1] + 0.4, frame[0][3] + 0.4, eave), 0.97
    )
    front, span = Shape(), width - 1.2
    for share in (0.2, 0.5, 0.8):
        parts.door(front, share * span, 0.0, (2.4, 3.6), -1.0, top)
    walls.copies(front, np.array([[2.4, width - 0.6, 0.0]]), np.array([-np.pi / 2.0]))
    b.element("columns", evidence="inferred", source="SHO")
    y = np.linspace(width - 1.0, 1.0, 6)
    places = np.stack([np.full(6, 2.25), y, np.full(6, top)], -1)
    b.many("columns", column("ionic", 0.6, eave - 0.7 - top, b.level), places, np.pi / 2.0)
    roof = b.guess("roof")
    roofs.gable(roof, roof, (2.4, length, 0.1, width - 0.1), eave, ridge, b.level, "ashlar")
