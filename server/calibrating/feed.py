"""Where a calibration's measurements come from: a recording, a video, a folder of photographs, or live sensors."""

from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, Queue
from time import monotonic
from typing import Protocol

import cv2

from server.errors import SensorMissing
from tracker.errors import InputError
from tracker.log import Log
from tracker.measurements import Frame, GpsFix, Measurement
from tracker.pictures import EncodedPicture
from tracker.rig import Rig
from tracker.running.supervisor import SourceThread
from tracker.sources.camera_file import open_file
from tracker.sources.motion_jpeg import camera_picture
from tracker.sources.source import Source

PHOTOGRAPHS = (".jpg", ".jpeg", ".png")
#: A live sensor that says nothing for so long at the start is missing, whatever its driver hopes for.
_PATIENCE_S = 15.0

Progress = Callable[[str, float], None]
"""Told what is going on, and the share that is done."""


class Feed(Protocol):
    """A run of measurements, to be read once."""

    @property
    def rig(self) -> Rig:
        """The rig whose body axes the measurements are in."""
        ...

    @property
    def name(self) -> str:
        """What it is called where there are several."""
        ...

    @property
    def is_live(self) -> bool:
        """Whether somebody stands beside the rig and waits."""
        ...

    def measurements(self, progress: Progress) -> Iterator[Measurement]:
        """Yield them in order of arrival."""
        ...

    def device(self, sensor: str) -> tuple[str, str]:
        """Return name and serial number of what the sensor's measurements came from."""
        ...

    def first_fix(self) -> GpsFix | None:
        """Return where and, where the clock is of the time of day, when this was; as far as it has been read."""
        ...


@dataclass(frozen=True)
class RecordedFeed:
    """A log."""

    log: Log
    camera: bool

    is_live = False

    @property
    def rig(self) -> Rig:
        """The log's own."""
        return self.log.rig

    @property
    def name(self) -> str:
        """The file's."""
        return self.log.path.name

    def measurements(self, progress: Progress) -> Iterator[Measurement]:
        """Yield what the log holds, but for the truth."""
        begin_ns, duration_ns = self.log.info.t_start_ns, max(1.0, self.log.info.duration_s * 1e9)
        for measurement in self.log.messages(camera=self.camera, truth=False):
            progress("reading", (measurement.t_recv_ns - begin_ns) / duration_ns)
            yield measurement

    def device(self, sensor: str) -> tuple[str, str]:
        """Return the log's name: it does not say which devices it was recorded with."""
        return f"recorded in {self.name}", ""

    def first_fix(self) -> GpsFix | None:
        """Return the log's first."""
        return self.log.info.first_fix


@dataclass(frozen=True)
class PictureFeed:
    """A video file, or a folder of photographs."""

    path: Path

    is_live = False
    rig = Rig()

    @property
    def name(self) -> str:
        """The file's."""
        return self.path.name

    def measurements(self, progress: Progress) -> Iterator[Measurement]:
        """Yield the pictures: a video's by its times, photographs a second apart.

        Raises:
            InputError: There is none, or it is no video.
        """
        return self._photographs(progress) if self.path.is_dir() else self._video(progress)

    def _photographs(self, progress: Progress) -> Iterator[Measurement]:
        files = sorted(file for file in self.path.iterdir() if file.suffix.lower() in PHOTOGRAPHS)
        if not files:
            raise InputError(f"{self.path} holds no photographs ({', '.join(PHOTOGRAPHS)}).")
        for i, file in enumerate(files):
            progress("reading", i / len(files))
            yield Frame(i * 1_000_000_000, i * 1_000_000_000, i, EncodedPicture(file.read_bytes()))

    def _video(self, progress: Progress) -> Iterator[Measurement]:
        capture = open_file(self.path)
        try:
            count, i = max(1.0, capture.get(cv2.CAP_PROP_FRAME_COUNT)), 0
            while capture.grab():
                t_ns = round(capture.get(cv2.CAP_PROP_POS_MSEC) * 1e6)
                picture = camera_picture(capture.retrieve()[1])
                if picture is not None:
                    progress("reading", i / count)
                    yield Frame(t_ns, t_ns, i, picture)
                i += 1
        finally:
            capture.release()
        if not i:
            raise InputError(
                f"{self.path} is no video that can be read: give a video, a folder of photographs or a log."
            )

    def device(self, sensor: str) -> tuple[str, str]:
        """Return the file's name."""
        return f"seen in {self.name}", ""

    def first_fix(self) -> GpsFix | None:
        """Return None."""
        return None


@dataclass
class LiveFeed:
    """Sensors that are here now, read for so long, or until the reader has had enough."""

    sources: Sequence[Source]
    rig: Rig
    seconds: float
    _devices: dict[str, tuple[str, str]] = field(default_factory=dict)
    _fix: GpsFix | None = None

    is_live = True
    name = "live"

    def measurements(self, progress: Progress) -> Generator[Measurement, None, None]:
        """Yield what they say, from when all of them have begun.

        Raises:
            SensorMissing: One of them is not there, or says nothing.
        """
        queue: Queue[tuple[str, Measurement | str]] = Queue()
        threads = [
            SourceThread(
                source,
                lambda name, measurement: queue.put((name, measurement)),
                lambda name, what, why: queue.put((name, why if what != "opened" else "")),
            )
            for source in self.sources
        ]
        for thread in threads:
            thread.start()
        try:
            yield from self._read(queue, progress)
        finally:
            self._note_devices()  # while they are attached, and also where the reader has had enough
            for thread in threads:
                thread.stop()
            for thread in threads:
                thread.join(5.0)

    def _read(self, queue: "Queue[tuple[str, Measurement | str]]", progress: Progress) -> Iterator[Measurement]:
        silent, begin_s = {source.name for source in self.sources}, monotonic()
        while True:
            try:
                name, item = queue.get(timeout=0.2)
            except Empty:
                name, item = "", ""
            now_s = monotonic()
            if silent and (now_s - begin_s > _PATIENCE_S or (item and isinstance(item, str))):
                why = (
                    item
                    if isinstance(item, str) and item
                    else f"The {min(silent)} says nothing: see its cable and its status."
                )
                raise SensorMissing(why)
            if isinstance(item, str):
                if item:
                    raise SensorMissing(item)
                continue
            if name in silent:
                silent.discard(name)
                begin_s = now_s
            if silent:
                continue
            if isinstance(item, GpsFix) and item.valid and self._fix is None:
                self._fix = item
            progress("listening", min(1.0, (now_s - begin_s) / self.seconds))
            yield item
            if now_s - begin_s >= self.seconds:
                return

    def _note_devices(self) -> None:
        for source in self.sources:
            status = source.status()
            name = str(status.facts.get("device", "")) or status.detail
            self._devices[source.name] = (name, str(status.facts.get("serial", "")))

    def device(self, sensor: str) -> tuple[str, str]:
        """Return what the source says of its device."""
        return self._devices.get(sensor, ("", ""))

    def first_fix(self) -> GpsFix | None:
        """Return the first fix that was heard."""
        return self._fix


def recorded_feed(path: Path, *, camera: bool) -> Feed:
    """Return the feed of a file: a log, or for pictures also a video or a folder of photographs.

    Raises:
        InputError: There is no such file, or it is none of these.
    """
    if not path.exists():
        raise InputError(f"There is no {path}.")
    if camera and (path.is_dir() or path.suffix.lower() != ".mcap"):
        return PictureFeed(path)
    return RecordedFeed(Log.open(path), camera)
