"""The monuments as they stand today, by kind. Each adds itself to a shape in the monument's own axes."""

from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np

from assets import parts, rubble
from assets.axes import Array
from assets.shape import Shape, size_m, turned
from assets.site import Monument

Ruin = Callable[[Monument, Shape, np.random.Generator], None]


def _inside(rng: np.random.Generator, count: int, length_m: float, width_m: float, z_m: float) -> Array:
    return np.stack(
        [rng.uniform(0.4, length_m - 0.4, count), rng.uniform(0.4, width_m - 0.4, count), np.full(count, z_m)], -1
    )


def _stumps(shape: Shape, rng: np.random.Generator, places_m: Array, diameter_m: float, highest_m: float) -> None:
    """Add what is left of columns: a few drums, at most places nothing."""
    for place in places_m[rng.random(len(places_m)) < 0.45]:
        height = float(rng.uniform(0.25, 1.0) ** 2 * highest_m + 0.2)
        shape.copies(rubble.drum(diameter_m, height), place[None], rng.uniform(0.0, 6.0, 1))


def _drums(shape: Shape, rng: np.random.Generator, places_m: Array, diameter_m: float) -> None:
    for place in places_m:
        part = rubble.lying_drum(diameter_m * float(rng.uniform(0.85, 1.0)), float(rng.uniform(0.7, 1.9)))
        shape.copies(part, place[None], rng.uniform(0.0, np.pi, 1))


def _row_of_blocks(
    shape: Shape, rng: np.random.Generator, start: Array, end: Array, size: tuple[float, float], z: float
) -> None:
    """Add a stylobate: blocks end to end, some of them missing."""
    length = float(np.hypot(*(end - start)))
    count = max(2, round(length / 1.15))
    share = (np.arange(count) + 0.5)[:, None] / count
    middles = np.column_stack([start + (end - start) * share, np.full(count, z) + rng.normal(0.0, 0.02, count)])
    kept = rng.random(count) > 0.14
    sizes = np.tile([length / count * 0.98, *size], (count, 1))
    yaw = np.full(count, np.arctan2(*(end - start)[::-1])) + rng.normal(0.0, 0.012, count)
    rubble.blocks(shape, rng, middles[kept], sizes[kept], yaw[kept])


def basilica(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Stylobates, a floor of earth, stumps, twelve columns set up again, the foot of the rear wall."""
    length, width = size_m(monument)
    shape.box("earth", (0.0, 0.4, -1.6), (length, width, -0.12))
    rows = (0.5, 5.2, 12.0)
    for y, size in zip(rows, ((0.95, 0.3), (0.8, 0.2), (0.8, 0.2)), strict=True):
        _row_of_blocks(shape, rng, np.array([0.0, y]), np.array([length, y]), size, -0.2)
    upright = np.sort(rng.permutation(np.arange(17, 31))[:8])
    for y in rows[1:]:
        places = parts.row((2.4, y), (length - 2.4, y), 33)
        chosen = upright if y == rows[1] else upright[1::2]
        _stumps(shape, rng, np.delete(places, chosen, axis=0), 0.75, 2.2)
        for i in chosen:
            height = 6.6 if rng.random() < 0.7 else float(rng.uniform(3.2, 5.2))
            column = parts.column(0.75, 6.6) if height == 6.6 else rubble.drum(0.75, height)
            shape.copies(column, places[i : i + 1])
    _stumps(shape, rng, parts.row((0.6, 0.5), (length - 0.6, 0.5), 67), 0.6, 0.9)
    rubble.broken_wall(shape, rng, "ashlar", (0.0, width - 0.35), (length, width - 0.35), 0.7, (0.5, 2.9))
    rubble.scatter(shape, rng, _inside(rng, 150, length, width, -0.1), 1.1)
    _drums(shape, rng, _inside(rng, 22, length, width - 2.0, -0.1), 0.7)


def stairs(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Worn steps with gaps."""
    length, width = size_m(monument)
    count = int(monument.measure("steps"))
    shape.box("stone", (0.0, 0.2, -0.6), (length, width, 0.1), 0.8)
    for i in range(count):
        y, top = width * (i + 0.5) / count, monument.height_m * (i + 1) / count - 0.04
        _row_of_blocks(shape, rng, np.array([0.0, y]), np.array([length, y]), (width / count * 1.05, 0.26), top - 0.26)
        _row_of_blocks(shape, rng, np.array([0.0, y]), np.array([length, y]), (width / count * 0.9, 0.26), top - 0.42)


def walls(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The feet of four walls and what fell from them."""
    length, width = size_m(monument)
    shape.box("earth", (0.2, 0.2, -1.4), (length - 0.2, width - 0.2, -0.1))
    rubble.broken_walls(shape, rng, "rustic", (length, width), 0.7, (0.4, 1.5))
    rubble.scatter(shape, rng, _inside(rng, round(length * width / 9.0), length, width, -0.1), 0.9)


def stoa(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """A stylobate with drums and the foot of the back wall."""
    length, width = size_m(monument)
    side = int(monument.measure("open_side"))
    w, d = (length, width) if side % 2 == 0 else (width, length)
    part = Shape()
    _row_of_blocks(part, rng, np.array([0.0, 0.5]), np.array([w, 0.5]), (0.9, 0.4), -0.45)
    _stumps(part, rng, parts.row((0.6, 0.5), (w - 0.6, 0.5), int(monument.measure("front_columns"))), 0.62, 1.5)
    rubble.broken_wall(part, rng, "rustic", (0.0, d - 0.4), (w, d - 0.4), 0.75, (0.4, 2.2), -0.3)
    rubble.scatter(part, rng, _inside(rng, round(w * d / 16.0), w, d, -0.5), 1.0)
    _drums(part, rng, _inside(rng, round(w / 7.0), w, d, -0.5), 0.62)
    turned(shape, part, side, length, width)


def temple(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The rectangle of a foundation, its core robbed."""
    length, width = size_m(monument)
    low = -monument.measure("steps_m")
    for inset, height in ((0.4, 0.55), (3.2, 0.4)):
        a, b, c, d = (inset, inset), (length - inset, inset), (length - inset, width - inset), (inset, width - inset)
        for start, end in ((a, b), (b, c), (c, d), (d, a)):
            _row_of_blocks(shape, rng, np.array(start), np.array(end), (0.95, height), low)
    rubble.scatter(shape, rng, _inside(rng, 60, length, width, low), 1.0)
    shape.box("earth", (3.6, 3.6, low - 0.5), (length - 3.6, width - 3.6, low + 0.22))


def bouleuterion(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Seats in a half circle, restored below and rubble above, between broken walls; the stage wall to its pedestals."""
    radius, y0 = size_m(monument)[0] / 2.0, 5.7
    angle = np.linspace(-0.06, np.pi + 0.06, 40)
    ring = np.stack([np.cos(angle), np.sin(angle)], -1)
    seats = [(4.6 + 0.72 * i, 0.42 * i) for i in range(14)]
    profile = [(r, z + rise) for r, z in seats for rise in (0.0, 0.42)]
    _half_ring(shape, "marble", ring, radius, y0, profile, 0.9)
    upper = [
        (14.9 + 0.85 * i + float(rng.normal(0.0, 0.12)), 6.2 + 0.5 * i + float(rng.normal(0.0, 0.14))) for i in range(9)
    ]
    _half_ring(shape, "rustic", ring, radius, y0, [(14.4, 5.9), *upper], 1.0)
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


def _half_ring(
    shape: Shape,
    material: str,
    ring: Array,
    centre_x: float,
    centre_y: float,
    profile: list[tuple[float, float]],
    tint: float,
) -> None:
    """Add steps around a half circle: flat strips between neighbours of `profile` (radius, height)."""
    for (r0, z0), (r1, z1) in pairwise(profile):
        inner, outer = (
            np.column_stack([ring * r + (centre_x, centre_y), np.full(len(ring), z)]) for r, z in ((r0, z0), (r1, z1))
        )
        strip = np.stack([inner[:-1], outer[:-1], outer[1:], inner[1:]], axis=1)
        shape.polygons(material, strip, tint)


def court(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Low foundations, the core of the podium, stumps."""
    walls(monument, shape, rng)
    length, width = size_m(monument)
    shape.box("rustic", (1.5, 6.0, -0.5), (10.0, width - 6.0, 0.9), 0.9)
    for y in (4.2, width - 4.2):
        _stumps(shape, rng, parts.row((12.0, y), (length - 4.5, y), 9), 0.55, 1.6)
    _stumps(shape, rng, parts.row((length - 4.6, 4.2), (length - 4.6, width - 4.2), 8), 0.7, 2.4)


def prytaneion(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """Wall feet, two Doric columns with a piece of their entablature, the hall's corner supports."""
    walls(monument, shape, rng)
    length, _ = size_m(monument)
    height, diameter = monument.measure("column_height_m"), monument.measure("column_diameter_m")
    x = length * 0.5
    for at in (x, x + 3.1):
        shape.copies(parts.column(diameter, height, plain=True), np.array([[at, 20.1, 0.0]]))
    parts.beam(shape, x - 0.7, x + 3.8, 19.6, 20.6, height, 1.3)
    _stumps(shape, rng, parts.row((3.6, 20.1), (length - 3.6, 20.1), 6), 1.1, 1.6)
    for corner in ((10.5, 31.0), (19.8, 31.0), (10.5, 40.0), (19.8, 40.0)):
        for off in (0.0, 0.4):
            shape.copies(
                rubble.drum(0.62, float(rng.uniform(1.2, 4.6))), np.array([[corner[0] + off, corner[1] + off, 0.0]])
            )
    for y in (27.6, 43.4):
        rubble.broken_wall(shape, rng, "ashlar", (0.7, y), (length - 0.7, y), 0.7, (0.4, 1.9))


def platform_hall(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The platform of bossed blocks, several courses of it."""
    length, width = size_m(monument)
    top = monument.measure("platform_m")
    shape.box("rustic", (0.4, 0.4, -1.6), (length - 0.4, width - 0.4, top - 1.2))
    rubble.broken_walls(shape, rng, "rustic", (length, width), 0.9, (top - 2.2, top - 0.2))
    rubble.scatter(shape, rng, _inside(rng, 40, length, width, top - 1.2), 1.2)


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
    rubble.scatter(shape, rng, _inside(rng, 30, length, width, 0.0), 0.9)


def terrace(monument: Monument, shape: Shape, rng: np.random.Generator) -> None:
    """The bare terrace, its edges broken, two tall piers with their entablature on the north front."""
    length, width = size_m(monument)
    top = monument.height_m
    shape.box("rustic", (0.5, 0.5, -1.6), (length - 0.5, width - 0.5, top - 0.35))
    shape.polygons(
        "grass", [(0.0, 0.0, top - 0.3), (length, 0.0, top - 0.3), (length, width, top - 0.3), (0.0, width, top - 0.3)]
    )
    rubble.broken_walls(shape, rng, "rustic", (length, width), 1.2, (top - 3.0, top - 0.2))
    rubble.scatter(shape, rng, _inside(rng, 160, length, width, top - 0.3), 1.2)
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
    rubble.scatter(shape, rng, _inside(rng, 160, length, width, 0.0), 1.2)


RUINS: Mapping[str, Ruin] = {
    "altar": walls,
    "arch": vaulted,
    "basilica": basilica,
    "basin": basin,
    "baths": baths,
    "bouleuterion": bouleuterion,
    "chambers": chambers,
    "court": court,
    "gate": walls,
    "hall": walls,
    "nymphaeum": high_walls,
    "piers": piers,
    "platform_hall": platform_hall,
    "prytaneion": prytaneion,
    "socle": socle,
    "steps": stairs,
    "stoa": stoa,
    "temple": temple,
    "terrace": terrace,
    "tower": tower,
    "wall": wall,
}
