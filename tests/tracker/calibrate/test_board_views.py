"""Which views are chosen, and how much of the picture they cover."""

import numpy as np

from tests.tracker.calibrate.board_video import rotation
from tracker.calibrate.board import Board, BoardView
from tracker.calibrate.board_views import coverage, covered, motions_px, place_of, varied
from tracker.lens import project
from tracker.measurements import Matrix
from tracker.rig import CameraModel

CAMERA = CameraModel(640, 480, 500.0, 500.0, 319.5, 239.5)
BOARD = Board()


def seen(R: Matrix, place_m: tuple[float, float, float], t_s: float = 0.0) -> BoardView:
    """A view of the board with its middle at a place."""
    points = (BOARD.corners_m - BOARD.corners_m.mean(axis=0)) @ R.T + place_m
    pixels = project(CAMERA, points[:, :2] / points[:, 2:])
    inside = np.all((pixels >= 0.0) & (pixels <= (639.0, 479.0)), axis=1)
    return BoardView(round(t_s * 1e9), (640, 480), np.flatnonzero(inside), pixels[inside])


STRAIGHT = np.eye(3)


def test_the_same_place_is_known_from_any_part_of_the_board() -> None:
    view = seen(rotation(np.array([0.4, -0.3, 0.2])), (0.02, 0.01, 0.4))
    part = view.chosen(np.arange(len(view.numbers)) % 8 < 4)
    np.testing.assert_allclose(place_of(part, BOARD.corners_m), place_of(view, BOARD.corners_m), atol=1e-6)


def test_slant_size_and_place_differ_as_they_should() -> None:
    straight = place_of(seen(STRAIGHT, (0.0, 0.0, 0.4)), BOARD.corners_m)
    np.testing.assert_allclose(straight[[0, 1, 3, 4, 5]], 0.0, atol=1e-3)
    near = place_of(seen(STRAIGHT, (0.0, 0.0, 0.3)), BOARD.corners_m)
    assert near[2] > straight[2] * 1.3
    across = place_of(seen(rotation(np.array([0.0, 0.5, 0.0])), (0.0, 0.0, 0.4)), BOARD.corners_m)
    assert abs(across[4]) > 0.1 > 10 * abs(across[5])


def test_views_that_tell_the_same_are_taken_once_and_the_still_ones_first() -> None:
    moving = [seen(STRAIGHT, (0.004 * i, 0.0, 0.4), i / 30) for i in range(5)]
    still = [seen(STRAIGHT, (0.02, 0.0, 0.4), 1.0 + i / 30) for i in range(5)]
    other = [seen(rotation(np.array([0.5, 0.0, 0.0])), (-0.05, 0.0, 0.5), 5.0)]
    views = [*moving, *still, *other]
    motions = motions_px(views)
    assert motions[:5].min() > 4.0 > 0.1 > motions[5:].max()
    chosen = varied(views, BOARD.corners_m)
    assert set(chosen[:2]) == {5, 10}
    assert not {6, 7, 8, 9} & set(chosen)


def test_coverage_is_the_share_of_the_pictures_parts() -> None:
    assert coverage([]) == 0.0
    left = seen(STRAIGHT, (-0.09, 0.0, 0.35))
    counts = covered([left])
    assert counts.shape == (6, 8)
    assert counts[:, 6:].sum() == 0.0
    assert counts.sum() == len(left.numbers)
    assert coverage([left]) == np.count_nonzero(counts >= 3) / 48 > 0.1
