"""What stands in a picture's place for those who may not see it: bystanders are in it, and did not ask to be."""

from functools import cache
from typing import Final

import numpy as np

from server.wire import FRAME_HEADER_BYTES
from tracker.pictures import encode_jpeg

_SIDE_PX: Final = 16
_GREY: Final = 92


def without_picture(frame: bytes) -> bytes:
    """Return a frame message with the same header and an empty picture, a few hundred bytes.

    The pose, the lens and all else stay: the square is drawn as the walker has it, over nothing. A page stretches any picture over
    the size that the header says.
    """
    return frame[:FRAME_HEADER_BYTES] + _blank_jpeg()


@cache
def _blank_jpeg() -> bytes:
    return encode_jpeg(np.full((_SIDE_PX, _SIDE_PX, 3), _GREY, np.uint8))
