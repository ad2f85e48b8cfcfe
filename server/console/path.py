"""The path of a walk as coloured segments. Pure."""

from typing import Final

import numpy as np

from tracker.measurements import Matrix

#: The page's colours (web/src/words.ts): lightness by position's coefficient, hue by rotation's.
MOTION_COLOURS: Final = {
    "P0R0": (0x9C, 0x8F, 0x7C),
    "P0R1": (0x8F, 0xA3, 0x7E),
    "P0R2": (0xA8, 0x8F, 0x9E),
    "P1R0": (0xC9, 0xA3, 0x6A),
    "P1R1": (0xDB, 0xA2, 0x4F),
    "P1R2": (0xD9, 0x8A, 0x6A),
    "P2R0": (0xF0, 0xC9, 0x87),
    "P2R1": (0xF2, 0xB2, 0x5C),
    "P2R2": (0xEE, 0x7F, 0x55),
}
NO_MODEL_COLOUR: Final = (0x7D, 0x75, 0x6A)
#: Points of the path closer than this tell nothing new.
_STEP_M: Final = 0.1
#: A jump longer than this is a seek or a restart, not a walk.
_JUMP_M: Final = 20.0
#: A piece of the path is sent whole each time it grows, so it stays short.
_PIECE: Final = 100
PIECES: Final = 200
"""So many are drawn."""


def colour_of(motion_model: str) -> tuple[int, int, int]:
    """Return a motion model's colour, sRGB."""
    return MOTION_COLOURS.get(motion_model, NO_MODEL_COLOUR)


class ColouredPath:
    """The path as pieces of coloured segments."""

    def __init__(self) -> None:
        self.pieces: list[list[tuple[Matrix, tuple[int, int, int]]]] = [[]]
        """Each segment is (2, 3) site metres and its colour; pieces that are no longer drawn are empty."""
        self._last: Matrix | None = None

    def add(self, p_site_m: Matrix, motion_model: str) -> bool:
        """Go on to a point, (3,); return whether there is a new segment."""
        last = self._last
        step_m = 0.0 if last is None else float(np.linalg.norm(p_site_m - last))
        if last is not None and step_m < _STEP_M:
            return False
        self._last = np.array(p_site_m)
        if last is None or step_m > _JUMP_M:
            return False
        if len(self.pieces[-1]) >= _PIECE:
            self.pieces.append([])
            if len(self.pieces) > PIECES:
                self.pieces[-PIECES - 1] = []  # no longer drawn; a day's walk has half a million segments
        self.pieces[-1].append((np.stack([last, self._last]), colour_of(motion_model)))
        return True

    def lift(self) -> None:
        """Begin elsewhere: what comes next is not joined to what was before."""
        self._last = None
