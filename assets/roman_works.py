"""Fountains, walls, terraces, gates, baths and monuments of the Roman square. Each adds itself to a shape."""

import numpy as np

from assets import parts
from assets.roman_halls import FOUNDATION_M
from assets.shape import Shape, size_m, turned
from assets.site import Monument


def stairs(monument: Monument, shape: Shape) -> None:
    """Steps that rise from the first edge of the footprint."""
    length, width = size_m(monument)
    count = int(monument.measure("steps"))
    shape.box("marble", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    for i in range(count):
        top = monument.height_m * (i + 1) / count
        shape.box("marble", (0.0, width * i / count, 0.0), (length, width, top), 1.0 - 0.04 * (i % 2))


def wall(monument: Monument, shape: Shape) -> None:
    """A retaining wall of bossed blocks with a coping."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("rustic", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    shape.box("rustic", (0.0, 0.0, 0.0), (length, width, top - 0.25))
    shape.box("marble", (-0.1, -0.1, top - 0.25), (length + 0.1, width + 0.1, top))


def socle(monument: Monument, shape: Shape) -> None:
    """A block of masonry clad in marble, with a foot and a cornice."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("ashlar", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    shape.box("ashlar", (0.0, 0.0, 0.0), (length, width, top - 0.5))
    for low, high, out in ((0.0, 0.5, 0.15), (0.5, 0.75, 0.08), (top - 0.7, top - 0.35, 0.15), (top - 0.35, top, 0.35)):
        shape.box("marble", (-out, -out, low), (length + out, width + out, high))


def vaulted(monument: Monument, shape: Shape) -> None:
    """A great arch to the west, an apse behind it, water at its foot."""
    length, width = size_m(monument)
    part, w, d = Shape(), width, length
    span, crown, top = monument.measure("span_m"), monument.measure("crown_m"), monument.height_m
    pier = (w - span) / 2.0
    spring = crown - span / 2.0
    part.box("ashlar", (0.0, 0.0, -FOUNDATION_M), (w, d, 0.0))
    for x in (0.0, w - pier):
        part.box("marble", (x, 0.0, 0.0), (x + pier, d, top - 0.6))
        part.box("marble", (x - 0.1, -0.15, spring - 0.4), (x + pier + 0.1, 1.7, spring))
    parts.arch(part, "marble", w / 2.0, span, 0.0, 1.6, spring, top - 0.6, 20)
    part.box("ashlar", (pier, d - 1.0, 0.0), (w - pier, d, top - 0.6))
    part.box("ashlar", (pier, 1.6, crown + 0.2), (w - pier, d - 1.0, top - 0.6))
    _apse(part, w / 2.0, d - 1.0, span / 2.0, spring)
    part.box("marble", (-0.25, -0.25, top - 0.6), (w + 0.25, d + 0.25, top))
    part.box("marble", (pier, 0.3, 0.0), (w - pier, 0.7, 0.9))
    part.polygons("water", [(pier, 0.7, 0.75), (w - pier, 0.7, 0.75), (w - pier, d - 1.0, 0.75), (pier, d - 1.0, 0.75)])
    turned(shape, part, 3, length, width)


def _apse(part: Shape, centre_x: float, back_y: float, radius_m: float, spring_m: float) -> None:
    """Add the hollow of an apse that looks to -y, with its half dome."""
    angle = np.linspace(0.0, np.pi, 13)
    front_y = max(back_y - radius_m, 1.6)
    deep = back_y - front_y
    ring = np.stack([centre_x + radius_m * np.cos(angle), front_y + deep * np.sin(angle)], -1)
    rows = [np.column_stack([ring, np.full(13, z)]) for z in (0.0, spring_m)]
    for rise in np.linspace(0.25, 1.0, 5) * np.pi / 2.0:
        at = (centre_x, front_y) + (ring - (centre_x, front_y)) * max(np.cos(rise), 1e-3)
        rows.append(np.column_stack([at, np.full(13, spring_m + radius_m * np.sin(rise))]))
    part.surface("plaster", np.stack(rows), 0.75)


def chambers(monument: Monument, shape: Shape) -> None:
    """A row of vaulted rooms, open to the west."""
    length, width = size_m(monument)
    part, w, d, top = Shape(), width, length, monument.height_m
    count = int(monument.measure("chambers"))
    bay = w / count
    span = bay * 0.62
    pier = (bay - span) / 2.0
    part.box("rustic", (0.0, 0.0, -FOUNDATION_M), (w, d, 0.0))
    part.box("rustic", (0.0, d - 0.8, 0.0), (w, d, top - 0.4))
    for i in range(count):
        for x in (i * bay, (i + 1) * bay - pier):
            part.box("rustic", (x, 0.0, 0.0), (x + pier, d - 0.8, top - 0.4))
        parts.arch(part, "rustic", (i + 0.5) * bay, span, 0.0, d - 0.8, top - 0.9 - span / 2.0, top - 0.4)
    part.box("marble", (-0.15, -0.2, top - 0.4), (w + 0.15, d, top))
    turned(shape, part, 3, length, width)


def nymphaeum(monument: Monument, shape: Shape) -> None:
    """Two storeys of little columned bays on three sides of a basin, open to the west."""
    length, width = size_m(monument)
    part, w, d, top = Shape(), width, length, monument.height_m
    diameter, lower = monument.measure("column_diameter_m"), monument.measure("column_height_m")
    beam, podium = 0.55, 1.2
    upper = top - podium - lower - 2.0 * beam
    part.box("marble", (0.0, 0.0, -FOUNDATION_M), (w, d, 0.0))
    part.box("ashlar", (0.0, d - 1.0, 0.0), (w, d, top - beam))
    for x in (0.0, w - 1.0):
        part.box("ashlar", (x, 4.0, 0.0), (x + 1.0, d - 1.0, top - beam))
    runs = (
        ((1.2, d - 2.0), (w - 1.2, d - 2.0), 8),
        ((2.0, 4.3), (2.0, d - 3.6), 4),
        ((w - 2.0, 4.3), (w - 2.0, d - 3.6), 4),
    )
    boxes = ((1.0, d - 2.5, w - 1.0, d - 1.0), (1.0, 4.0, 2.5, d - 2.5), (w - 2.5, 4.0, w - 1.0, d - 2.5))
    for (start, end, count), (x0, y0, x1, y1) in zip(runs, boxes, strict=True):
        part.box("marble", (x0, y0, 0.0), (x1, y1, podium))
        part.copies(parts.column(diameter, lower), parts.row(start, end, count, podium))
        parts.beam(part, x0, x1, y0, y1, podium + lower, beam)
        part.copies(parts.column(0.85 * diameter, upper), parts.row(start, end, count, podium + lower + beam))
        parts.beam(part, x0, x1, y0, y1, top - beam, beam)
    part.box("marble", (0.0, 0.0, 0.0), (w, 0.5, 1.0))
    for x in (0.0, w - 0.5):
        part.box("marble", (x, 0.5, 0.0), (x + 0.5, 4.0, 1.0))
    part.polygons("water", [(0.5, 0.5, 0.8), (w - 0.5, 0.5, 0.8), (w - 0.5, d - 2.5, 0.8), (0.5, d - 2.5, 0.8)])
    turned(shape, part, 3, length, width)


def terrace(monument: Monument, shape: Shape) -> None:
    """A great platform: two storeys of half-pillars on the north and east, plain walls elsewhere."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("rustic", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    shape.box("ashlar", (0.0, 0.0, 0.0), (length, width, top - 0.02))
    shape.polygons("paving", [(0.0, 0.0, top), (length, 0.0, top), (length, width, top), (0.0, width, top)])
    for side, run in ((1, width), (2, length)):
        part = Shape()
        count = round(run / 3.6)
        x = np.linspace(0.4, run - 0.4, count)
        for low, high, half in ((0.1, top * 0.5 - 0.5, 0.35), (top * 0.5, top - 0.6, 0.3)):
            level = np.ones(count)
            lows = np.stack([x - half, -0.35 * level, low * level], -1)
            part.boxes("marble", lows, np.stack([x + half, 0.2 * level, high * level], -1))
            middle = (x[:-1] + x[1:]) / 2.0
            flat = np.ones(count - 1)
            lows = np.stack([middle - 0.9, -0.05 * flat, (low + 0.05) * flat], -1)
            part.boxes("wood", lows, np.stack([middle + 0.9, 0.1 * flat, (high - 1.0) * flat], -1), 0.4)
        part.box("marble", (0.0, -0.5, top * 0.5 - 0.5), (run, 0.2, top * 0.5))
        part.box("marble", (0.0, -0.5, top - 0.6), (run, 0.2, top - 0.02))
        turned(shape, part, side, length, width)


def gate(monument: Monument, shape: Shape) -> None:
    """A columned gateway: two walls, two columns between them at either end, a gable roof along the passage."""
    length, width = size_m(monument)
    part, w, d = Shape(), width, length
    height, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    eave = height + 1.3
    part.box("paving", (0.0, 0.0, -FOUNDATION_M), (w, d, 0.0))
    for y in (0.0, d - 0.9):
        part.box("ashlar", (0.0, y, 0.0), (w, y + 0.9, height))
    for x in (0.6, w - 0.6):
        part.copies(parts.column(diameter, height, plain=True), parts.row((x, 0.33 * d), (x, 0.67 * d), 2))
    parts.frame(part, 0.5, w - 0.5, 0.45, d - 0.45, 0.9, height, 1.3)
    parts.gable(part, 0.0, w, 0.0, d, eave, monument.height_m, "marble")
    turned(shape, part, 1, length, width)


def tower(monument: Monument, shape: Shape) -> None:
    """Steps, a rusticated foot, a storey of arches between corner piers, a storey of columns, a pointed roof."""
    length, width = size_m(monument)
    side, top = monument.measure("side_m"), monument.height_m
    shape.box("ashlar", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    for i in range(3):
        inset = 0.45 * i
        shape.box("marble", (inset, inset, 0.0), (length - inset, width - inset, 0.3 * (i + 1)))
    part, half = Shape(), side / 2.0
    part.box("rustic", (-half, -half, 0.9), (half, half, 3.2))
    storey, spring, pier = 8.6, 6.2, 1.5
    for x in (-half, half - pier):
        for y in (-half, half - pier):
            part.box("marble", (x, y, 3.2), (x + pier, y + pier, storey))
    part.box("ashlar", (-half + 1.4, -half + 1.4, 3.2), (half - 1.4, half - 1.4, storey), 0.85)
    for yaw in range(4):
        front = Shape()
        parts.arch(front, "marble", 0.0, side - 2.0 * pier, -half, -half + 1.4, spring - 1.0, storey, 12)
        part.copies(front, np.zeros((1, 3)), np.array([yaw * np.pi / 2.0]))
    part.box("marble", (-half - 0.3, -half - 0.3, storey), (half + 0.3, half + 0.3, storey + 0.7))
    part.box("ashlar", (-half + 1.8, -half + 1.8, storey + 0.7), (half - 1.8, half - 1.8, 13.2))
    ring = parts.ring(-half + 0.8, half - 0.8, -half + 0.8, half - 0.8, 4, 4)
    ring[:, 2] = storey + 0.7
    part.copies(parts.column(0.6, 13.2 - storey - 0.7), ring)
    part.box("marble", (-half + 0.2, -half + 0.2, 13.2), (half - 0.2, half - 0.2, 14.2))
    parts.revolved(part, "marble", np.array([(half - 1.2, 14.2), (half - 1.2, 15.3)]), 16)
    parts.revolved(part, "marble", np.array([(half - 0.9, 15.3), (0.05, top)]), 16)
    shape.copies(part, np.array([[length / 2.0, width / 2.0, 0.0]]))


def basin(monument: Monument, shape: Shape) -> None:
    """A street fountain: a basin with a wall behind it."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("marble", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    parts.walls(shape, "marble", 0.0, length, 0.0, width, 0.0, 0.9, 0.4)
    shape.box("ashlar", (0.0, 0.0, 0.0), (0.8, width, top))
    corners = [(0.8, 0.4, 0.7), (length - 0.4, 0.4, 0.7), (length - 0.4, width - 0.4, 0.7), (0.8, width - 0.4, 0.7)]
    shape.polygons("water", corners)


def baths(monument: Monument, shape: Shape) -> None:
    """Four barrel-vaulted halls in the north, lower halls and an open court in the south."""
    length, width = size_m(monument)
    spring, crown = monument.measure("spring_m"), monument.height_m
    middle, count = width * 0.5, 4
    bay = length / count
    shape.box("paving", (0.0, 0.0, -FOUNDATION_M), (length, width, 0.0))
    for i in range(count):
        x0, x1 = i * bay, (i + 1) * bay
        top = crown - (0.0, 0.9, 0.4, 1.2)[i]
        parts.walls(shape, "ashlar", x0, x1, middle, width, 0.0, spring, 1.2)
        parts.vault(shape, "plaster", x0 + 0.2, x1 - 0.2, middle, width, spring, top, "ashlar")
        window = Shape()
        for share in (0.32, 0.5, 0.68):
            window.box("wood", (share * bay - 1.0, width, 3.0), (share * bay + 1.0, width + 0.06, 6.0), 0.35)
        shape.copies(window, np.array([[x0, 0.0, 0.0]]))
    for x0, x1 in ((0.0, bay), (3.0 * bay, length)):
        low = Shape()
        parts.walls(low, "plaster", 0.0, middle, 0.0, x1 - x0, 0.0, 4.8)
        parts.gable(low, 0.0, middle, 0.0, x1 - x0, 4.8, 7.4, "plaster")
        shape.copies(low, np.array([[x1, 0.0, 0.0]]), np.array([np.pi / 2.0]))
    shape.box("plaster", (bay, 0.0, 0.0), (3.0 * bay, 0.6, 3.6))
    south = Shape()
    south.copies(parts.column(0.55, 4.2), parts.row((bay + 1.5, middle - 4.0), (3.0 * bay - 1.5, middle - 4.0), 13))
    parts.beam(south, bay, 3.0 * bay, middle - 4.35, middle - 3.65, 4.2, 0.7)
    parts.lean_to(south, bay, 3.0 * bay, middle - 4.6, middle, 4.9, 6.3)
    shape.copies(south, np.zeros((1, 3)))
