"""Temples, courts and the civic buildings of the Roman square. Each adds itself to a shape."""

import numpy as np

from assets import parts
from assets.axes import Array
from assets.roman_halls import FOUNDATION_M, floor
from assets.shape import Shape, footprint_own_m, size_m, turned
from assets.site import Monument


def temple(monument: Monument, shape: Shape) -> None:
    """Columns all around a windowless cella, steps on every side, pediments at both ends, the door to the east."""
    length, width = size_m(monument)
    column_h, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    steps_m, inset = monument.measure("steps_m"), 0.75 * diameter
    across, along = int(monument.measure("columns_short")), int(monument.measure("columns_long"))
    parts.steps(shape, 0.0, length, 0.0, width, steps_m, round(steps_m / 0.3) + 1)
    places = parts.ring(inset, length - inset, inset, width - inset, across, along)
    shape.copies(parts.column(diameter, column_h), places)
    eave = column_h + 0.22 * column_h
    parts.frame(shape, inset, length - inset, inset, width - inset, 0.95 * diameter, column_h, eave - column_h)
    bay_x, bay_y = (length - 2.0 * inset) / (along - 1), (width - 2.0 * inset) / (across - 1)
    x0, x1 = inset + bay_x, length - inset - 1.6 * bay_x
    y0, y1 = inset + 1.2 * bay_y, width - inset - 1.2 * bay_y
    parts.walls(shape, "ashlar", x0, x1, y0, y1, 0.0, column_h + 0.3)
    entrance = Shape()
    parts.door(entrance, (y1 - y0) / 2.0, 0.0, 0.3 * (y1 - y0), 0.6 * column_h, -1.0)
    shape.copies(entrance, np.array([[x1, y0, 0.0]]), np.array([np.pi / 2.0]))
    ceiling = [(inset, inset, column_h), (inset, width - inset, column_h), (length - inset, width - inset, column_h)]
    shape.polygons("wood", [*ceiling, (length - inset, inset, column_h)], 0.8)
    edge = inset - 0.5 * diameter
    parts.gable(shape, edge, length - edge, edge, width - edge, eave, monument.height_m, "marble")


def altar(monument: Monument, shape: Shape) -> None:
    """A U of low walls on steps around the table."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("paving", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    for i in range(3):
        shape.box("marble", (0.4 * i, 0.4 * i, 0.0), (length - 0.4 * i, width - 0.4 * i, 0.25 * (i + 1)))
    wall = 0.8
    for low, high in (
        ((1.6, 1.2), (length - 1.2, 1.2 + wall)),
        ((1.6, width - 1.2 - wall), (length - 1.2, width - 1.2)),
        ((length - 1.2 - wall, 1.2 + wall), (length - 1.2, width - 1.2 - wall)),
    ):
        shape.box("marble", (*low, 0.75), (*high, top - 0.25))
        shape.box("marble", (low[0] - 0.15, low[1] - 0.15, top - 0.25), (high[0] + 0.15, high[1] + 0.15, top))
    shape.box("marble", (length / 2.0 - 0.8, width / 2.0 - 1.6, 0.75), (length / 2.0 + 0.8, width / 2.0 + 1.6, 2.0))


def bouleuterion(monument: Monument, shape: Shape) -> None:
    """The theatre-shaped council house under its timber roof: stage front with five doors, a round back with pilasters."""
    outline = footprint_own_m(monument)
    eave, ridge = monument.measure("eave_m"), monument.height_m
    prism(shape, "ashlar", outline, -FOUNDATION_M, 0.0)
    prism(shape, "ashlar", outline, 0.0, eave * 0.52)
    prism(shape, "marble", offset(outline, 0.18), eave * 0.52, eave * 0.52 + 0.5)
    prism(shape, "plaster", outline, eave * 0.52 + 0.5, eave - 0.8)
    prism(shape, "marble", offset(outline, 0.25), eave - 0.8, eave)
    length = outline[1, 0]
    for share in (0.18, 0.34, 0.5, 0.66, 0.82):
        parts.door(shape, share * length, 0.0, 2.6 if share == 0.5 else 1.9, 4.4 if share == 0.5 else 3.4, -1.0)
    _openings(shape, outline, eave * 0.62, eave - 1.6)
    roof = offset(outline, 0.7)
    middle = outline[:, 1].max() * 0.36
    tops = np.stack([np.clip(roof[:, 0], 0.34 * length, 0.66 * length), np.full(len(roof), middle)], -1)
    hip_roof(shape, roof, tops, eave, ridge)


def prism(shape: Shape, material: str, outline: Array, low_m: float, high_m: float) -> None:
    """Add a solid with vertical sides over a convex outline (n, 2), counter-clockwise, with its top."""
    following = np.roll(outline, -1, axis=0)
    low, high = np.full(len(outline), low_m), np.full(len(outline), high_m)
    bottom = [np.column_stack([outline, low]), np.column_stack([following, low])]
    top = [np.column_stack([following, high]), np.column_stack([outline, high])]
    shape.polygons(material, np.stack([*bottom, *top], axis=1))
    shape.polygons(material, np.column_stack([outline, high]))


def offset(outline: Array, out_m: float) -> Array:
    """Return a convex outline (n, 2), counter-clockwise, with every edge moved out by `out_m`."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.stack([edges[:, 1], -edges[:, 0]], -1) / np.linalg.norm(edges, axis=1, keepdims=True)
    before = np.roll(normals, 1, axis=0)
    return np.asarray(outline + out_m * (normals + before) / (1.0 + (normals * before).sum(axis=1, keepdims=True)))


def hip_roof(shape: Shape, outline: Array, tops: Array, eave_m: float, ridge_m: float) -> None:
    """Add a tiled roof from an outline (n, 2) up to a point of the ridge for each of its corners, (n, 2)."""
    low = np.column_stack([outline, np.full(len(outline), eave_m)])
    high = np.column_stack([tops, np.full(len(tops), ridge_m)])
    next_low, next_high = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
    shape.polygons("tiles", np.stack([low, next_low, next_high], axis=1))
    broad = np.linalg.norm(next_high - high, axis=1) > 1e-6
    shape.polygons("tiles", np.stack([low, next_high, high], axis=1)[broad])
    shape.polygons("wood", low[::-1], 0.6)


def _openings(shape: Shape, outline: Array, low_m: float, high_m: float) -> None:
    """Add a dark window in the middle of every side that has room for it, and a pilaster at every corner."""
    pilaster, window = Shape(), Shape()
    pilaster.box("marble", (-0.45, -0.14, 0.3), (0.45, 0.3, high_m + 0.8))
    window.box("wood", (-0.7, -0.06, low_m), (0.7, 0.3, high_m), 0.35)
    edges = np.roll(outline, -1, axis=0) - outline
    yaw = np.arctan2(edges[:, 1], edges[:, 0])
    ground = np.zeros(len(outline))
    shape.copies(pilaster, np.column_stack([outline, ground]), yaw)
    roomy = np.linalg.norm(edges, axis=1) > 3.0
    shape.copies(window, np.column_stack([outline + edges / 2.0, ground])[roomy], yaw[roomy])
    for share in np.linspace(0.06, 0.94, 9):
        shape.copies(window, np.array([[*(outline[0] + share * edges[0]), 0.0]]))


def portico(width_m: float, depth_m: float, column: tuple[float, float], spacing_m: float, top_m: float) -> Shape:
    """Return a lean-to colonnade: wall at y = 0, columns (diameter, height) at `depth_m`, its roof up to `top_m` at the wall."""
    part = Shape()
    diameter, height = column
    y, beam_m = depth_m - 0.4, 0.16 * height
    count = max(2, round(width_m / spacing_m))
    part.copies(parts.column(diameter, height), parts.row((0.6, y), (width_m - 0.6, y), count))
    parts.beam(part, 0.0, width_m, y - 0.3, y + 0.3, height, beam_m)
    part.box("plaster", (0.0, 0.0, 0.0), (width_m, 0.6, top_m - 0.02))
    parts.lean_to(part, 0.0, width_m, depth_m + 0.3, 0.0, height + beam_m, top_m)
    return part


def court(monument: Monument, shape: Shape) -> None:
    """A walled court, colonnades on three sides, the eastern one higher; two shrines on a podium in the west."""
    length, width = size_m(monument)
    column = (monument.measure("column_diameter_m"), monument.measure("column_height_m"))
    depth, low_top = 4.2, column[1] * 1.16 + 4.5 * 0.2
    floor(shape, length, width)
    turned(shape, portico(length - depth, depth, column, 2.4, low_top), 0, length, width)
    north = portico(length - depth, depth, column, 2.4, low_top)
    shape.copies(north, np.array([[length - depth, width, 0.0]]), np.array([np.pi]))
    turned(shape, portico(width, depth + 0.6, (0.7, column[1] * 1.24), 3.2, monument.height_m), 1, length, width)
    shape.box("plaster", (0.0, depth, 0.0), (0.6, width - depth, low_top))
    shape.box("ashlar", (0.6, depth + 1.0, 0.0), (11.0, width - depth - 1.0, 1.5))
    for share in (0.3, 0.7):
        _shrine(shape, 1.8, share * width - 2.75, 8.0, 5.5, 1.5, monument.height_m - 0.2)
    parts.door(shape, 0.45 * length, 0.0, 2.4, 3.4, -1.0)


def _shrine(shape: Shape, x: float, y: float, length_m: float, width_m: float, z: float, top_m: float) -> None:
    """Add a little temple with four columns to the east."""
    part, eave = Shape(), top_m - z - 1.1
    parts.walls(part, "marble", 0.3, length_m - 2.4, 0.3, width_m - 0.3, 0.0, eave - 0.5, 0.4)
    front = parts.row((length_m - 0.5, 0.5), (length_m - 0.5, width_m - 0.5), 4)
    part.copies(parts.column(0.42, eave - 0.5), front)
    parts.frame(part, 0.5, length_m - 0.5, 0.5, width_m - 0.5, 0.4, eave - 0.5, 0.5)
    parts.gable(part, 0.2, length_m - 0.2, 0.2, width_m - 0.2, eave, top_m - z, "marble")
    shape.copies(part, np.array([[x, y, z]]))


def prytaneion(monument: Monument, shape: Shape) -> None:
    """A forecourt with porticoes on three sides, a Doric porch of six columns, the hall of Hestia under one roof with it."""
    length, width = size_m(monument)
    floor(shape, length, width)
    court_y, porch_y, rear_y = 19.3, 27.3, 43.4
    column = (0.5, 4.0)
    turned(shape, portico(length, 3.9, column, 2.4, 5.4), 0, length, width)
    for x, yaw in ((0.0, -np.pi / 2.0), (length, np.pi / 2.0)):
        aisle = portico(court_y - 3.9, 3.9, column, 2.4, 5.4)
        shape.copies(aisle, np.array([[x, court_y if x == 0.0 else 3.9, 0.0]]), np.array([yaw]))
    parts.door(shape, length / 2.0, 0.0, 2.2, 3.2, -1.0)
    height, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    eave = height + 1.9
    doric = parts.row((3.6, court_y + 0.8), (length - 3.6, court_y + 0.8), int(monument.measure("porch_columns")))
    shape.copies(parts.column(diameter, height, plain=True), doric)
    parts.beam(shape, 0.0, length, court_y + 0.25, court_y + 1.35, height, 1.9)
    for x in (0.0, length - 0.8):
        shape.box("ashlar", (x, court_y, 0.0), (x + 0.8, rear_y, eave))
    shape.box("ashlar", (0.8, porch_y, 0.0), (length - 0.8, porch_y + 0.7, eave))
    shape.box("ashlar", (0.8, rear_y - 0.7, 0.0), (length - 0.8, rear_y, eave))
    parts.door(shape, length * 0.66, porch_y, 2.6, 4.2, -1.0)
    parts.door(shape, length * 0.2, porch_y, 1.4, 2.8, -1.0)
    roof = Shape()
    parts.gable(roof, court_y, rear_y, 0.1, length - 0.1, eave, monument.height_m, "plaster")
    shape.copies(roof, np.array([[length, 0.0, 0.0]]), np.array([np.pi / 2.0]))
    parts.walls(shape, "plaster", 0.0, length, rear_y, width, 0.0, 5.6)
    parts.lean_to(shape, 0.0, length, width + 0.4, rear_y, 5.5, 7.6)
