"""What an NMEA receiver says, as measurements: bytes in, in any pieces, fixes and velocities out. No I/O, no clock."""

from collections import Counter
from collections.abc import Iterator, Mapping
from datetime import datetime, timedelta
from math import degrees

from tracker.errors import MalformedInput
from tracker.measurements import GpsFix, GpsVelocity
from tracker.sources.nmea_accuracy import QUALITIES
from tracker.sources.nmea_epoch import Epoch, EpochAssembler
from tracker.sources.nmea_fix import NmeaFixes
from tracker.sources.nmea_lines import NmeaLines
from tracker.sources.nmea_sentence import Gsa, Gsv, Rmc, parse
from tracker.sources.nmea_sky import Satellite, Sky


class NmeaReader:
    """Reads one receiver's stream. The same bytes give the same measurements, whole or byte by byte; none make it raise.

    Read are GGA, RMC, VTG, GSA, GSV and GST of any talker. `counts` says what became of every sentence: `sentences` were
    understood, `unknown` are of no concern, `unreadable` made no sense although their checksum was right, `repeated` said a
    second time what an epoch had; what did not get so far is counted by `NmeaLines`. Beside them `fixes`, `no_fix`, `velocities`.
    """

    def __init__(self, counts: Counter[str] | None = None, *, geoid_separation_m: float | None = None) -> None:
        """Begin a stream.

        Args:
            counts: Counted on; None for a new count.
            geoid_separation_m: Height of the geoid above the ellipsoid, for a receiver that does not say it. Without either, the
                height above the sea is given as the height above the ellipsoid, with a variance that admits the difference.
        """
        self.counts: Counter[str] = Counter() if counts is None else counts
        self.utc: datetime | None = None
        """What the receiver took for the date and time at its last RMC."""
        self._lines = NmeaLines(self.counts)
        self._epochs = EpochAssembler(self.counts)
        self._fixes = NmeaFixes(self.counts, geoid_separation_m)
        self._sky = Sky()

    def feed(self, data: bytes, t_recv_ns: int, t_ns: int | None = None) -> list[GpsFix | GpsVelocity]:
        """Return what these bytes complete, oldest first.

        Args:
            data: The next bytes of the stream, cut anywhere.
            t_recv_ns: When they were here; not before those of the last call.
            t_ns: When they were said, where that is known better than by their receipt (a log's stamp).
        """
        return list(self._measured(self._lines.feed(data, t_recv_ns if t_ns is None else t_ns), t_recv_ns))

    def close(self, t_recv_ns: int) -> list[GpsFix | GpsVelocity]:
        """Return what the stream's end completes."""
        found = list(self._measured(self._lines.close(), t_recv_ns))
        for epoch in self._epochs.close():
            found.extend(self._given(epoch, t_recv_ns))
        return found

    def satellites(self, t_recv_ns: int) -> tuple[Satellite, ...]:
        """Return the satellites in view now."""
        return self._sky.satellites(t_recv_ns)

    def facts(self, t_recv_ns: int) -> Mapping[str, object]:
        """Return what a person wants to see, as JSON values; angles in degrees."""
        return {
            "fix": QUALITIES[self._fixes.quality].words,
            "hdop": self._fixes.hdop,
            "satellites_used": self._fixes.satellites_used,
            "utc": None if self.utc is None else self.utc.isoformat(timespec="milliseconds") + "Z",
            "clock_drift_ppm": round(self._fixes.clock.drift_ppm, 2),
            "clock_resets": self._fixes.clock.resets,
            "satellites": [_described(satellite) for satellite in self.satellites(t_recv_ns)],
        }

    def _measured(self, lines: Iterator[tuple[str, int]], t_recv_ns: int) -> Iterator[GpsFix | GpsVelocity]:
        for content, t_ns in lines:
            try:
                sentence = parse(content)
            except MalformedInput:
                self.counts["unreadable"] += 1
                continue
            self.counts["unknown" if sentence is None else "sentences"] += 1
            match sentence:
                case None:
                    pass
                case Gsv():
                    self._sky.take_view(sentence, t_recv_ns)
                case Gsa():
                    self._sky.take_used(sentence)
                    self._fixes.take_gsa(sentence, t_ns)
                case _:
                    if isinstance(sentence, Rmc):
                        self._read_date(sentence)
                    for epoch in self._epochs.take(sentence, t_ns):
                        yield from self._given(epoch, t_recv_ns)

    def _given(self, epoch: Epoch, t_recv_ns: int) -> Iterator[GpsFix | GpsVelocity]:
        for measurement in self._fixes.measure(epoch, t_recv_ns):
            if isinstance(measurement, GpsFix):
                self._sky.end_epoch()
            yield measurement

    def _read_date(self, rmc: Rmc) -> None:
        if rmc.date is not None and rmc.time_of_day_ns is not None:
            midnight = datetime(rmc.date.year, rmc.date.month, rmc.date.day)
            self.utc = midnight + timedelta(microseconds=rmc.time_of_day_ns // 1000)


def _described(satellite: Satellite) -> dict[str, object]:
    elevation_rad, azimuth_rad = satellite.elevation_rad, satellite.azimuth_rad
    return {
        "system": satellite.system,
        "number": satellite.number,
        "elevation_deg": None if elevation_rad is None else round(degrees(elevation_rad), 1),
        "azimuth_deg": None if azimuth_rad is None else round(degrees(azimuth_rad), 1),
        "snr_db_hz": satellite.snr_db_hz,
        "used": satellite.used,
    }
