"""The baths at the State Agora: four barrel-vaulted halls in the north, lower halls and an open court in the south."""

import numpy as np

from assets import parts, roofs
from assets.building import Building
from assets.entablature import entablature
from assets.orders import column
from assets.shape import Shape

HALLS, FALL_M = 4, (0.0, 0.9, 0.4, 1.2)
"""How many halls, and how much lower than the highest the crown of each is."""


def baths(b: Building) -> None:
    """Add the whole complex."""
    length, width = b.face(0)
    middle, bay, body = width * 0.5, length / HALLS, b.element()
    parts.floor(body, length, width)
    for i in range(HALLS):
        _vaulted_hall(b, i * bay, (i + 1) * bay, (middle, width), b.monument.height_m - FALL_M[i])
    for x0, x1 in ((0.0, bay), (3.0 * bay, length)):
        wing = b.wing()
        low = wing.guess("south_halls")
        parts.walls(low, "plaster", 0.0, middle, 0.0, x1 - x0, 0.0, 4.8)
        roofs.gable(wing.guess("roof"), low, (0.0, middle, 0.0, x1 - x0), 4.8, 7.4, max(b.level, 1), "plaster")
        b.join(wing, (x1, 0.0), np.pi / 2.0)
    b.guess("south_halls").box("plaster", (bay, 0.0, 0.0), (3.0 * bay, 0.6, 3.6))
    _court(b, bay, middle)


def _vaulted_hall(b: Building, x0: float, x1: float, y: tuple[float, float], crown: float) -> None:
    spring, body, vaults = b.measure("spring_m"), b.element(), b.guess("vaults")
    parts.walls(body, "ashlar", x0, x1, *y, 0.0, spring, 1.2)
    parts.vault(vaults, "plaster", x0 + 0.2, x1 - 0.2, *y, spring, crown, "ashlar")
    window = Shape()
    for share in (0.32, 0.5, 0.68):
        at = share * (x1 - x0)
        for facing, wall_y in ((1.0, y[1]), (-1.0, y[0])):
            low, high = sorted((wall_y, wall_y + 0.06 * facing))
            window.box("wood", (at - 1.0, low, 3.0), (at + 1.0, high, 6.0), 0.3)
            window.slab("marble", (at - 1.2, low, 6.0), (at + 1.2, high + 0.02, 6.3))
    vaults.copies(window, np.array([[x0, 0.0, 0.0]]))


def _court(b: Building, bay: float, middle: float) -> None:
    """The portico along the halls."""
    b.guess("columns")
    places = parts.row((bay + 1.5, middle - 4.0), (3.0 * bay - 1.5, middle - 4.0), 13)
    b.many("columns", column("ionic", 0.55, 4.2, b.level, fluted=False), places)
    beam = b.guess("south_halls")
    entablature(beam, "ionic", (bay, 3.0 * bay, middle - 4.3, middle - 3.7), 4.2, 0.7, max(b.level, 1))
    roofs.lean_to(b.guess("roof"), beam, (bay, 3.0 * bay), (middle - 4.6, 4.9), (middle, 6.3), b.level)
