"""What is left out before anything else sees it: stamps that do not rise, and numbers that are none."""

from math import inf, nan

import numpy as np
import pytest

from tracker.measurements import GpsFix, ImuSample, Measurement, VisualMotion
from tracker.soundness import Soundness

S = 1_000_000_000


def _imu(t_ns: int, t_recv_ns: int | None = None, gyro_x: float = 0.0) -> ImuSample:
    return ImuSample(t_ns, t_ns if t_recv_ns is None else t_recv_ns, (gyro_x, 0.0, 0.0), (0.0, 0.0, 9.81))


def _faults(*measurements: Measurement) -> list[str | None]:
    soundness = Soundness()
    return [soundness.fault(m) for m in measurements]


def test_stamps_must_rise_within_one_kind_only() -> None:
    """A fix may be older than a sample: it was measured by another sensor."""
    fix = GpsFix(S, 3 * S, 38.0, 27.0, 50.0, (0.0,) * 9)
    assert _faults(_imu(2 * S), fix, _imu(2 * S), _imu(S), _imu(3 * S)) == [
        None, None, "duplicate_stamp", "stamp_went_back", None
    ]  # fmt: skip


def test_a_stamp_that_leaps_ahead_of_its_arrival_does_not_become_the_last() -> None:
    """Else all that follow would have gone back."""
    assert _faults(_imu(S), _imu(90 * S, 2 * S), _imu(2 * S)) == [None, "stamp_after_arrival", None]


@pytest.mark.parametrize("value", [nan, inf])
def test_what_is_no_number_is_left_out(value: float) -> None:
    """And a motion of the camera is looked at as well."""
    motion = VisualMotion(2 * S, 2 * S, 1, S, np.full((3, 3), value), (0.0, 0.0, 0.0), 50, 1.0, False)
    assert _faults(_imu(S, gyro_x=value), motion) == ["not_finite", "not_finite"]


def test_a_fix_that_says_itself_that_it_is_none_may_hold_anything() -> None:
    """It tells that the receiver is there."""
    assert _faults(GpsFix(S, S, nan, nan, nan, (0.0,) * 9, valid=False)) == [None]
