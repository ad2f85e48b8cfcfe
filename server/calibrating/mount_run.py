"""`agora calibrate rig`: camera against gyroscope, by corners that were followed, or by the board where that is in view."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from server.calibrating.feed import Feed, Progress
from server.calibrating.lens_run import result_of as lens_result
from server.calibrating.result import Result, joined, today
from server.plots.mount import mount_pictures
from server.plots.style import Picture
from tracker.calibrate.board import Board, BoardView
from tracker.calibrate.board_turns import board_turns
from tracker.calibrate.camera_lens import LensFit, fit_lens
from tracker.calibrate.camera_mount import (
    LEAST_PAIRS,
    CameraMount,
    find_mount_by_board,
    find_mount_by_flow,
    unknown_camera,
)
from tracker.calibrate.flow import Flow
from tracker.calibrate.gyro_track import GyroTrack
from tracker.calibrate.turns import PointPair, Turns
from tracker.errors import InputError, MalformedInput
from tracker.lens import scaled
from tracker.measurements import Frame, ImuSample
from tracker.rig import CameraModel
from tracker.rig_file import RigFile
from tracker.rig_sheets import CameraMountSheet, CameraSheet

#: Standard errors that are good enough to be kept.
LARGEST_ROTATION_SIGMA_RAD = np.radians(0.5)
LARGEST_OFFSET_SIGMA_S = 0.005
LARGEST_FOCAL_SCATTER = 0.02
#: Share of the turning that must be across the line of sight for a focal length.
LEAST_ACROSS = 0.6
#: The board is looked for in every fifth picture until it was seen.
_LOOK_EVERY = 5


@dataclass
class _Gathered:
    board: Board
    flow: Flow = field(default_factory=Flow)
    samples: list[ImuSample] = field(default_factory=list)
    pairs: list[PointPair] = field(default_factory=list)
    views: list[BoardView] = field(default_factory=list)

    def step(self, frame: Frame) -> None:
        pair = self.flow.step(frame)
        if pair is not None:
            self.pairs.append(pair)
        if self.views or self.flow.pictures % _LOOK_EVERY == 1:
            try:
                view = self.board.find(frame.picture.gray(), frame.t_ns)
            except MalformedInput:
                return
            if view is not None:
                self.views.append(view)


def calibrate_rig(feed: Feed, rig_file: RigFile, board: Board, progress: Progress) -> Result:
    """Return how the camera sits beside the inertial unit.

    Raises:
        InputError: Nothing can be told; with the remedy.
    """
    gathered = _Gathered(board)
    for measurement in feed.measurements(progress):
        if isinstance(measurement, ImuSample):
            gathered.samples.append(measurement)
        elif isinstance(measurement, Frame):
            gathered.step(measurement)
    if gathered.flow.size_px is None:
        raise InputError("There are no pictures in this: `agora calibrate rig` needs a camera beside the gyroscope.")
    t_zero_ns = gathered.samples[0].t_ns if gathered.samples else 0
    track = GyroTrack.of(gathered.samples, t_zero_ns)
    size_px = gathered.flow.size_px
    known, stated = _known_lens(rig_file, size_px), _stated_lens(feed, size_px)
    if len(gathered.views) >= max(LEAST_PAIRS, 0.3 * gathered.flow.pictures):
        fit = None if known is not None else _lens_by_board(gathered, progress)
        lens = known or (stated if fit is None else fit.camera)
        turns = None if lens is None else _turns_by_board(gathered, lens, t_zero_ns, progress)
        if lens is not None and turns is not None:
            result = _result(find_mount_by_board(track, turns, lens), None, feed, rig_file, by="board")
            return result if fit is None else joined(lens_result(fit, feed.device("camera")), result)

    def by_flow(camera: CameraModel, what: str, *, focal_is_free: bool) -> CameraMount:
        return find_mount_by_flow(
            track,
            gathered.pairs,
            t_zero_ns,
            camera,
            focal_is_free=focal_is_free,
            progress=lambda share: progress(what, share),
        )

    if known is not None:
        return _result(by_flow(known, "comparing", focal_is_free=False), None, feed, rig_file, by="flow")
    free = by_flow(unknown_camera(*size_px), "finding the focal length", focal_is_free=True)
    # a recording that says which lens it had is believed for the mount, but the focal length is found without it
    mount = free if stated is None else by_flow(stated, "comparing", focal_is_free=False)
    return _result(mount, free, feed, rig_file, by="flow")


def _known_lens(rig_file: RigFile, size_px: tuple[int, int]) -> CameraModel | None:
    """Return the calibrated lens for pictures of this size; None where none was calibrated."""
    sheet = rig_file.camera
    if sheet is None or sheet.method != "board":
        return None
    width, height = size_px
    if abs(width * sheet.height_px - height * sheet.width_px) > 0.01 * width * sheet.height_px:
        raise InputError(
            f"The camera was calibrated at {sheet.width_px} x {sheet.height_px} px, but these pictures have {width} x {height}: "
            "another shape is another part of the sensor; run `agora calibrate camera` at this size."
        )
    return scaled(sheet.camera, width, height)


def _stated_lens(feed: Feed, size_px: tuple[int, int]) -> CameraModel | None:
    """Return the lens that a recording states for its own pictures; of live sensors the rig file knows all that is known."""
    camera = None if feed.is_live else feed.rig.camera
    return camera if camera is not None and (camera.width_px, camera.height_px) == size_px else None


def _lens_by_board(gathered: _Gathered, progress: Progress) -> LensFit | None:
    """Return the lens as the same views of the board tell it; None where they are too few or too much alike."""
    try:
        return fit_lens(gathered.views, gathered.board, lambda what: progress(what, 0.0))
    except InputError:
        return None


def _turns_by_board(gathered: _Gathered, lens: CameraModel, t_zero_ns: int, progress: Progress) -> Turns | None:
    """Return the turns before the board; None where they are too few."""
    turns = board_turns(gathered.views, gathered.board, lens, t_zero_ns, lambda share: progress("comparing", share))
    return turns if len(turns.times_s) >= LEAST_PAIRS else None


def _result(
    mount: CameraMount, free: CameraMount | None, feed: Feed, rig_file: RigFile, *, by: Literal["board", "flow"]
) -> Result:
    """Return the mount as tables and words, and the focal length of `free`, which was found with no lens known."""
    alignment, device = mount.alignment, feed.device("camera")
    worst = float(alignment.rotation_sigmas_rad[-1])
    sheets: dict[str, CameraMountSheet | CameraSheet] = {}
    doubts: list[str] = []
    if worst > LARGEST_ROTATION_SIGMA_RAD or alignment.offset_sigma_s > LARGEST_OFFSET_SIGMA_S:
        doubts.append(
            f"The mount was not kept: about one axis it is uncertain by {np.degrees(worst):.1f} degrees (0.5 is asked for), "
            f"and the clock by {alignment.offset_sigma_s * 1e3:.1f} ms (5): pan to both sides, then nod and tilt as well, "
            "a bit faster."
        )
    else:
        sheets["camera_mount"] = _mount_sheet(mount, feed, rig_file, device)
    found = [*_words(mount, by), *_against_present(mount, rig_file)]
    if free is not None:
        focal_px, scatter_px = free.camera.fx_px, free.focal_scatter_px
        stated = "" if mount is free else f"; the recording states {mount.camera.fx_px:.1f}"
        least_px, most_px = _focal_between_px(free)
        found.insert(
            0,
            f"Focal length {focal_px:.1f} px by the turning alone{stated}. Its turns agree within ±{scatter_px:.1f} px; with what "
            f"no turn tells (the gyroscope's scale, a lens that bends, the camera's way about who holds it) it is between "
            f"{least_px:.0f} and {most_px:.0f} px, nineteen times of twenty.",
        )
        if free.across < LEAST_ACROSS:
            doubts.append(
                f"The focal length, {focal_px:.0f} px, was not kept: the rig mostly rolled about the line of sight, "
                "which hardly tells it: pan instead, or run `agora calibrate camera`."
            )
        elif scatter_px > LARGEST_FOCAL_SCATTER * focal_px:
            doubts.append(
                f"The focal length, {focal_px:.0f} px, was not kept: its turns agree only within {scatter_px / focal_px:.1%}: "
                "pan further and longer, or run `agora calibrate camera`."
            )
        else:
            sheets["camera"] = _camera_sheet(free, device)
            found.append(
                "The lens is taken as one that does not bend; `agora calibrate camera` measures it with a board."
            )
    numbers = {
        "focal_px": (free or mount).camera.fx_px,
        "focal_sigma_px": (free or mount).focal_sigma_px,
        "focal_between_px": _focal_between_px(free or mount),
        "focal_is_found": free is not None,
        "R_body_cam": alignment.R_body_cam.tolist(),
        "rotation_sigma_deg": float(np.degrees(worst)),
        "time_offset_s": alignment.offset_s,
        "time_sigma_s": alignment.offset_sigma_s,
        "gyro_bias_rad_s": alignment.bias_rad_s.tolist(),
        "readout_s": mount.readout_s,
        "residual_px": mount.residual_px,
        "by": by,
    }

    def pictures() -> Sequence[Picture]:
        return mount_pictures(mount)

    return Result("rig", sheets, found, doubts, numbers, pictures)


def _focal_between_px(mount: CameraMount) -> tuple[float, float]:
    """Return the ends of what holds the focal length nineteen times of twenty."""
    off_px = 1.96 * mount.focal_sigma_px
    return mount.camera.fx_px - off_px, mount.camera.fx_px + off_px


def _mount_sheet(mount: CameraMount, feed: Feed, rig_file: RigFile, device: tuple[str, str]) -> CameraMountSheet:
    before = rig_file.rig() if rig_file.camera_mount is not None else feed.rig
    T_body_cam = np.eye(4)
    T_body_cam[:3, :3] = mount.alignment.R_body_cam
    T_body_cam[:3, 3] = before.T_body_cam[:3, 3]
    return CameraMountSheet(
        date=today(),
        device=device[0],
        serial=device[1],
        T_body_cam=tuple(tuple(row) for row in T_body_cam.tolist()),
        time_offset_s=mount.alignment.offset_s,
        rotation_sigma_rad=float(mount.alignment.rotation_sigmas_rad[-1]),
        time_sigma_s=mount.alignment.offset_sigma_s,
        residual_px=mount.residual_px,
    )


def _camera_sheet(mount: CameraMount, device: tuple[str, str]) -> CameraSheet:
    return CameraSheet.of(
        mount.camera,
        date=today(),
        device=device[0],
        serial=device[1],
        method="pan",
        rms_px=mount.residual_px,
        focal_sigma_px=mount.focal_sigma_px,
        views=mount.pairs,
        coverage=1.0,
    )


def _words(mount: CameraMount, by: Literal["board", "flow"]) -> list[str]:
    alignment = mount.alignment
    words = [
        f"The camera's pictures are {abs(alignment.offset_s) * 1e3:.1f} ms too {'early' if alignment.offset_s > 0 else 'late'} "
        f"in their stamps, ±{alignment.offset_sigma_s * 1e3:.1f}.",
        f"The camera's axes on the rig are known to {', '.join(f'{s:.2f}' for s in np.degrees(alignment.rotation_sigmas_rad))} "
        f"degrees (best to worst axis), from {mount.pairs} turns of {np.degrees(mount.turn_rad):.0f} degrees in all, "
        f"{'before the board' if by == 'board' else 'by corners that were followed'}.",
        f"What of a turn the gyroscope does not explain: {mount.residual_px:.2f} px, median.",
    ]
    if mount.readout_s:
        words.append(
            f"The camera reads its rows one after the other, in {abs(mount.readout_s) * 1e3:.0f} ms (rolling shutter)."
        )
    return words


def _against_present(mount: CameraMount, rig_file: RigFile) -> list[str]:
    """Say how far the new mount is from the one so far."""
    if rig_file.camera_mount is None:
        return []
    R = rig_file.rig().T_body_cam[:3, :3].T @ mount.alignment.R_body_cam
    angle = float(np.degrees(np.arccos(np.clip(0.5 * (np.trace(R) - 1.0), -1.0, 1.0))))
    return [f"That is {angle:.2f} degrees from the mount that was known so far."]
