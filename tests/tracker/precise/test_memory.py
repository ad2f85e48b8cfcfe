"""What a rig remembers of its sensors: it fades as the filter would have it, and text from outside cannot hurt."""

import re

import numpy as np
import pytest

from tracker.errors import MalformedInput
from tracker.precise import observations, receiver_error
from tracker.precise.error_model import BG, GPS_ERROR, THETA, P, start_covariance
from tracker.precise.error_state import ErrorState
from tracker.precise.memory import KEPT, SIZE, Memory, forgotten, from_toml, recall, remember, to_toml
from tracker.precise.navigation import Biases, Navigation
from tracker.precise.settings import PreciseSettings

S = 1_000_000_000
SETTINGS = PreciseSettings()
STILL = ((0.0, 0.0, 0.0), (0.0, 0.0, 9.8))
FIX_SIGMA_M = (2.0, 2.0, 4.0)


def fresh(t_ns: int = 0) -> ErrorState:
    """Return a filter that knows nothing yet, level and at rest."""
    nav = Navigation(t_ns, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    return ErrorState(SETTINGS, nav, Biases(), start_covariance(SETTINGS, (100.0, 100.0, 100.0), 1.0, 1.0), 9.8)


def aligned() -> ErrorState:
    """Return one that was given a fix 3 m east of where somebody then said that it stands, and a gyro reading at rest."""
    state = fresh()
    state.correct(*observations.gps_position(state, (3.0, 0.0, 0.0), FIX_SIGMA_M, (0.0, 0.0, 0.0)), 0.2 * np.eye(3))
    state.correct(*observations.position(state, (0.0, 0.0, 0.0)), 0.01 * np.eye(3), gated=False)
    state.correct(*observations.turn_rate(state, (0.004, 0.0, 0.0)), 1e-8 * np.eye(3))
    return state


def memory() -> Memory:
    return remember(aligned())


def test_what_was_learned_is_remembered() -> None:
    state = aligned()
    kept = remember(state)
    assert kept.t_ns == state.nav.t_ns
    assert kept.mean[0] == pytest.approx(0.004, rel=0.01)
    east_m = FIX_SIGMA_M[0] * sum(state.gps_error[[0, 3, 6]])
    assert east_m == pytest.approx(3.0, abs=0.3)
    assert np.array_equal(kept.mean[6:], state.gps_error)
    assert np.array_equal(kept.covariance, state.covariance[KEPT, KEPT])


def test_at_once_a_new_filter_knows_as_much_and_nothing_of_where_it_is() -> None:
    old, new = aligned(), fresh()
    recall(new, remember(old))
    assert new.biases == old.biases
    assert np.array_equal(new.gps_error, old.gps_error)
    assert np.array_equal(new.covariance[KEPT, KEPT], old.covariance[KEPT, KEPT])
    assert new.nav == fresh().nav
    assert np.array_equal(new.covariance[P, P], fresh().covariance[P, P])
    assert not new.covariance[KEPT, P].any()
    assert not new.covariance[THETA, KEPT].any()


def test_it_fades_as_the_filter_itself_forgets() -> None:
    """The receiver's error after a minute: once carried on by the filter, once put away and taken out again."""
    old = aligned()
    kept = remember(old)
    for step in range(1, 3001):
        old.advance(step * 20_000_000, *STILL)
    old.settle()
    new = fresh(old.nav.t_ns)
    recall(new, kept)
    assert new.gps_error == pytest.approx(old.gps_error, rel=1e-9)
    assert new.covariance[GPS_ERROR, GPS_ERROR] == pytest.approx(
        old.covariance[GPS_ERROR, GPS_ERROR], rel=1e-6, abs=1e-9
    )
    assert np.diag(new.covariance)[BG] == pytest.approx(np.diag(old.covariance)[BG], rel=0.02)


def test_a_day_later_it_is_as_if_nothing_were_known() -> None:
    state = fresh(24 * 3600 * S)
    before = state.covariance.copy()
    recall(state, memory())
    assert state.covariance == pytest.approx(before, rel=0.01, abs=1e-12)
    assert np.abs(state.gps_error).max() < 1e-9
    assert abs(state.biases.gyro_rad_s[0]) < 0.1 * 0.004


@pytest.mark.parametrize("after_s", [0, 1, 30, 600, 10_000, 10_000_000])
def test_the_covariance_stays_one(after_s: int) -> None:
    state = fresh(after_s * S)
    recall(state, memory())
    assert np.linalg.eigvalsh(state.covariance).min() > 0.0


def test_a_memory_from_the_future_is_of_another_clock() -> None:
    state = fresh(-1)
    before = state.covariance.copy()
    recall(state, memory())
    assert np.array_equal(state.covariance, before)
    assert state.biases == Biases()


def test_it_changes_what_the_first_fix_means() -> None:
    """The receiver is still 3 m too far east a moment later: who remembers that knows better where the rig is."""
    found = []
    for is_remembered in (True, False):
        state = fresh(5 * S)
        if is_remembered:
            recall(state, memory())
        state.correct(*observations.gps_position(state, (3.0, 0.0, 0.0), FIX_SIGMA_M, (0.0, 0.0, 0.0)), 0.2 * np.eye(3))
        found.append((abs(state.nav.p_m[0]), float(state.covariance[0, 0]) ** 0.5))
    (off_m, sigma_m), (off_without_m, sigma_without_m) = found
    assert off_m < 1.2 < 2.5 < off_without_m
    assert sigma_m < 0.8 * sigma_without_m


def test_as_text_it_is_the_same_to_the_last_bit() -> None:
    state = claiming()
    for step in range(1, 200):
        state.advance(step * 5_000_000, (0.1, -0.2, 0.3), (0.5, 1.0, 9.8))
    kept = remember(state)
    again = from_toml(to_toml(kept))
    assert (again.t_ns, again.receiver_sigma_m) == (kept.t_ns, kept.receiver_sigma_m)
    assert np.array_equal(again.mean, kept.mean)
    assert np.array_equal(again.covariance, kept.covariance)


def test_in_metres_the_receiver_is_as_far_off_whatever_it_claims_at_the_next_start() -> None:
    """It claims 8 m, before it has seen many satellites: what is remembered is 3 m, and what is forgotten is of those 8."""
    old, claimed_m = aligned(), (8.0, 8.0, 16.0)
    receiver_error.restate(old, FIX_SIGMA_M)
    kept = remember(old)
    for after_s in (0, 60, 24 * 3600):
        state, t_ns = fresh(after_s * S), after_s * S
        recall(state, kept)
        faded = state.gps_error * np.tile(FIX_SIGMA_M, 3)
        receiver_error.restate(state, claimed_m, forgotten(kept, t_ns, SETTINGS))
        assert state.gps_error * np.tile(claimed_m, 3) == pytest.approx(faded)
        assert np.linalg.eigvalsh(state.covariance).min() > 0.0
        variances = np.diag(state.covariance)[GPS_ERROR] * np.tile(claimed_m, 3) ** 2
        if after_s == 0:
            assert variances == pytest.approx(np.diag(old.covariance)[GPS_ERROR] * np.tile(FIX_SIGMA_M, 3) ** 2)
    assert variances == pytest.approx(np.repeat(SETTINGS.gps_error_share, 3) * np.tile(claimed_m, 3) ** 2, rel=1e-3)


def test_a_memory_of_an_earlier_version_is_read() -> None:
    text = re.sub(r"receiver_sigma_m = .*\n", "", TEXT)
    assert text != TEXT
    kept = from_toml(text)
    assert kept.receiver_sigma_m is None
    assert np.array_equal(kept.mean, from_toml(TEXT).mean)


def claiming() -> ErrorState:
    state = aligned()
    receiver_error.restate(state, FIX_SIGMA_M)
    return state


TEXT = to_toml(remember(claiming()))
ROW = re.search(r"^    \[.*\],$", TEXT, re.MULTILINE)
assert ROW is not None


@pytest.mark.parametrize(
    "text",
    [
        "",
        "=",
        "t_ns = " + "9" * 5000,
        "a = " + "[" * 60_000,
        "# " + "x" * 70_000,
        TEXT + "more = 1\n",
        TEXT.replace("t_ns = 0", "t_ns = -1"),
        TEXT.replace("t_ns = 0", "t_ns = 1.0"),
        TEXT.replace("t_ns = 0", "t_ns = true"),
        TEXT.replace("t_ns = 0", f"t_ns = {2**63}"),
        TEXT.replace("gyro_bias_rad_s = [", "gyro_bias_rad_s = [0.0, "),
        TEXT.replace("receiver_error = [", "receiver_error = ['a', "),
        re.sub(r"receiver_sigma_m = .*", "receiver_sigma_m = [1.0, 1.0]", TEXT),
        re.sub(r"receiver_sigma_m = .*", "receiver_sigma_m = [1.0, 0.0, 1.0]", TEXT),
        re.sub(r"receiver_sigma_m = .*", "receiver_sigma_m = [1.0, 1.0, 20000.0]", TEXT),
        re.sub(r"gyro_bias_rad_s = .*", "gyro_bias_rad_s = [nan, 0.0, 0.0]", TEXT),
        re.sub(r"gyro_bias_rad_s = .*", "gyro_bias_rad_s = [inf, 0.0, 0.0]", TEXT),
        re.sub(r"gyro_bias_rad_s = .*", f"gyro_bias_rad_s = [{10**400}, 0, 0]", TEXT),
        re.sub(r"gyro_bias_rad_s = .*", "gyro_bias_rad_s = [0.6, 0.0, 0.0]", TEXT),
        re.sub(r"gyro_bias_rad_s = .*", "gyro_bias_rad_s = [[0.0], 0.0, 0.0]", TEXT),
        re.sub(r"gyro_bias_rad_s = .*", "gyro_bias_rad_s = 0.0", TEXT),
        TEXT.replace(ROW.group(), "", 1),
        TEXT.replace(ROW.group(), f"    {[0.0] * SIZE},", 1),
        TEXT.replace(ROW.group(), f"    {[-1e-9] + [0.0] * (SIZE - 1)},", 1),
        TEXT.replace(ROW.group(), f"    {[1e-9] + [1.0] * (SIZE - 1)},", 1),
        re.sub(r"covariance = \[.*\]", "covariance = 1", TEXT, flags=re.DOTALL),
    ],
    ids=range(26),
)
def test_broken_or_hostile_text_is_refused(text: str) -> None:
    assert text != TEXT
    with pytest.raises(MalformedInput, match=r"rig's memory"):
        from_toml(text)


def test_a_covariance_that_is_none_is_refused() -> None:
    kept = memory()
    covariance = kept.covariance.copy()
    covariance[0, 1] = covariance[1, 0] = 1.01 * np.sqrt(covariance[0, 0] * covariance[1, 1])
    with pytest.raises(MalformedInput, match="no sensor can have"):
        from_toml(to_toml(Memory(kept.t_ns, kept.mean, covariance)))
