"""What is said of a sensor: in one word, in one sentence, and when."""

from types import MappingProxyType

import pytest

from tracker.running.backoff import Backoff
from tracker.running.figures import Latencies, Rate
from tracker.running.health import KINDS, SensorState, Watch
from tracker.sources.source import SourceStatus

S = 1_000_000_000
ATTACHED = SourceStatus(True, "a PhidgetGPS, serial 1234", MappingProxyType({"bad_checksum": 3}))


def _streaming(name: str, until_s: float, rate_hz: float = 10.0) -> Watch:
    """Return a sensor that has spoken regularly until then."""
    watch = Watch(name, 0)
    for index in range(round(until_s * rate_hz) + 1):
        watch.arrived(round(index * S / rate_hz))
    return watch


def test_a_sensor_waits_then_streams() -> None:
    """Its rate is that of the last two seconds; what its source counts is passed on."""
    assert Watch("gps", 0).read(S).state is SensorState.WAITING
    health = _streaming("gps", 20.0).read(20 * S, ATTACHED)
    assert (health.state, health.count, health.counts["bad_checksum"]) == (SensorState.STREAMING, 201, 3)
    assert health.rate_hz == pytest.approx(10.0, rel=0.1)
    assert health.sentence == "The GPS receiver is well: 10 messages a second."
    assert not health.state.is_trouble


@pytest.mark.parametrize("name", KINDS)
def test_silence_is_said_when_it_is_longer_than_usual(name: str) -> None:
    """And for how long; its rate has fallen to nothing."""
    silent_s = KINDS[name].silent_s
    watch = _streaming(name, 10.0)
    assert watch.read(round((10.0 + 0.9 * silent_s) * S)).state is SensorState.STREAMING
    health = watch.read(40 * S, ATTACHED)
    assert (health.state, health.rate_hz) == (SensorState.SILENT, 0.0)
    assert "for 30 s: check its plug" in health.sentence
    watch.arrived(41 * S)
    assert watch.read(41 * S).state is SensorState.STREAMING


def test_a_sensor_that_never_spoke_is_silent_too() -> None:
    """Since it was opened."""
    watch = Watch("imu", 0)
    watch.opened(5 * S)
    assert watch.read(5 * S + S // 4).state is SensorState.WAITING
    assert "nothing yet" in watch.read(6 * S).sentence


def test_a_lost_sensor_is_lost_until_it_speaks_again() -> None:
    """The reason and the remedy are its source's; a restart alone is no recovery."""
    watch = _streaming("imu", 2.0)
    watch.lost("no PhidgetSpatial is plugged in: plug it in.")
    watch.opened(3 * S)
    health = watch.read(3 * S)
    assert (health.state, health.restarts, health.rate_hz) == (SensorState.LOST, 1, 0.0)
    assert health.sentence == (
        "The inertial unit is gone: no PhidgetSpatial is plugged in: plug it in. It is looked for again and again."
    )
    watch.arrived(4 * S)
    assert watch.read(4 * S).state is SensorState.STREAMING


def test_a_sensor_that_was_never_there_is_not_gone() -> None:
    """It is looked for all the same."""
    watch = Watch("gps", 0)
    watch.lost("no PhidgetGPS was found: plug it in.")
    assert watch.read(S).sentence.startswith("The GPS receiver is not there: no PhidgetGPS was found")


def test_a_source_that_waits_for_its_device_says_so_itself() -> None:
    """It need not end for that: some libraries wait for the plug by themselves."""
    watch = _streaming("gps", 2.0)
    gone = SourceStatus(False, "no PhidgetGPS is plugged in: plug it in")
    assert watch.read(2 * S + S // 10, gone).state is SensorState.STREAMING
    health = watch.read(2 * S + S // 2, gone)
    assert (health.state, health.sentence) == (
        SensorState.LOST,
        "The GPS receiver is not there: no PhidgetGPS is plugged in: plug it in.",
    )


def test_what_can_never_work_stays_so() -> None:
    """Nobody tries again."""
    watch = _streaming("camera", 1.0)
    watch.failed("walk.txt is no video.")
    health = watch.read(2 * S)
    assert (health.state, health.sentence) == (
        SensorState.FAILED,
        "The camera cannot be used: walk.txt is no video.",
    )


def test_repeating_and_seeing_nothing_are_troubles() -> None:
    """A sensor that speaks may be out of order nevertheless."""
    watch = _streaming("camera", 2.0)
    watch.is_unusable = True
    assert watch.read(2 * S).state is SensorState.UNUSABLE
    watch.is_stuck = True
    health = watch.read(2 * S)
    assert health.state is SensorState.STUCK
    assert health.state.is_trouble
    assert health.as_json()["state"] == "stuck"


def test_pauses_double_to_two_seconds_and_begin_anew_after_a_good_run() -> None:
    """A plug put back is found within two seconds."""
    backoff = Backoff()
    assert [backoff.after(0.0) for _ in range(6)] == [0.25, 0.5, 1.0, 2.0, 2.0, 2.0]
    assert backoff.after(10.0) == 0.25


def test_what_has_waited_and_comes_all_at_once_has_a_rate_that_can_be_told() -> None:
    """After a stall a thousand samples are taken in one go; the server takes no message with a rate of a million."""
    watch = Watch("imu", 0)
    for _ in range(1200):
        watch.arrived(5 * S)
    assert watch.read(5 * S).rate_hz < 2e4


def test_latencies_and_rates() -> None:
    """To a bin, with whatever is beyond the last one counted there."""
    latencies, rate = Latencies(), Rate()
    assert latencies.percentile_s(99.0) is None
    for index in range(100):
        latencies.add(0.001 if index < 98 else 9.0)
        rate.note(index * S // 50)
    assert latencies.percentile_s(50.0) == pytest.approx(0.001, abs=1e-4)
    assert latencies.percentile_s(99.0) == pytest.approx(0.5, abs=1e-3)
    assert latencies.longest_s == 9.0
    assert rate.at(2 * S) == pytest.approx(50.0, rel=0.05)
    assert (rate.at(9 * S), rate.count) == (0.0, 100)
