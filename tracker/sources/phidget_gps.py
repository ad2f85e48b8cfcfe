"""PhidgetGPS (1040 and later) as a source of positions and velocities.

Measured on Phidget22 1.26 with USB reports of a 1040: the library reads GGA, GSA, RMC and VTG and refuses what has no checksum or a
wrong one. A position event comes with GGA, and only where latitude, longitude or altitude are not those of the last; a heading
event comes with every valid RMC, also while the receiver stands. In the handler of the latter, time and GGA are of the event's
own epoch, and position and velocity therefore of one moment; in the handler of the former GGA is still of the epoch before. So
heading events make the epochs, and a receiver whose position does not change is no outage. Without a fix there are no events,
but the time goes on: it tells a receiver that sees no sky from one that is dead.

Days, clocks and covariances are made as of any receiver (`nmea_fix`, `nmea_accuracy`): an autonomous fix has 2.5 m along each
axis at HDOP 1, and that times HDOP elsewhere; its height 3.5 m times VDOP.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from math import radians
from time import monotonic_ns
from typing import Any, TypeAlias

from Phidget22.Devices.GPS import GPS
from Phidget22.PhidgetException import PhidgetException

from tracker.measurements import Measurement
from tracker.sources.nmea_accuracy import QUALITIES
from tracker.sources.nmea_epoch import Epoch
from tracker.sources.nmea_fix import NmeaFixes
from tracker.sources.nmea_sentence import Gga, Gsa, Rmc
from tracker.sources.phidget import ATTACH_S, PhidgetSource

_KM_H_M_S = 1.0 / 3.6
_MS_NS = 1_000_000
_NOT_A_POSITION = 0
#: A receiver that speaks and has not said a valid epoch for so long has no fix, whatever it said last.
_OLD_NS = 2_000_000_000

_Said: TypeAlias = tuple[int, int | None, Gga | None, Gsa | None, Rmc | None]
"""When it was here, the epoch's UTC time of day, and what was said: all of an epoch, or only that it has begun."""


class PhidgetGpsSource(PhidgetSource[_Said]):
    """A `Source` of `GpsFix` and `GpsVelocity`."""

    _KIND = "PhidgetGPS"

    def __init__(
        self, serial: int | None = None, *, attach_s: float = ATTACH_S, clock_ns: Callable[[], int] = monotonic_ns
    ) -> None:
        """Prepare; nothing is opened before `run`.

        Args:
            serial: Serial number of the device; None for any.
            attach_s: How long it may take to attach at the start.
            clock_ns: The local clock.
        """
        super().__init__("gps", serial, attach_s=attach_s, clock_ns=clock_ns)
        self._restart()

    def _create(self) -> GPS:
        channel = GPS()
        channel.setOnPositionChangeHandler(self._guarded(self._on_position))
        channel.setOnHeadingChangeHandler(self._guarded(self._on_heading))
        channel.setOnPositionFixStateChangeHandler(self._guarded(self._on_fix_state))
        return channel

    def _prepare(self, channel: Any) -> Mapping[str, object]:
        return {}

    def _restart(self) -> None:
        self._fixes = NmeaFixes(self._counts, None)
        self._begun: tuple[int | None, int] | None = None
        self._has_fix = True  # until it says that it has none, or says nothing of it for too long
        self._t_epoch_ns = self._clock_ns()
        self._utc_ns: int | None = None

    def _on_position(self, channel: Any, _lat_deg: float, _lon_deg: float, _h_msl_m: float) -> None:
        t_recv_ns = self._clock_ns()
        self._receive((t_recv_ns, _time_of_day_ns(channel), None, None, None), t_recv_ns)

    def _on_heading(self, channel: Any, heading_deg: float, speed_km_h: float) -> None:
        t_recv_ns, time_of_day_ns = self._clock_ns(), _time_of_day_ns(channel)
        nmea = channel.getNMEAData()
        rmc = Rmc(time_of_day_ns, None, None, None, 1, speed_km_h * _KM_H_M_S, radians(heading_deg))
        gga, gsa = _gga(nmea.GGA, time_of_day_ns), _gsa(nmea.GSA)
        self._receive((t_recv_ns, time_of_day_ns, gga, gsa, rmc), t_recv_ns)

    def _on_fix_state(self, channel: Any, has_fix: int) -> None:
        t_recv_ns, time_of_day_ns = self._clock_ns(), _time_of_day_ns(channel)
        gga = None if has_fix else _no_fix(time_of_day_ns)
        self._receive((t_recv_ns, time_of_day_ns, gga, None, None), t_recv_ns)

    def _measure(self, said: _Said) -> Iterator[Measurement]:
        t_recv_ns, time_of_day_ns, gga, gsa, rmc = said
        if gga is None:
            self._begun = (time_of_day_ns, t_recv_ns)
            return
        t_first_ns = t_recv_ns
        if self._begun is not None and time_of_day_ns is not None and self._begun[0] == time_of_day_ns:
            t_first_ns = self._begun[1]
        self._has_fix, self._t_epoch_ns = QUALITIES[gga.quality].is_position, t_recv_ns
        if gsa is not None:
            self._fixes.take_gsa(gsa, t_first_ns)
        epoch = Epoch(time_of_day_ns, t_first_ns, gga, rmc if self._has_fix else None)
        yield from self._fixes.measure(epoch, t_recv_ns)

    def _look(self, channel: Any) -> Iterator[Measurement]:
        """Tell no fix from no receiver: say `no fix` each second as long as the receiver's time goes on."""
        t_recv_ns, time_of_day_ns = self._clock_ns(), _time_of_day_ns(channel)
        if time_of_day_ns is None or time_of_day_ns == self._utc_ns:
            return
        self._utc_ns, self._t_heard_ns = time_of_day_ns, t_recv_ns
        if not self._has_fix or t_recv_ns - self._t_epoch_ns > _OLD_NS:
            gga = replace(_no_fix(time_of_day_ns), satellites_used=channel.getNMEAData().GGA.numSatellites)
            yield from self._measure((t_recv_ns, time_of_day_ns, gga, None, None))

    def _facts(self) -> Mapping[str, object]:
        clock = self._fixes.clock
        return {
            "fix": QUALITIES[self._fixes.quality if self._has_fix else _NOT_A_POSITION].words,
            "hdop": self._fixes.hdop,
            "satellites_used": self._fixes.satellites_used,
            "utc_time_of_day_s": None if self._utc_ns is None else self._utc_ns / 1e9,
            "clock_drift_ppm": round(clock.drift_ppm, 2),
            "clock_resets": clock.resets,
        }


def _time_of_day_ns(channel: Any) -> int | None:
    """Return UTC since midnight of the newest epoch; None while the receiver does not know it."""
    try:
        time = channel.getTime()
    except PhidgetException:
        return None
    seconds = (time.tm_hour * 60 + time.tm_min) * 60 + time.tm_sec
    return int((seconds * 1000 + time.tm_ms) * _MS_NS)


def _gga(gga: Any, time_of_day_ns: int | None) -> Gga:
    """Return the library's GGA as ours; it says 0 where a field is empty, also of the geoid, which is at 0 in few places."""
    quality = gga.fixQuality if gga.fixQuality in QUALITIES else _NOT_A_POSITION
    return Gga(
        time_of_day_ns,
        gga.latitude,
        gga.longitude,
        quality,
        gga.numSatellites,
        gga.horizontalDilution or None,
        gga.altitude,
        gga.heightOfGeoid or None,
    )


def _gsa(gsa: Any) -> Gsa | None:
    """Return the library's GSA as ours; None where there has been none."""
    if not gsa.fixType:
        return None
    used = tuple(number for number in gsa.satUsed if number)
    return Gsa("GPS", used, gsa.fixType, gsa.horizDilution or None, gsa.vertDilution or None)


def _no_fix(time_of_day_ns: int | None) -> Gga:
    return Gga(time_of_day_ns, None, None, _NOT_A_POSITION, None, None, None, None)
