"""Pictures as cameras hand them over: bytes with padding and without Huffman tables, arrays of every shape."""

from io import BytesIO

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as PillowImage

from tracker.pictures import encode_jpeg
from tracker.sources.motion_jpeg import camera_picture, whole_jpeg

PIXELS = np.kron(np.random.default_rng(3).integers(0, 255, (6, 8, 3), np.uint8), np.ones((8, 8, 1), np.uint8))
WHOLE = encode_jpeg(PIXELS)


def without_tables(data: bytes) -> bytes:
    """Leave out the Huffman tables, as webcams do."""
    kept, place = data[:2], 2
    while data[place + 1] != 0xDA:
        end = place + 2 + int.from_bytes(data[place + 2 : place + 4], "big")
        kept += b"" if data[place + 1] == 0xC4 else data[place:end]
        place = end
    return kept + data[place:]


def test_missing_tables_are_put_in() -> None:
    bare = without_tables(WHOLE)
    assert len(bare) < len(WHOLE) - 400
    mended = whole_jpeg(bare)
    assert mended is not None
    decoded = cv2.imdecode(np.frombuffer(mended, np.uint8), cv2.IMREAD_COLOR)
    np.testing.assert_array_equal(decoded, cv2.imdecode(np.frombuffer(WHOLE, np.uint8), cv2.IMREAD_COLOR))


def test_a_whole_picture_stays_as_it_is_and_padding_goes() -> None:
    assert whole_jpeg(WHOLE) == WHOLE
    assert whole_jpeg(WHOLE + b"\0" * 999) == WHOLE


@given(st.integers(0, len(WHOLE) - 1))
def test_a_picture_that_was_cut_off_is_none(length: int) -> None:
    assert whole_jpeg(WHOLE[:length]) is None


@given(st.binary(max_size=60))
def test_any_bytes_are_a_picture_or_none(data: bytes) -> None:
    made = whole_jpeg(b"\xff\xd8" + data + b"\xff\xd9")
    assert made is None or made.startswith(b"\xff\xd8")


@pytest.mark.parametrize(
    "pixels", [PIXELS, PIXELS[:, :, 0], PIXELS[:, :, :1]], ids=["colour", "grey", "grey, three axes"]
)
def test_arrays_become_colour_pictures(pixels: np.ndarray) -> None:
    picture = camera_picture(pixels)
    assert picture is not None
    assert picture.gray().shape == (48, 64)
    assert PillowImage.open(BytesIO(picture.jpeg())).size == (64, 48)
    assert picture.jpeg() is picture.jpeg()


@pytest.mark.parametrize(
    "nothing", [None, np.zeros((0, 0), np.uint8), np.zeros((48, 64, 2), np.uint8), np.zeros((1, 99), np.uint8)]
)
def test_what_is_no_picture_is_none(nothing: np.ndarray | None) -> None:
    assert camera_picture(nothing) is None
