"""The terrace of the Sebastoi: shops with half-columns below, piers with figures of gods above."""

import numpy as np

from assets import parts, statues
from assets.axes import Array
from assets.building import Building
from assets.shape import Shape

BAY_M = 3.6


def terrace(b: Building) -> None:
    """A great platform: two storeys on the north and east, plain walls elsewhere, a paved top."""
    length, width = b.face(0)
    top, body = b.monument.height_m, b.element()
    body.box("rustic", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    for low, high in (((0.0, 0.0), (length, 0.6)), ((0.0, 0.6), (0.6, width)),
                      ((length - 1.2, 0.6), (length, width)), ((0.6, width - 1.2), (length - 1.2, width))):  # fmt: skip
        body.box("ashlar", (*low, 0.0), (*high, top - 0.02))
    body.polygons("paving", [(0.0, 0.0, top), (length, 0.0, top), (length, width, top), (0.0, width, top)])
    for side, run in ((1, width), (2, length)):
        wing = b.wing()
        _front(wing, run, top)
        corner = ((0.0, 0.0), (length, 0.0), (length, width))[side]
        b.join(wing, corner, side * np.pi / 2.0)
    rail = b.guess("parapet")
    for low, high in (((0.0, width - 0.35), (length, width)), ((length - 0.35, 0.0), (length, width - 0.35))):
        rail.box("marble", (*low, top - 0.02), (*high, top - 0.001))


def _front(wing: Building, run: float, top: float) -> None:
    """Half-columns between shop doors below, pillars with gods before them above."""
    front = wing.element("front", evidence="inferred", source="GK")
    x = np.linspace(0.4, run - 0.4, round(run / BAY_M))
    middle = (x[:-1] + x[1:]) / 2.0
    half = top * 0.5
    _rank(front, "marble", x, (0.1, half - 0.5), 0.34, 0.35)
    _rank(front, "marble", x, (half, top - 0.6), 0.28, 0.3)
    _rank(front, "wood", middle, (0.1, half - 1.5), 0.95, -0.04, 0.35)
    _rank(front, "wood", middle, (half + 0.3, top - 1.6), 0.7, -0.04, 0.35)
    if wing.level < 2:
        _rank(front, "marble", middle, (half - 1.5, half - 1.2), 1.15, 0.12)
    wing.element("gods", evidence="inferred", source="GK")
    places = np.stack([x[1:-1:2], np.full(len(x[1:-1:2]), -0.42), np.full(len(x[1:-1:2]), half)], -1)
    wing.many("gods", statues.standing(2.6, "marble", max(wing.level, 1)), places)
    front.slab("marble", (0.0, -0.5, half - 0.5), (run, 0.0, half))
    front.slab("marble", (0.0, -0.5, top - 0.6), (run, 0.0, top - 0.02))


def _rank(
    shape: Shape, material: str, x: Array, z: tuple[float, float], half_m: float, out_m: float, tint: float = 1.0
) -> None:
    """Add boxes on a wall that looks to -y, at each of `x`; a negative `out_m` is a dark opening flush with the wall."""
    o = np.ones_like(x)
    out = out_m if out_m > 0.0 else 0.03
    low, high = np.stack([x - half_m, -out * o, z[0] * o], -1), np.stack([x + half_m, 0.0 * o, z[1] * o], -1)
    shape.boxes(material, low, high, tint)
