"""A lens is recovered from a simulated board video; too little and too much alike is refused."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.tracker.calibrate.board_video import BoardVideo, rotation, shown_around
from tracker.calibrate.board import Board, BoardView
from tracker.calibrate.camera_lens import LensFit, fit_lens
from tracker.errors import InputError
from tracker.lens import project, unproject
from tracker.measurements import Matrix
from tracker.rig import CameraModel

WEBCAM = CameraModel(640, 480, 560.0, 558.0, 325.3, 236.1, "plumb_bob", (-0.28, 0.09, 0.0008, -0.0005, 0.0))
FISHEYE = CameraModel(640, 480, 330.0, 331.0, 318.0, 243.0, "equidistant", (0.02, -0.01, 0.003, -0.001))


def looked_at(video: BoardVideo, poses: Sequence[tuple[Matrix, Matrix]]) -> list[BoardView]:
    views = [video.board.find(video.picture(R, p, i), i * 1_000_000_000) for i, (R, p) in enumerate(poses)]
    return [view for view in views if view is not None]


@cache
def shown_to_webcam() -> tuple[BoardVideo, tuple[BoardView, ...]]:
    """Return a video of a board shown around fifty times, and its views; points are changed in copies alone."""
    video = BoardVideo(WEBCAM)
    return video, tuple(looked_at(video, list(shown_around(video, 50))))


@pytest.mark.parametrize(("camera", "seed"), [(WEBCAM, 2), (FISHEYE, 1)], ids=["webcam", "fisheye"])
def test_a_lens_is_recovered_within_half_a_percent(camera: CameraModel, seed: int) -> None:
    video = BoardVideo(camera, seed=seed)
    fit = fit_lens(looked_at(video, list(shown_around(video, 50))), video.board)
    found = fit.camera
    for value, true in ((found.fx_px, camera.fx_px), (found.fy_px, camera.fy_px)):
        assert value == pytest.approx(true, rel=0.005)
    assert (found.cx_px, found.cy_px) == pytest.approx((camera.cx_px, camera.cy_px), abs=0.005 * camera.width_px)
    assert abs(found.fx_px - camera.fx_px) < 4.0 * fit.focal_sigma_px + 0.1
    assert fit.rms_px < 0.25
    assert fit.is_checked
    assert fit.verdict == "excellent"
    # the lens as a whole: where it puts what is anywhere in the picture
    u, v = np.meshgrid(np.linspace(20, 620, 13), np.linspace(20, 460, 10))
    points = np.column_stack([u.ravel(), v.ravel()])
    assert np.abs(project(found, unproject(camera, points)) - points).max() < 1.5


def placed(distance_m: float, across: float, down: float, slant: Sequence[float] | Matrix) -> tuple[Matrix, Matrix]:
    R = rotation(np.array([*slant, 0.1]))
    middle = Board().corners_m.mean(axis=0)
    return R, np.array([across, down, 1.0]) * distance_m - R @ middle


def in_the_middle(rng: np.random.Generator) -> tuple[Matrix, Matrix]:
    across, down = rng.uniform(-0.05, 0.05, 2)
    return placed(rng.uniform(0.6, 1.0), across, down, rng.uniform(-0.6, 0.6, 2))


def never_slanted(rng: np.random.Generator) -> tuple[Matrix, Matrix]:
    across, down = rng.uniform(-0.4, 0.4, 2)
    return placed(rng.uniform(0.45, 0.9), across, down, (0.0, 0.0))


@pytest.mark.parametrize(
    ("how", "words"),
    [(in_the_middle, "bring it to the edges"), (never_slanted, "slant the board more")],
)
def test_poor_views_are_refused(how: Callable[[np.random.Generator], tuple[Matrix, Matrix]], words: str) -> None:
    video, rng = BoardVideo(WEBCAM), np.random.default_rng(3)
    with pytest.raises(InputError, match=words):
        fit_lens(looked_at(video, [how(rng) for _ in range(24)]), video.board)


def test_a_board_that_is_held_still_is_refused() -> None:
    video = BoardVideo(WEBCAM)
    with pytest.raises(InputError, match="seen in 1 different ways"):
        fit_lens(looked_at(video, [placed(0.4, 0.0, 0.0, (0.3, 0.2))] * 20), video.board)


def test_corners_that_are_off_by_pixels_are_refused() -> None:
    """A bent board, or one of another kind."""
    (video, views), rng = shown_to_webcam(), np.random.default_rng(4)
    bent = [replace(view, points_px=view.points_px + rng.normal(0.0, 2.0, view.points_px.shape)) for view in views]
    with pytest.raises(InputError, match="glue the board to something flat"):
        fit_lens(bent, video.board)


def test_a_mistaken_corner_now_and_then_does_no_harm() -> None:
    (video, seen), rng = shown_to_webcam(), np.random.default_rng(5)
    views = [replace(view, points_px=view.points_px.copy()) for view in seen]
    for view in views:
        view.points_px[rng.integers(len(view.points_px))] += rng.uniform(-25.0, 25.0, 2)
    fit: LensFit = fit_lens(views, video.board)
    assert fit.camera.fx_px == pytest.approx(WEBCAM.fx_px, rel=0.005)


def test_the_same_views_give_the_same_lens() -> None:
    video, views = shown_to_webcam()
    one, other = (fit_lens(views, video.board).camera for _ in range(2))
    assert other.distortion == pytest.approx(one.distortion, rel=1e-6)  # OpenCV's threads add in any order
    assert other.fx_px == pytest.approx(one.fx_px, rel=1e-9)


def test_a_picture_without_a_board_has_no_corners() -> None:
    noise = np.random.default_rng(1).integers(0, 255, (480, 640)).astype(np.uint8)
    assert Board().find(noise, 0) is None
    assert Board().find(np.zeros((480, 640), np.uint8), 0) is None


def test_corners_are_where_the_board_says() -> None:
    """Pixel (0, 0) is the centre of the first pixel; corner 0 lies one square from the board's corner."""
    board = Board()
    drawn = np.kron(np.where(board.cells(), 255, 0), np.ones((6, 6), int))
    view = board.find(np.pad(drawn, 60, constant_values=255).astype(np.uint8), 0)
    assert view is not None
    assert len(view.numbers) == 8 * 5
    expected = board.corners_m[view.numbers, :2] / board.square_m * 48.0 + 59.5
    np.testing.assert_allclose(view.points_px, expected, atol=0.1)


@pytest.mark.parametrize(
    ("columns", "rows", "square_m", "dictionary"),
    [(2, 6, 0.03, "4x4_50"), (12, 9, 0.03, "4x4_50"), (9, 6, 0.0, "4x4_50"), (9, 6, 0.03, "?")],
)
def test_boards_that_cannot_be(columns: int, rows: int, square_m: float, dictionary: str) -> None:
    with pytest.raises(InputError, match=r"is none|no dictionary"):
        Board(columns, rows, square_m, dictionary)
