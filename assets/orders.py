"""The orders as functions of a module, the lower diameter of the column: columns of a height, at a level of detail.

A column stands at (0, 0, 0). Volutes and bulls' heads look along x, the direction of the row. Level 0 has flutes and carved
capitals, 1 the outlines of both, 2 a tapering post.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from assets.axes import Array
from assets.parts import revolved
from assets.records import Order
from assets.shape import Shape

FLUTES = {"doric": 20, "ionic": 24, "bull": 24, "corinthian": 24}
BASE_D, CAPITAL_D = 0.5, {"doric": 0.5, "ionic": 0.62, "bull": 0.75, "corinthian": 1.12}
"""Heights in diameters; Doric columns have no base."""
TAPER = 0.84
ENTASIS = ((0.0, 1.0), (0.4, 0.972), (1.0, TAPER))
"""Share of the shaft's height and of its lower radius: it narrows faster towards the top."""


def column(
    order: Order, diameter_m: float, height_m: float, level: int = 0, material: str = "marble", fluted: bool = True
) -> Shape:
    """Return one column."""
    shape, d = Shape(), diameter_m
    base = 0.0 if order == "doric" else BASE_D * d
    capital = CAPITAL_D[order] * d
    sides = (14, 12, 7)[level]
    if level == 2:
        _post(shape, order, d, height_m, base, capital, material, sides)
        return shape
    if base:
        _attic_base(shape, d, level)
    _shaft(shape, d, base, height_m - capital, FLUTES[order] if fluted and level == 0 else 0, material, sides)
    _CAPITALS[order](shape, d, height_m - capital, capital, level)
    return shape


def _post(
    shape: Shape, order: Order, d: float, height_m: float, base: float, capital: float, material: str, sides: int
) -> None:
    r, top = d / 2.0, height_m - capital
    wide = 1.3 if order != "corinthian" else 1.15
    profile = [(r * 1.25, 0.0), (r * 1.25, 0.6 * base)] if base else []
    profile += [(r, base), (r * TAPER, top), (r * wide, height_m - 0.3 * capital)]
    revolved(shape, material, np.array(profile), sides)
    half = 0.66 * d
    shape.slab(material, (-half, -half, height_m - 0.3 * capital), (half, half, height_m))


def _attic_base(shape: Shape, d: float, level: int) -> None:
    """Plinth, torus, scotia, torus."""
    half = 0.69 * d
    shape.box("marble", (-half, -half, 0.0), (half, half, 0.15 * d))
    if level == 0:
        profile = [(0.66, 0.15), (0.69, 0.22), (0.65, 0.29), (0.56, 0.34), (0.61, 0.42), (0.5, 0.5)]
    else:
        profile = [(0.68, 0.15), (0.66, 0.28), (0.56, 0.34), (0.5, 0.5)]
    revolved(shape, "marble", np.array(profile) * d, (12, 9)[level], 0.97)


def _shaft(shape: Shape, d: float, low_m: float, high_m: float, flutes: int, material: str, sides: int) -> None:
    rows = np.array([(d / 2.0 * wide, low_m + share * (high_m - low_m)) for share, wide in ENTASIS])
    if not flutes:
        revolved(shape, material, rows, sides)
        return
    count = 2 * flutes + 1
    angle = np.arange(count) * np.pi / flutes
    reach = np.where(np.arange(count) % 2 == 0, 1.0, 0.91)
    ring = np.stack([np.cos(angle), np.sin(angle)], -1) * reach[:, None]
    points = np.stack([np.column_stack([ring * r, np.full(count, z)]) for r, z in rows])
    across = np.broadcast_to(angle * d / 2.0, (len(rows), count))
    uvs = np.stack([across, np.broadcast_to(-rows[:, 1:], across.shape)], -1)
    shape.panels(material, _facets(points), _facets(uvs))


def _facets(grid: Array) -> Array:
    """Return the four-sided facets (k, 4, c) of a grid (a, b, c), rows upwards, columns counter-clockwise."""
    quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)
    return quads.reshape(-1, 4, grid.shape[2])


def _doric(shape: Shape, d: float, low_m: float, height_m: float, level: int) -> None:
    """Neck with annulets, echinus, abacus."""
    profile = [(0.5 * TAPER, 0.0), (0.44, 0.12), (0.46, 0.2), (0.62, 0.55), (0.64, 0.62)]
    rows = np.array([(r * d, low_m + share * height_m) for r, share in (profile if level == 0 else profile[::2])])
    revolved(shape, "marble", rows, (16, 10)[level])
    half = 0.66 * d
    shape.slab("marble", (-half, -half, low_m + 0.6 * height_m), (half, half, low_m + height_m))


def _ionic(shape: Shape, d: float, low_m: float, height_m: float, level: int) -> None:
    """Echinus, cushion with a volute at either end, abacus."""
    top = low_m + height_m
    rows = np.array([(0.42, 0.0), (0.46, 0.25), (0.55, 0.5)]) * (d, height_m) + (0.0, low_m)
    revolved(shape, "marble", rows, (14, 8)[level])
    shape.slab(
        "marble", (-0.62 * d, -0.45 * d, top - 0.52 * height_m), (0.62 * d, 0.45 * d, top - 0.14 * height_m), 0.95
    )
    shape.slab("marble", (-0.66 * d, -0.54 * d, top - 0.14 * height_m), (0.66 * d, 0.54 * d, top))
    for x in (-0.6 * d, 0.6 * d):
        _scroll(shape, x, top - 0.48 * height_m, 0.24 * d, 0.52 * d, (10, 6)[level])


def _scroll(shape: Shape, x_m: float, z_m: float, radius_m: float, half_m: float, sides: int) -> None:
    """Add a volute: a roll along y with discs at both ends, an eye raised on each."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    x, z = np.cos(angle), np.sin(angle)
    roll = np.stack(
        [np.stack([x_m + radius_m * x, np.full_like(x, y), z_m + radius_m * z], -1) for y in (-half_m, half_m)]
    )
    shape.surface("marble", roll, 0.93)
    for y, turn in ((-half_m, 1), (half_m, -1)):
        for reach, out in ((1.0, 0.0), (0.55, 0.02)):
            disc = np.stack(
                [x_m + reach * radius_m * x, np.full_like(x, y + out * np.sign(y)), z_m + reach * radius_m * z], -1
            )
            shape.polygons("marble", disc[:-1][::turn], 1.0 if out else 0.84)


def _bull(shape: Shape, d: float, low_m: float, height_m: float, level: int) -> None:
    """An Ionic capital from whose ends two bulls lean out: necks, heads, horns."""
    _ionic(shape, d, low_m, height_m, level)
    top = low_m + height_m
    for side in (1.0, -1.0):
        neck = [(0.45, 0.27, -0.62, -0.06), (0.86, 0.22, -0.66, -0.08)]
        head = [(0.86, 0.2, -0.78, -0.12), (1.22, 0.12, -0.92, -0.5)]
        for a, b in (neck, head):
            _wedge(shape, d, top, a, b, side)
        if level == 0:
            for y in (-1.0, 1.0):
                root = [(0.9, y * 0.14, -0.14), (0.98, y * 0.14, -0.2), (0.94, y * 0.2, -0.2)]
                tip = np.array([side * 0.98, y * 0.36, 0.04]) * d + (0.0, 0.0, top)
                corners = np.array(root) * (side * d, d, d) + (0.0, 0.0, top)
                for i in range(3):
                    shape.polygons("marble", [corners[i], corners[(i + 1) % 3], tip], 0.9)
                    shape.polygons("marble", [corners[(i + 1) % 3], corners[i], tip], 0.9)


def _wedge(shape: Shape, d: float, top_m: float, near: tuple[float, ...], far: tuple[float, ...], side: float) -> None:
    """Add a tapering block along x between two upright rectangles: (x, half width, low, high) in diameters."""
    a, b = (
        np.array([(x, -half, low), (x, half, low), (x, half, high), (x, -half, high)]) * d + (0.0, 0.0, top_m)
        for x, half, low, high in (near, far)
    )
    faces = np.stack([*(np.stack([a[i - 1], b[i - 1], b[i], a[i]]) for i in range(4)), b])
    part = Shape()
    part.polygons(
        "marble", faces[:, ::-1] if not _looks_out(faces, (a.mean(axis=0) + b.mean(axis=0)) / 2.0) else faces, 0.94
    )
    shape.copies(part, np.zeros((1, 3)), np.array([0.0 if side > 0.0 else np.pi]))


def _looks_out(faces: Array, middle: Array) -> bool:
    normal = np.cross(faces[0, 1] - faces[0, 0], faces[0, 2] - faces[0, 0])
    return bool(normal @ (faces[0].mean(axis=0) - middle) > 0.0)


def _corinthian(shape: Shape, d: float, low_m: float, height_m: float, level: int) -> None:
    """A bell with two rows of acanthus, volutes under the horns of a hollow-sided abacus."""
    bell = np.array([(0.42, 0.0), (0.43, 0.5), (0.52, 0.78), (0.6, 0.88)]) * (d, height_m) + (0.0, low_m)
    revolved(shape, "marble", bell if level == 0 else bell[[0, 1, 3]], (12, 8)[level], 0.82)
    if level == 0:
        for row, (low, high, lean, count) in enumerate(((0.0, 0.42, 0.62, 8), (0.2, 0.72, 0.66, 8))):
            _acanthus(
                shape,
                d,
                low_m,
                height_m,
                (low, high, lean),
                np.asarray(np.arange(count) * np.pi / 4.0 + row * np.pi / 8.0, dtype=np.float64),
            )
        for quarter in np.pi / 4.0 + np.arange(4) * np.pi / 2.0:
            part = Shape()
            part.slab(
                "marble",
                (0.5 * d, -0.07 * d, low_m + 0.66 * height_m),
                (0.78 * d, 0.07 * d, low_m + 0.88 * height_m),
                0.93,
            )
            shape.copies(part, np.zeros((1, 3)), np.array([quarter]))
    _hollow_abacus(shape, d, low_m + 0.88 * height_m, low_m + height_m)


def _acanthus(
    shape: Shape, d: float, low_m: float, height_m: float, leaf: tuple[float, float, float], turns: Array
) -> None:
    """Add leaves around the bell: upright, then bent out and down at the tip."""
    low, high, lean = leaf
    spine = [(0.43, low, 0.13), (0.47, 0.6 * low + 0.4 * high, 0.17), (0.54, high, 0.13), (lean, high - 0.05, 0.04)]
    rows = [
        np.array([(r * d, w * d, low_m + z * height_m), (r * d, -w * d, low_m + z * height_m)]) for r, z, w in spine
    ]
    part = Shape()
    quads = np.stack([np.array([b[0], b[1], a[1], a[0]])[::-1] for a, b in pairwise(rows)])
    part.polygons("marble", quads[:, ::-1], np.array([(0.86,) * 3, (0.97,) * 3, (1.0,) * 3]))
    shape.copies(part, np.zeros((len(turns), 3)), turns)


def _hollow_abacus(shape: Shape, d: float, low_m: float, high_m: float) -> None:
    """Add a slab with four horns and four hollow sides."""
    angle = np.arange(8) * np.pi / 4.0
    reach = np.where(np.arange(8) % 2 == 0, 0.58, 0.86) * d
    ring = np.stack([reach * np.cos(angle), reach * np.sin(angle)], -1)
    following = np.roll(ring, -1, axis=0)
    low, high = np.full((8, 1), low_m), np.full((8, 1), high_m)
    sides = [np.hstack([ring, low]), np.hstack([following, low]), np.hstack([following, high]), np.hstack([ring, high])]
    shape.polygons("marble", np.stack(sides, axis=1))
    centre = np.zeros((8, 2))
    shape.polygons(
        "marble", np.stack([np.hstack([centre, low]), np.hstack([following, low]), np.hstack([ring, low])], 1), 0.8
    )


_CAPITALS: dict[str, Callable[[Shape, float, float, float, int], None]] = {
    "doric": _doric,
    "ionic": _ionic,
    "bull": _bull,
    "corinthian": _corinthian,
}
