"""What arrives in any order is taken in order of measuring, once."""

from hypothesis import given
from hypothesis import strategies as st

from tracker.measurements import GpsVelocity, ImuSample
from tracker.precise.timeline import Keyframe, Timed, Timeline

ZERO = (0.0, 0.0, 0.0)


def _all() -> list[Timed]:
    samples: list[Timed] = [ImuSample(4 * i, 4 * i, ZERO, ZERO) for i in range(20)]
    return [*samples, *(GpsVelocity(8 * i, 0, ZERO) for i in range(8)), *(Keyframe(8 * i) for i in range(4))]


@given(st.permutations(_all()))
def test_any_order_of_arrival_is_one_order_of_measuring(arrivals: list[Timed]) -> None:
    timeline = Timeline()
    assert all(timeline.add(measurement) for measurement in arrivals)
    assert timeline.newest_ns == 76
    taken = [*timeline.take(30), *timeline.take(1000)]
    assert [(m.t_ns, type(m)) for m in taken if m.t_ns == 8] == [(8, ImuSample), (8, GpsVelocity), (8, Keyframe)]
    assert [m.t_ns for m in taken] == sorted(m.t_ns for m in arrivals)
    assert sorted(map(repr, taken)) == sorted(map(repr, arrivals))
    assert timeline.imu == []


def test_what_is_too_late_or_said_twice_is_refused() -> None:
    timeline = Timeline()
    assert timeline.add(ImuSample(10, 10, ZERO, ZERO))
    assert not timeline.add(ImuSample(10, 11, ZERO, ZERO))
    assert timeline.add(GpsVelocity(10, 11, ZERO))
    timeline.take(10)
    assert not timeline.add(GpsVelocity(9, 12, ZERO))
    assert timeline.add(GpsVelocity(11, 12, ZERO))
