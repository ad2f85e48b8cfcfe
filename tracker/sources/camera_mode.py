"""How a camera is asked to run, and how it answered; nothing here opens one."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

#: V4L2's menu of `exposure_auto`: by hand, and by aperture priority, which is what webcams call automatic.
_MANUAL, _AUTOMATIC = 1.0, 3.0
#: V4L2 counts exposure in units of 100 microseconds.
_EXPOSURES_PER_S = 1e4


class Capture(Protocol):
    """The part of `cv2.VideoCapture` that is used."""

    def isOpened(self) -> bool: ...
    def grab(self) -> bool: ...
    def retrieve(self) -> tuple[bool, NDArray[np.uint8] | None]: ...
    def get(self, prop: int, /) -> float: ...
    def set(self, prop: int, value: float, /) -> bool: ...
    def getBackendName(self) -> str: ...
    def release(self) -> None: ...


@dataclass(frozen=True)
class CameraSettings:
    """What a camera is asked for. It may do otherwise: what it does is read back and told in the source's status."""

    width_px: int = 1280
    height_px: int = 720
    rate_hz: float = 30.0
    codec: str = "MJPG"
    """MJPG lets USB 2 carry large pictures at full rate; what a camera lacks, it replaces by what it has."""
    exposure_s: float | None = None
    """Fixed; None lets the camera choose. Short exposures blur less: 0.008 and below while the head turns."""
    latency_s: float = 0.04
    """From the middle of the exposure to the reading, where no driver tells: a frame's read-out and its way over USB, at 30 Hz."""
    silent_s: float = 3.0
    """A camera that has shown nothing for this long is lost."""
    loop: bool = True
    """A video file begins again at its end."""

    def __post_init__(self) -> None:
        """Check."""
        if not (0 < self.width_px <= 16_384 and 0 < self.height_px <= 16_384 and 0.0 < self.rate_hz <= 1000.0):
            raise ValueError(f"no camera has {self.width_px}x{self.height_px} at {self.rate_hz} Hz")
        if len(self.codec) != 4:
            raise ValueError(f"expected a codec of four letters, got {self.codec!r}")


def ask(capture: Capture, settings: CameraSettings) -> None:
    """Ask a device for what is wanted: codec before size before rate, since each limits the next."""
    capture.set(cv2.CAP_PROP_BUFFERSIZE, 1.0)
    capture.set(cv2.CAP_PROP_FOURCC, float(cv2.VideoWriter.fourcc(*settings.codec)))
    capture.set(cv2.CAP_PROP_FRAME_WIDTH, float(settings.width_px))
    capture.set(cv2.CAP_PROP_FRAME_HEIGHT, float(settings.height_px))
    capture.set(cv2.CAP_PROP_FPS, settings.rate_hz)
    if settings.exposure_s is None:
        capture.set(cv2.CAP_PROP_AUTO_EXPOSURE, _AUTOMATIC)
    else:
        capture.set(cv2.CAP_PROP_AUTO_EXPOSURE, _MANUAL)
        capture.set(cv2.CAP_PROP_EXPOSURE, settings.exposure_s * _EXPOSURES_PER_S)
    if codec_of(capture) == "MJPG":
        capture.set(
            cv2.CAP_PROP_CONVERT_RGB, 0.0
        )  # the camera's own JPEG bytes, unspoilt, and no time spent on decoding


def codec_of(capture: Capture) -> str:
    """Return the four letters of the codec in use, or nothing."""
    number = capture.get(cv2.CAP_PROP_FOURCC)
    letters = int(number).to_bytes(4, "little", signed=False) if 0.0 < number < 2.0**32 else b""
    return letters.decode("latin-1") if letters.isalnum() else ""


def mode_of(capture: Capture) -> Mapping[str, Any]:
    """Return what a camera does, as it says itself, as JSON values."""
    exposure = capture.get(cv2.CAP_PROP_EXPOSURE)
    is_manual = capture.get(cv2.CAP_PROP_AUTO_EXPOSURE) == _MANUAL
    return MappingProxyType(
        {
            "backend": capture.getBackendName(),
            "codec": codec_of(capture),
            "width_px": int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)),
            "height_px": int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT)),
            "rate_hz": capture.get(cv2.CAP_PROP_FPS),
            "exposure_s": exposure / _EXPOSURES_PER_S if is_manual and exposure > 0.0 else None,
        }
    )
