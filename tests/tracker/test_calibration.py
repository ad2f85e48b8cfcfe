"""Offsets at rest and the mean of four."""

import numpy as np
import pytest

from tracker.calibration import RestCalibration, SampleMean
from tracker.measurements import ImuSample


def sample(t_s: float, gyro: tuple[float, float, float], accel: tuple[float, float, float] = (0, 0, 9.81)) -> ImuSample:
    t_ns = round(t_s * 1e9)
    return ImuSample(t_ns, t_ns, gyro, accel)


def test_offset_is_the_mean_at_rest_and_stays_when_the_rig_moves() -> None:
    rng = np.random.default_rng(1)
    calibration = RestCalibration()
    for k in range(2500):
        x, y, z = (float(v) for v in rng.normal((0.004, -0.002, 0.001), 0.002))
        calibration.step(sample(k * 0.004, (x, y, z)))
    assert calibration.gyro_offset_rad_s == pytest.approx((0.004, -0.002, 0.001), abs=2e-4)
    for k in range(2500, 5000):
        calibration.step(sample(k * 0.004, (0.0, 0.0, 1.0)))
    assert calibration.finished
    assert calibration.gyro_offset_rad_s == pytest.approx((0.004, -0.002, 0.001), abs=2e-4)


def test_five_thousand_samples_are_enough() -> None:
    calibration = RestCalibration()
    for k in range(6000):
        calibration.step(sample(k * 0.004, (0.001, 0.0, 0.0)))
    assert calibration.finished
    assert 5000 <= calibration.samples < 5200


def wander(seconds: float, rad_s_s: float) -> list[ImuSample]:
    """A rig that lies still while its offset grows."""
    return [sample(k * 0.004, (0.001 + rad_s_s * k * 0.004, 0.0, 0.0)) for k in range(round(seconds * 250))]


def test_an_offset_that_wanders_is_followed_while_the_rig_lies_still() -> None:
    """The newest 5000 samples but for a second: 20 s whose middle is 11 s ago. They are never more than that, however long."""
    calibration = RestCalibration()
    for one in wander(60.0, 1e-5):
        calibration.step(one)
    assert calibration.finished
    assert 5000 <= calibration.samples < 5200
    assert calibration.gyro_offset_rad_s[0] == pytest.approx(0.001 + 1e-5 * (60.0 - 11.0), abs=1e-5)


def test_taking_the_rig_up_spoils_no_offset() -> None:
    """The hand's first second looks still, and is not counted; after it the offset stands, though the rig lies down again."""
    calibration = RestCalibration()
    still, taken = wander(40.0, 0.0), [sample(40.0 + k * 0.004, (0.02, 0.0, 0.0)) for k in range(250)]
    moving = [sample(41.0 + k * 0.004, (0.5, 0.0, 0.0)) for k in range(250)]
    again = [sample(42.0 + k * 0.004, (0.009, 0.0, 0.0)) for k in range(10000)]
    for one in (*still, *taken, *moving, *again):
        calibration.step(one)
    assert calibration.gyro_offset_rad_s[0] == pytest.approx(0.001, abs=1e-6)


def test_a_turning_rig_gives_no_offset() -> None:
    calibration = RestCalibration()
    for k in range(1000):
        calibration.step(sample(k * 0.004, (0.0, 0.0, 0.5)))
    assert calibration.samples == 0
    assert calibration.gyro_offset_rad_s == (0.0, 0.0, 0.0)


def test_half_a_second_of_stillness_is_no_rest() -> None:
    """A hand that begins to turn slowly looks still for a moment; its rate is no offset."""
    calibration = RestCalibration()
    for k in range(60):
        calibration.step(sample(k / 60, (0.0, 0.0, -0.014)))
    for k in range(60, 600):
        calibration.step(sample(k / 60, (0.0, 0.0, -0.2)))
    assert calibration.gyro_offset_rad_s == (0.0, 0.0, 0.0)


def test_sway_is_believed_less_than_a_table() -> None:
    """Three seconds of blocks that scatter by 0.02 rad/s leave little of their mean; the same mean on a table stays."""
    table, person = RestCalibration(), RestCalibration()
    for k in range(300):
        sway = 0.025 if (k // 51) % 2 else -0.015
        table.step(sample(k / 100, (0.0, 0.005, 0.0)))
        person.step(sample(k / 100, (0.0, sway, 0.0)))
    assert table.gyro_offset_rad_s[1] == pytest.approx(0.005)
    assert 0.0 < person.gyro_offset_rad_s[1] < 0.0025


@pytest.mark.parametrize(("rate_hz", "group"), [(250.0, 4), (100.0, 1), (200.0, 3), (16.0, 1)])
def test_groups_span_at_most_16_ms(rate_hz: float, group: int) -> None:
    mean = SampleMean()
    groups = [m for k in range(101) if (m := mean.step(sample(k / rate_hz, (float(k), 0.0, 0.0)))) is not None]
    assert groups[0].dt_s == 0.0
    assert [m.dt_s for m in groups[1:]] == pytest.approx([group / rate_hz] * (100 // group))
    assert groups[1].gyro_rad_s[0] == pytest.approx((1 + group) / 2)


def test_a_gap_is_not_integrated_over() -> None:
    mean = SampleMean()
    mean.step(sample(0.0, (0.0, 0.0, 0.0)))
    after = mean.step(sample(5.0, (1.0, 0.0, 0.0)))
    assert after is not None
    assert after.dt_s == 0.25
