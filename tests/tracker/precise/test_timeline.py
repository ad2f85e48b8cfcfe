"""What arrives in any order is taken in order of measuring, once, and knows the inertial sample after it."""

from hypothesis import given
from hypothesis import strategies as st

from tracker.measurements import GpsVelocity, ImuSample, Sighting
from tracker.precise.timeline import Keyframe, Timed, Timeline

ZERO = (0.0, 0.0, 0.0)
S = 1_000_000_000


def _imu(t_ns: int) -> ImuSample:
    return ImuSample(t_ns, t_ns, ZERO, ZERO)


def _velocity(t_ns: int) -> GpsVelocity:
    return GpsVelocity(t_ns, t_ns, ZERO)


def _all() -> list[Timed]:
    samples: list[Timed] = [_imu(4 * i) for i in range(20)]
    return [*samples, *(_velocity(6 * i) for i in range(8)), *(Keyframe(8 * i) for i in range(4))]


@given(st.permutations(_all()))
def test_any_order_of_arrival_is_one_order_of_measuring(arrivals: list[Timed]) -> None:
    timeline = Timeline()
    assert all(timeline.add(measurement) for measurement in arrivals)
    assert timeline.newest_ns == 76
    taken = [*timeline.take(30), *timeline.take(1000)]
    assert [(m.t_ns, type(m)) for m, _ in taken if m.t_ns == 24] == [
        (24, ImuSample),
        (24, GpsVelocity),
        (24, Keyframe),
    ]
    assert [m.t_ns for m, _ in taken] == sorted(m.t_ns for m in arrivals)
    assert sorted(repr(m) for m, _ in taken) == sorted(map(repr, arrivals))
    assert timeline.waiting == []
    following = {m.t_ns: after.t_ns for m, after in taken if isinstance(m, GpsVelocity) and after is not None}
    assert {t: after for t, after in following.items() if t % 4} == {6: 8, 18: 20, 30: 32, 42: 44}


def test_a_turn_is_over_when_the_next_inertial_sample_s_has_come() -> None:
    """Not before: between two samples it is open until the later one is taken."""
    timeline = Timeline()
    for t_ns in (10, 20, 30):
        timeline.add(_imu(t_ns))
    assert [m.t_ns for m, _ in timeline.take(30)] == [10, 20]
    assert not timeline.add(_velocity(20))
    assert timeline.add(_velocity(21))
    assert timeline.take(30) == []
    timeline.add(_imu(40))
    assert [m.t_ns for m, _ in timeline.take(31)] == [21, 30]


def test_what_is_measured_just_when_it_must_have_arrived_is_in_time() -> None:
    timeline = Timeline()
    timeline.add(_imu(10))
    assert timeline.take(10) == []
    assert timeline.add(_velocity(10))
    assert [type(m) for m, _ in timeline.take(11)] == [ImuSample, GpsVelocity]


def test_what_is_said_twice_is_refused() -> None:
    timeline, ray = Timeline(), (1.0, 0.0, 0.0)
    assert timeline.add(_imu(10))
    assert not timeline.add(ImuSample(10, 11, (1.0, 0.0, 0.0), ZERO))
    assert timeline.add(_velocity(10))
    assert timeline.add(_velocity(9))
    assert not timeline.add(_velocity(10))
    assert timeline.add(Sighting(10, 10, (1.0, 2.0, 3.0), ray, 0.01))
    assert timeline.add(Sighting(10, 10, (1.0, 2.0, 4.0), ray, 0.01)), "another landmark of the same picture"
    assert not timeline.add(Sighting(10, 12, (1.0, 2.0, 3.0), ray, 0.02))


def test_a_receiver_without_an_inertial_sensor_fills_nothing() -> None:
    timeline = Timeline()
    for second in range(100):
        timeline.add(_velocity(second * S))
    assert len(timeline.waiting) <= 3
    assert timeline.newest_ns is None
    timeline.add(_imu(99 * S))
    assert timeline.newest_ns == 99 * S
