"""The monument of Memmius: what was found of its foot and arches, and two rival readings of what stood on them."""

import numpy as np

from assets import parts, statues
from assets.building import Building
from assets.entablature import entablature
from assets.orders import column
from assets.shape import Shape

ARCH = "arch"
"""The reading of 1971; any other is a tower."""
FOOT_M, STOREY_M, PIER_M = 3.2, 8.6, 1.5


def memmius(b: Building) -> None:
    """Steps and a rusticated foot, a storey of arches between corner piers; above it an attic, or a storey and a roof."""
    length, width = b.face(0)
    side = b.measure("side_m")
    body = b.element()
    body.box("ashlar", (0.0, 0.0, -parts.FOUNDATION_M), (length, width, 0.0))
    for i in range(3):
        inset = 0.45 * i
        body.box(
            "marble", (inset, inset, 0.3 * i), (length - inset, width - inset, 0.3 * (i + 1)), 1.0 - 0.04 * (i % 2)
        )
    wing = b.wing()
    _storey_of_arches(wing, side)
    for rival in b.rivals():
        variant = rival.id if rival else None
        top = b.monument.as_variant(variant).height_m
        (_attic if variant == ARCH else _tower)(wing, side, top, variant)
    b.join(wing, (length / 2.0, width / 2.0), 0.0)


def _storey_of_arches(wing: Building, side: float) -> None:
    half, body = side / 2.0, wing.element()
    body.box("rustic", (-half, -half, 0.9), (half, half, FOOT_M))
    arches = wing.element("arches", evidence="inferred", source="FiE7")
    for x in (-half, half - PIER_M):
        for y in (-half, half - PIER_M):
            parts.moulded(arches, "marble", (x, x + PIER_M, y, y + PIER_M), (FOOT_M, STOREY_M), 0.5)
    arches.box("ashlar", (-half + 1.4, -half + 1.4, FOOT_M), (half - 1.4, half - 1.4, STOREY_M), 0.85)
    for turn in range(4):
        front = Shape()
        span = side - 2.0 * PIER_M
        if turn == 2:  # the north side is plain
            front.box("ashlar", (-span / 2.0, -half + 0.3, FOOT_M), (span / 2.0, -half + 1.4, STOREY_M))
        else:
            sides = (16, 12, 8)[wing.level]
            parts.arch(front, "marble", 0.0, span, -half, -half + 1.4, STOREY_M - 0.6 - span / 2.0, STOREY_M, sides)
            front.copies(
                statues.standing(2.2, "marble", wing.level),
                np.array([[s, -half + 0.9, FOOT_M + 0.3] for s in (-1.6, 0.0, 1.6)]),
            )
            front.box("marble", (-span / 2.0, -half + 0.4, FOOT_M), (span / 2.0, -half + 1.4, FOOT_M + 0.3))
        arches.copies(front, np.zeros((1, 3)), np.array([turn * np.pi / 2.0]))


def _attic(wing: Building, side: float, top_m: float, variant: str | None) -> None:
    """As the excavators drew it: an entablature and an attic with reliefs of men in togas and soldiers."""
    half, attic = side / 2.0, wing.element("attic", evidence="hypothetical", source="FiE7", variant=variant)
    entablature(attic, "ionic", (-half, half, -half, half), STOREY_M, 0.9, wing.level, (0, 1, 2, 3))
    parts.moulded(attic, "marble", (-half + 0.3, half - 0.3, -half + 0.3, half - 0.3), (STOREY_M + 0.9, top_m), 0.4)
    wing.element("reliefs", evidence="attested", source="FiE7", variant=variant)
    figure = statues.standing(min(2.0, top_m - STOREY_M - 1.9), "marble", max(wing.level, 1), 0.95)
    x = np.linspace(-half + 1.2, half - 1.2, 6)
    for turn in (0, 1, 3):
        yaw = turn * np.pi / 2.0
        at = np.stack([x, np.full(6, -half + 0.24)], -1) @ np.array(
            [[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]]
        )
        wing.many("reliefs", figure, np.column_stack([at, np.full(6, STOREY_M + 1.35)]), yaw)


def _tower(wing: Building, side: float, top_m: float, variant: str | None) -> None:
    """After Outschar: a second storey of Corinthian columns about a core, a drum, a pointed roof."""
    half, level = side / 2.0, wing.level
    tower = wing.element("tower", evidence="hypothetical", source="EHW", variant=variant)
    floor, beam = STOREY_M + 0.7, 13.2
    tower.slab("marble", (-half - 0.3, -half - 0.3, STOREY_M), (half + 0.3, half + 0.3, floor))
    tower.box("ashlar", (-half + 1.8, -half + 1.8, floor), (half - 1.8, half - 1.8, beam))
    ring = parts.ring(-half + 0.8, half - 0.8, -half + 0.8, half - 0.8, 4, 4)
    ring[:, 2] = floor
    wing.many("tower", column("corinthian", 0.6, beam - floor, level, fluted=False), ring)
    entablature(tower, "ionic", (-half + 0.5, half - 0.5, -half + 0.5, half - 0.5), beam, 1.0, level, (0, 1, 2, 3))
    sides = (24, 16, 10)[level]
    parts.revolved(tower, "marble", np.array([(half - 1.2, beam + 1.0), (half - 1.2, top_m - 2.7)]), sides)
    parts.revolved(
        tower,
        "marble",
        np.array(
            [
                (half - 1.2, top_m - 2.7),
                (half - 0.9, top_m - 2.7),
                (half - 1.0, top_m - 2.4),
                (0.2, top_m - 0.3),
                (0.05, top_m),
            ]
        ),
        sides,
        0.92,
    )
