"""Pictures come out as libjpeg has them, whether the browser hands out a JPEG's planes or makes a bitmap of it."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from time import monotonic

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from server.showing import Showing
from server.wire import decode_frame, encode_frame
from tests.web.pages import PATIENCE_S, ArPage, Pixels, open_page
from tests.web.tampering import change_frames

pytestmark = pytest.mark.browser

COUNTING = """{
    globalThis.planar = 0;
    const copyTo = VideoFrame.prototype.copyTo;
    VideoFrame.prototype.copyTo = function (...taken) { planar += 1; return copyTo.apply(this, taken); };
}"""
SAMPLINGS = {
    "4:2:0": cv2.IMWRITE_JPEG_SAMPLING_FACTOR_420,
    "4:2:2": cv2.IMWRITE_JPEG_SAMPLING_FACTOR_422,
    "4:4:4": cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444,
    "4:1:1": cv2.IMWRITE_JPEG_SAMPLING_FACTOR_411,
}
SIZE_PX = (640, 480)
ODD_SIZE_PX = (641, 481)
"""Whose last samples of colour reach beyond the picture."""


def colourful(width: int, height: int) -> Pixels:
    """Return a picture of slopes in strong colours, (height, width, 3)."""
    y, x = np.mgrid[:height, :width]
    waves = np.stack([np.sin(x / 29.0), np.sin(y / 23.0), np.sin((x + y) / 31.0)], -1)
    return (128 + 120 * waves).astype(np.uint8)


def edged() -> Pixels:
    """Return such a picture with hard edges in it."""
    pixels = colourful(*SIZE_PX)
    pixels[40:-40:37, 40:-40] = 255 - pixels[40:-40:37, 40:-40]
    pixels[:, 53::41] = 255 - pixels[:, 53::41]
    return pixels


def jpeg(pixels: Pixels, sampling: str = "4:2:0") -> bytes:
    """Return it as a JPEG whose colour is as coarse as that."""
    return cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_SAMPLING_FACTOR, SAMPLINGS[sampling]])[1].tobytes()


def turned(encoded: bytes) -> bytes:
    """Return a JPEG that says of itself that it stands on its head (EXIF orientation 3)."""
    exif = b"Exif\0\0MM\0*" + struct.pack(">IHHHIHHI", 8, 1, 0x112, 3, 1, 3, 0, 0)
    return encoded[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + encoded[2:]


class Pictures:
    """Somebody who puts a picture of the test's choice into every message to a page."""

    def __init__(self, ar: ArPage) -> None:
        self._ar = ar
        self._jpeg = jpeg(colourful(*SIZE_PX))
        self._passed: list[int] = []
        change_frames(ar.page, self._change)

    def _change(self, message: bytes) -> bytes:
        meta, _ = decode_frame(message)
        height, width = libjpeg(self._jpeg).shape[:2]
        self._passed.append(meta.frame_id)
        return encode_frame(replace(meta, camera=replace(meta.camera, width_px=width, height_px=height)), self._jpeg)

    def off_by(self, encoded: bytes) -> NDArray[np.int64]:
        """Return how far what the page draws of a picture is from libjpeg's, (height, width, 3)."""
        self._jpeg = encoded
        self._passed.clear()
        self._ar.until("globalThis.agora?.stats()?.framesDrawn > 0")
        deadline = monotonic() + PATIENCE_S
        while self._ar.stats()["lastFrameId"] not in self._passed:
            assert monotonic() < deadline, self._ar.state()
            self._ar.page.wait_for_timeout(20)
        expected = libjpeg(encoded)
        height, width = expected.shape[:2]
        return np.abs(self._ar.pixels((width, height)).astype(int) - expected)


def libjpeg(encoded: bytes) -> Pixels:
    """Return a picture as OpenCV has it, (height, width, 3), red first."""
    decoded = cv2.imdecode(np.frombuffer(encoded, np.uint8), cv2.IMREAD_COLOR)
    assert decoded is not None
    return np.asarray(decoded[..., ::-1], np.uint8)


@contextmanager
def opened(browser: Browser, showing: Showing, script: str) -> Iterator[tuple[ArPage, Pictures]]:
    """Open the page, without a model, after a script."""
    with open_page(browser) as ar:
        ar.page.route("**/models/*", lambda route: route.fulfill(status=404))
        ar.page.add_init_script(script)
        pictures = Pictures(ar)
        ar.page.goto(f"{showing.url}ar")
        yield ar, pictures


def test_planes_come_out_as_a_bitmap_does(browser: Browser, showing: Showing) -> None:
    asked = [(edged(), sampling, 1) for sampling in ("4:2:0", "4:2:2", "4:4:4")]
    # SwiftShader places what it filters to a 65536th of a texture: even bitmaps of odd size come out a little off
    asked += [(colourful(*ODD_SIZE_PX), sampling, 2) for sampling in ("4:2:0", "4:2:2")]
    with opened(browser, showing, COUNTING) as (ar, pictures):
        for pixels, sampling, most in asked:
            before = ar.ask("globalThis.planar ?? 0")
            off = pictures.off_by(jpeg(pixels, sampling))
            assert ar.ask("planar") > before, "it was shown as a bitmap"
            assert off.max() <= most, (pixels.shape, sampling)
            assert (off > 1).mean() < 0.001


def test_without_planes_there_are_bitmaps(browser: Browser, showing: Showing) -> None:
    with opened(browser, showing, "delete globalThis.ImageDecoder") as (_, pictures):
        assert pictures.off_by(jpeg(edged())).max() <= 1


def test_what_has_other_planes_or_stands_on_its_head_becomes_a_bitmap(browser: Browser, showing: Showing) -> None:
    upright = jpeg(edged())
    grey = jpeg(np.ascontiguousarray(edged()[..., 0]))
    for odd in (turned(upright), grey, jpeg(edged(), "4:1:1")):
        with opened(browser, showing, COUNTING) as (ar, pictures):
            assert pictures.off_by(upright).max() <= 1
            assert ar.ask("planar") > 0
            assert pictures.off_by(odd).max() <= 1
            assert [error for error in ar.errors if "404" not in error] == []
