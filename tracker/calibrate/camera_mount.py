"""`agora calibrate rig`: how the camera sits beside the inertial unit and how late its clock is, from a pan of ten seconds.

Where the lens is not known yet the focal length is found as well: the gyroscope says by how much the picture should have moved.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tracker import rotations
from tracker.calibrate.alignment import Alignment, align, align_all, rough
from tracker.calibrate.gyro_track import GyroTrack
from tracker.calibrate.shutter import readout_s, without_shutter
from tracker.calibrate.turns import CORNER_SIGMA_PX, PointPair, Turns, times_of, turns_of, with_focal
from tracker.errors import InputError
from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: The pairs that tell most are enough.
MOST_PAIRS = 300
LEAST_PAIRS = 30
#: In all, both ways counted: less says too little.
LEAST_TURN_RAD = np.radians(60.0)
#: Clocks differ by no more than this, but for network cameras far away.
LARGEST_OFFSET_S = 0.6
_OFFSETS_S = np.arange(-LARGEST_OFFSET_S, LARGEST_OFFSET_S + 1e-9, 0.02)
#: Focal lengths that are tried, as shares of the picture's width: from fisheye to the length of a telephoto lens.
_FOCALS = np.exp(np.arange(np.log(0.35), np.log(3.0), 0.15))
#: Median of what remains of a turn, as its share: more is no turn that camera and gyroscope have in common.
LARGEST_SHARE = 0.35
#: What no turn tells apart from the focal length, as shares of it, one sigma each: how true the gyroscope's scale is (data sheets
#: of consumer units say 3 % at most), a lens that bends (k1 of 0.07 where none is known), and the camera's own way while the rig
#: turns about whoever holds it (a third of a metre, before things twenty metres away).
GYRO_SCALE_SHARE, BEND_SHARE, OWN_WAY_SHARE = 0.015, 0.02, 0.017
_UNTOLD_SHARE = float(np.sqrt(GYRO_SCALE_SHARE**2 + BEND_SHARE**2 + OWN_WAY_SHARE**2))

Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class CameraMount:
    """What was found."""

    alignment: Alignment
    camera: CameraModel
    """With the focal length as found, where it was not known."""
    focal_scatter_px: float
    """By how much the turns of this recording disagree about the focal length, as its standard error."""
    readout_s: float
    turn_rad: float
    """All turning added up."""
    track: GyroTrack
    turns: Turns
    pairs: Sequence[PointPair] = ()
    """What the turns were made of, without the shutter; empty before a board."""
    t_zero_ns: int = 0
    """Time zero of the track."""

    @property
    def across(self) -> float:
        """Share of the turning that was across the line of sight, 0 to 1: only that tells the focal length."""
        squares = np.mean(self.turns.vectors_rad**2, axis=0)
        return float(np.sqrt(squares[:2].sum() / squares.sum()))

    @property
    def focal_sigma_px(self) -> float:
        """Standard error of the focal length, with what a turn cannot tell apart from it; zero where it was known."""
        return with_untold(self.focal_scatter_px, self.camera)

    @property
    def residual_px(self) -> float:
        """What of the pictures' turning the gyroscope does not explain."""
        return self.alignment.residual_rad * self.camera.fx_px


def with_untold(focal_scatter_px: float, camera: CameraModel) -> float:
    """Return the standard error of a focal length of which the turns tell so much; zero where they were not asked for it.

    What no turn tells does not average out over turns, nor over recordings: it is the same gyroscope and the same lens, and the
    camera's own way, another in every place, makes the focal length too long in most, since who holds the rig stands behind it.
    """
    return float(np.hypot(focal_scatter_px, _UNTOLD_SHARE * camera.fx_px)) if focal_scatter_px else 0.0


def unknown_camera(width_px: int, height_px: int) -> CameraModel:
    """Return a lens of which nothing is known but that its axis goes through the middle."""
    return CameraModel(width_px, height_px, width_px, width_px, 0.5 * (width_px - 1), 0.5 * (height_px - 1))


def find_mount_by_flow(
    track: GyroTrack,
    pairs: Sequence[PointPair],
    t_zero_ns: int,
    camera: CameraModel,
    *,
    focal_is_free: bool,
    progress: Progress = lambda share: None,
) -> CameraMount:
    """Return the mount from corners that were followed.

    Args:
        track: The gyroscope's, with time zero at t_zero_ns.
        pairs: Neighbouring pictures.
        t_zero_ns: Time zero.
        camera: The lens; of an unknown one what `unknown_camera` returns.
        focal_is_free: Whether its focal length is to be found.
        progress: Told the share that is done.

    Raises:
        InputError: The rig hardly turned, or camera and gyroscope did not turn alike; one sentence with the remedy.
    """
    pairs, turn_rad = _most_telling(track, pairs, t_zero_ns, camera)
    focals = [camera.fx_px] if not focal_is_free else (_FOCALS * camera.width_px).tolist()
    tried = []
    for i, focal_px in enumerate(focals):
        lens_ = with_focal(camera, focal_px)
        turns = turns_of(pairs, t_zero_ns, lens_, focal_is_free=False)
        tried.append((*rough(track, turns, _OFFSETS_S), lens_))
        progress(0.6 * (i + 1) / len(focals))
    _, offset_s, R, lens_ = min(tried, key=lambda item: item[0])
    (found,), (turns,), lens_ = aligned([(track, pairs, t_zero_ns)], lens_, R, [offset_s], focal_is_free=focal_is_free)
    progress(0.7)
    readout = readout_s(track, pairs, t_zero_ns, lens_, found)
    if readout:
        pairs = without_shutter(track, pairs, t_zero_ns, lens_, found, readout)
        (found,), (turns,), lens_ = aligned(
            [(track, pairs, t_zero_ns)], lens_, found.R_body_cam, [found.offset_s], focal_is_free=focal_is_free
        )
    progress(1.0)
    scatter_px = found.log_focal_sigma * lens_.fx_px
    return _judged(CameraMount(found, lens_, scatter_px, readout, turn_rad, track, turns, pairs, t_zero_ns))


def find_mount_by_board(track: GyroTrack, turns: Turns, camera: CameraModel) -> CameraMount:
    """Return the mount from turns that a calibrated camera saw in a board.

    Raises:
        InputError: As `find_mount_by_flow`.
    """
    turn_rad = _total_turn(track, turns.times_s)
    if len(turns.times_s) < LEAST_PAIRS or turn_rad < LEAST_TURN_RAD:
        raise InputError(_hardly_turned(turn_rad))
    _, offset_s, R = rough(track, turns, _OFFSETS_S)
    return _judged(CameraMount(align(track, turns, R, offset_s), camera, 0.0, 0.0, turn_rad, track, turns))


def aligned(
    recordings: Sequence[tuple[GyroTrack, Sequence[PointPair], int]],
    camera: CameraModel,
    R_body_cam: Matrix,
    offsets_s: Sequence[float],
    *,
    focal_is_free: bool,
) -> tuple[Sequence[Alignment], Sequence[Turns], CameraModel]:
    """Return the alignments, with the turns made anew until the focal length that they were made with is the one found.

    Args:
        recordings: Track, pairs and time zero of each.
        camera: The lens.
        R_body_cam: (3, 3) rough.
        offsets_s: Rough, of each recording.
        focal_is_free: Whether the lens's focal length is to be found.
    """
    for _ in range(6):
        turns = [turns_of(pairs, t_zero_ns, camera, focal_is_free=focal_is_free) for _, pairs, t_zero_ns in recordings]
        found = align_all(
            [(track, of) for (track, _, _), of in zip(recordings, turns, strict=True)], R_body_cam, offsets_s
        )
        R_body_cam, offsets_s = found[0].R_body_cam, [alignment.offset_s for alignment in found]
        camera = with_focal(camera, camera.fx_px * float(np.exp(found[0].log_focal)))
        if abs(found[0].log_focal) < 1e-3:
            break
    return found, turns, camera


def _total_turn(track: GyroTrack, times_s: Matrix) -> float:
    known = track.knows(times_s[:, 0], times_s[:, 1])
    return float(np.sum(np.linalg.norm(rotations.log(track.between(*times_s[known].T)), axis=1)))


def _most_telling(
    track: GyroTrack, pairs: Sequence[PointPair], t_zero_ns: int, camera: CameraModel
) -> tuple[Sequence[PointPair], float]:
    """Return the pairs that turned most beside what else moved in them, in order, and all turning added up.

    Raises:
        InputError: There are too few, or they hardly turned.
    """
    times_s = times_of(pairs, t_zero_ns) if pairs else np.zeros((0, 2))
    known = np.flatnonzero(track.knows(times_s[:, 0], times_s[:, 1]))
    if len(known) < LEAST_PAIRS:
        raise InputError(
            f"Only {len(known)} pairs of pictures can be followed while the gyroscope runs, expected at least {LEAST_PAIRS}: "
            "look at something with detail in good light, turn more slowly, and record for ten seconds."
        )
    pairs = [pairs[i] for i in known.tolist()]
    sizes = np.linalg.norm(rotations.log(track.between(*times_s[known].T)), axis=1)
    if float(sizes.sum()) < LEAST_TURN_RAD:
        raise InputError(_hardly_turned(float(sizes.sum())))
    errors = turns_of(pairs, t_zero_ns, camera, focal_is_free=False).errors_rad
    telling = sizes / np.maximum(errors, CORNER_SIGMA_PX / camera.fx_px)
    return [pairs[i] for i in sorted(np.argsort(-telling)[:MOST_PAIRS].tolist())], float(sizes.sum())


def _hardly_turned(turn_rad: float) -> str:
    return (
        f"The rig has turned by only {np.degrees(turn_rad):.0f} degrees in all, expected at least "
        f"{np.degrees(LEAST_TURN_RAD):.0f}: pan to both sides, then nod and tilt, for ten seconds."
    )


def _judged(mount: CameraMount) -> CameraMount:
    found, sizes = mount.alignment, np.linalg.norm(mount.turns.vectors_rad, axis=1)
    if found.residual_rad > LARGEST_SHARE * float(np.median(sizes)) or abs(found.offset_s) > LARGEST_OFFSET_S:
        raise InputError(
            "Camera and gyroscope did not turn alike: are both on the same rig, is the picture stabilised by the camera "
            "(switch that off), or does something near fill the picture?"
        )
    return mount
