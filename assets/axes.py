"""The square's own axes: from the `agora` frame (u along it, v across it) to the site frame (east, north) and back."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def agora_from_site(azimuth_rad: float) -> Array:
    """Return the (2, 2) matrix that maps (east, north) to (u, v); its transpose maps back.

    At azimuth 0 u is north and v is west; at 90 degrees u is east and v is north.
    """
    sin, cos = math.sin(azimuth_rad), math.cos(azimuth_rad)
    return np.array([[sin, cos], [-cos, sin]])
