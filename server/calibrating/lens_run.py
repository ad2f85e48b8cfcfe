"""`agora calibrate camera`: pictures of the board gathered, a lens fitted, both judged."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import cv2
import numpy as np

from server.calibrating.feed import Feed, Progress
from server.calibrating.result import Result, today
from server.language import Say
from server.plots.lens import lens_pictures
from tracker.calibrate.board import Board, BoardView
from tracker.calibrate.board_views import GRID, covered, place_of
from tracker.calibrate.camera_lens import LEAST_COVERAGE, LEAST_SLANT_RAD, LensFit, fit_lens
from tracker.errors import InputError, MalformedInput
from tracker.measurements import Frame, Image, Matrix
from tracker.rig_sheets import CameraSheet

#: While collecting, a view counts where it differs from all so far by this (see `board_views.place_of`).
_NEW = 0.08
ENOUGH_VIEWS = 40
ENOUGH_COVERAGE = 0.85
ENOUGH_SLANTED = 12
#: The perspective part of a board's homography, of a slant of about 20 degrees.
_SLANTED = 0.12
#: Views of a long recording that are kept; more tell nothing more.
_MOST_VIEWS = 3000


@dataclass
class Collection:
    """The views so far, and what is still missing; a page reads it while it grows."""

    board: Board
    views: list[BoardView] = field(default_factory=list)
    counts: Matrix = field(default_factory=lambda: np.zeros((GRID[1], GRID[0])))
    places: list[Matrix] = field(default_factory=list)
    pictures: int = 0
    finished: bool = False
    """Whether the lens was found."""
    newest: tuple[Image, BoardView | None] | None = None

    def step(self, frame: Frame) -> None:
        """Look at a picture."""
        try:
            gray = frame.picture.gray()
        except MalformedInput:
            return
        self.pictures += 1
        view = self.board.find(gray, frame.t_ns)
        self.newest = (gray, view)
        if view is None or len(self.views) >= _MOST_VIEWS:
            return
        self.views.append(view)
        place = place_of(view, self.board.corners_m)
        if all(np.abs(place - other).max() > _NEW for other in self.places):
            self.places.append(place)
            self.counts = self.counts + covered([view])

    @property
    def coverage(self) -> float:
        """Share of the picture that is covered."""
        return float(np.mean(self.counts >= 3))

    @property
    def slanted(self) -> int:
        """How many of the different views are slanted."""
        return sum(float(np.abs(place[4:]).max()) > _SLANTED for place in self.places)

    def is_enough(self) -> bool:
        """Return whether more would tell little."""
        return len(self.places) >= ENOUGH_VIEWS and self.coverage >= ENOUGH_COVERAGE and self.slanted >= ENOUGH_SLANTED

    def hint(self, say: Say = str) -> str:
        """Return what to do next, in words."""
        if self.finished:
            return say("Done: the lens is known, and its figures are in the terminal.")
        if not self.views:
            return say("Show the board to the camera: nothing of it is seen yet.")
        if self.coverage < ENOUGH_COVERAGE:
            rows, columns = np.divmod(int(np.argmin(_least(self.counts))), GRID[0])
            side = say(_side(int(rows), int(columns)))
            return say("Bring the board to the {side} of the picture; a part of it is enough.").format(side=side)
        if self.slanted < ENOUGH_SLANTED:
            return say("Slant the board by 30 degrees to each side, and up and down.")
        if len(self.places) < ENOUGH_VIEWS:
            return say("Go on, near and far, and hold still now and then.")
        return say("That is enough.")

    def state(self, say: Say = str) -> Mapping[str, Any]:
        """Return it for the page, as JSON values, with its words in a language."""
        counts = self.counts
        return {
            "pictures": self.pictures,
            "board_seen": self.newest is not None and self.newest[1] is not None,
            "views": len(self.places),
            "views_wanted": ENOUGH_VIEWS,
            "coverage": self.coverage,
            "coverage_wanted": ENOUGH_COVERAGE,
            "slanted": self.slanted,
            "slanted_wanted": ENOUGH_SLANTED,
            "grid": [[int(value) for value in row] for row in counts.tolist()],
            "hint": self.hint(say),
            "finished": self.finished,
        }

    def picture(self) -> bytes | None:
        """Return the newest picture with the corners that were found in it, as JPEG."""
        if self.newest is None:
            return None
        gray, view = self.newest
        drawn = cv2.cvtColor(gray, cv2.COLOR_GRAY2BGR)
        if view is not None:
            for x, y in view.points_px:
                cv2.circle(drawn, (round(float(x)), round(float(y))), 4, (40, 160, 255), -1, cv2.LINE_AA)
        return cv2.imencode(".jpg", drawn, (cv2.IMWRITE_JPEG_QUALITY, 80))[1].tobytes()


def _least(counts: Matrix) -> Matrix:
    """Return the counts, with the border preferred: a corner of the picture tells more than its neighbour."""
    border = np.ones_like(counts)
    border[1:-1, 1:-1] = 0.0
    return np.where(counts >= 3, 1e9, counts - 0.5 * border)


def _side(row: int, column: int) -> str:
    down = "top" if row < GRID[1] // 3 else "bottom" if row >= GRID[1] - GRID[1] // 3 else ""
    across = "left" if column < GRID[0] // 3 else "right" if column >= GRID[0] - GRID[0] // 3 else ""
    return " ".join(filter(None, (down, across))) or "middle"


def calibrate_camera(
    feed: Feed, collection: Collection, progress: Progress, stop: Callable[[], bool] = lambda: False
) -> Result:
    """Return what a camera's pictures of the board tell of its lens.

    Raises:
        InputError: Too little was seen, or the result is poor; with the remedy.
    """
    for measurement in feed.measurements(progress):
        if isinstance(measurement, Frame):
            collection.step(measurement)
        if stop() or (feed.is_live and collection.is_enough()):
            break
    if not collection.pictures:
        raise InputError("There are no pictures in this: name a camera, a video, photographs, or a log with a camera.")
    if not collection.views:
        raise InputError(
            f"The board is in none of the {collection.pictures} pictures: is it the one that `agora calibrate board` printed, "
            "and large enough in the picture? `--squares` names another size."
        )
    fit = fit_lens(collection.views, collection.board, lambda what: progress(what, 1.0))
    return result_of(fit, feed.device("camera"))


def result_of(fit: LensFit, device: tuple[str, str]) -> Result:
    """Return a fit as sheet, words and figures."""
    camera = fit.camera
    sheet = CameraSheet.of(
        camera,
        date=today(),
        device=device[0],
        serial=device[1],
        method="board",
        rms_px=round(fit.rms_px, 4),
        focal_sigma_px=round(fit.focal_sigma_px, 4),
        views=len(fit.views),
        coverage=round(fit.coverage, 3),
    )
    across = float(np.degrees(2.0 * np.arctan(0.5 * camera.width_px / camera.fx_px)))
    seen_again = "in views that were not used" if fit.is_checked else "in the views that were used"
    slanted = int(np.count_nonzero(fit.slants_rad > LEAST_SLANT_RAD))
    found = (
        f"Focal length {camera.fx_px:.1f} x {camera.fy_px:.1f} px, ±{fit.focal_sigma_px:.1f}: "
        f"about {across:.0f} degrees across {camera.width_px} px.",
        f"Centre {camera.cx_px:.1f}, {camera.cy_px:.1f}; {camera.distortion_model.replace('_', ' ')} distortion "
        f"{', '.join(f'{value:.4g}' for value in camera.distortion)}.",
        f"A corner seen again is off by {fit.rms_px:.2f} px ({seen_again}): {fit.verdict}.",
        f"{len(fit.views)} views, {slanted} of them slanted, cover {fit.coverage:.0%} of the picture "
        f"(at least {LEAST_COVERAGE:.0%} is asked for).",
    )
    numbers = {
        "fx_px": camera.fx_px,
        "fy_px": camera.fy_px,
        "cx_px": camera.cx_px,
        "cy_px": camera.cy_px,
        "distortion_model": camera.distortion_model,
        "distortion": list(camera.distortion),
        "rms_px": fit.rms_px,
        "focal_sigma_px": fit.focal_sigma_px,
        "views": len(fit.views),
        "coverage": fit.coverage,
        "verdict": fit.verdict,
    }

    def pictures() -> Sequence[Any]:
        return lens_pictures(fit)

    return Result("camera", {"camera": sheet}, found, (), numbers, pictures)
