"""Which of many views of a board to calibrate from: sharp ones that differ, and how much of the picture they fill. Numpy only."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from tracker.calibrate.board import BoardView
from tracker.measurements import Matrix

#: The picture is cut into so many parts across and down; a part is covered where a corner was seen in it.
GRID = (8, 6)
MOST_VIEWS = 40
#: Views nearer to each other than this (see `place_of`) tell the same.
_NEAREST = (0.12, 0.08, 0.05, 0.03)


def place_of(view: BoardView, corners_m: Matrix) -> Matrix:
    """Return (6,) where and how a board is seen: its middle, its size, its turn, and its slant across and down.

    All are of about the same weight: 1 is as different as can be. The slant is the perspective part of the board's homography.
    """
    width, height = view.size_px
    scale = np.hypot(width, height)
    flat = corners_m[:, :2] - corners_m[:, :2].mean(axis=0)
    size_m = np.ptp(flat, axis=0).max()
    H = _homography(flat[view.numbers] / size_m, (view.points_px - (0.5 * width, 0.5 * height)) / scale)
    middle = H[:2, 2] / H[2, 2]
    across, down = H[:2, 0] / H[2, 2], H[:2, 1] / H[2, 2]
    size = np.sqrt(abs(across[0] * down[1] - across[1] * down[0]))
    turn = np.arctan2(across[1] - down[0], across[0] + down[1])
    slant = H[2, :2] / H[2, 2]
    return np.array([*middle, size, 0.5 * turn / np.pi, *np.clip(slant, -1.0, 1.0)])


def _homography(plane: Matrix, points: Matrix) -> Matrix:
    """Return H, (3, 3), with points ~ H plane (direct linear transform)."""
    x, y = plane.T
    u, v = points.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    rows = np.concatenate(
        [
            np.stack([x, y, one, zero, zero, zero, -u * x, -u * y, -u], axis=1),
            np.stack([zero, zero, zero, x, y, one, -v * x, -v * y, -v], axis=1),
        ]
    )
    H = np.linalg.svd(rows)[2][-1].reshape(3, 3)
    return np.asarray(H / (H[2, 2] if abs(H[2, 2]) > 1e-12 else 1e-12))


def motions_px(views: Sequence[BoardView]) -> Matrix:
    """Return (V,) how far the board's corners move between neighbouring views of a recording: what moves is blurred."""
    moved = np.full(len(views), np.inf)
    for i, (before, after) in enumerate(pairwise(views)):
        _, here, there = np.intersect1d(before.numbers, after.numbers, return_indices=True)
        if len(here) and 0 < after.t_ns - before.t_ns < 0.5e9:
            step = float(np.median(np.linalg.norm(before.points_px[here] - after.points_px[there], axis=1)))
            step /= (after.t_ns - before.t_ns) * 30e-9  # as at 30 Hz
            moved[i], moved[i + 1] = min(moved[i], step), min(moved[i + 1], step)
    # single photographs were taken by a hand that held still
    return np.where(np.isfinite(moved), moved, 0.0)


def varied(views: Sequence[BoardView], corners_m: Matrix, most: int = MOST_VIEWS) -> list[int]:
    """Return the places of at most so many views that differ, the stillest first; the same views give the same choice."""
    order = np.argsort(motions_px(views), kind="stable").tolist()
    places = [place_of(view, corners_m) for view in views]
    chosen: list[int] = []
    for nearest in _NEAREST:
        for i in order:
            if len(chosen) >= most:
                return chosen
            if i not in chosen and all(np.abs(places[i] - places[k]).max() > nearest for k in chosen):
                chosen.append(i)
    return chosen


def covered(views: Sequence[BoardView]) -> Matrix:
    """Return the (6, 8) parts of the picture, each with how many corners were seen in it."""
    across, down = GRID
    counts = np.zeros((down, across))
    for view in views:
        width, height = view.size_px
        column = np.clip((view.points_px[:, 0] * across / width).astype(int), 0, across - 1)
        row = np.clip((view.points_px[:, 1] * down / height).astype(int), 0, down - 1)
        np.add.at(counts, (row, column), 1.0)
    return counts


def coverage(views: Sequence[BoardView]) -> float:
    """Return the share of the picture's parts in which at least three corners were seen."""
    return float(np.mean(covered(views) >= 3)) if views else 0.0
