"""What is withheld from the estimator: stamps that do not rise, and sensors that say one thing for ever."""

from tracker.measurements import GpsFix, GpsVelocity, ImuSample
from tracker.running.guard import Guard

S = 1_000_000_000


def _imu(index: int, gyro_x: float = 0.1) -> ImuSample:
    t_ns = index * S // 100
    return ImuSample(t_ns, t_ns, (gyro_x, 0.0, 0.0), (0.0, 0.0, 9.81))


def _fix(second: int, lat_deg: float = 37.9) -> GpsFix:
    return GpsFix(second * S, second * S, lat_deg, 27.3, 80.0, (0.0,) * 9)


def test_an_inertial_unit_that_repeats_one_value_is_withheld_at_once_and_stuck_after_a_tenth_of_a_second() -> None:
    """Until it says something else; equal numbers twice are nothing."""
    guard, kept, stuck = Guard(), [], []
    for index in range(100):
        kept.append(not guard.withholds(_imu(index), 0.0))
        stuck.append(guard.imu_stuck)
    assert kept == [True] * 3 + [False] * 97
    assert stuck == [False] * 10 + [True] * 90
    assert not guard.withholds(_imu(100, 0.2), 0.0)
    assert not guard.imu_stuck
    assert guard.withheld == {"imu_repeats": 97}


def test_a_slow_unit_is_stuck_after_as_many_samples() -> None:
    """At 16 Hz a tenth of a second is two."""
    guard, stuck = Guard(), []
    for i in range(12):
        guard.withholds(ImuSample(i * S // 16, i * S // 16, (0.0,) * 3, (0.0,) * 3), 0.0)
        stuck.append(guard.imu_stuck)
    assert stuck == [False] * 9 + [True] * 3


def test_a_receiver_that_repeats_itself_is_withheld_where_the_rig_walks() -> None:
    """And stays so when the rig stands, until it says something else; so does its velocity."""
    guard = Guard()
    assert [guard.withholds(_fix(second), 1.2) for second in range(5)] == [False, False, False, True, True]
    assert guard.gps_stuck
    assert guard.withholds(GpsVelocity(4 * S, 4 * S, (0.0, 0.0, 0.0)), 0.0)
    assert guard.withholds(_fix(5), 0.0)
    assert not guard.withholds(_fix(6, 37.91), 1.2)
    assert not guard.withholds(GpsVelocity(6 * S, 6 * S, (0.0, 0.0, 0.0)), 0.0)
    assert guard.withheld == {"gps_repeats": 4}


def test_a_receiver_may_repeat_itself_where_the_rig_stands() -> None:
    """Some hold their position on purpose."""
    guard = Guard()
    assert not any(guard.withholds(_fix(second), 0.1) for second in range(60))


def test_a_receiver_whose_velocity_does_not_move_it_is_stuck_at_once() -> None:
    """Whatever the rig does: it says itself that it moves, and that it does not."""
    guard, moving = Guard(), (0.9, 0.0, 0.0)
    assert not guard.withholds(_fix(0), 0.0)
    assert not guard.withholds(GpsVelocity(0, 0, moving), 0.0)
    assert not guard.withholds(_fix(1), 0.0)
    assert guard.withholds(GpsVelocity(S, S, moving), 0.0)
    assert guard.withholds(_fix(2), 0.0)
    assert not guard.withholds(_fix(3, 37.91), 0.0)
    assert not guard.withholds(GpsVelocity(3 * S, 3 * S, moving), 0.0)


def test_a_fast_receiver_of_few_digits_may_say_one_position_twice() -> None:
    """A step of the last digit is some decimetres."""
    guard = Guard()
    for tenth in range(100):
        t_ns, lat_deg = tenth * S // 10, 37.9 + (tenth // 3) * 3e-6
        assert not guard.withholds(GpsFix(t_ns, t_ns, lat_deg, 27.3, 80.0, (0.0,) * 9), 1.2)
        assert not guard.withholds(GpsVelocity(t_ns, t_ns, (0.0, 1.2, 0.0)), 1.2)


def test_stamps_out_of_order_are_withheld() -> None:
    """As a log's reader leaves them out: a replay must see the same."""
    guard = Guard()
    assert [guard.withholds(_imu(i, 0.01 * i), 0.0) for i in (1, 3, 2, 3, 4)] == [False, False, True, True, False]
    assert guard.withheld == {"stamp_went_back": 1, "duplicate_stamp": 1}
