"""Fountains, walls, terraces, baths and monuments as they stand today. Each adds itself to a shape in the monument's own axes."""

import numpy as np

from assets import parts, rubble
from assets.shape import Shape, size_m, turned
from assets.site import Monument


def platform_hall(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The platform of bossed blocks, several courses of it."""
    length, width = size_m(monument)
    top = monument.measure("platform_m")
    shape.box("rustic", (0.4, 0.4, -1.6), (length - 0.4, width - 0.4, top - 1.2))
    rubble.broken_walls(shape, rng, "rustic", (length, width), 0.9, (top - 2.2, top - 0.2))
    rubble.scatter(shape, rng, rubble.inside(rng, 40, length, width, top - 1.2), 1.2)


def wall(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The terrace wall up to the grass, its last courses broken."""
    length, width = size_m(monument)
    top = -monument.base_z_m
    shape.box("rustic", (0.0, 0.0, -1.6), (length, width, top - 0.1))
    rubble.broken_wall(
        shape, rng, "rustic", (0.0, width / 2.0), (length, width / 2.0), width * 0.8, (0.2, 0.9), top - 0.1
    )


def socle(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """A block of masonry with most of its facing."""
    length, width = size_m(monument)
    shape.box("rustic", (0.15, 0.15, -1.6), (length - 0.15, width - 0.15, monument.height_m - 0.5), 0.95)
    rubble.broken_walls(shape, rng, "ashlar", (length, width), 0.5, (0.7 * monument.height_m, monument.height_m - 0.2))


def vaulted(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The tall arch, set up again, before the foot of its apse."""
    length, width = size_m(monument)
    span, crown = monument.measure("span_m"), monument.measure("crown_m")
    part, pier, spring = Shape(), (width - span) / 2.0, crown - span / 2.0
    for x in (0.0, width - pier):
        part.box("ashlar", (x, 0.2, -1.6), (x + pier, 1.5, spring))
        part.box("marble", (x - 0.1, 0.1, spring - 0.35), (x + pier + 0.1, 1.6, spring))
    parts.arch(part, "ashlar", width / 2.0, span, 0.3, 1.4, spring, crown + 0.7, 18)
    for x in (0.0, width - pier):
        part.box("ashlar", (x, 0.3, spring), (x + pier, 1.4, crown + 0.7))
    rubble.broken_wall(part, rng, "rustic", (0.6, length - 0.6), (width - 0.6, length - 0.6), 1.2, (1.2, 4.6))
    for x in (0.6, width - 0.6):
        rubble.broken_wall(part, rng, "rustic", (x, 1.6), (x, length - 0.6), 1.2, (0.8, 3.6))
    turned(shape, part, 3, length, width)


def chambers(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Side walls of vaulted rooms, one arch still up."""
    length, width = size_m(monument)
    part, count = Shape(), int(monument.measure("chambers"))
    rubble.broken_wall(part, rng, "rustic", (0.0, length - 0.5), (width, length - 0.5), 1.0, (2.0, 5.6))
    for i in range(count + 1):
        x = 0.5 + (width - 1.0) * i / count
        rubble.broken_wall(part, rng, "rustic", (x, 0.0), (x, length), 1.1, (1.2, 5.0))
    parts.arch(part, "rustic", width / count * 1.5, width / count - 1.4, 0.4, 2.0, 1.6, 5.4)
    turned(shape, part, 3, length, width)


def high_walls(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Core walls of rubble to two or three metres."""
    length, width = size_m(monument)
    shape.box("earth", (0.3, 0.3, -1.4), (length - 0.3, width - 0.3, -0.05))
    rubble.broken_walls(shape, rng, "rustic", (length, width), 1.1, (0.8, 3.2))
    rubble.scatter(shape, rng, rubble.inside(rng, 30, length, width, 0.0), 0.9)


def terrace(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The bare terrace, its edges broken, two tall piers with their entablature on the north front."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("rustic", (0.5, 0.5, -1.6), (length - 0.5, width - 0.5, top - 0.35))
    shape.polygons(
        "grass", [(0.0, 0.0, top - 0.3), (length, 0.0, top - 0.3), (length, width, top - 0.3), (0.0, width, top - 0.3)]
    )
    rubble.broken_walls(shape, rng, "rustic", (length, width), 1.2, (top - 3.0, top - 0.2))
    rubble.scatter(shape, rng, rubble.inside(rng, 160, length, width, top - 0.3), 1.2)
    for x in (18.0, 22.0):
        shape.box("marble", (x - 0.5, width + 0.2, -0.5), (x + 0.5, width + 0.9, top - 0.8), 0.9)
    shape.box("marble", (17.2, width + 0.1, top - 0.8), (22.8, width + 1.0, top), 0.9)


def tower(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The socle and arches put together from what was found, about seven metres."""
    length, width = size_m(monument)
    half, part = monument.measure("side_m") / 2.0, Shape()
    part.box("rustic", (-half - 0.8, -half - 0.8, -1.6), (half + 0.8, half + 0.8, 0.9))
    part.box("rustic", (-half, -half, 0.9), (half, half, 3.0))
    for x in (-half, half - 1.5):
        for y in (-half, half - 1.5):
            part.box("ashlar", (x, y, 3.0), (x + 1.5, y + 1.5, 6.2))
    for yaw in (0.0, np.pi / 2.0):
        front = Shape()
        parts.arch(front, "ashlar", 0.0, 2.0 * half - 3.0, -half, -half + 1.2, 4.2, 7.6, 12)
        part.copies(front, np.zeros((1, 3)), np.array([yaw]))
    rubble.broken_wall(part, rng, "rustic", (-half + 1.5, half - 1.0), (half - 1.5, half - 1.0), 1.2, (0.8, 3.0), 3.0)
    shape.copies(part, np.array([[length / 2.0, width / 2.0, 0.0]]))


def basin(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The rim of a street fountain and bases of its late statues."""
    length, width = size_m(monument)
    rubble.broken_walls(shape, rng, "ashlar", (length, width), 0.6, (0.4, 1.3))
    for y in np.linspace(1.5, width - 1.5, 4):
        shape.copies(rubble.drum(0.55, float(rng.uniform(1.2, 3.4))), np.array([[length - 0.6, y, 0.0]]))


def piers(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Two piers that narrow a street."""
    _, width = size_m(monument)
    for y in (width / 2.0 - 1.4, width / 2.0 + 1.4):
        shape.box("marble", (0.4, y - 0.4, -1.2), (1.2, y + 0.4, monument.height_m), 0.9)
    rubble.scatter(shape, rng, np.array([[0.8, 0.3, 0.0], [0.9, width - 0.4, 0.0]]), 0.8)


def baths(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Tall stubs of walls and three arches in the north, the rest low and overgrown."""
    length, width = size_m(monument)
    for i in range(5):
        x = 0.8 + (length - 1.6) * i / 4.0
        rubble.broken_wall(shape, rng, "ashlar", (x, width * 0.5), (x, width), 1.5, (1.5, 7.5))
    rubble.broken_wall(shape, rng, "rustic", (0.0, width - 0.7), (length, width - 0.7), 1.4, (1.5, 6.5))
    for i in range(3):
        parts.arch(shape, "ashlar", 6.0 + 5.2 * i, 3.6, width * 0.5, width * 0.5 + 1.3, 4.2, 7.0)
        for x in (3.4 + 5.2 * i, 7.8 + 5.2 * i):
            shape.box("ashlar", (x, width * 0.5, -1.0), (x + 0.8, width * 0.5 + 1.3, 7.0))
    rubble.broken_walls(shape, rng, "rustic", (length, width * 0.5), 0.9, (0.4, 3.0))
    rubble.scatter(shape, rng, rubble.inside(rng, 160, length, width, 0.0), 1.2)
