"""Features of a picture, and who finds them: what the front end needs to know of pictures, and nothing of their pixels."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tracker.measurements import Frame, Matrix

Pixels = NDArray[np.float32]
#: Share of the strongest corner's response that a corner must have.
QUALITY = 0.005


@dataclass(frozen=True, eq=False)
class View:
    """A picture as its source sees it."""

    t_ns: int
    frame_id: int
    width_px: int
    height_px: int
    content: NDArray[Any]
    """Of meaning to the source alone: grey levels, or a pose."""

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height."""
        return self.width_px, self.height_px


@dataclass(frozen=True, eq=False)
class Features:
    """Features in one picture. Arrays are replaced, never changed."""

    points_px: Pixels
    """(N, 2) where they are."""
    marks: Matrix
    """(N, k) what the source keeps of each; k is the source's own."""

    def __len__(self) -> int:
        return len(self.points_px)

    def chosen(self, chosen: NDArray[np.bool_]) -> "Features":
        """Return those where (N,) is true."""
        return Features(self.points_px[chosen], self.marks[chosen])

    def joined(self, other: "Features") -> "Features":
        """Return these and after them the others."""
        if len(self) == 0:
            return other
        return Features(np.concatenate([self.points_px, other.points_px]), np.concatenate([self.marks, other.marks]))


#: Before the first picture.
NO_FEATURES = Features(np.zeros((0, 2), np.float32), np.zeros((0, 0)))


class FeatureSource(Protocol):
    """Finds features in pictures and follows them. Holds no state of a run: what it knows lies in views and features."""

    def look(self, frame: Frame) -> View:
        """Return a picture's view.

        Raises:
            MalformedInput: The picture does not decode.
        """
        ...

    def follow(self, before: View, after: View, features: Features) -> tuple[Features, NDArray[np.bool_]]:
        """Return the features of one view that are found in the next, there, and (N,) which of the given ones those are."""
        ...

    def detect(self, view: View, kept: Features, wanted: int, apart_px: int) -> Features:
        """Return at most `wanted` new features, all at least `apart_px` from each other and from those that are kept."""
        ...
