"""Empty pictures for a walk without a camera: the square is then drawn over them, and the walk can still be watched."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from tracker.log import Log
from tracker.measurements import Frame, Measurement, Picture
from tracker.pictures import EncodedPicture, encode_jpeg
from tracker.rig import CameraModel

RATE_HZ = 10.0
CAMERA = CameraModel(640, 480, 554.0, 554.0, 319.5, 239.5)
"""60 degrees wide."""
_GREY = 92


@cache
def blank_picture() -> Picture:
    """Return the empty picture."""
    return EncodedPicture(encode_jpeg(np.full((CAMERA.height_px, CAMERA.width_px, 3), _GREY, np.uint8)))


@dataclass(frozen=True)
class BlankCamera:
    """A log with an empty picture ten times a second added."""

    log: Log

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return the measurements that arrived at or after start_ns, in order of arrival."""
        return self._with_pictures(self.log.messages(start_ns=start_ns), start_ns or 0)

    def pictures(self, at_ns: int) -> Iterator[Frame]:
        """Yield the empty pictures alone, from the one on that was the newest at at_ns."""
        info, period_ns = self.log.info, round(1e9 / RATE_HZ)
        frame_id, picture = max(0, (at_ns - info.t_start_ns) // period_ns), blank_picture()
        while (t_ns := info.t_start_ns + frame_id * period_ns) <= info.t_end_ns:
            yield Frame(t_ns, t_ns, frame_id, picture)
            frame_id += 1

    def _with_pictures(self, measurements: Iterable[Measurement], start_ns: int) -> Iterator[Measurement]:
        picture = blank_picture()
        begin_ns, period_ns = self.log.info.t_start_ns, round(1e9 / RATE_HZ)
        frame_id = max(0, -((begin_ns - start_ns) // period_ns))
        for measurement in measurements:
            while begin_ns + frame_id * period_ns <= measurement.t_recv_ns:
                t_ns = begin_ns + frame_id * period_ns
                yield Frame(t_ns, t_ns, frame_id, picture)
                frame_id += 1
            yield measurement
