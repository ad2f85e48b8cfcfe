"""The lens against OpenCV, and its own inverse."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker import lens
from tracker.rig import CameraModel

LENSES = [
    CameraModel(640, 480, 520.0, 510.0, 321.0, 238.0),
    CameraModel(640, 480, 520.0, 510.0, 321.0, 238.0, "plumb_bob", (-0.28, 0.07, 1e-3, -2e-3, -0.01)),
    CameraModel(640, 480, 520.0, 510.0, 321.0, 238.0, "rational_polynomial", (0.4, 0.1, 1e-3, 0, 0.01, 0.7, 0.2, 0.02)),
    CameraModel(640, 480, 300.0, 305.0, 321.0, 238.0, "equidistant", (0.01, -0.02, 0.003, 0.0)),
]


@pytest.mark.parametrize("camera", LENSES, ids=lambda camera: f"{camera.distortion_model}-{len(camera.distortion)}")
def test_projects_as_opencv_does(camera: CameraModel) -> None:
    """To a millionth of a pixel, over the whole picture."""
    xy = np.random.default_rng(2).uniform((-0.6, -0.45), (0.6, 0.45), (200, 2))
    rays = np.column_stack([xy, np.ones(len(xy))])
    d = np.array(camera.distortion or (0.0,) * 4)
    if camera.distortion_model == "equidistant":
        expected, _ = cv2.fisheye.projectPoints(rays[:, None, :], np.zeros(3), np.zeros(3), camera.K, d)
    else:
        expected, _ = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), camera.K, d)
    np.testing.assert_allclose(lens.project(camera, xy), expected.reshape(-1, 2), atol=1e-6)


@pytest.mark.parametrize("camera", LENSES, ids=lambda camera: f"{camera.distortion_model}-{len(camera.distortion)}")
@given(x=st.floats(0.0, 639.0), y=st.floats(0.0, 479.0))
def test_unproject_is_the_inverse(camera: CameraModel, x: float, y: float) -> None:
    """Every pixel of the picture comes back."""
    pixel = np.array([[x, y]])
    np.testing.assert_allclose(lens.project(camera, lens.unproject(camera, pixel)), pixel, atol=1e-3)


def test_a_smaller_picture_shows_the_same_rays() -> None:
    """The corners of the pixel grid coincide: the first small pixel's centre is that of the first four big ones."""
    camera = LENSES[1]
    half = lens.scaled(camera, 320, 240)
    np.testing.assert_allclose(
        lens.unproject(half, np.array([[0.0, 0.0], [319.0, 100.0]])),
        lens.unproject(camera, np.array([[0.5, 0.5], [638.5, 200.5]])),
        atol=1e-9,
    )
