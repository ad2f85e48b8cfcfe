"""Turning from the gyroscope: against a fine integration, in any two legs, and over gaps."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.tracker.calibrate.rig_motion import RigMotion
from tracker import rotations
from tracker.calibrate.gyro_track import GyroTrack
from tracker.errors import InputError
from tracker.measurements import ImuSample

times = st.floats(0.0, 9.9)


@given(st.integers(0, 1000), times, times, times)
def test_two_legs_are_the_whole(seed: int, a: float, b: float, c: float) -> None:
    track = RigMotion(seed % 3).track
    legs = rotations.multiply(track.between(np.array([a]), np.array([b])), track.between(np.array([b]), np.array([c])))
    whole = track.between(np.array([a]), np.array([c]))
    assert abs(float(np.sum(legs * whole))) == pytest.approx(1.0, abs=1e-12)


@settings(max_examples=20)
@given(st.integers(0, 2), times, st.floats(0.0, 2.0))
def test_few_samples_tell_nearly_what_many_tell(seed: int, a: float, span: float) -> None:
    fine = RigMotion(seed).track
    coarse = GyroTrack(fine.times_s[::5], fine.rates_rad_s[::5])
    begin, end = np.array([a]), np.array([min(a + span, 9.9)])
    off = rotations.log(rotations.multiply(rotations.conjugate(fine.between(begin, end)), coarse.between(begin, end)))
    assert float(np.linalg.norm(off)) < 5e-4


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("rate_hz", [16.0, 32.0])
def test_a_phone_of_few_samples_a_second_tells_the_whole_turn(seed: int, rate_hz: float) -> None:
    """Not a share less, as straight lines from sample to sample would: at 16 Hz these lose 0.5 % of a hand's turns."""
    fine = RigMotion(seed).track
    times_s = np.arange(-0.9, 10.9, 1.0 / rate_hz)
    rates = np.stack([np.interp(times_s, fine.times_s, fine.rates_rad_s[:, k]) for k in range(3)], axis=1)
    begin = np.linspace(0.0, 9.8, 300)
    whole = rotations.log(fine.between(begin, begin + 0.14))
    told = rotations.log(GyroTrack(times_s, rates).between(begin, begin + 0.14))
    assert float(np.sum(told * whole) / np.sum(whole**2)) == pytest.approx(1.0, abs=5e-4)


def test_two_samples_close_together_make_no_more_noise_than_one() -> None:
    """Units that deliver in pairs: a slope by the two alone would carry their noise through the step that follows."""
    rng = np.random.default_rng(1)
    paired_s = np.sort(np.concatenate([np.arange(0.0, 20.0, 0.02), np.arange(0.001, 20.0, 0.02)]))
    off = []
    for times_s in (paired_s, np.arange(0.0, 20.0, 0.02)):
        noisy = GyroTrack(times_s, rng.normal(0.0, 0.01, (len(times_s), 3)))
        begin = np.arange(0.5, 19.0, 0.1)
        off.append(float(np.std(rotations.log(noisy.between(begin, begin + 0.1)))))
    assert off[0] < 1.05 * off[1]


@given(st.lists(st.tuples(*[st.floats(-3.1, 3.1)] * 3), min_size=1, max_size=8))
def test_rotations_agree_with_scipy(vectors: list[tuple[float, float, float]]) -> None:
    q = rotations.exp(np.array(vectors))
    theirs = Rotation.from_rotvec(np.array(vectors))
    np.testing.assert_allclose(rotations.matrices(q), theirs.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(rotations.log(q), theirs.as_rotvec(), atol=1e-9)


def test_nothing_is_known_over_a_gap_and_beyond_the_ends() -> None:
    t = np.concatenate([np.arange(0.0, 1.0, 0.01), np.arange(2.0, 3.0, 0.01)])
    track = GyroTrack(t, np.zeros((len(t), 3)))
    known = track.knows(np.array([0.1, 0.5, 2.1, -0.5, 2.5]), np.array([0.9, 2.5, 2.9, 0.5, 3.5]))
    assert known.tolist() == [True, False, True, False, False]


def test_samples_out_of_order_are_left_out() -> None:
    def at(t_ns: int) -> ImuSample:
        return ImuSample(t_ns, t_ns, (1.0, 0.0, 0.0), (0.0, 0.0, 9.81))

    track = GyroTrack.of([at(0), at(10**9), at(5 * 10**8), at(10**9), at(2 * 10**9)], 0)
    np.testing.assert_allclose(track.times_s, [0.0, 1.0, 2.0])
    with pytest.raises(InputError):
        GyroTrack.of([at(0), at(0)], 0)
