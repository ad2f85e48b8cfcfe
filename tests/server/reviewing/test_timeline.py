"""What happened on a walk, told by its sensors alone."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from server.reviewing.timeline import Event, Timeline, timeline_of
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, GpsFix, ImuSample, MagSample, Measurement
from tracker.pictures import EncodedPicture
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

SECONDS = 20.0
Change = Callable[[Measurement, float], Measurement | None]


def walk(path: Path, change: Change = lambda measurement, t_s: measurement) -> Timeline:
    """Return the timeline of a walk of twenty seconds, of which each measurement was changed or left out."""
    rig = default_rig()
    simulated = Walk(WalkSettings(seed=4, duration_s=SECONDS, still_s=4.0), rig)
    frames = [
        Frame(t, late, i, EncodedPicture(b"\xff\xd8\xff\xd9")) for i, (t, late) in enumerate(simulated.frame_times())
    ]
    everything = sorted([*simulate(simulated), *frames], key=lambda m: m.t_recv_ns)
    with LogWriter(path, rig, simulated.settings.origin, t_start_ns=START_NS) as writer:
        for measurement in everything:
            changed = change(measurement, (measurement.t_recv_ns - START_NS) * 1e-9)
            if changed is not None:
                writer.write(changed)
    return timeline_of(Log.open(path))


def of_kind(timeline: Timeline, kind: str) -> Iterator[Event]:
    """Yield the events of a kind."""
    return (event for event in timeline.events if event.kind == kind)


def test_a_walk_on_which_nothing_happens_has_its_stop_at_the_start_and_its_pictures(tmp_path: Path) -> None:
    timeline = walk(tmp_path / "calm.mcap")
    assert timeline.duration_s == pytest.approx(SECONDS, abs=0.2)
    assert timeline.has_truth
    assert len(timeline.pictures_s) == SECONDS * 12
    assert timeline.pictures_s == sorted(timeline.pictures_s)
    assert {event.kind for event in timeline.events} == {"stop"}
    first = next(of_kind(timeline, "stop"))
    assert first.from_s < 1.0
    assert first.until_s == pytest.approx(4.0, abs=1.0)


@pytest.mark.parametrize(
    ("kind", "sensor"), [(GpsFix, "gps"), (ImuSample, "imu"), (Frame, "camera"), (MagSample, "mag")]
)
def test_a_sensor_that_says_nothing_is_told(tmp_path: Path, kind: type[Measurement], sensor: str) -> None:
    timeline = walk(
        tmp_path / "silent.mcap",
        lambda measurement, t_s: None if isinstance(measurement, kind) and 8.0 < t_s < 13.0 else measurement,
    )
    (silence,) = of_kind(timeline, "silence")
    assert silence.sensor == sensor
    assert silence.from_s == pytest.approx(8.0, abs=1.1)
    assert silence.until_s == pytest.approx(13.0, abs=1.1)


def test_iron_nearby_and_a_weak_receiver_are_told(tmp_path: Path) -> None:
    def disturbed(measurement: Measurement, t_s: float) -> Measurement:
        if isinstance(measurement, MagSample) and 6.0 < t_s < 9.0:
            x, y, z = measurement.field_body_t
            return replace(measurement, field_body_t=(1.5 * x, 1.5 * y, 1.5 * z))
        if isinstance(measurement, GpsFix) and 12.0 < t_s < 18.0:
            return replace(measurement, cov_enu_m2=tuple(100.0 * value for value in measurement.cov_enu_m2))
        return measurement

    timeline = walk(tmp_path / "disturbed.mcap", disturbed)
    (iron,), (weak,) = of_kind(timeline, "magnetic"), of_kind(timeline, "weak_gps")
    assert (iron.from_s, iron.until_s) == pytest.approx((6.0, 9.0), abs=0.3)
    assert (weak.from_s, weak.until_s) == pytest.approx((12.0, 18.0), abs=1.2)
    assert not list(of_kind(timeline, "silence"))
