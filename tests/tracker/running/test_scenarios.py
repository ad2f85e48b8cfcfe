"""Sensors that are pulled out, freeze, lie and come late: what is said of them, and how far the pose may be off meanwhile.

Each on simulated time through everything but the threads. The walk's own receiver is off by 3.4 to 4.3 m in it; bounds are for the
horizontal error against the truth. "Within 3 s" is after the sensor's return: there is a pose, north is known, and both are right.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.running.faults import (
    CAMERA,
    GPS,
    IMU,
    Row,
    at,
    changed,
    healthy,
    run,
    without,
)
from tests.tracker.running.walking import S
from tracker.device_clock import DeviceClock
from tracker.measurements import GpsFix, ImuSample, MagSample, Measurement, VisualMotion
from tracker.running.health import SensorState

BEGIN_S = 30.0
#: What the receiver's own slow error and the filter make of the walk when nothing is amiss.
USUAL_M = 5.0
SOON_S = 3.0


def between(rows: list[Row], from_s: float, to_s: float) -> list[Row]:
    return [row for row in rows if from_s <= row.t_s < to_s]


def states(rows: list[Row], sensor: str) -> set[SensorState]:
    return {row.states[sensor] for row in rows}


def expect_tracking(rows: list[Row], error_m: float = USUAL_M, heading_deg: float = 15.0) -> None:
    """There is a pose all the time, north is known, and both are right."""
    assert rows
    assert all(row.has_pose and row.heading_known for row in rows)
    assert max(row.error_m for row in rows) < error_m
    assert max(row.heading_error_deg for row in rows) < heading_deg


def expect_no_lie(rows: list[Row], sigmas: float = 3.5) -> None:
    """What is said to be known is: the error is within what the pose says of itself, and so is the heading."""
    told = [row for row in rows if row.has_pose]
    assert max((row.error_m / row.sigma_m for row in told), default=0.0) < sigmas
    assert all(row.heading_error_deg < 25.0 for row in told if row.heading_known)


def expect_well(rows: list[Row], from_s: float, to_s: float) -> None:
    """Every sensor streams, and tracking is as usual."""
    later = between(rows, from_s, to_s)
    for sensor in ("gps", "imu", "camera"):
        assert states(later, sensor) == {SensorState.STREAMING}, sensor
    expect_tracking(later)


def repeated(kinds: tuple[type, ...], from_s: float, to_s: float) -> Iterator[Measurement]:
    """The walk with sensors that say the same again and again for a time, at their usual rate."""
    last: dict[type, Measurement] = {}
    for m in healthy():
        kind = type(m)
        if not isinstance(m, kinds):
            yield m
        elif at(from_s) <= m.t_ns < at(to_s) and kind in last:
            yield replace(last[kind], t_ns=m.t_ns, t_recv_ns=m.t_recv_ns)
        else:
            last[kind] = m
            yield m


def test_nothing_amiss() -> None:
    """Expected: every sensor streams from its first second on; error below 5 m, heading known and within 15 degrees."""
    rows = run(healthy(), until_s=45.0)
    expect_well(rows, 10.0, 45.0)
    expect_no_lie(rows)


def test_gps_gone_for_a_minute() -> None:
    """Expected: gps lost; the steps and the camera carry the walk on: error below 12 m after a minute, said honestly."""
    end_s = BEGIN_S + 60.0
    rows = run(without(healthy(), GPS, BEGIN_S, end_s), gone={"gps": (BEGIN_S, end_s)}, until_s=end_s + 8.0)
    away = between(rows, BEGIN_S + 1.0, end_s)
    assert states(away, "gps") == {SensorState.LOST}
    assert "put it back" in away[-1].sentences["gps"]
    expect_tracking(away, error_m=12.0)
    expect_no_lie(rows)
    expect_well(rows, end_s + SOON_S, end_s + 8.0)


def test_gps_silent_without_a_word_of_its_source() -> None:
    """Expected: gps silent after three seconds, with the remedy; tracking as with one that is lost."""
    rows = run(without(healthy(), GPS, BEGIN_S, BEGIN_S + 10.0), until_s=BEGIN_S + 20.0)
    assert states(between(rows, BEGIN_S + 4.0, BEGIN_S + 10.0), "gps") == {SensorState.SILENT}
    expect_well(rows, BEGIN_S + 10.0 + SOON_S, BEGIN_S + 20.0)


def test_gps_frozen() -> None:
    """Expected: gps stuck after three seconds of walking, and what it says is not used: error below 8 m after half a minute."""
    end_s = BEGIN_S + 30.0
    rows = run(repeated(GPS, BEGIN_S, end_s), until_s=end_s + 8.0)
    assert states(between(rows, BEGIN_S + 4.0, end_s), "gps") == {SensorState.STUCK}
    expect_tracking(between(rows, BEGIN_S, end_s), error_m=8.0)
    expect_well(rows, end_s + SOON_S, end_s + 8.0)


def jumped(seconds: float) -> Iterator[Measurement]:
    """The walk with fixes that are 50 m to the north for a time."""

    def north(m: Measurement) -> Measurement:
        assert isinstance(m, GpsFix)
        return replace(m, lat_deg=m.lat_deg + 50.0 / 111_000.0)

    return changed(healthy(), (GpsFix,), BEGIN_S, BEGIN_S + seconds, north)


def unseen(m: Measurement) -> Measurement:
    """Return a motion without inliers, which stands for a picture in which nothing was seen."""
    assert isinstance(m, VisualMotion)
    return replace(m, inliers=0)


def test_gps_jumps_for_a_moment() -> None:
    """Expected: no word of health, since the receiver is well; a jump of 50 m for three seconds moves nothing: below 5 m."""
    rows = run(jumped(3.0), until_s=BEGIN_S + 12.0)
    expect_well(rows, BEGIN_S, BEGIN_S + 12.0)
    expect_no_lie(rows)


def test_gps_jumps_and_stays() -> None:
    """Expected: below 5 m for four seconds; then the receiver is believed, as it must be, and off by 50 m + 5 m until it returns.

    Then it is believed at once: back below 5 m within 3 s.
    """
    rows = run(jumped(20.0), until_s=BEGIN_S + 30.0)
    expect_tracking(between(rows, BEGIN_S, BEGIN_S + 4.0))
    expect_tracking(between(rows, BEGIN_S, BEGIN_S + 20.0 + SOON_S), error_m=55.0)
    expect_well(rows, BEGIN_S + 20.0 + SOON_S, BEGIN_S + 30.0)


@pytest.mark.parametrize(
    ("name", "seconds", "seed"),
    [
        ("gps-imu/precise", 2.0, 12),
        ("camera-gps-imu/precise", 2.0, 12),
        ("camera-gps-imu/precise", 2.0, 4),
        ("camera-gps-imu/precise", 6.0, 12),
        ("camera-gps-imu/precise", 6.0, 4),
    ],
)
def test_imu_gone_for_seconds(name: str, seconds: float, seed: int) -> None:
    """Expected: imu lost; the pose goes on for a second, north unknown soon, then none. Within 3 s it is back: 5 m, 30 degrees.

    With the camera, which has seen how the head turned meanwhile, 15 degrees.
    """
    end_s = BEGIN_S + seconds
    stream = without(healthy(seed), IMU, BEGIN_S, end_s)
    rows = run(stream, gone={"imu": (BEGIN_S, end_s)}, name=name, until_s=end_s + 10.0, seed=seed)
    assert states(between(rows, BEGIN_S + 0.5, end_s), "imu") == {SensorState.LOST}
    assert not any(row.heading_known for row in between(rows, BEGIN_S + 0.7, end_s))
    assert not any(row.has_pose for row in between(rows, BEGIN_S + 1.1, end_s))
    expect_no_lie(rows)
    later = between(rows, end_s + SOON_S, end_s + 10.0)
    expect_tracking(later, heading_deg=15.0 if name.startswith("camera") else 30.0)


def test_imu_gone_for_half_a_second() -> None:
    """Expected: no more than a moment of silence; the pose goes on, north is unknown for a moment and then right: 15 degrees."""
    rows = run(without(healthy(), IMU, BEGIN_S, BEGIN_S + 0.5), until_s=BEGIN_S + 10.0)
    assert all(row.has_pose for row in between(rows, BEGIN_S, BEGIN_S + 10.0))
    expect_no_lie(rows)
    expect_well(rows, BEGIN_S + 0.5 + SOON_S, BEGIN_S + 10.0)


def test_imu_stuck() -> None:
    """Expected: imu stuck after a tenth of a second, its samples not used; then as with one that is gone."""
    end_s = BEGIN_S + 3.0
    rows = run(repeated((ImuSample,), BEGIN_S, end_s), until_s=end_s + 10.0)
    assert states(between(rows, BEGIN_S + 0.3, end_s), "imu") == {SensorState.STUCK}
    expect_no_lie(rows)
    expect_well(rows, end_s + SOON_S, end_s + 10.0)


def test_camera_black() -> None:
    """Expected: camera unusable after two seconds, and said what may cover it; tracking goes on without: below 5 m."""
    end_s = BEGIN_S + 10.0
    black = changed(healthy(), (VisualMotion,), BEGIN_S, end_s, unseen)
    rows = run(black, until_s=end_s + 8.0)
    dark = between(rows, BEGIN_S + 2.5, end_s)
    assert states(dark, "camera") == {SensorState.UNUSABLE}
    assert "covered" in dark[0].sentences["camera"]
    expect_tracking(between(rows, BEGIN_S, end_s))
    expect_well(rows, end_s + SOON_S, end_s + 8.0)


def test_camera_gone() -> None:
    """Expected: camera lost; tracking goes on without: below 5 m."""
    end_s = BEGIN_S + 10.0
    stream = without(healthy(), CAMERA, BEGIN_S, end_s)
    rows = run(stream, gone={"camera": (BEGIN_S, end_s)}, until_s=end_s + 8.0)
    assert states(between(rows, BEGIN_S + 0.5, end_s), "camera") == {SensorState.LOST}
    expect_tracking(between(rows, BEGIN_S, end_s))
    expect_well(rows, end_s + SOON_S, end_s + 8.0)


def by_its_clock(device_ns: Callable[[int], int], away_s: tuple[float, float] = (0.0, 0.0)) -> Iterator[Measurement]:
    """The walk with an inertial unit that stamps by a clock of its own, mapped to ours as its source does."""
    clock = DeviceClock()
    for m in sorted(healthy(), key=lambda m: m.t_recv_ns):
        if isinstance(m, ImuSample | MagSample):
            if at(away_s[0]) <= m.t_ns < at(away_s[1]):
                continue
            yield replace(m, t_ns=clock.local_ns(device_ns(m.t_ns), m.t_recv_ns))
        else:
            yield m


def test_a_clock_steps_back_by_a_second() -> None:
    """Expected: nothing to be seen, since the clock is followed: below 5 m all the time, every sensor streaming."""
    rows = run(by_its_clock(lambda t_ns: t_ns - at(0.0) - (S if t_ns >= at(BEGIN_S) else 0)), until_s=BEGIN_S + 12.0)
    expect_well(rows, BEGIN_S, BEGIN_S + 12.0)
    expect_no_lie(rows)


def test_a_sensor_comes_back_with_its_clock_at_zero() -> None:
    """Expected: as with an inertial unit that is gone for two seconds; that its clock began anew makes no difference."""
    end_s = BEGIN_S + 2.0
    stream = by_its_clock(lambda t_ns: t_ns - at(end_s if t_ns >= at(end_s) else -900.0), (BEGIN_S, end_s))
    rows = run(stream, gone={"imu": (BEGIN_S, end_s)}, until_s=end_s + 10.0)
    assert states(between(rows, BEGIN_S + 0.5, end_s), "imu") == {SensorState.LOST}
    expect_no_lie(rows)
    expect_well(rows, end_s + SOON_S, end_s + 10.0)


def test_samples_out_of_order() -> None:
    """Expected: no word of health; what is out of order is left out, and the pose is as usual: below 5 m."""
    rng = np.random.default_rng(3)

    def delayed(m: Measurement) -> Measurement:
        return replace(m, t_recv_ns=m.t_recv_ns + int(rng.integers(0, 120_000_000)))

    rows = run(changed(healthy(), IMU, BEGIN_S, BEGIN_S + 10.0, delayed), until_s=BEGIN_S + 16.0)
    expect_well(rows, BEGIN_S, BEGIN_S + 16.0)
    expect_no_lie(rows)


def test_all_of_them_at_once() -> None:
    """Expected: each sensor lost and back by itself; error below 8 m, and 3 s after the last has returned all is as usual."""
    gps_s, imu_s, camera_s = (BEGIN_S, BEGIN_S + 15.0), (BEGIN_S + 2.0, BEGIN_S + 4.0), (BEGIN_S, BEGIN_S + 10.0)
    stream = without(without(without(healthy(), GPS, *gps_s), IMU, *imu_s), CAMERA, *camera_s)
    rows = run(stream, gone={"gps": gps_s, "imu": imu_s, "camera": camera_s}, until_s=BEGIN_S + 26.0)
    for sensor, (from_s, to_s) in {"gps": gps_s, "imu": imu_s, "camera": camera_s}.items():
        assert states(between(rows, from_s + 0.5, to_s), sensor) == {SensorState.LOST}, sensor
    expect_no_lie(rows)
    expect_tracking(between(rows, imu_s[1] + SOON_S, gps_s[1]), error_m=8.0)
    expect_well(rows, gps_s[1] + SOON_S, BEGIN_S + 26.0)
