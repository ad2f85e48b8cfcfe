"""How far a fix moves the place: fresh doubt is corrected in full, old doubt by less, and the covariance says what that costs."""

from math import exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.measurements import Matrix
from tracker.precise.doubt import Doubt
from tracker.precise.settings import PreciseSettings

S = 1_000_000_000
SETTINGS = PreciseSettings()
OLD = SETTINGS.settled_share


def _covariance(level_m2: float) -> Matrix:
    """Of the place alone; what is upwards is another thing."""
    return np.diag([0.5 * level_m2, 0.5 * level_m2, 99.0])


def _shares(fixes: list[tuple[float, float, float]]) -> list[float]:
    """Return the shares of fixes at seconds, each with the variance of the level place before it and after it."""
    doubt, found = Doubt(SETTINGS), []
    for t_s, before_m2, after_m2 in fixes:
        found.append(doubt.share(round(t_s * S), _covariance(before_m2)))
        doubt.corrected(_covariance(after_m2))
    return found


def test_more_than_the_whole_is_no_share() -> None:
    with pytest.raises(ValueError, match="more than the whole"):
        PreciseSettings(settled_share=1.1)


def test_a_first_fix_moves_the_place_in_full() -> None:
    assert _shares([(7.0, 1e4, 6.0)]) == [1.0]


def test_doubt_grows_old() -> None:
    first, soon, late = _shares([(0.0, 1e4, 6.0), (1.0, 6.0, 5.8), (1000.0, 5.8, 5.7)])
    assert first == 1.0
    assert soon == pytest.approx(OLD + (1.0 - OLD) * exp(-1.0 / SETTINGS.fresh_s))
    assert late == pytest.approx(OLD, abs=1e-6)


def test_what_an_outage_has_added_is_fresh() -> None:
    """Of 9 square metres after ten minutes without a fix, 6 are new."""
    assert _shares([(0.0, 1e4, 3.0), (600.0, 9.0, 3.0)])[-1] == pytest.approx(OLD + (1.0 - OLD) * 6.0 / 9.0, abs=1e-4)


def test_what_a_landmark_has_told_makes_nothing_fresh() -> None:
    assert _shares([(0.0, 1e4, 6.0), (600.0, 0.1, 0.1), (601.0, 0.1, 0.1)])[1:] == pytest.approx([OLD, OLD], abs=1e-4)


def test_a_place_begun_anew_is_doubted_anew() -> None:
    doubt = Doubt(SETTINGS)
    doubt.share(0, _covariance(6.0))
    doubt.corrected(_covariance(6.0))
    doubt.begin()
    assert doubt.share(600 * S, _covariance(6.0)) == 1.0


@given(
    st.lists(
        st.tuples(st.floats(0.0, 1e4), st.floats(1e-6, 1e6), st.floats(0.0, 1.0)),
        min_size=1,
        max_size=30,
    )
)
def test_a_share_is_never_more_than_all_nor_less_than_that_of_the_old(fixes: list[tuple[float, float, float]]) -> None:
    for share in _shares([(t_s, m2, m2 * kept) for t_s, m2, kept in fixes]):
        assert OLD - 1e-9 <= share <= 1.0 + 1e-9
