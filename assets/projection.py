"""A pinhole camera as OpenGL's clip space, and what a depth stored there means."""

import numpy as np

from assets.axes import Array
from assets.lens import Pinhole

NEAR_M, FAR_M = 0.2, 4000.0
SKY_M = 3900.0
"""What is drawn beyond is the sky, which lies just before the far plane."""


def projection_from_pinhole(camera: Pinhole) -> Array:
    """Return the (4, 4) map from the camera's frame to OpenGL's clip space.

    Row 0 of the framebuffer is the top row of the picture, so nothing is flipped when it is read; the half pixel is there
    because OpenGL counts from a pixel's edge and OpenCV from its centre.
    """
    w, h = camera.width_px, camera.height_px
    return np.array(
        [
            [2.0 * camera.fx_px / w, 0.0, 2.0 * (camera.cx_px + 0.5) / w - 1.0, 0.0],
            [0.0, 2.0 * camera.fy_px / h, 2.0 * (camera.cy_px + 0.5) / h - 1.0, 0.0],
            [0.0, 0.0, (FAR_M + NEAR_M) / (FAR_M - NEAR_M), -2.0 * FAR_M * NEAR_M / (FAR_M - NEAR_M)],
            [0.0, 0.0, 1.0, 0.0],
        ]
    )


def depths(stored: Array) -> Array:
    """Return metres along the line of sight for depths as the buffer stores them, 0 to 1; infinite for the sky's."""
    clip = 2.0 * stored - 1.0
    metres = 2.0 * FAR_M * NEAR_M / (FAR_M + NEAR_M - clip * (FAR_M - NEAR_M))
    return np.asarray(np.where(metres < SKY_M, metres, np.inf))
