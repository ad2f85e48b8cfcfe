"""The readings of the paper's text: each is a setting, and each changes what it is said to change."""

import pytest

from server.paper.cases import Seen
from server.paper.readings import CHANGES, reading_row
from server.settings import changes, choose
from tracker.simulate import Walk, WalkSettings, default_rig, simulate


@pytest.fixture(scope="module")
def seen() -> Seen:
    """Half a minute without a camera."""
    settings = WalkSettings(seed=5, duration_s=30.0, still_s=4.0, imu_hz=100.0, truth_hz=50.0)
    walk = Walk(settings, default_rig())
    return Seen(walk, list(simulate(walk)), [])


@pytest.mark.parametrize("pairs", sorted({pairs for tried in CHANGES.values() for pairs in tried}))
def test_every_reading_is_a_change_of_settings(pairs: tuple[str, ...]) -> None:
    assert len(changes(choose(pairs))) == len(pairs)


def test_a_row_for_a_reading(seen: Seen) -> None:
    """Four samples are no path between fixes: the filter is surprised by every one of them."""
    usual = reading_row(seen, "gps-imu", ())
    literal = reading_row(seen, "gps-imu", ("m_imu=literal",))
    assert literal["changes"] == ["m_imu=literal"]
    assert literal["filter_error_m"]["mean"] > 1.02 * usual["filter_error_m"]["mean"]
    assert literal["filter_error_rad"] == usual["filter_error_rad"]
    assert usual["truth"]["ate_rmse_m"] < 5.0
