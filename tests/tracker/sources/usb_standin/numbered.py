"""A GPS and a Spatial on the bus that say numbered samples and epochs, so that each one that is lost or comes twice is seen."""

import time
from collections.abc import Callable, Sequence
from itertools import pairwise
from time import monotonic_ns

from tests.tracker.sources.listening import PATIENCE_S, Listening
from tests.tracker.sources.usb_standin.bus import GPS_1040, SPATIAL_1042, Bus, Vector3, nmea_reports, spatial_report
from tests.tracker.sources.usb_standin.walker import GEOID_M, epoch_sentences
from tracker.measurements import GpsFix, ImuSample, MagSample
from tracker.sources.source import Source

G_M_S2 = 9.80665
TICK_NS = 4_000_000
LEVEL: Vector3 = (0.0, 0.0, 1.0)
STILL: Vector3 = (0.0, 0.0, 0.0)
NOON_MS = 12 * 3600 * 1000
#: Samples are numbered by their acceleration along x, in steps of 1/1024 g, from -4 g to 4 g and over again.
NUMBERS = 8192


class Rig:
    """A GPS and a Spatial on the bus, which say numbered samples and epochs in real time or faster."""

    def __init__(self, bus: Bus, kind: tuple[int, int] = SPATIAL_1042) -> None:
        self.bus, self.kind = bus, kind
        self.gps, self.spatial = bus.add(GPS_1040, 1001), bus.add(kind, 2002)
        self.tick = 0
        """Of 4 ms; the device's clock."""
        self.ticks_ahead = 0
        """What was added to the clock of the Spatial."""
        self.utc_ms = NOON_MS
        self.has_sky, self.stands = True, False
        self.damage: Callable[[bytes, int], bytes] = lambda sentences, epoch: sentences
        self.samples_said: list[int] = []
        self.epochs_said: list[int] = []
        self._listening: list[Listening] = []

    def listen(self, source: Source) -> Listening:
        """Run a source, whose end would be this rig's failure."""
        listening = Listening(source)
        self._listening.append(listening)
        return listening

    def say(self) -> None:
        """Say what a tick brings: a sample, and every 25th an epoch."""
        number = self.tick % NUMBERS
        accel_g = ((number - NUMBERS // 2) / 1024.0, 0.0, 1.0)
        t_ms = 4 * (self.tick + self.ticks_ahead)
        if self.bus.push(self.spatial, spatial_report(t_ms, accel_g, STILL, (0.2, 0.1, 0.4), self.kind)):
            self.samples_said.append(self.tick)
        if self.tick % 25 == 0:
            self.say_epoch(self.tick // 25)
        self.tick += 1

    def say_epoch(self, epoch: int) -> None:
        """Say where the receiver is: one step of 1e-6 degrees north an epoch."""
        lat_deg = 37.0 if self.stands else 37.0 + epoch * 1e-6
        fix = GpsFix(0, 0, lat_deg, 27.0, 80.0 + GEOID_M, ())
        sentences = epoch_sentences(fix, (3.0, 4.0, 0.0), self.utc_ms + 100 * epoch, self.has_sky)
        taken = [self.bus.push(self.gps, part) for part in nmea_reports(self.damage(sentences, epoch))]
        if all(taken):
            self.epochs_said.append(epoch)

    def live(self, seconds: float) -> None:
        """Go on for some seconds of real time."""
        t_start_ns, first = monotonic_ns(), self.tick
        for _ in range(round(seconds * 250)):
            self.say()
            wait_ns = t_start_ns + (self.tick - first) * TICK_NS - monotonic_ns()
            if wait_ns > 0:
                time.sleep(wait_ns / 1e9)

    def live_until(self, is_done: Callable[[], object]) -> None:
        """Go on until something has happened."""
        for _ in range(round(PATIENCE_S * 50)):
            if is_done():
                return
            errors = [listening.error for listening in self._listening if listening.error is not None]
            assert not errors
            self.live(0.02)
        devices = {
            number: (self.bus.listened_to(number), self.bus.waiting(number)) for number in (self.gps, self.spatial)
        }
        raise AssertionError(
            f"it has not happened in {PATIENCE_S} s: listened to, and reports waiting, by device: {devices}"
        )


def of_kind(kind: type, listening: Listening) -> list:  # type: ignore[type-arg]
    return [measurement for measurement in list(listening.found) if isinstance(measurement, kind)]


def imu(listening: Listening) -> list[ImuSample]:
    return of_kind(ImuSample, listening)


def mag(listening: Listening) -> list[MagSample]:
    return of_kind(MagSample, listening)


def numbers(samples: Sequence[ImuSample]) -> list[int]:
    """Return the numbers that samples carry."""
    return [round(-sample.accel_m_s2[0] / G_M_S2 * 1024.0) + NUMBERS // 2 for sample in samples]


def epochs(fixes: Sequence[GpsFix]) -> list[int]:
    """Return the numbers that fixes carry."""
    return [round((fix.lat_deg - 37.0) / 1e-6) for fix in fixes if fix.valid]


def consecutive(found: Sequence[int], turn: int | None = None) -> bool:
    """Whether numbers follow one another with none left out and none twice."""
    steps = {b - a if turn is None else (b - a) % turn for a, b in pairwise(found)}
    return steps == {1}
