"""The calibration board: chessboard squares with a marker in each white one, so that every corner has a name (ChArUco).

Any part of it is enough, which is how corners get to the edges of a picture. Reading pictures is all that happens here.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.errors import InputError
from tracker.measurements import Image, Matrix

#: A marker has four cells by four and a border of one cell; it fills this share of its square.
MARKER_SHARE = 0.75
#: Cells that a square is drawn of: a marker's six are then whole ones.
CELLS = 8
DICTIONARIES = {
    "4x4_50": cv2.aruco.DICT_4X4_50,
    "4x4_100": cv2.aruco.DICT_4X4_100,
    "4x4_250": cv2.aruco.DICT_4X4_250,
}
LEAST_CORNERS = 8


@dataclass(frozen=True)
class Board:
    """A board of squares."""

    columns: int = 9
    rows: int = 6
    square_m: float = 0.028
    """Measured on the print: it sets no focal length, only distances."""
    dictionary: str = "4x4_50"

    def __post_init__(self) -> None:
        """Check; InputError where there can be no such board."""
        if self.dictionary not in DICTIONARIES:
            raise InputError(f"There is no dictionary {self.dictionary}: choose one of {', '.join(DICTIONARIES)}.")
        most = int(self.dictionary.rpartition("_")[2])
        if (
            min(self.columns, self.rows) < 3
            or self.columns * self.rows // 2 > most
            or not 0.002 <= self.square_m <= 1.0
        ):
            raise InputError(
                f"A board of {self.columns} by {self.rows} squares of {self.square_m * 1e3:g} mm is none: "
                f"3 squares and more each way, at most {2 * most} in all, 2 mm to 1 m wide."
            )

    @cached_property
    def _drawn(self) -> Any:
        dictionary = cv2.aruco.getPredefinedDictionary(DICTIONARIES[self.dictionary])
        return cv2.aruco.CharucoBoard(
            (self.columns, self.rows), self.square_m, MARKER_SHARE * self.square_m, dictionary
        )

    @cached_property
    def _detector(self) -> Any:
        parameters = cv2.aruco.CharucoParameters()
        parameters.tryRefineMarkers = True
        markers = cv2.aruco.DetectorParameters()
        # the corners are then refined on the squares themselves, which blur and compression spoil less than markers
        markers.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_NONE
        return cv2.aruco.CharucoDetector(self._drawn, parameters, markers)

    @cached_property
    def corners_m(self) -> Matrix:
        """(N, 3) inner corners by their number, on the board's plane z = 0."""
        return np.asarray(self._drawn.getChessboardCorners(), np.float64)

    def cells(self) -> NDArray[np.bool_]:
        """Return the board as (8 rows, 8 columns) cells, true where white."""
        drawn = self._drawn.generateImage((self.columns * CELLS, self.rows * CELLS), marginSize=0, borderBits=1)
        return np.asarray(drawn > 127)

    def find(self, gray: Image, t_ns: int) -> "BoardView | None":
        """Return the corners that a picture shows; None where they are fewer than eight."""
        try:
            corners, ids, _, _ = self._detector.detectBoard(gray)
        except cv2.error:
            return None  # markers in a degenerate place
        if ids is None or len(ids) < LEAST_CORNERS:
            return None
        points = np.asarray(corners, np.float64).reshape(-1, 2)
        numbers = np.asarray(ids).ravel()
        flat = self.corners_m[numbers]
        if np.linalg.matrix_rank(flat[:, :2] - flat[0, :2], tol=0.5 * self.square_m) < 2:
            return None  # corners on one line tell nothing of a plane
        height, width = gray.shape
        return BoardView(t_ns, (width, height), numbers, points)


@dataclass(frozen=True, eq=False)
class BoardView:
    """Corners of the board in one picture."""

    t_ns: int
    size_px: tuple[int, int]
    """Width and height."""
    numbers: NDArray[np.int_]
    """(N,) which corners."""
    points_px: Matrix
    """(N, 2) where they are."""

    def chosen(self, chosen: NDArray[np.bool_]) -> "BoardView":
        """Return the view with some of its corners."""
        return BoardView(self.t_ns, self.size_px, self.numbers[chosen], self.points_px[chosen])
