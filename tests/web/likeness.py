"""How like two pictures are, to the eye and not to the bit: other versions of a software renderer pass, other views do not."""

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]

MOST_DIFFERENCE = 8.0
"""Mean, of 255, once both pictures are small and blurred: another version of the software renderer stays far below."""
LEAST_LIKENESS = 0.85
"""Of local structure, 1 for the same."""

MOST_BLEMISH = 12.0
"""Of 255, of the part that differs most: a control that is gone or moved is above it, how a picture is kept changes less than 8."""
_PART_PX = 4
"""Side of such a part, once a picture is small: 16 pixels of the picture as it is kept."""


def kept(path: Path, make: str) -> Picture:
    """Return a golden picture; `make` is the command that makes it."""
    picture = cv2.imread(str(path), cv2.IMREAD_COLOR)
    assert picture is not None, f"there is no golden picture {path.name}: {make}"
    return np.asarray(picture, np.uint8)


def small(picture: Picture) -> NDArray[np.float64]:
    """Return a picture at a quarter of its size, blurred: edges that moved by a pixel are the same."""
    quarter = cv2.resize(picture, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    return np.asarray(cv2.GaussianBlur(quarter, (0, 0), 1.5), np.float64)


def difference(a: Picture, b: Picture) -> float:
    """Return the mean difference of two pictures, 0 to 255."""
    return float(np.abs(small(a) - small(b)).mean())


def blemish(a: Picture, b: Picture) -> float:
    """Return the mean difference of that part of two pictures which differs most, 0 to 255."""
    far = np.abs(small(a) - small(b)).mean(axis=2)
    return float(cv2.blur(far, (_PART_PX, _PART_PX)).max())


def likeness(a: Picture, b: Picture) -> float:
    """Return the mean structural similarity (Wang et al. 2004) of two pictures' greys."""

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(cv2.GaussianBlur(values, (0, 0), 3.0), np.float64)

    x, y = (small(picture).mean(axis=2) for picture in (a, b))
    mx, my = mean(x), mean(y)
    vx, vy, cxy = mean(x * x) - mx * mx, mean(y * y) - my * my, mean(x * y) - mx * my
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    return float(((2 * mx * my + c1) * (2 * cxy + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2))).mean())
