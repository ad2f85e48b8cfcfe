"""Live sensors as a feed: from when all speak until enough was heard; one that is missing is told at once."""

from collections.abc import Callable
from threading import Event

import pytest

from server.calibrating.feed import LiveFeed
from server.errors import SensorMissing
from tracker.errors import SourceLost
from tracker.measurements import ImuSample, MagSample, Measurement
from tracker.rig import Rig
from tracker.sources.source import Put, SourceStatus


class Said:
    """A sensor that says the same until it is stopped, or fails."""

    def __init__(self, name: str, make: Callable[[int], Measurement], fails: str = "") -> None:
        self.name, self._make, self._fails = name, make, fails
        self.stopped = False

    def run(self, put: Put, stop: Event) -> None:
        if self._fails:
            raise SourceLost(self._fails)
        i = 0
        while not stop.wait(0.001):
            put(self._make(i))
            i += 1
        self.stopped = True

    def status(self) -> SourceStatus:
        return SourceStatus(True, "a thing", facts={"device": f"The {self.name}", "serial": "7"})


def imu(i: int) -> Measurement:
    return ImuSample(i, i, (0.0,) * 3, (0.0, 0.0, 9.81))


def mag(i: int) -> Measurement:
    return MagSample(i, i, (1e-5,) * 3)


def test_what_all_of_them_say_is_heard_and_everything_stops() -> None:
    sources = [Said("imu", imu), Said("mag", mag)]
    heard: list[Measurement] = []
    feed = LiveFeed(sources, Rig(), 60.0)
    measurements = feed.measurements(lambda what, share: None)
    while len(heard) < 50:
        heard.append(next(measurements))
    measurements.close()
    assert {type(measurement) for measurement in heard} == {ImuSample, MagSample}
    assert all(source.stopped for source in sources)
    assert feed.device("imu") == ("The imu", "7")
    assert feed.device("gps") == ("", "")


def test_a_missing_sensor_is_told_with_its_own_words() -> None:
    there = Said("mag", mag)
    feed = LiveFeed([there, Said("imu", imu, fails="Plug the thing in.")], Rig(), 60.0)
    with pytest.raises(SensorMissing, match="Plug the thing in"):
        list(feed.measurements(lambda what, share: None))
    assert SensorMissing.exit_code == 3
