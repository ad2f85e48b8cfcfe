"""A walk's pictures in small, side by side in one JPEG: what its timeline is painted with."""

from math import ceil
from typing import Final

import cv2
import numpy as np

from server.errors import LogRefused
from tracker.errors import MalformedInput
from tracker.log import Log
from tracker.measurements import Image
from tracker.pictures import EncodedPicture

#: So many, so high: a strip 2560 pixels wide on a desktop, and enough for a phone's.
COUNT: Final = 24
HEIGHT_PX: Final = 72
#: Pictures are never taken for wider than this, in heights.
_WIDEST: Final = 2.4
_QUALITY: Final = 72


def thumbnails_of(log: Log) -> bytes:
    """Return the strip: `COUNT` pictures of equal width, each the newest in the middle of its share of the walk.

    Raises:
        LogRefused: 404, the walk has no pictures that decode.
    """
    info = log.info
    middles = [info.t_start_ns + round((index + 0.5) / COUNT * info.duration_s * 1e9) for index in range(COUNT)]
    found = [_at(log, t_ns) for t_ns in middles] if info.counts["frames"] else []
    sizes = [picture.shape[1] for picture in found if picture is not None]
    if not sizes:
        raise LogRefused(404, "This walk has no pictures.")
    blank = np.zeros((HEIGHT_PX, sizes[0], 3), np.uint8)
    strip = np.hstack([_fitted(blank if picture is None else picture, sizes[0]) for picture in found])
    done, data = cv2.imencode(".jpg", strip, (cv2.IMWRITE_JPEG_QUALITY, _QUALITY))
    if not done:
        raise LogRefused(422, "The walk's pictures cannot be made smaller.")
    return data.tobytes()


def _at(log: Log, t_ns: int) -> Image | None:
    """Return the picture there in small, as it is stored; None where none decodes."""
    frame = next(log.pictures(t_ns), None)
    if frame is None:
        return None
    try:
        pixels = EncodedPicture(frame.picture.jpeg()).bgr()
    except MalformedInput:
        return None
    height, width = pixels.shape[:2]
    width_px = max(1, min(ceil(_WIDEST * HEIGHT_PX), round(width * HEIGHT_PX / height)))
    return np.asarray(cv2.resize(pixels, (width_px, HEIGHT_PX), interpolation=cv2.INTER_AREA), np.uint8)


def _fitted(picture: Image, width_px: int) -> Image:
    if picture.shape[1] == width_px:
        return picture
    return np.asarray(cv2.resize(picture, (width_px, HEIGHT_PX)), np.uint8)
