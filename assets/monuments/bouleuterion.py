"""The council house and concert hall: seats in a half circle before a two-storey stage wall, under one timber roof."""

from itertools import pairwise

import numpy as np

from assets import parts, roofs, statues
from assets.axes import Array
from assets.building import Building
from assets.orders import column
from assets.shape import Shape

SCENE_M, ORCHESTRA_M, STAGE_M = 5.7, 4.5, 1.35
"""Depth of the scene block, radius of the orchestra (9.0 across), height of the pulpitum: FiE9/5 p. 85 f."""
LOWER = (4.6, 0.0, 13, 0.72, 0.42)
UPPER = (15.2, 6.3, 10, 0.52, 0.46)
"""Blocks of seats: first radius, level, rows, depth and height of a row."""
WALL_M = 1.1
DOORS = (0.24, 0.37, 0.5, 0.63, 0.76)
PEDESTALS = (0.305, 0.435, 0.565, 0.695)
Profile = list[tuple[float, float]]
Block = tuple[float, float, int, float, float]


def bouleuterion(b: Building) -> None:
    """Add the whole building."""
    b.face(0)
    outline = b.outline()
    radius = outline[1, 0] / 2.0
    middle = (radius, SCENE_M)
    _shell(b, outline)
    seats = b.element("seats", evidence="attested", source="FiE9/5")
    angle = np.linspace(-0.05, np.pi + 0.05, (29, 19, 11)[b.level])
    ring = np.stack([np.cos(angle), np.sin(angle)], -1)
    seating(seats, ring, middle, b.level)
    _gallery(b, middle, radius)
    _stage(b, 2.0 * radius)
    roof = b.guess("roof")
    eave, out = b.measure("eave_m"), parts.offset(outline, 0.7)
    tops = np.stack(
        [np.clip(out[:, 0], 0.68 * radius, 1.32 * radius), np.full(len(out), outline[:, 1].max() * 0.42)], -1
    )
    roofs.hip(roof, out, tops, eave, b.monument.height_m)
    _trusses(roof, middle, radius, eave, b.level)


def _shell(b: Building, outline: Array) -> None:
    body, eave, length = b.element(), b.measure("eave_m"), outline[1, 0]
    parts.prism(body, "ashlar", outline, -parts.FOUNDATION_M, -0.02)
    body.polygons("paving", np.column_stack([outline, np.zeros(len(outline))]))
    half = eave * 0.52
    round_wall = np.roll(outline, -1, axis=0)[: len(outline)]
    curve = np.array([p for p in round_wall if p[1] > 1.0])
    for (z0, z1), material, thick in (((0.0, half), "ashlar", WALL_M), ((half + 0.5, eave - 0.8), "plaster", WALL_M)):
        _curved(body, material, curve, thick, (z0, z1))
    for z0, z1 in ((half, half + 0.5), (eave - 0.8, eave)):
        _curved(body, "marble", parts.offset(curve, 0.12), WALL_M + 0.12, (z0, z1))
    widths = [(s * length, 2.6 if s == 0.5 else 1.9, 0.0, 4.4 if s == 0.5 else 3.4) for s in DOORS]
    parts.pierced(body, "ashlar", (0.0, length), (0.0, 1.0), (0.0, half), widths)
    body.slab("marble", (-0.12, -0.12, half), (length + 0.12, 1.0, half + 0.5))
    upper = [(s * length, 1.4, eave * 0.62, eave - 1.7) for s in np.linspace(0.08, 0.92, 9)]
    parts.pierced(body, "plaster", (0.0, length), (0.0, 1.0), (half + 0.5, eave - 0.8), upper)
    body.slab("marble", (-0.12, -0.12, eave - 0.8), (length + 0.12, 1.0, eave))
    for x, width, _, head in widths:
        parts.surround(body, x, 0.0, (width, head), -1.0)
    if b.level < 2:
        at = np.array([0.4, *(length * (np.array(DOORS)[:-1] + np.array(DOORS)[1:]) / 2.0), length - 0.4])
        parts.pilasters(body, at, 0.0, (0.3, half), 0.8, 0.14)
        _buttresses(body, curve, half)


def _curved(shape: Shape, material: str, curve: Array, thick_m: float, z: tuple[float, float]) -> None:
    """Add a wall along an open polyline (n, 2), its outside to the right, with its top."""
    middle = curve.mean(axis=0)
    inward = middle - curve
    inner = curve + inward / np.linalg.norm(inward, axis=1, keepdims=True) * thick_m
    rows = []
    for a, c, tone in ((curve, np.roll(curve, -1, axis=0), 1.0), (inner[::-1], np.roll(inner[::-1], -1, axis=0), 0.95)):
        low, high = np.full((len(a), 1), z[0]), np.full((len(a), 1), z[1])
        quads = np.stack([np.hstack([a, low]), np.hstack([c, low]), np.hstack([c, high]), np.hstack([a, high])], axis=1)
        shape.polygons(material, quads[:-1], tone)
        rows.append(quads)
    top = np.full((len(curve), 1), z[1])
    lid_a, lid_b = np.hstack([curve, top]), np.hstack([inner, top])
    shape.polygons(material, np.stack([lid_a[:-1], lid_a[1:], lid_b[1:], lid_b[:-1]], axis=1))


def _buttresses(shape: Shape, curve: Array, high_m: float) -> None:
    edges = np.diff(curve, axis=0)
    part = Shape()
    part.box("marble_grey", (-0.45, -0.16, 0.0), (0.45, 0.3, high_m))
    yaw = np.arctan2(edges[:, 1], edges[:, 0])
    shape.copies(part, np.column_stack([curve[:-1], np.zeros(len(edges))]), yaw)


def rows_profile(block: Block, nosing: bool) -> Profile:
    """Return a block of seats as (radius, height): rise and tread of every row, the edge of a seat standing out as a nosing."""
    radius, z, count, depth, height = block
    profile: Profile = []
    for i in range(count):
        r, low, high = radius + depth * i, z + height * i, z + height * (i + 1)
        hollow = [(r + 0.07, low), (r + 0.07, high - 0.08), (r, high - 0.08)] if nosing else [(r, low)]
        profile += [*hollow, (r, high)]
    return [*profile, (radius + depth * count, z + height * count)]


def seating(shape: Shape, ring: Array, middle: tuple[float, float], level: int, material: str = "marble") -> None:
    """Add both blocks of seats, the passage between them and, at the finest level, the stairs."""
    r, z, count, depth, height = LOWER
    top = z + count * height
    passage: Profile = [(r + count * depth, top), (UPPER[0], top), (UPPER[0], UPPER[1])]
    profile = rows_profile(LOWER, level == 0) + passage + rows_profile(UPPER, level == 0)
    end = (UPPER[0] + UPPER[2] * UPPER[3], UPPER[1] + UPPER[2] * UPPER[4])
    profile += [(21.9, end[1])]
    if level == 2:
        profile = [(r, z), *passage, end, profile[-1]]
    half_ring(shape, material, ring, middle, profile)
    shape.polygons("paving", np.column_stack([ring * ORCHESTRA_M + middle, np.full(len(ring), 0.02)]))
    if level == 0:
        for block, stairs in ((LOWER, 6), (UPPER, 11)):
            stairs_between(shape, middle, block, np.linspace(0.04, np.pi - 0.04, stairs))


def half_ring(
    shape: Shape, material: str, ring: Array, middle: tuple[float, float], profile: Profile, tint: float = 1.0
) -> None:
    """Add steps around a half circle, closed at both ends: flat strips between neighbours of `profile` (radius, height)."""
    for (r0, z0), (r1, z1) in pairwise(profile):
        if (r0, z0) == (r1, z1):
            continue
        inner, outer = (np.column_stack([ring * r + middle, np.full(len(ring), z)]) for r, z in ((r0, z0), (r1, z1)))
        quads = np.stack([inner[:-1], outer[:-1], outer[1:], inner[1:]], axis=1)
        shape.polygons(material, quads, tint * (1.0 if r1 > r0 else 0.72 if r1 < r0 or z1 - z0 > 0.2 else 0.95))
        if r1 > r0:
            for at, order in ((0, 1), (-1, -1)):
                low = np.stack([inner[at], outer[at]]) * (1.0, 1.0, 0.0)
                shape.polygons(material, np.stack([*low, outer[at], inner[at]])[::order], tint)


def stairs_between(shape: Shape, middle: tuple[float, float], block: Block, at: Array) -> None:
    """Add flights between the wedges: one half step before every row."""
    radius, z, count, depth, height = block
    part = Shape()
    i = np.arange(count)
    r, level = radius + depth * i, z + height * i
    o = np.ones(count)
    low = np.stack([r - 0.5 * depth, -0.36 * o, level - 0.02], -1)
    part.boxes("marble", low, np.stack([r + 0.02, 0.36 * o, level + 0.5 * height], -1), 0.9)
    places = np.tile((*middle, 0.0), (len(at), 1))
    shape.copies(part, places, at)


def _gallery(b: Building, middle: tuple[float, float], radius: float) -> None:
    """Columns of red granite along the top, EHW; disputed by Meinel."""
    b.element("gallery", evidence="inferred", source="EHW")
    level = UPPER[1] + UPPER[2] * UPPER[4]
    angle = np.linspace(0.06, np.pi - 0.06, 22)
    at = np.stack([np.cos(angle), np.sin(angle)], -1) * (radius - 2.2) + middle
    height = b.measure("eave_m") - level - 0.35
    post = column("ionic", 0.34, height, max(b.level, 1), "granite", fluted=False)
    b.many("gallery", post, np.column_stack([at, np.full(22, level)]), angle + np.pi / 2.0)


def _stage(b: Building, length: float) -> None:
    """The stage wall looks to the seats (+y): five doors, aediculae of two columns on four pedestals, one column at each end."""
    wall = b.element("stage_wall", evidence="inferred", source="FiE9/5")
    doors = [(s * length, 2.2 if s == 0.5 else 1.5, STAGE_M, STAGE_M + (3.6 if s == 0.5 else 2.9)) for s in DOORS]
    wall.box("marble", (6.0, 3.6, 0.0), (length - 6.0, SCENE_M - 0.2, STAGE_M - 0.12), 0.96)
    wall.slab("marble", (5.9, 3.4, STAGE_M - 0.12), (length - 5.9, SCENE_M - 0.1, STAGE_M))
    parts.pierced(wall, "ashlar", (4.0, length - 4.0), (2.3, 3.2), (0.0, 11.4), doors)
    for x, width, sill, head in doors:
        parts.surround(wall, x, 3.2, (width, head - sill), 1.0, sill)
    order = b.element("stage_columns", evidence="inferred", source="FiE9/5")
    lower, upper = 5.0, 3.8
    for i, share in enumerate((*PEDESTALS, 0.18, 0.82)):
        x, half = share * length, (0.35 if i >= 4 else 1.35)
        parts.moulded(wall, "marble", (x - half, x + half, 3.2, 4.3), (STAGE_M, STAGE_M + 1.1), 0.3)
        foot = STAGE_M + 1.1
        for z in (foot + lower, foot + lower + 0.6 + upper):
            order.slab("marble", (x - half, 3.2, z), (x + half, 4.3, z + 0.35))
            order.slab("marble", (x - half - 0.15, 3.2, z + 0.35), (x + half + 0.15, 4.5, z + 0.55))
        if i < 4:
            _little_gable(order, x, half, foot + lower + upper + 1.15, i % 2 == 1)
    xs = [s * length + o for s in PEDESTALS for o in (-1.05, 1.05)] + [0.18 * length, 0.82 * length]
    foot = STAGE_M + 1.1
    at = np.array([(x, 3.95, foot) for x in xs])
    b.many("stage_columns", column("corinthian", 0.5, lower, b.level, fluted=False), at)
    post = column("corinthian", 0.4, upper, max(b.level, 1), "granite", fluted=False)
    b.many("stage_columns", post, np.add(at, (0.0, 0.0, lower + 0.6)))
    b.element("statues", evidence="inferred", source="FiE9/5")
    niches = np.array([(s * length, 3.75, z) for s in PEDESTALS for z in (foot, foot + lower + 0.55)])
    b.many("statues", statues.standing(1.9, "marble", b.level), niches, np.pi)


def _little_gable(shape: Shape, x: float, half: float, z: float, curved: bool) -> None:
    """Add a small pediment, round or pointed, over an aedicula."""
    angle = np.linspace(0.0, np.pi, 7 if curved else 3)
    outline = np.stack([x - (half + 0.15) * np.cos(angle), z + 0.62 * np.sin(angle)], -1)
    for y, turn in ((4.5, 1), (3.2, -1)):
        face = np.column_stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]])
        shape.polygons("marble", face[::turn], 0.95)
    curve = np.stack([np.column_stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]]) for y in (3.2, 4.5)])
    shape.polygons("marble", np.stack([curve[0, :-1], curve[1, :-1], curve[1, 1:], curve[0, 1:]], axis=1)[:, ::1])


def _trusses(shape: Shape, middle: tuple[float, float], radius: float, eave: float, level: int) -> None:
    """Tie beams of the roof across the hall."""
    if level:
        return
    for y in np.linspace(2.0, radius - 4.0, 7):
        half = float(np.sqrt(max((radius - 0.8) ** 2 - y**2, 1.0)))
        shape.box(
            "wood",
            (middle[0] - half, middle[1] + y - 0.2, eave - 0.5),
            (middle[0] + half, middle[1] + y + 0.2, eave - 0.01),
        )
        low = [
            (middle[0] + s * half, middle[1] + y + t * 0.2, eave - 0.5) for s, t in ((-1, 1), (1, 1), (1, -1), (-1, -1))
        ]
        shape.polygons("wood", low, 0.8)
