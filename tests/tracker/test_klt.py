"""Features of real pictures: where they are found, that they are followed, and that what is gone is let go."""

import cv2
import numpy as np

from tracker.features import NO_FEATURES, Features, View
from tracker.klt import Klt
from tracker.measurements import Frame, Image
from tracker.pictures import ArrayPicture


def _spots(seed: int = 0) -> Image:
    noise = np.random.default_rng(seed).integers(0, 255, (30, 40), np.uint8)
    return np.asarray(cv2.resize(noise, (320, 240), interpolation=cv2.INTER_CUBIC), np.uint8)


def _view(gray: Image, number: int = 0) -> View:
    pixels = np.asarray(cv2.cvtColor(gray, cv2.COLOR_GRAY2BGR), np.uint8)
    return Klt().look(Frame(number, number, number, ArrayPicture(pixels)))


def _shifted(gray: Image, right_px: float, down_px: float) -> Image:
    M = np.array([[1.0, 0.0, right_px], [0.0, 1.0, down_px]])
    return np.asarray(cv2.warpAffine(gray, M, (320, 240)), np.uint8)


def test_a_view_is_the_picture_in_grey() -> None:
    view = _view(_spots(), 7)
    assert (view.frame_id, view.size_px) == (7, (320, 240))
    assert view.content.shape == (240, 320)


def test_new_features_keep_their_distance() -> None:
    view = _view(_spots())
    first = Klt().detect(view, NO_FEATURES, 40, 12)
    more = Klt().detect(view, first, 60, 12)
    assert len(first) == 40
    assert 10 < len(more) <= 60
    both = first.joined(more).points_px
    apart_px = np.linalg.norm(both[:, None] - both[None], axis=2) + 1e3 * np.eye(len(both))
    assert apart_px.min() >= 12.0


def test_features_go_where_the_picture_goes() -> None:
    """A tenth of a pixel, out to a shift that only the pyramid reaches; and those that leave the picture are lost."""
    before, after = _view(_spots()), _view(_shifted(_spots(), 21.5, -6.25), 1)
    features = Klt().detect(before, NO_FEATURES, 80, 8)
    there, kept = Klt().follow(before, after, features)
    assert len(there) == np.count_nonzero(kept)
    expected = features.chosen(kept).points_px + np.array([21.5, -6.25])
    assert np.median(np.linalg.norm(there.points_px - expected, axis=1)) < 0.1
    assert not kept[features.points_px[:, 0] > 300.0].any()


def test_what_is_not_there_any_more_is_lost() -> None:
    before, other = _view(_spots()), _view(_spots(seed=1), 1)
    features = Klt().detect(before, NO_FEATURES, 80, 8)
    there, _ = Klt().follow(before, other, features)
    assert len(there) < 0.3 * len(features)
    nothing, kept = Klt().follow(before, other, Features(np.zeros((0, 2), np.float32), np.zeros((0, 0))))
    assert (len(nothing), len(kept)) == (0, 0)


def test_a_dark_picture_has_no_features() -> None:
    assert len(Klt().detect(_view(np.zeros((240, 320), np.uint8)), NO_FEATURES, 80, 8)) == 0
