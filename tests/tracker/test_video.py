"""H.264 there and back."""

from threading import Thread

import numpy as np

from tracker.measurements import Image
from tracker.video import VideoDecoder, VideoEncoder, is_key

SIZE = (64, 96)


def _picture(number: int) -> Image:
    rows, columns = np.mgrid[0 : SIZE[0], 0 : SIZE[1]]
    picture = np.stack([rows * 2, columns, rows + columns], axis=2).astype(np.uint8)
    picture[20:40, number : number + 20] = 255
    return picture


def _encoded(count: int) -> list[bytes]:
    encoder = VideoEncoder(SIZE[1], SIZE[0], 10.0, crf=20)
    return [encoder.encode(_picture(number)) for number in range(count)]


def test_one_unit_in_one_picture_out() -> None:
    """In order, with its own number, at once: no unit waits for another."""
    decoder = VideoDecoder()
    for number, unit in enumerate(_encoded(30)):
        ((shown, picture),) = decoder.decode(unit, number)
        assert shown == number
        assert np.abs(picture.bgr().astype(int) - _picture(number)).mean() < 6.0
        assert picture.gray().shape == SIZE
        assert picture.jpeg().startswith(b"\xff\xd8")


def test_a_key_frame_every_two_seconds() -> None:
    """A seek begins there: the first unit, and each twentieth at 10 Hz."""
    units = _encoded(41)
    assert [number for number, unit in enumerate(units) if is_key(unit)] == [0, 20, 40]
    (found,) = VideoDecoder().decode(units[20], 20)
    assert found[0] == 20


def test_the_same_pictures_give_the_same_bytes() -> None:
    """So that the demo's log can be made again."""
    assert _encoded(6) == _encoded(6)


def test_a_broken_unit_gives_no_picture_and_the_next_key_frame_does() -> None:
    """Bytes that are no video end nothing."""
    units, decoder = _encoded(22), VideoDecoder()
    assert list(decoder.decode(b"no video at all", 0)) == []
    assert list(decoder.decode(b"", 1)) == []
    assert not is_key(b"\x00\x00\x01")
    assert [number for number, _ in decoder.decode(units[20], 20)] == [20]


def test_vision_recorder_and_show_may_look_at_one_picture_at_once() -> None:
    """Left to itself the library waits for ever where two threads convert one frame."""
    decoder = VideoDecoder()
    for number, unit in enumerate(_encoded(100)):
        ((_, picture),) = decoder.decode(unit, number)
        looks = (picture.gray, picture.bgr, picture.jpeg)
        threads = [Thread(target=look, daemon=True) for look in (*looks, *looks)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(20.0)
            assert not thread.is_alive()
