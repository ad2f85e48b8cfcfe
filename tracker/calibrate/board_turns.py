"""How a calibrated camera turned before a board: exact whatever else it did, since the board's whole pose is seen."""

from collections.abc import Callable, Sequence

import numpy as np

from tracker import rotations
from tracker.calibrate.board import Board, BoardView
from tracker.calibrate.camera_lens import board_pose
from tracker.calibrate.turns import Turns
from tracker.geometry import wxyz_from_matrix
from tracker.rig import CameraModel

#: A pose is off by a hundredth of a degree or more, so that turns are taken over this long, to be far larger than that;
_LEAST_S = 0.25
#: but not so long that the gyroscope's bias and gaps count.
_LONGEST_S = 1.0


def board_turns(
    views: Sequence[BoardView],
    board: Board,
    camera: CameraModel,
    t_zero_ns: int,
    progress: Callable[[float], None] = lambda share: None,
) -> Turns:
    """Return the turns between views a quarter of a second apart and more; views in order of time."""
    times_s, attitudes, errors = [], [], []
    for i, view in enumerate(views):
        pose = board_pose(camera, view, board)
        if pose is not None:
            spread = np.ptp(view.points_px, axis=0).max() / camera.fx_px
            times_s.append((view.t_ns - t_zero_ns) * 1e-9)
            attitudes.append(wxyz_from_matrix(pose[0]))
            errors.append(1.0 / (camera.fx_px * spread * np.sqrt(len(view.numbers))))
        progress((i + 1) / len(views))
    t, error = np.array(times_s), np.array(errors)
    after = np.searchsorted(t, t + _LEAST_S)
    first = np.flatnonzero(after < len(t))
    second = after[first]
    near = t[second] - t[first] <= _LONGEST_S
    first, second = first[near], second[near]
    if not len(first):
        return Turns(np.zeros((0, 2)), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0))
    q = np.array(attitudes)
    vectors = rotations.log(rotations.multiply(q[first], rotations.conjugate(q[second])))
    return Turns(
        np.column_stack([t[first], t[second]]), vectors, np.zeros_like(vectors), np.hypot(error[first], error[second])
    )
