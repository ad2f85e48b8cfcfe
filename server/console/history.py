"""What the charts of one walk show, by time. Pure."""

from collections import deque
from typing import Final

import numpy as np

from server.messages import Figures
from server.wire import FrameMeta
from tracker.measurements import Matrix

#: Twenty minutes at ten pictures a second.
_KEPT: Final = 12_000
#: A chart of more points is no finer on any screen.
_DRAWN: Final = 600


class History:
    """Innovations, doubt and refusals of one walk."""

    def __init__(self) -> None:
        self.rejected: dict[str, int] = {}
        """Measurements that were not used, by reason."""
        self._updates: deque[tuple[float, float, float]] = deque(maxlen=_KEPT)
        self._doubts: deque[tuple[float, float, float]] = deque(maxlen=_KEPT)

    def take_figures(self, figures: Figures) -> None:
        """Take what the tracker says of itself."""
        if figures.anew:
            self._updates.clear()
        for update in figures.updates:
            while self._updates and self._updates[-1][0] >= update.t_s:
                self._updates.pop()
            self._updates.append((update.t_s, update.position_m, float(np.degrees(update.rotation_rad))))
        self.rejected = dict(figures.rejected)

    def take_frame(self, frame: FrameMeta) -> None:
        """Take how sure a pose is; a walk that goes back in time begins anew."""
        if not frame.pose_valid:
            return
        if frame.did_seek or (self._doubts and self._doubts[-1][0] >= frame.position_s):
            self._doubts.clear()
        sigma_m = float(np.sqrt(max(0.0, np.trace(frame.cov[:2, :2]))))
        sigma_deg = float(np.degrees(np.sqrt(max(0.0, frame.cov[5, 5]))))
        self._doubts.append((frame.position_s, sigma_m, sigma_deg))

    def innovations(self) -> Matrix:
        """Return (3, n): time in seconds, innovation of the position in metres, of the rotation in degrees."""
        return _columns(self._updates)

    def doubts(self) -> Matrix:
        """Return (3, n): time in seconds, standard deviation of the horizontal position in metres, of the heading in degrees."""
        return _columns(self._doubts)


def _columns(rows: "deque[tuple[float, float, float]]") -> Matrix:
    """Return (3, n) with n of at most `_DRAWN`: of many rows every so-manieth, and the last one always."""
    if not rows:
        return np.zeros((3, 0))
    step = -(-len(rows) // _DRAWN)
    return np.array(list(rows)[::-1][::step][::-1]).T
