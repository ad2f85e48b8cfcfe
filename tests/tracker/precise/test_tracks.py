"""Features are followed from picture to picture, and every look at one is used once."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.measurements import VisualTracks
from tracker.precise.tracks import Tracks, seen_in

MOST = 4


def looks(t_key: int, t: int, ids: list[int]) -> VisualTracks:
    """Every ray tells which feature it is of, and when."""
    rays = np.array([[i, t_key, i, t] for i in ids], np.float32).reshape(-1, 4)
    return VisualTracks(np.array(ids, np.int64), rays)


@given(st.lists(st.sets(st.integers(0, 12), max_size=8), min_size=2, max_size=12))
def test_every_look_is_told_once_at_most_and_of_its_own_picture(pictures: list[set[int]]) -> None:
    tracks, told = Tracks(MOST), set()
    for t, ids in enumerate(pictures, 1):
        ended = tracks.take(looks(t - 1, t, sorted(ids)), t - 1, t, is_held=True)
        assert ended.shape[1:] == (len(tracks.stamps), 2)
        for row in ended:
            at = [tracks.stamps[k] for k in np.flatnonzero(seen_in(row[None])[0])]
            assert 2 <= len(at) <= MOST + 1
            assert at == list(range(at[0], at[-1] + 1))
            (feature,) = set(row[np.isfinite(row[:, 0]), 0].tolist())
            assert row[np.isfinite(row[:, 0]), 1].tolist() == at
            assert all((feature, t_ns) not in told for t_ns in at[1:])
            told |= {(feature, t_ns) for t_ns in at}
        tracks.forget_oldest()
        assert len(tracks.stamps) <= MOST


def test_a_feature_that_is_lost_or_seen_for_long_is_told() -> None:
    tracks = Tracks(MOST)
    assert len(tracks.take(looks(0, 1, [5, 6]), 0, 1, is_held=True)) == 0
    assert len(tracks.take(looks(1, 2, [5, 6]), 1, 2, is_held=True)) == 0
    lost, full = tracks.take(looks(2, 3, [6]), 2, 3, is_held=True)
    assert lost[:3].tolist() == [[5, 0], [5, 1], [5, 2]]
    assert np.isnan(lost[3]).all()
    assert full.tolist() == [[6, 0], [6, 1], [6, 2], [6, 3]]


def test_several_pictures_may_be_of_one_keyframe() -> None:
    """The keyframe's look at a feature is told once with those at the pictures after it."""
    tracks = Tracks(MOST)
    assert len(tracks.take(looks(0, 1, [5, 6]), 0, 1, is_held=True)) == 0
    assert len(tracks.take(looks(0, 2, [5, 6]), 0, 2, is_held=True)) == 0
    lost, full = tracks.take(looks(2, 3, [6]), 2, 3, is_held=True)
    assert lost[:3].tolist() == [[5, 0], [5, 1], [5, 2]]
    assert full.tolist() == [[6, 0], [6, 1], [6, 2], [6, 3]]


@pytest.mark.parametrize(("t_key", "is_held"), [(2, False), (1, True)])
def test_where_the_picture_before_is_not_known_all_begins_anew(t_key: int, is_held: bool) -> None:
    tracks = Tracks(MOST)
    tracks.take(looks(7, 8, [5, 6]), 7, 8, is_held=True)
    assert len(tracks.take(looks(t_key, 9, [5]), t_key, 9, is_held=is_held)) == 0
    assert tracks.stamps == ([t_key, 9] if is_held else [9])
