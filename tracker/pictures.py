"""Pictures as logs and cameras hold them, decoded only when somebody looks."""

from dataclasses import dataclass
from functools import cached_property
from threading import Lock
from typing import Any

import cv2
import numpy as np

from tracker.errors import MalformedInput
from tracker.measurements import Image

#: Of pictures that were not JPEG to begin with.
JPEG_QUALITY = 85


@dataclass(frozen=True, eq=False)
class EncodedPicture:
    """JPEG or PNG bytes, as a `CompressedImage` holds them."""

    data: bytes

    def gray(self) -> Image:
        """The picture as (height, width) uint8."""
        return self._decode(cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION)

    def bgr(self) -> Image:
        """The picture as (height, width, 3) uint8."""
        return self._decode(cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION)

    def jpeg(self) -> bytes:
        """The picture as JPEG: the very bytes of the log where they are JPEG."""
        return self.data if self.data.startswith(b"\xff\xd8") else encode_jpeg(self.bgr())

    def _decode(self, mode: int) -> Image:
        try:
            picture = cv2.imdecode(np.frombuffer(self.data, np.uint8), mode)
        except cv2.error as error:
            raise MalformedInput("A picture of the log does not decode: it is left out.") from error
        if picture is None or picture.size == 0:
            raise MalformedInput("A picture of the log does not decode: it is left out.")
        return np.asarray(picture, np.uint8)


#: Two threads that convert one frame at a time wait for each other for ever (measured on PyAV 18).
_CONVERTING = Lock()


class VideoPicture:
    """A decoded video frame (an `av.VideoFrame`). Several threads may ask for it; the JPEG is made once."""

    def __init__(self, frame: Any) -> None:
        self._frame = frame
        self._jpeg: bytes | None = None

    def gray(self) -> Image:
        """The picture as (height, width) uint8."""
        return self._converted("gray")

    def bgr(self) -> Image:
        """The picture as (height, width, 3) uint8."""
        return self._converted("bgr24")

    def jpeg(self) -> bytes:
        """The picture as JPEG."""
        if self._jpeg is None:
            self._jpeg = encode_jpeg(self.bgr())
        return self._jpeg

    def _converted(self, layout: str) -> Image:
        with _CONVERTING:
            return np.asarray(self._frame.to_ndarray(format=layout), np.uint8)


@dataclass(frozen=True, eq=False)
class ArrayPicture:
    """A picture in memory, (height, width, 3) uint8, blue first: what a renderer makes, or a camera that knows no JPEG."""

    pixels: Image

    def gray(self) -> Image:
        """The picture as (height, width) uint8."""
        return np.asarray(cv2.cvtColor(self.pixels, cv2.COLOR_BGR2GRAY), np.uint8)

    def bgr(self) -> Image:
        """The picture as (height, width, 3) uint8."""
        return self.pixels

    def jpeg(self) -> bytes:
        """The picture as JPEG, encoded the first time that somebody asks: a recorder and the wire want the same bytes."""
        return self._jpeg

    @cached_property
    def _jpeg(self) -> bytes:
        return encode_jpeg(self.pixels)


def encode_jpeg(bgr: Image) -> bytes:
    """Return (height, width, 3) pixels, blue first, as JPEG bytes."""
    done, data = cv2.imencode(".jpg", bgr, (cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY))
    if not done:
        raise ValueError(f"a picture of shape {bgr.shape} does not encode")
    return data.tobytes()
