"""Statues as honest abstractions: the mass and stance of a figure, no face. Each stands at (0, 0, 0) and looks to -y."""

import numpy as np

from assets.parts import revolved
from assets.shape import Shape

TOGA = (
    (0.15, 0.0), (0.14, 0.12), (0.115, 0.3), (0.125, 0.42), (0.115, 0.54), (0.135, 0.66), (0.145, 0.76), (0.1, 0.82),
    (0.045, 0.845),
)  # fmt: skip
HEAD = ((0.04, 0.83), (0.06, 0.87), (0.07, 0.92), (0.055, 0.98), (0.0, 1.0))


def standing(stature_m: float, material: str = "marble", level: int = 0, tint: float = 1.0) -> Shape:
    """Return a draped figure."""
    part, sides = Shape(), (10, 7, 5)[level]
    for profile in ((TOGA, HEAD), (TOGA[::2], HEAD[::2]), (TOGA[::4], HEAD[::2]))[level]:
        revolved(part, material, np.array(profile) * stature_m, sides, tint)
    shape = Shape()
    for batch in part.batches:
        batch.points[:, 1] *= 0.72
    shape.copies(part, np.zeros((1, 3)))
    if level == 0:
        for side in (-1.0, 1.0):
            low, high = np.array([0.12 * side, -0.05, 0.42]), np.array([0.14 * side, 0.0, 0.77])
            shape.box(
                material,
                np.subtract(np.minimum(low, high), (0.03, 0.045, 0.0)) * stature_m,
                np.add(np.maximum(low, high), (0.03, 0.045, 0.0)) * stature_m,
                0.94 * tint,
            )
    return shape


def seated(height_m: float, level: int = 0) -> Shape:
    """Return a figure on a throne."""
    shape, h = Shape(), height_m
    shape.box("marble", (-0.26 * h, -0.1 * h, 0.0), (0.26 * h, 0.3 * h, 0.42 * h), 0.9)
    shape.box("marble", (-0.26 * h, 0.22 * h, 0.42 * h), (0.26 * h, 0.3 * h, 0.86 * h), 0.9)
    shape.box("marble", (-0.2 * h, -0.3 * h, 0.0), (0.2 * h, 0.2 * h, 0.45 * h))
    bust = Shape()
    for profile in (((0.22, 0.4), (0.2, 0.6), (0.2, 0.76), (0.1, 0.82), (0.06, 0.85)), HEAD):
        revolved(bust, "marble", np.array(profile) * h, (10, 7, 5)[level])
    shape.copies(bust, np.array([[0.0, 0.05 * h, 0.0]]))
    return shape


def pedestal(side_m: float, height_m: float) -> Shape:
    """Return a square base with foot and cornice."""
    shape, half = Shape(), side_m / 2.0
    for low, high, wide in ((0.0, 0.16, 1.15), (0.16, 0.84, 0.94), (0.84, 1.0, 1.12)):
        shape.box("marble", (-half * wide, -half * wide, low * height_m), (half * wide, half * wide, high * height_m))
    return shape


def on_pedestal(stature_m: float, material: str, level: int) -> Shape:
    """Return a statue of honour on its base: of one material each."""
    shape = Shape()
    base = pedestal(0.55 * stature_m, 0.75 * stature_m)
    shape.copies(base, np.zeros((1, 3)))
    shape.copies(standing(stature_m, material, level), np.array([[0.0, 0.0, 0.75 * stature_m]]))
    return shape
