"""A live camera: a V4L2 device or a network stream, read by OpenCV; pictures are handed over as soon as they are here.

A thread reads it flat out, so that no buffer fills: what is handed over is always the newest, and pictures that lay in a buffer
too long are dropped and counted.
"""

import os
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from threading import Event
from time import monotonic_ns
from types import MappingProxyType
from typing import Any, cast
from urllib.parse import urlsplit

import cv2

from tracker.errors import InputError, SourceLost
from tracker.measurements import Frame
from tracker.sources.camera_devices import camera_device, camera_devices
from tracker.sources.camera_file import VideoFile
from tracker.sources.camera_mode import CameraSettings, Capture, ask, mode_of
from tracker.sources.motion_jpeg import camera_picture
from tracker.sources.picture_clock import PictureClock
from tracker.sources.source import Put, Source, SourceStatus

_SCHEMES = ("rtsp", "rtsps", "http", "https", "udp", "tcp", "rtp")
#: A picture this old was in a buffer; the pose of its time is history.
_LATEST_NS = 500_000_000
#: How long to wait where the camera has nothing and says so at once.
_RETRY_S = 0.02
_NOTHING: Mapping[str, Any] = MappingProxyType({})

OpenCapture = Callable[[str, CameraSettings], Capture]
"""Opens what a specification names; what it returns may be not open."""


def camera_source(spec: str, settings: CameraSettings | None = None) -> Source:
    """Return the camera that a word of the command line names.

    Args:
        spec: `0` or `/dev/video0` (a V4L2 device), `rtsp://…` or another address of a stream, or a video file's path, which
            then plays in real time.
        settings: What it is asked for.

    Raises:
        InputError: There is no such file, or the word names nothing that can be a camera.
    """
    settings = settings or CameraSettings()
    if _number(spec) is not None or urlsplit(spec).scheme in _SCHEMES:
        return LiveCamera(spec, settings)
    path = Path(spec).expanduser()
    if spec.startswith("/dev/"):  # a name that udev gives, such as /dev/v4l/by-id/…, which may come and go
        return LiveCamera(spec, settings)
    if not path.is_file():
        raise InputError(
            f"There is no camera {spec!r}: give a number, /dev/video0, rtsp://…, or a video file. {_those_here()}"
        )
    return VideoFile(path, settings)


def _those_here() -> str:
    devices = camera_devices()
    return f"Here: {', '.join(f'{d.path} ({d.name})' for d in devices)}." if devices else "No camera is attached here."


def _number(spec: str) -> int | None:
    """Return N of `N` or `/dev/videoN`."""
    digits = spec.removeprefix("/dev/video")
    return int(digits) if digits.isdecimal() and len(digits) <= 4 else None


class LiveCamera:
    """A `Source` of pictures from a camera."""

    name = "camera"

    def __init__(
        self,
        spec: str,
        settings: CameraSettings,
        *,
        open_capture: OpenCapture | None = None,
        clock_ns: Callable[[], int] = monotonic_ns,
    ) -> None:
        """Prepare; nothing is opened before `run`.

        Args:
            spec: A device's number or path, or a stream's address.
            settings: What it is asked for.
            open_capture: Opens it; OpenCV unless a test brings its own.
            clock_ns: The local clock.
        """
        self._spec, self._settings = spec, settings
        self._open, self._clock_ns = open_capture or open_with_opencv, clock_ns
        self._is_stream = urlsplit(spec).scheme in _SCHEMES
        self._frame_id = 0
        self._counts: Counter[str] = Counter()
        self._status = SourceStatus(attached=False, detail=f"{self._title()}: not opened yet.")

    def status(self) -> SourceStatus:
        """Return how it is now."""
        return self._status

    def run(self, put: Put, stop: Event) -> None:
        """Read pictures until told to stop.

        Raises:
            SourceLost: It cannot be opened, has gone, or has shown nothing for too long.
        """
        try:
            self._run(put, stop)
        except SourceLost as error:
            self._say(attached=False, detail=str(error))
            raise
        self._say(attached=False, detail=f"{self._title()}: stopped.")

    def _run(self, put: Put, stop: Event) -> None:
        capture = self._open(self._spec, self._settings)
        try:
            if not capture.isOpened():
                raise SourceLost(self._absent())
            if not self._is_stream:
                ask(capture, self._settings)
            self._read(capture, put, stop)
        finally:
            capture.release()

    def _read(self, capture: Capture, put: Put, stop: Event) -> None:
        facts = {**mode_of(capture), **self._identity()}
        clock = PictureClock(is_driver=not self._is_stream, latency_ns=round(self._settings.latency_s * 1e9))
        self._say(attached=True, detail=self._title(), facts=facts)
        t_seen_ns = self._clock_ns()
        while not stop.is_set():
            if not capture.grab():
                if self._clock_ns() - t_seen_ns >= self._settings.silent_s * 1e9:
                    raise SourceLost(self._silent())
                stop.wait(_RETRY_S)
                continue
            t_recv_ns = t_seen_ns = self._clock_ns()
            t_ns = clock.local_ns(capture.get(cv2.CAP_PROP_POS_MSEC), t_recv_ns)
            self._counts["pictures"] += 1
            if t_recv_ns - t_ns > _LATEST_NS:
                self._counts["late"] += 1
            elif (picture := camera_picture(capture.retrieve()[1])) is None:
                self._counts["broken"] += 1
            else:
                put(Frame(t_ns, t_recv_ns, self._frame_id, picture))
                self._frame_id += 1
            self._say(attached=True, detail=self._title(), facts={**facts, "stamps": clock.kind})

    def _say(self, *, attached: bool, detail: str, facts: Mapping[str, Any] = _NOTHING) -> None:
        self._status = SourceStatus(
            attached, detail, MappingProxyType(dict(self._counts)), MappingProxyType(dict(facts))
        )

    def _identity(self) -> dict[str, str]:
        number = _number(self._spec)
        device = None if number is None else camera_device(number)
        name, serial = (self._title(), "") if device is None else (device.name, device.serial)
        return {"device": name, "serial": serial}

    def _title(self) -> str:
        number = _number(self._spec)
        return without_password(self._spec) if number is None else f"/dev/video{number}"

    def _absent(self) -> str:
        if self._is_stream:
            return f"{self._title()} does not answer: check its address, its password and the network."
        number = _number(self._spec)
        path = Path(self._title())
        if not path.exists():
            return f"There is no {path}: plug the camera in. {_those_here()}"
        if not os.access(path, os.R_OK | os.W_OK):
            return f"{path} may not be used: run `sudo usermod -aG video $USER`, then log in anew."
        known = number is None or camera_device(number) is not None
        return (
            f"{path} cannot be opened: close the program that uses it."
            if known
            else f"{path} gives no pictures: choose another. {_those_here()}"
        )

    def _silent(self) -> str:
        if self._is_stream:
            return f"{self._title()} has sent no picture for {self._settings.silent_s:g} s: check the camera and the network."
        if not Path(self._title()).exists():
            return f"{self._title()} is gone: plug the camera in again."
        return f"{self._title()} has shown no picture for {self._settings.silent_s:g} s: plug it out and in again."


def without_password(address: str) -> str:
    """Return an address as it may be shown: a status is read by others than who typed the password."""
    parts = urlsplit(address)
    if parts.password is None and parts.username is None:
        return address
    return parts._replace(netloc=parts.netloc.rpartition("@")[2]).geturl()


def open_with_opencv(spec: str, settings: CameraSettings) -> Capture:
    """Open a device by V4L2, or a stream by FFmpeg, both with a limit on how long a read may take."""
    # what it would print on its own, about a camera that is not there, the source says better
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_ERROR)
    wait_ms = max(1, round(settings.silent_s * 1e3))
    if urlsplit(spec).scheme in _SCHEMES:
        limits = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, wait_ms, cv2.CAP_PROP_READ_TIMEOUT_MSEC, wait_ms]
        return cast(Capture, cv2.VideoCapture(spec, cv2.CAP_FFMPEG, limits))
    # read by OpenCV when it opens a device; its own limit is ten seconds, for which nothing could be stopped
    os.environ["OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT"] = str(max(1, round(settings.silent_s)))
    number = _number(spec)
    device: Any = spec if number is None else number
    return cast(Capture, cv2.VideoCapture(device, cv2.CAP_V4L2))
