"""Halls, temples and civic buildings as they stand today. Each adds itself to a shape in the monument's own axes."""

import numpy as np

from assets import orders, parts, rubble
from assets.entablature import entablature
from assets.monuments.bouleuterion import LOWER, half_ring, rows_profile, stairs_between
from assets.shape import Shape, size_m, turned
from assets.site import Monument


def basilica(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Stylobates, a floor of earth, stumps, twelve columns set up again, the foot of the rear wall."""
    length, width = size_m(monument)
    shape.box("earth", (0.0, 0.4, -1.6), (length, width, -0.12))
    rows = (0.5, 5.2, 12.0)
    for y, size in zip(rows, ((0.95, 0.3), (0.8, 0.2), (0.8, 0.2)), strict=True):
        rubble.row_of_blocks(shape, rng, np.array([0.0, y]), np.array([length, y]), size, -0.2)
    upright = np.sort(rng.permutation(np.arange(17, 31))[:8])
    for y in rows[1:]:
        places = parts.row((2.4, y), (length - 2.4, y), 33)
        chosen = upright if y == rows[1] else upright[1::2]
        rubble.stumps(shape, rng, np.delete(places, chosen, axis=0), 0.75, 2.2)
        for i in chosen:
            height = 6.6 if rng.random() < 0.7 else float(rng.uniform(3.2, 5.2))
            column = orders.column("bull", 0.75, 6.6, 1) if height == 6.6 else rubble.drum(0.75, height)
            shape.copies(column, places[i : i + 1])
    rubble.stumps(shape, rng, parts.row((0.6, 0.5), (length - 0.6, 0.5), 67), 0.6, 0.9)
    rubble.broken_wall(shape, rng, "ashlar", (0.0, width - 0.35), (length, width - 0.35), 0.7, (0.5, 2.9))
    rubble.scatter(shape, rng, rubble.inside(rng, 150, length, width, -0.1), 1.1)
    rubble.drums(shape, rng, rubble.inside(rng, 22, length, width - 2.0, -0.1), 0.7)


def stairs(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Worn steps with gaps."""
    length, width = size_m(monument)
    count = int(monument.measure("steps"))
    shape.box("stone", (0.0, 0.2, -0.6), (length, width, 0.1), 0.8)
    for i in range(count):
        y, top = width * (i + 0.5) / count, monument.height_m * (i + 1) / count - 0.04
        rubble.row_of_blocks(
            shape, rng, np.array([0.0, y]), np.array([length, y]), (width / count * 1.05, 0.26), top - 0.26
        )
        rubble.row_of_blocks(
            shape, rng, np.array([0.0, y]), np.array([length, y]), (width / count * 0.9, 0.26), top - 0.42
        )


def walls(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The feet of four walls and what fell from them."""
    length, width = size_m(monument)
    shape.box("earth", (0.2, 0.2, -1.4), (length - 0.2, width - 0.2, -0.1))
    rubble.broken_walls(shape, rng, "rustic", (length, width), 0.7, (0.4, 1.5))
    rubble.scatter(shape, rng, rubble.inside(rng, round(length * width / 9.0), length, width, -0.1), 0.9)


def stoa(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """A stylobate with drums and the foot of the back wall."""
    length, width = size_m(monument)
    side = int(monument.measure("open_side"))
    w, d = (length, width) if side % 2 == 0 else (width, length)
    part = Shape()
    rubble.row_of_blocks(part, rng, np.array([0.0, 0.5]), np.array([w, 0.5]), (0.9, 0.4), -0.45)
    rubble.stumps(part, rng, parts.row((0.6, 0.5), (w - 0.6, 0.5), int(monument.measure("front_columns"))), 0.62, 1.5)
    rubble.broken_wall(part, rng, "rustic", (0.0, d - 0.4), (w, d - 0.4), 0.75, (0.4, 2.2), -0.3)
    rubble.scatter(part, rng, rubble.inside(rng, round(w * d / 16.0), w, d, -0.5), 1.0)
    rubble.drums(part, rng, rubble.inside(rng, round(w / 7.0), w, d, -0.5), 0.62)
    turned(shape, part, side, length, width)


def temple(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The rectangle of a foundation, its core robbed."""
    length, width = size_m(monument)
    low = -monument.measure("steps_m")
    for inset, height in ((0.4, 0.55), (3.2, 0.4)):
        a, b, c, d = (inset, inset), (length - inset, inset), (length - inset, width - inset), (inset, width - inset)
        for start, end in ((a, b), (b, c), (c, d), (d, a)):
            rubble.row_of_blocks(shape, rng, np.array(start), np.array(end), (0.95, height), low)
    rubble.scatter(shape, rng, rubble.inside(rng, 60, length, width, low), 1.0)
    shape.box("earth", (3.6, 3.6, low - 0.5), (length - 3.6, width - 3.6, low + 0.22))


def bouleuterion(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Seats in a half circle, restored below and rubble above, between broken walls; the stage wall to its pedestals."""
    radius, y0 = size_m(monument)[0] / 2.0, 5.7
    angle = np.linspace(-0.06, np.pi + 0.06, 40)
    ring = np.stack([np.cos(angle), np.sin(angle)], -1)
    middle = (radius, y0)
    half_ring(shape, "marble", ring, middle, [*rows_profile(LOWER, nosing=False), (14.4, LOWER[2] * LOWER[4])], 0.9)
    stairs_between(shape, middle, LOWER, np.linspace(0.04, np.pi - 0.04, 6))
    upper = [
        (14.9 + 0.85 * i + float(rng.normal(0.0, 0.12)), 6.2 + 0.5 * i + float(rng.normal(0.0, 0.14))) for i in range(9)
    ]
    half_ring(shape, "rustic", ring, middle, [(14.4, LOWER[2] * LOWER[4]), *upper], 1.0)
    places = np.column_stack([ring[2:-2] * 18.0 + (radius, y0), np.full(len(ring) - 4, 7.6)])
    rubble.scatter(shape, rng, places + rng.normal(0.0, (1.6, 1.6, 0.1), places.shape), 1.0)
    outer = ring * (radius - 0.6) + (radius, y0)
    for start, end in zip(outer[:-1:3], outer[3::3], strict=True):
        rubble.broken_wall(shape, rng, "ashlar", tuple(start), tuple(end), 1.2, (8.2, 11.6))
    for side in (0.0, 2.0 * radius - 8.4):
        rubble.broken_wall(shape, rng, "ashlar", (side, y0), (side + 8.4, y0), 1.2, (3.2, 7.4))
    for share in np.linspace(0.04, 0.96, 7):
        x = share * 2.0 * radius
        rubble.broken_wall(shape, rng, "ashlar", (x - 2.2, 1.4), (x + 2.2, 1.4), 1.0, (2.2, 3.6))
    shape.box("paving", (0.3, 0.3, -1.2), (2.0 * radius - 0.3, y0, 0.02), 0.9)
    shape.polygons("paving", np.column_stack([ring * 4.7 + (radius, y0), np.full(len(ring), 0.03)]), 0.95)


def court(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Low foundations, the core of the podium, stumps."""
    walls(monument, shape, rng)
    length, width = size_m(monument)
    shape.box("rustic", (1.5, 6.0, -0.5), (10.0, width - 6.0, 0.9), 0.9)
    for y in (4.2, width - 4.2):
        rubble.stumps(shape, rng, parts.row((12.0, y), (length - 4.5, y), 9), 0.55, 1.6)
    rubble.stumps(shape, rng, parts.row((length - 4.6, 4.2), (length - 4.6, width - 4.2), 8), 0.7, 2.4)


def prytaneion(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Wall feet, two Doric columns with a piece of their entablature, the hall's corner supports."""
    walls(monument, shape, rng)
    length, _ = size_m(monument)
    height, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    x = length * 0.5
    for at in (x, x + 3.1):
        shape.copies(orders.column("doric", diameter, height, 1), np.array([[at, 20.1, 0.0]]))
    entablature(shape, "doric", (x - 0.7, x + 3.8, 19.6, 20.6), height, 1.3)
    rubble.stumps(shape, rng, parts.row((3.6, 20.1), (length - 3.6, 20.1), 6), 1.1, 1.6)
    for corner in ((10.5, 31.0), (19.8, 31.0), (10.5, 40.0), (19.8, 40.0)):
        for off in (0.0, 0.4):
            shape.copies(
                rubble.drum(0.62, float(rng.uniform(1.2, 4.6))), np.array([[corner[0] + off, corner[1] + off, 0.0]])
            )
    for y in (27.6, 43.4):
        rubble.broken_wall(shape, rng, "ashlar", (0.7, y), (length - 0.7, y), 0.7, (0.4, 1.9))
