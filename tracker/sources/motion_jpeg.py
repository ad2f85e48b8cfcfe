"""Pictures as cameras hand them over, made into ones that everybody can read. Pure."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from tracker.measurements import Image, Picture
from tracker.pictures import ArrayPicture, EncodedPicture, encode_jpeg

_START, _END = b"\xff\xd8", b"\xff\xd9"
_HUFFMAN, _SCAN = 0xC4, 0xDA


def camera_picture(retrieved: NDArray[np.uint8] | None) -> Picture | None:
    """Return what `VideoCapture.retrieve` gave as a picture; None where it is none.

    With `CAP_PROP_CONVERT_RGB` off a camera in MJPG mode gives its own bytes as an array of one row or column.
    """
    if retrieved is None or retrieved.size == 0:
        return None
    if retrieved.ndim == 3 and retrieved.shape[2] == 3:
        return ArrayPicture(retrieved)
    if retrieved.ndim == 3 and retrieved.shape[2] != 1:
        return None
    flat = retrieved.reshape(retrieved.shape[:2]) if retrieved.ndim == 3 else retrieved
    if flat.ndim == 2 and 1 not in flat.shape:
        return ArrayPicture(_colour(flat))
    data = whole_jpeg(flat.tobytes())
    return None if data is None else EncodedPicture(data)


def _colour(grey: Image) -> Image:
    return np.repeat(grey[:, :, None], 3, axis=2)


def whole_jpeg(data: bytes) -> bytes | None:
    """Return one frame of motion JPEG as a JPEG file; None where it was cut off or is none.

    Buffers are longer than the picture, so that what follows its end is cut away; and webcams leave out the Huffman tables, which
    motion JPEG fixes and decoders of files may miss (they are those of the standard's annex K, and so of every plain encoder).
    """
    end = data.rfind(_END)
    if not data.startswith(_START) or end < 0:
        return None
    data = data[: end + 2]
    scan = _segment(data, _SCAN)
    if scan is None:
        return None
    return data if _segment(data, _HUFFMAN) is not None else data[:scan] + _standard_tables() + data[scan:]


def _segment(data: bytes, kind: int) -> int | None:
    """Return where the first segment of a kind begins in a JPEG's header."""
    place = 2
    while place + 4 <= len(data) and data[place] == 0xFF:
        if data[place + 1] == kind:
            return place
        if data[place + 1] == _SCAN:
            return None
        place += 2 + int.from_bytes(data[place + 2 : place + 4], "big")
    return None


@cache
def _standard_tables() -> bytes:
    """Return the four standard Huffman tables as segments, taken from a picture of OpenCV's encoder, which uses them."""
    data = encode_jpeg(np.zeros((16, 16, 3), np.uint8))
    tables, place = b"", 2
    while data[place + 1] != _SCAN:
        length = 2 + int.from_bytes(data[place + 2 : place + 4], "big")
        if data[place + 1] == _HUFFMAN:
            tables += data[place : place + length]
        place += length
    return tables
