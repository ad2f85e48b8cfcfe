"""Empty pictures for a walk without a camera."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import cast

import pytest

from tracker.blank import CAMERA, RATE_HZ, BlankCamera
from tracker.log import Log
from tracker.measurements import Frame, ImuSample, Measurement

START_NS, MS = 5_000_000_000, 1_000_000


class Walk:
    """Two seconds of IMU in place of a log."""

    info = SimpleNamespace(t_start_ns=START_NS, t_end_ns=START_NS + 285 * 7 * MS)

    def messages(self, *, start_ns: int | None = None) -> Iterator[Measurement]:
        """Yield a sample every 7 ms."""
        for index in range(286):
            t = START_NS + index * 7 * MS
            if t >= (start_ns or 0):
                yield ImuSample(t, t, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81))


@pytest.mark.parametrize("start_ms", [0, 300, 333])
def test_ten_a_second_in_order_and_numbered_by_their_time(start_ms: int) -> None:
    """From the middle as from the start: a seek must show the same numbers."""
    camera = BlankCamera(cast(Log, Walk()))
    start_ns = START_NS + start_ms * MS
    found = list(camera.messages(start_ns=start_ns))
    arrivals = [m.t_recv_ns for m in found]
    assert arrivals == sorted(arrivals)
    frames = [m for m in found if isinstance(m, Frame)]
    first = -(-start_ms // 100)
    assert [f.frame_id for f in frames] == list(range(first, 20))
    assert all(f.t_ns == START_NS + f.frame_id * round(1e9 / RATE_HZ) for f in frames)
    assert frames[0].picture.gray().shape == (CAMERA.height_px, CAMERA.width_px)
    assert sum(isinstance(m, ImuSample) for m in found) == len(list(Walk().messages(start_ns=start_ns)))


@pytest.mark.parametrize("at_ms", [0, 300, 333, 1999])
def test_alone_they_begin_with_the_newest(at_ms: int) -> None:
    camera = BlankCamera(cast(Log, Walk()))
    whole = [m for m in camera.messages() if isinstance(m, Frame)]
    assert list(camera.pictures(START_NS + at_ms * MS)) == whole[at_ms // 100 :]
