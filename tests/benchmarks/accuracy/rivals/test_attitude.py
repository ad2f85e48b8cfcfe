"""What the attitude libraries are fed: samples at an even rate, whatever came."""

import pytest

from tests.benchmarks.accuracy.rivals.attitude import Even, period_s
from tracker.measurements import ImuSample

MS = 1_000_000


def sample(t_ms: float, gyro_z: float = 0.0) -> ImuSample:
    t_ns = round(t_ms * MS)
    return ImuSample(t_ns, t_ns, (0.0, 0.0, gyro_z), (0.0, 0.0, 9.8))


def evened(samples: list[ImuSample]) -> list[ImuSample]:
    even = Even(4 * MS)
    return [one for sample in samples for one in even.add(sample)]


def test_uneven_samples_are_interpolated() -> None:
    found = evened([sample(t_ms, 0.1 * t_ms) for t_ms in (0.0, 3.0, 9.0, 12.0)])
    assert [one.t_ns for one in found] == [0, 4 * MS, 8 * MS, 12 * MS]
    assert [one.gyro_rad_s[2] for one in found] == pytest.approx([0.0, 0.4, 0.8, 1.2])


def test_a_lost_sample_is_filled_and_a_long_gap_is_not() -> None:
    assert len(evened([sample(0.0), sample(8.0)])) == 3
    assert len(evened([sample(0.0), sample(2000.0), sample(2004.0)])) == 3


def test_a_second_sample_of_one_stamp_counts_for_nothing() -> None:
    assert len(evened([sample(0.0), sample(4.0), sample(4.0, 9.0), sample(8.0)])) == 3


def test_the_period_is_the_usual_one() -> None:
    assert period_s([sample(t_ms) for t_ms in (0.0, 4.0, 8.0, 40.0, 44.0)]) == pytest.approx(0.004)
    assert period_s([sample(0.0)]) is None
