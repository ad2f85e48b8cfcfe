"""The rolling shutter: most cameras read their rows one after the other, so that a turning camera bends the picture. Numpy only."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracker import lens, rotations, two_view
from tracker.calibrate.alignment import Alignment
from tracker.calibrate.gyro_track import GyroTrack
from tracker.calibrate.turns import PointPair, disagreement_px, times_of
from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: From the first row to the last: no webcam takes longer; a negative time is a camera that is upside down.
_READOUTS_S = np.arange(-0.040, 0.0401, 0.008)
#: A readout is believed where it explains this share more of what single turns leave.
_LEAST_GAIN = 0.03


def readout_s(
    track: GyroTrack, pairs: Sequence[PointPair], t_zero_ns: int, camera: CameraModel, alignment: Alignment
) -> float:
    """Return how long the camera takes from its first row to its last; 0 where nothing shows that it takes any time."""
    misfits = np.array(
        [
            disagreement_px(without_shutter(track, pairs, t_zero_ns, camera, alignment, float(readout)), camera)
            for readout in _READOUTS_S
        ]
    )
    best = int(np.argmin(misfits))
    none = int(np.argmin(np.abs(_READOUTS_S)))
    if best in (0, len(misfits) - 1) or misfits[best] > (1.0 - _LEAST_GAIN) * misfits[none]:
        return 0.0
    before, at, after = misfits[best - 1 : best + 2]
    return float(
        _READOUTS_S[best] + 0.5 * (before - after) / (before - 2.0 * at + after) * (_READOUTS_S[1] - _READOUTS_S[0])
    )


def without_shutter(
    track: GyroTrack,
    pairs: Sequence[PointPair],
    t_zero_ns: int,
    camera: CameraModel,
    alignment: Alignment,
    readout: float,
) -> list[PointPair]:
    """Return the pairs as a camera would have seen them that takes each picture in its middle row's moment."""
    times_s = times_of(pairs, t_zero_ns) + alignment.offset_s
    steady = track.without(alignment.bias_rad_s)
    R = alignment.R_body_cam

    def moved(points_px: Matrix, t_s: float) -> Matrix:
        rows_s = readout * ((points_px[:, 1] + 0.5) / camera.height_px - 0.5)
        turns = rotations.matrices(steady.between(np.full(len(points_px), t_s), t_s + rows_s))
        rays = two_view.bearings(lens.unproject(camera, points_px))
        rays = np.einsum("ab,nbc,nc->na", R.T, turns, rays @ R.T)
        return lens.project(camera, rays[:, :2] / rays[:, 2:])

    return [
        replace(pair, first_px=moved(pair.first_px, t_first), second_px=moved(pair.second_px, t_second))
        for pair, (t_first, t_second) in zip(pairs, times_s.tolist(), strict=True)
    ]
