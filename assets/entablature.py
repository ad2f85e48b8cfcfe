"""Entablatures: architrave, frieze and cornice over a rectangle, with triglyphs or dentils; heights are shares of the whole."""

from itertools import pairwise
from typing import Literal

import numpy as np

from assets.axes import Array
from assets.shape import Shape

ENTABLATURE = {
    "ionic": (
        (0.0, 0.0, 1.0), (0.0, 0.13, 1.0), (0.02, 0.13, 0.97), (0.02, 0.26, 0.97), (0.04, 0.26, 1.0), (0.04, 0.37, 1.0),
        (0.09, 0.41, 0.9), (0.03, 0.41, 1.0), (0.03, 0.66, 1.0), (0.09, 0.69, 0.85), (0.09, 0.78, 0.8), (0.30, 0.8, 1.0),
        (0.30, 0.91, 1.0), (0.36, 1.0, 1.0),
    ),
    "doric": (
        (0.0, 0.0, 1.0), (0.0, 0.37, 1.0), (0.05, 0.37, 0.9), (0.05, 0.42, 0.9), (0.01, 0.42, 1.0), (0.01, 0.78, 1.0),
        (0.06, 0.78, 1.0), (0.06, 0.83, 1.0), (0.32, 0.84, 0.9), (0.32, 0.94, 1.0), (0.36, 1.0, 1.0),
    ),
}  # fmt: skip
"""From the face of the architrave out and from its underside up, in heights of the whole, with the tone of what follows."""
PAINT_RED, PAINT_BLUE = (0.78, 0.42, 0.34), (0.40, 0.50, 0.70)
"""Tints of mouldings: paint is known on marble in general, not here."""


def entablature(
    shape: Shape,
    order: Literal["ionic", "doric"],
    faces: tuple[float, float, float, float],
    z_m: float,
    height_m: float,
    level: int = 0,
    fronts: tuple[int, ...] = (0,),
    hollow_m: float = 0.0,
) -> None:
    """Add an entablature over the rectangle of its architrave's outer `faces` (x0, x1, y0, y1), mouldings on all four sides.

    Dentils or triglyphs go on `fronts` (0 to -y, then counter-clockwise). `hollow_m` is the beam's thickness where it runs
    around a hall; without it the beam is solid.
    """
    profile = (
        ENTABLATURE[order]
        if level == 0
        else ((0, 0, 1), (0, 0.4, 0.95), (0.02, 0.66, 0.9), (0.3, 0.8, 1), (0.36, 1, 1))
    )
    if level == 2:
        profile = ((0.0, 0.0, 1.0), (0.1, 0.7, 1.0), (0.36, 1.0, 1.0))
    rows = [(out * height_m, z_m + share * height_m, tone) for out, share, tone in profile]
    around(shape, faces, rows)
    _closed(shape, faces, (z_m, height_m), hollow_m)
    if level == 0:
        for side in fronts:
            _ornament(shape, order, faces, z_m, height_m, side)


def _closed(shape: Shape, faces: tuple[float, float, float, float], z: tuple[float, float], hollow_m: float) -> None:
    """Add the underside of a beam of (underside, height), and its top or, where it is hollow, its inner faces."""
    (x0, x1, y0, y1), (z_m, height_m), t = faces, z, hollow_m
    low = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    if t == 0.0:
        shape.polygons("marble", [(*p, z_m) for p in low[::-1]], 0.85)
        out = 0.36 * height_m
        top = [(x0 - out, y0 - out), (x1 + out, y0 - out), (x1 + out, y1 + out), (x0 - out, y1 + out)]
        shape.polygons("marble", [(*p, z_m + height_m) for p in top])
        return
    inner = [(x0 + t, y0 + t), (x1 - t, y0 + t), (x1 - t, y1 - t), (x0 + t, y1 - t)]
    _flat_ring(shape, low, inner, z_m, down=True)
    pairs = [(inner[i], inner[(i + 1) % 4]) for i in range(4)]
    walls = [[(*a, z_m + height_m), (*b, z_m + height_m), (*b, z_m), (*a, z_m)] for a, b in pairs]
    shape.polygons("marble", np.array(walls), 0.92)


def around(shape: Shape, faces: tuple[float, float, float, float], rows: list[tuple[float, float, float]]) -> None:
    """Add a moulding around a rectangle: `rows` of (out, height, tone), mitred at the corners."""
    x0, x1, y0, y1 = faces

    def corners(out: float, z: float) -> Array:
        return np.array(
            [(x0 - out, y0 - out, z), (x1 + out, y0 - out, z), (x1 + out, y1 + out, z), (x0 - out, y1 + out, z)]
        )

    for (out_a, z_a, _), (out_b, z_b, tone) in pairwise(rows):
        a, b = corners(out_a, z_a), corners(out_b, z_b)
        quads = np.stack([a, np.roll(a, -1, axis=0), np.roll(b, -1, axis=0), b], axis=1)
        shape.polygons("marble", quads, tone)


def _flat_ring(
    shape: Shape, outer: list[tuple[float, float]], inner: list[tuple[float, float]], z_m: float, down: bool
) -> None:
    quads = np.array([[outer[i], outer[(i + 1) % 4], inner[(i + 1) % 4], inner[i]] for i in range(4)])
    flat = np.concatenate([quads, np.full((4, 4, 1), z_m)], axis=2)
    shape.polygons("marble", flat[:, ::-1] if down else flat, 0.85)


def _ornament(
    shape: Shape, order: str, faces: tuple[float, float, float, float], z_m: float, height_m: float, side: int
) -> None:
    x0, x1, y0, y1 = faces
    run = (x1 - x0, y1 - y0)[side % 2]
    part, h = Shape(), height_m
    if order == "doric":
        count = max(2, round(run / 1.25))
        x = np.linspace(0.3, run - 0.3, count)
        for low, high, half, out, tint in (
            (0.42, 0.78, 0.24 * 1.25 * 0.8, 0.05, PAINT_BLUE),
            (0.30, 0.36, 0.24, 0.04, (0.9, 0.88, 0.84)),
        ):
            _blocks_on(part, x, half * min(1.0, h / 1.2), (z_m + low * h, z_m + high * h), out * h + 0.01, tint)
    else:
        count = max(4, round(run / (0.2 * h + 0.06)))
        x = np.linspace(0.05, run - 0.05, count)
        _blocks_on(part, x, 0.27 * run / count, (z_m + 0.70 * h, z_m + 0.785 * h), 0.15 * h, (0.97, 0.94, 0.9))
    corner = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))[side]
    shape.copies(part, np.array([[*corner, 0.0]]), np.array([side * np.pi / 2.0]))


def _blocks_on(
    part: Shape, x: Array, half_m: float, level_m: tuple[float, float], out_m: float, tint: tuple[float, ...]
) -> None:
    """Add blocks standing out to -y from y = 0: front, both sides and underside."""
    low, high = level_m
    a, b, o = x - half_m, x + half_m, np.zeros_like(x)
    y = o - out_m
    zl, zh = o + low, o + high

    def quad(*corners: tuple[Array, Array, Array]) -> Array:
        return np.stack([np.stack(corner, -1) for corner in corners], axis=1)

    front = quad((a, y, zl), (b, y, zl), (b, y, zh), (a, y, zh))
    left = quad((a, o, zl), (a, y, zl), (a, y, zh), (a, o, zh))
    right = quad((b, y, zl), (b, o, zl), (b, o, zh), (b, y, zh))
    under = quad((a, o, zl), (b, o, zl), (b, y, zl), (a, y, zl))
    part.polygons("marble", np.concatenate([front, left, right, under]), np.tile(tint, (4 * len(x), 1)))
