"""Corners followed from picture to picture, as pairs of points for `turns`."""

from dataclasses import dataclass, field

import numpy as np

from tracker.calibrate.turns import PointPair
from tracker.errors import MalformedInput
from tracker.features import NO_FEATURES, FeatureSource, View
from tracker.klt import Klt
from tracker.measurements import Frame

CORNERS = 150
#: Fewer corners than this tell of a wall, of the dark, or of too fast a turn.
LEAST_CORNERS = 20
#: Pictures further apart are not followed.
LONGEST_S = 0.8


@dataclass
class Flow:
    """Follows corners; give it pictures in order."""

    source: FeatureSource = field(default_factory=Klt)
    pictures: int = 0
    """How many were seen."""
    size_px: tuple[int, int] | None = None
    """Width and height of the newest."""
    _before: View | None = None

    def step(self, frame: Frame) -> PointPair | None:
        """Return the pair of this picture and the one before; None where too little is seen again."""
        try:
            view = self.source.look(frame)
        except MalformedInput:
            return None
        before, self._before = self._before, view
        self.pictures += 1
        self.size_px = view.size_px
        if before is None or before.size_px != view.size_px or not 0 < view.t_ns - before.t_ns <= LONGEST_S * 1e9:
            return None
        # close together: the strongest corners are what stands far off, and the ground at the feet has weaker ones
        apart_px = max(5, round((view.width_px * view.height_px) ** 0.5 / 70.0))
        corners = self.source.detect(before, NO_FEATURES, CORNERS, apart_px)
        found, kept = self.source.follow(before, view, corners)
        if len(found) < LEAST_CORNERS:
            return None
        first, second = corners.points_px[kept].astype(np.float64), found.points_px.astype(np.float64)
        return PointPair(before.t_ns, view.t_ns, first, second)
