"""Courts with porticoes: the Rhodian peristyle, and the Prytaneion behind its forecourt."""

import numpy as np

from assets import parts, roofs, statues
from assets.building import Building
from assets.entablature import entablature
from assets.orders import column
from assets.shape import Shape


def portico(
    b: Building, width_m: float, depth_m: float, post: tuple[float, float], spacing_m: float, top_m: float
) -> Building:
    """Return a lean-to colonnade: wall at y = 0, columns (diameter, height) at `depth_m`, its roof up to `top_m` at the wall."""
    wing, (diameter, height) = b.wing(), post
    y, beam_m = depth_m - 0.4, 0.16 * height
    wing.element("columns", evidence="hypothetical", source="design")
    places = parts.row((0.6, y), (width_m - 0.6, y), max(2, round(width_m / spacing_m)))
    wing.many("columns", column("ionic", diameter, height, b.level, fluted=False), places)
    beam = wing.guess("entablature")
    entablature(beam, "ionic", (0.2, width_m - 0.2, y - 0.24, y + 0.24), height, beam_m, b.level, (2,))
    wall = wing.element()
    wall.box("plaster", (0.0, 0.0, 0.0), (width_m, 0.6, top_m - 0.02))
    if b.level < 2:
        wall.box("painted", (0.6, 0.6, 0.0), (width_m - 0.6, 0.63, 2.0))
    roofs.lean_to(
        wing.guess("roof"), beam, (0.0, width_m), (depth_m + 0.3, height + beam_m), (0.0, top_m - 0.1), b.level
    )
    return wing


def court(b: Building) -> None:
    """A walled court, colonnades on three sides, the eastern one higher; two shrines on a podium in the west."""
    length, width = b.face(0)
    post = (b.measure("column_diameter_m"), b.measure("column_height_m"))
    depth, low_top = 4.2, post[1] * 1.16 + 4.5 * 0.2
    body = b.element()
    parts.floor(body, length, width)
    b.join(portico(b, length - depth, depth, post, 2.4, low_top), (0.0, 0.0), 0.0)
    b.join(portico(b, length - depth, depth, post, 2.4, low_top), (length - depth, width), np.pi)
    east = portico(b, width, depth + 0.6, (0.7, post[1] * 1.24), 3.2, b.monument.height_m)
    b.join(east, (length, 0.0), np.pi / 2.0)
    body.box("plaster", (0.0, depth, 0.0), (0.6, width - depth, low_top))
    podium = b.element("podium", evidence="attested", source="SIGN")
    parts.moulded(podium, "ashlar", (0.9, 11.0, depth + 1.3, width - depth - 1.3), (0.0, 1.5), 0.4)
    for i in range(5):
        podium.box(
            "marble", (11.0, width / 2.0 - 2.5, 0.0), (11.0 + 0.32 * (i + 1), width / 2.0 + 2.5, 1.5 - 0.3 * i - 0.3)
        )
    for share in (0.3, 0.7):
        b.join(_shrine(b, 8.0, 5.5, b.monument.height_m - 0.2 - 1.5), (1.8, share * width - 2.75), 0.0, 1.5)
    parts.door(body, 0.45 * length, 0.0, (2.4, 3.4), -1.0)


def _shrine(b: Building, length_m: float, width_m: float, top_m: float) -> Building:
    """A little temple with four columns to the east."""
    wing, eave = b.wing(), top_m - 1.1
    shape = wing.guess("shrines")
    parts.walls(shape, "marble", 0.3, length_m - 2.4, 0.3, width_m - 0.3, 0.0, eave - 0.5, 0.4)
    entrance = Shape()
    parts.door(entrance, (width_m - 0.6) / 2.0, 0.0, (1.4, 2.5), -1.0)
    shape.copies(entrance, np.array([[length_m - 2.4, 0.3, 0.0]]), np.array([np.pi / 2.0]))
    front = parts.row((length_m - 0.5, 0.5), (length_m - 0.5, width_m - 0.5), 4)
    wing.many("shrines", column("ionic", 0.42, eave - 0.5, b.level, fluted=False), front, np.pi / 2.0)
    faces = (0.3, length_m - 0.3, 0.3, width_m - 0.3)
    entablature(shape, "ionic", faces, eave - 0.5, 0.5, max(b.level, 1))
    roofs.gable(shape, shape, faces, eave, top_m, max(b.level, 1), out_m=0.2)
    return wing


COURT_Y_M, PORCH_Y_M, REAR_Y_M = 19.3, 27.3, 43.4
"""Where the Prytaneion's court ends, its porch, and its hall; after FiE9/4 and EHW."""


def prytaneion(b: Building) -> None:
    """A forecourt with porticoes on three sides, a Doric porch of six columns, the hall of Hestia under one roof with it."""
    length, width = b.face(0)
    body, post = b.element(), (0.5, 4.0)
    parts.floor(body, length, width)
    b.join(portico(b, length, 3.9, post, 2.4, 5.4), (0.0, 0.0), 0.0)
    for x, yaw in ((0.0, -np.pi / 2.0), (length, np.pi / 2.0)):
        aisle = portico(b, COURT_Y_M - 3.9, 3.9, post, 2.4, 5.4)
        b.join(aisle, (x, COURT_Y_M if x == 0.0 else 3.9), yaw)
    parts.door(body, length / 2.0, 0.0, (2.2, 3.2), -1.0)
    base = ((length / 2.0 - 1.25, length / 2.0 + 1.25, 10.5, 12.6), (0.0, 1.1))
    parts.moulded(b.element("base", evidence="attested", source="EHW"), "marble_grey", *base, foot_m=0.35)
    _porch(b, length)
    _hall(b, length, width)


def _porch(b: Building, length: float) -> None:
    height, diameter, level = b.measure("column_height_m"), b.measure("column_diameter_m"), b.level
    b.element("porch_columns", evidence="attested", source="FiE9/4")
    doric = parts.row((3.6, COURT_Y_M + 0.8), (length - 3.6, COURT_Y_M + 0.8), int(b.measure("porch_columns")))
    b.many("porch_columns", column("doric", diameter, height, level, "marble_grey", fluted=False), doric)
    beam, eave = b.guess("entablature"), height + 1.9
    faces = (0.25, length - 0.25, COURT_Y_M + 0.3, COURT_Y_M + 1.3)
    entablature(beam, "doric", faces, height, 1.9, level)
    roof, gables = b.guess("roof"), b.wing()
    faces = (COURT_Y_M + 0.3, REAR_Y_M, 0.25, length - 0.25)
    roofs.gable(gables.guess("roof"), gables.guess("entablature"), faces, eave, b.monument.height_m, level, "plaster")
    b.join(gables, (length, 0.0), np.pi / 2.0)
    roofs.rafters(roof, (0.8, length - 0.8), (COURT_Y_M + 0.8, PORCH_Y_M), eave - 0.4, level)


def _hall(b: Building, length: float, width: float) -> None:
    body, eave = b.element(), b.measure("column_height_m") + 1.9
    for low, high in (
        ((0.0, COURT_Y_M), (0.8, REAR_Y_M)),
        ((length - 0.8, COURT_Y_M), (length, REAR_Y_M)),
        ((0.8, REAR_Y_M - 0.7), (length - 0.8, REAR_Y_M)),
    ):
        body.box("ashlar", (*low, 0.0), (*high, eave))
    openings = [(length * 0.2, 1.4, 0.0, 2.8), (length * 0.66, 2.6, 0.0, 4.2)]
    parts.pierced(body, "ashlar", (0.8, length - 0.8), (PORCH_Y_M, PORCH_Y_M + 0.7), (0.0, eave), openings)
    for at_x, wide, _, head in openings:
        parts.surround(body, at_x, PORCH_Y_M, (wide, head), -1.0)
    hearth = (length * 0.66 - 1.1, length * 0.66 + 1.1, 34.0, 36.0)
    parts.moulded(b.element("base"), "marble_grey", hearth, (0.0, 1.0), foot_m=0.3)
    parts.walls(body, "plaster", 0.0, length, REAR_Y_M, width, 0.0, 5.6)
    roofs.lean_to(b.guess("roof"), body, (0.0, length), (width + 0.4, 5.5), (REAR_Y_M, 7.6), b.level)
    b.element("statues", evidence="inferred", source="FiE9/4")
    at = np.array([(length * 0.2 + 2.2, PORCH_Y_M - 1.0, 0.0), (length * 0.66 + 3.0, PORCH_Y_M - 1.0, 0.0)])
    b.many("statues", statues.on_pedestal(1.9, "marble", b.level), at)
