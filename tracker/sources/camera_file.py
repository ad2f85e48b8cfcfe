"""A video file that stands in for a camera: its pictures come in real time, by the times that are written beside them."""

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from threading import Event
from time import monotonic_ns
from types import MappingProxyType
from typing import cast

import cv2

from tracker.errors import InputError, SourceLost
from tracker.measurements import Frame
from tracker.sources.camera_mode import CameraSettings, Capture, codec_of
from tracker.sources.motion_jpeg import camera_picture
from tracker.sources.source import Put, SourceStatus

#: Of a file that does not say.
_USUAL_RATE_HZ = 30.0
#: A picture that should have been shown this long ago is passed over; a camera would not have kept it either.
_LATEST_NS = 200_000_000
#: A real camera's pictures arrive this much after they were taken; without it the tracker would see an easier world.
ARRIVAL_NS = 30_000_000


def open_file(path: Path) -> Capture:
    """Open a video file. OpenCV would take some names for numbered pictures or addresses: none here is either."""
    return cast(Capture, cv2.VideoCapture(str(path.resolve()), cv2.CAP_FFMPEG))


class VideoFile:
    """A `Source` that plays a file."""

    name = "camera"

    def __init__(
        self,
        path: Path,
        settings: CameraSettings,
        *,
        open_capture: Callable[[Path], Capture] = open_file,
        clock_ns: Callable[[], int] = monotonic_ns,
        wait: Callable[[Event, float], bool] = Event.wait,
    ) -> None:
        """Prepare; the file is opened by `run`.

        Args:
            path: Any video that FFmpeg reads.
            settings: Of these only `loop` concerns a file.
            open_capture: Opens it.
            clock_ns: The local clock.
            wait: Waits for the event at most so many seconds, and tells whether it is set.
        """
        self._path, self._loop = path, settings.loop
        self._open, self._clock_ns, self._wait = open_capture, clock_ns, wait
        self._frame_id = 0
        self._counts: Counter[str] = Counter()
        self._status = SourceStatus(attached=False, detail=f"{path.name}: not opened yet.")

    def status(self) -> SourceStatus:
        """Return how it is now."""
        return self._status

    def run(self, put: Put, stop: Event) -> None:
        """Play until told to stop.

        Raises:
            SourceLost: The file has ended and does not loop.
            InputError: It is no video that can be read.
        """
        try:
            while not stop.is_set():
                if not self._play(put, stop):
                    raise InputError(f"{self._path} is no video that can be read: give another file.")
                if not self._loop and not stop.is_set():
                    raise SourceLost(f"{self._path.name} has ended.")
            self._say(attached=False, detail=f"{self._path.name}: stopped.")
        except (SourceLost, InputError) as error:
            self._say(attached=False, detail=str(error))
            raise

    def _play(self, put: Put, stop: Event) -> bool:
        """Play once; return whether there was a picture."""
        capture = self._open(self._path)
        try:
            rate_hz = capture.get(cv2.CAP_PROP_FPS)
            period_ns = round(1e9 / (rate_hz if 0.1 <= rate_hz <= 1000.0 else _USUAL_RATE_HZ))
            facts = {
                "device": self._path.name,
                "codec": codec_of(capture),
                "width_px": int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)),
                "height_px": int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT)),
                "rate_hz": rate_hz,
                "stamps": "file",
            }
            t_begin_ns, place_ns = self._clock_ns(), -period_ns
            while not stop.is_set() and capture.grab():
                stamp_ns = round(capture.get(cv2.CAP_PROP_POS_MSEC) * 1e6)
                # times that stand still or jump are not believed; the rate is, then
                place_ns = stamp_ns if 0 < stamp_ns - place_ns <= 10 * period_ns else place_ns + period_ns
                if self._wait_until(t_begin_ns + place_ns + ARRIVAL_NS, stop):
                    return True
                self._hand_over(capture, t_begin_ns + place_ns, put)
                self._say(attached=True, detail=f"{self._path.name}, a file", facts=facts)
            self._wait_until(t_begin_ns + place_ns + period_ns, stop)
            return place_ns >= 0
        finally:
            capture.release()

    def _wait_until(self, t_ns: int, stop: Event) -> bool:
        """Wait; return whether to stop."""
        left_ns = t_ns - self._clock_ns()
        return self._wait(stop, left_ns * 1e-9) if left_ns > 0 else stop.is_set()

    def _hand_over(self, capture: Capture, t_ns: int, put: Put) -> None:
        self._counts["pictures"] += 1
        t_recv_ns = self._clock_ns()
        if t_recv_ns - t_ns > _LATEST_NS:
            self._counts["late"] += 1
        elif (picture := camera_picture(capture.retrieve()[1])) is None:
            self._counts["broken"] += 1
        else:
            put(Frame(t_ns, max(t_ns, t_recv_ns), self._frame_id, picture))
            self._frame_id += 1

    def _say(self, *, attached: bool, detail: str, facts: dict[str, object] | None = None) -> None:
        counts = MappingProxyType(dict(self._counts))
        self._status = SourceStatus(attached, detail, counts, MappingProxyType(facts or {}))
