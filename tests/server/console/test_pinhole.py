"""A picture as a centred pinhole sees it: each of its pixels where the lens says that it looks."""

from dataclasses import replace

import numpy as np
import pytest

from server.console.pinhole import fov_of, seen_by_pinhole, upright
from tracker.lens import project
from tracker.rig import CameraModel

CAMERA = CameraModel(320, 240, 260.0, 255.0, 170.0, 110.0, "plumb_bob", (-0.2, 0.05, 0.001, -0.001, 0.0))


def picture_of(camera: CameraModel, ray: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return a black picture with a white disc where a ray comes in, and that place, pixels."""
    place = project(camera, np.array([ray]))[0]
    y, x = np.mgrid[: camera.height_px, : camera.width_px]
    disc = (np.hypot(x - place[0], y - place[1]) < 4.0) * 255
    return np.repeat(disc[..., None], 3, axis=2).astype(np.uint8), place


@pytest.mark.parametrize("quarter_turns", [0, 1, 2, 3])
@pytest.mark.parametrize("ray", [(0.2, 0.1), (-0.3, 0.15), (0.1, -0.25)])
def test_a_point_is_seen_where_viser_draws_it(quarter_turns: int, ray: tuple[float, float]) -> None:
    """viser's camera has its axis in the middle of the canvas, square pixels, and a vertical field of view."""
    seen = seen_by_pinhole(picture_of(CAMERA, ray)[0], CAMERA, quarter_turns, 1.6)
    height_px, width_px = seen.shape[:2]
    assert width_px / height_px == pytest.approx(1.6, abs=0.01)
    point_eye = np.linalg.inv(upright(np.eye(4), quarter_turns)) @ (*ray, 1.0, 1.0)
    focal_px = height_px / 2.0 / np.tan(fov_of(CAMERA, quarter_turns) / 2.0)
    expected = point_eye[:2] / point_eye[2] * focal_px + ((width_px - 1) / 2.0, (height_px - 1) / 2.0)
    y, x = np.nonzero(seen[..., 0] > 127)
    assert (x.mean(), y.mean()) == pytest.approx(tuple(expected), abs=1.0)


def test_a_picture_turned_clockwise_stands_upright() -> None:
    """What is on the left of the stored picture is above once that is turned clockwise."""
    centred = replace(CAMERA, cx_px=159.5, cy_px=119.5, distortion=())
    seen = seen_by_pinhole(picture_of(centred, (-0.4, 0.0))[0], centred, 1, 1.0)
    y, x = np.nonzero(seen[..., 0] > 127)
    assert y.mean() < seen.shape[0] / 3
    assert x.mean() == pytest.approx(seen.shape[1] / 2, abs=2.0)


def test_where_the_picture_ends_it_is_black_and_all_of_it_is_there_from_top_to_bottom() -> None:
    white = np.full((240, 320, 3), 255, np.uint8)
    seen = seen_by_pinhole(white, CAMERA, 0, 3.0)
    assert not seen[:, 0].any()
    assert not seen[:, -1].any()
    middle = seen[:, seen.shape[1] // 2, 0]
    assert (middle > 0).mean() > 0.8


def test_a_picture_of_another_size_stands_for_the_whole() -> None:
    small = np.full((30, 40, 3), 200, np.uint8)
    seen = seen_by_pinhole(small, CAMERA, 0, 1.33)
    assert seen[seen.shape[0] // 2, seen.shape[1] // 2].tolist() == [200, 200, 200]
