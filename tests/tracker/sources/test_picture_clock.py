"""Capture times: whatever comes with pictures, in order and never after reading."""

from hypothesis import given
from hypothesis import strategies as st

from tracker.sources.picture_clock import PictureClock

MS = 1_000_000


@given(
    st.booleans(),
    st.lists(st.tuples(st.floats(allow_nan=True, allow_infinity=True), st.integers(1, 10_000 * MS)), max_size=50),
)
def test_times_rise_and_are_never_after_reading_whatever_the_camera_says(
    is_driver: bool, pictures: list[tuple[float, int]]
) -> None:
    clock, t_recv_ns, last_ns = PictureClock(is_driver=is_driver, latency_ns=40 * MS), 10**12, 0
    for stamp_ms, step_ns in pictures:
        t_recv_ns += step_ns
        t_ns = clock.local_ns(stamp_ms, t_recv_ns)
        assert last_ns < t_ns <= t_recv_ns
        last_ns = t_ns


@given(st.lists(st.integers(0, 400 * MS), min_size=3, max_size=60))
def test_a_drivers_stamps_come_out_as_they_are(waits_ns: list[int]) -> None:
    clock, t_recv_ns = PictureClock(is_driver=True, latency_ns=0), 0
    for i, wait_ns in enumerate(waits_ns):
        t_ns = 10**12 + i * 33 * MS
        t_recv_ns = max(t_recv_ns + 1000, t_ns + wait_ns)
        assert abs(clock.local_ns(t_ns / 1e6, t_recv_ns) - t_ns) <= 1000
        assert clock.kind == "driver"


def test_a_stamp_that_stands_still_is_not_believed() -> None:
    clock = PictureClock(is_driver=True, latency_ns=5 * MS)
    times = [clock.local_ns(7.0, 10**12 + i * 33 * MS) for i in range(4)]
    assert times[1:] == [10**12 + i * 33 * MS - 5 * MS for i in (1, 2, 3)]
    assert clock.kind == "read"
