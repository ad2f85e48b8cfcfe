"""H.264 of the log's `/camera/video`: Annex B, one access unit a message, no B frames."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import av
import numpy as np
from av.error import FFmpegError

from tracker.measurements import Image
from tracker.pictures import VideoPicture

_SLICE_IDR, _SPS = 5, 7
_LOW_DELAY = 0x80000


def is_key(data: bytes) -> bool:
    """Return whether decoding can begin at this access unit: it holds parameters or an IDR slice."""
    start = data.find(b"\x00\x00\x01")
    while start != -1 and start + 3 < len(data) and start < 256:
        if data[start + 3] & 0x1F in (_SLICE_IDR, _SPS):
            return True
        start = data.find(b"\x00\x00\x01", start + 3)
    return False


class VideoDecoder:
    """Decodes access units in order; each picture comes with the number that its unit was given."""

    def __init__(self) -> None:
        context: Any = av.CodecContext.create("h264", "r")
        context.thread_count = 1
        context.flags |= _LOW_DELAY
        self._context = context

    def decode(self, data: bytes, number: int) -> Iterator[tuple[int, VideoPicture]]:
        """Yield the pictures that a unit completes; a broken unit completes none."""
        if not data:
            return  # to FFmpeg nothing means the end, after which it takes no more
        packet = av.Packet(data)
        packet.pts = number
        packet.time_base = Fraction(1, 1000)
        try:
            frames = self._context.decode(packet)
        except (FFmpegError, ValueError):
            return
        for frame in frames:
            if not frame.is_corrupt:
                yield frame.pts if frame.pts is not None else number, VideoPicture(frame)


class VideoEncoder:
    """Encodes pictures with x264: a key frame every two seconds, so that a seek decodes little."""

    def __init__(self, width_px: int, height_px: int, rate_hz: float, *, crf: int = 27) -> None:
        context: Any = av.CodecContext.create("libx264", "w")
        context.width, context.height = width_px, height_px
        context.pix_fmt = "yuv420p"
        context.time_base = Fraction(1, 1000)
        context.framerate = Fraction(rate_hz).limit_denominator(1000)
        context.gop_size = max(1, round(2 * rate_hz))
        context.max_b_frames = 0
        # one thread and no look-ahead: the same pictures give the same bytes, one unit out for each picture in
        context.thread_count = 1
        context.options = {"preset": "slow", "tune": "zerolatency", "crf": str(crf), "x264-params": "threads=1"}
        self._context = context
        self._count = 0

    def encode(self, bgr: Image) -> bytes:
        """Return the access unit of the next picture, (height, width, 3) uint8, blue first."""
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(bgr), format="bgr24")
        frame.pts = self._count * 1000
        self._count += 1
        return b"".join(bytes(packet) for packet in self._context.encode(frame))
