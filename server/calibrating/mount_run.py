"""`agora calibrate rig`: camera against gyroscope, by corners that were followed, or by the board where that is in view."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from server.calibrating.feed import Feed, Progress
from server.calibrating.lens_run import result_of as lens_result
from server.calibrating.mount_result import device_of, mount_result
from server.calibrating.result import Result, joined
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
from tracker.calibrate.common_mount import CommonMount, common_mount
from tracker.calibrate.flow import Flow
from tracker.calibrate.gyro_track import GyroTrack
from tracker.calibrate.turns import PointPair
from tracker.errors import InputError, MalformedInput
from tracker.lens import scaled
from tracker.measurements import Frame, ImuSample
from tracker.rig import CameraModel
from tracker.rig_file import RigFile

T = TypeVar("T")

#: The board is looked for in every fifth picture until it was seen.
_LOOK_EVERY = 5


@dataclass
class _Gathered:
    """What one recording holds."""

    feed: Feed
    board: Board
    flow: Flow = field(default_factory=Flow)
    samples: list[ImuSample] = field(default_factory=list)
    pairs: list[PointPair] = field(default_factory=list)
    views: list[BoardView] = field(default_factory=list)

    def read(self, progress: Progress) -> None:
        """Gather all of it.

        Raises:
            InputError: There are no pictures.
        """
        for measurement in self.feed.measurements(progress):
            if isinstance(measurement, ImuSample):
                self.samples.append(measurement)
            elif isinstance(measurement, Frame):
                self._look(measurement)
        if self.flow.size_px is None:
            raise InputError(
                "There are no pictures in this: `agora calibrate rig` needs a camera beside the gyroscope."
            )

    def _look(self, frame: Frame) -> None:
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

    @property
    def size_px(self) -> tuple[int, int]:
        """Of the pictures."""
        return self.flow.size_px or (0, 0)

    @property
    def shows_board(self) -> bool:
        """Whether the board was there for most of it."""
        return len(self.views) >= max(LEAST_PAIRS, 0.3 * self.flow.pictures)

    @property
    def t_zero_ns(self) -> int:
        """Time zero of its track."""
        return self.samples[0].t_ns if self.samples else 0

    @property
    def stated_lens(self) -> CameraModel | None:
        """The lens that a recording states for its own pictures; of live sensors the rig file knows all that is known."""
        camera = None if self.feed.is_live else self.feed.rig.camera
        return camera if camera is not None and (camera.width_px, camera.height_px) == self.size_px else None

    def by_board(self, lens: CameraModel, progress: Progress) -> CameraMount | None:
        """Return the mount by the board's views; None where they are too few."""
        turns = board_turns(self.views, self.board, lens, self.t_zero_ns, lambda share: progress("comparing", share))
        if len(turns.times_s) < LEAST_PAIRS:
            return None
        return find_mount_by_board(GyroTrack.of(self.samples, self.t_zero_ns), turns, lens)

    def by_flow(self, lens: CameraModel | None, progress: Progress) -> CameraMount:
        """Return the mount by corners that were followed, and the focal length with it where no lens is given."""
        what = "finding the focal length" if lens is None else "comparing"
        return find_mount_by_flow(
            GyroTrack.of(self.samples, self.t_zero_ns),
            self.pairs,
            self.t_zero_ns,
            unknown_camera(*self.size_px) if lens is None else lens,
            focal_is_free=lens is None,
            progress=lambda share: progress(what, share),
        )


def calibrate_rig(feeds: Sequence[Feed], rig_file: RigFile, board: Board, progress: Progress) -> Result:
    """Return how the camera sits beside the inertial unit, from one recording or from several of the same rig.

    Raises:
        InputError: Nothing can be told; with the remedy.
    """
    recordings = [_Gathered(feed, board) for feed in feeds]
    _each(recordings, lambda gathered: gathered.read(progress))
    size_px = _one_size(recordings)
    known = _known_lens(rig_file, size_px)
    stated = recordings[0].stated_lens if len({gathered.stated_lens for gathered in recordings}) == 1 else None
    if all(gathered.shows_board for gathered in recordings):
        fit = None if known is not None else _lens_by_board(recordings, progress)
        lens = known or (stated if fit is None else fit.camera)
        mounts = [] if lens is None else _each(recordings, lambda gathered: gathered.by_board(lens, progress))
        before_board = [mount for mount in mounts if mount is not None]
        if len(before_board) == len(recordings):
            result = mount_result(common_mount(before_board), None, feeds, rig_file, by="board")
            return result if fit is None else joined(lens_result(fit, device_of(feeds)), result)

    def by_flow(lens: CameraModel | None) -> CommonMount:
        return common_mount(_each(recordings, lambda gathered: gathered.by_flow(lens, progress)))

    if known is not None:
        return mount_result(by_flow(known), None, feeds, rig_file, by="flow")
    free = by_flow(None)
    # recordings that say which lens they had are believed for the mount, but the focal length is found without it
    mount = free if stated is None else by_flow(stated)
    return mount_result(mount, free, feeds, rig_file, by="flow")


def _each(recordings: Sequence[_Gathered], ask: Callable[[_Gathered], T]) -> list[T]:
    """Return what each recording answers; where there are several, what is wrong is said with the recording's name."""
    answers = []
    for gathered in recordings:
        try:
            answers.append(ask(gathered))
        except InputError as error:
            if len(recordings) == 1:
                raise
            raise InputError(f"{gathered.feed.name}: {error}") from error
    return answers


def _one_size(recordings: Sequence[_Gathered]) -> tuple[int, int]:
    first = recordings[0]
    for other in recordings[1:]:
        if other.size_px != first.size_px:
            raise InputError(
                f"{first.feed.name} has pictures of {first.size_px[0]} x {first.size_px[1]} px, but {other.feed.name} of "
                f"{other.size_px[0]} x {other.size_px[1]}: give recordings of one camera at one size."
            )
    return first.size_px


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


def _lens_by_board(recordings: Sequence[_Gathered], progress: Progress) -> LensFit | None:
    """Return the lens as the same views of the board tell it; None where they are too few or too much alike."""
    views = [view for gathered in recordings for view in gathered.views]
    try:
        return fit_lens(views, recordings[0].board, lambda what: progress(what, 0.0))
    except InputError:
        return None
