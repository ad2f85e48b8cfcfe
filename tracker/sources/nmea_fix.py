"""A receiver's epochs as fixes and velocities.

Times: a receiver says the UTC of each position. `DeviceClock` maps it to the local clock, so that fixes are as evenly spaced as
they were measured, however late each one comes. What the quickest of its positions takes to be computed and sent (some 0.05 to
0.2 s) cannot be told from the clocks' offset and stays in. Days are counted by the time of day alone, so a date that is wrong
(by 1024 weeks in old receivers) does no harm.
"""

from collections import Counter
from collections.abc import Iterator
from math import cos, nan, sin
from typing import TypeVar

from tracker.device_clock import DeviceClock
from tracker.measurements import GpsFix, GpsVelocity, Vector3
from tracker.sources.nmea_accuracy import QUALITIES, covariance
from tracker.sources.nmea_epoch import Epoch
from tracker.sources.nmea_sentence import Gsa, Gst

_DAY_NS = 86_400_000_000_000
#: How long dilutions and deviations count for epochs that say none of their own.
_HELD_NS = 6_000_000_000
#: Receivers leave the course out where they stand; below this speed the velocity is then zero, within the speed's own error.
_STANDING_M_S = 0.3
#: A stamp that is so little before the last one is jitter; more is a clock that was set.
_JITTER_NS = 1_000_000_000

_Said = TypeVar("_Said")


class NmeaFixes:
    """Makes measurements of epochs; remembers what epochs leave out."""

    def __init__(self, counts: Counter[str], geoid_separation_m: float | None) -> None:
        self.quality = 0
        """GGA's quality indicator, in the last epoch."""
        self.hdop: float | None = None
        self.satellites_used: int | None = None
        self.clock = DeviceClock()
        self._is_valid = False
        self._counts = counts
        self._separation_m = geoid_separation_m
        self._h_m: float | None = None
        self._gsa: tuple[int, Gsa] | None = None
        self._gst: tuple[int, Gst] | None = None
        self._t_device_ns: int | None = None
        self._t_ns: int | None = None

    def take_gsa(self, gsa: Gsa, t_ns: int) -> None:
        """Take dilutions, for the epochs to come."""
        self._gsa = (t_ns, gsa)

    def measure(self, epoch: Epoch, t_recv_ns: int) -> Iterator[GpsFix | GpsVelocity]:
        """Yield an epoch's fix and its velocity, each once, as soon as there is what it needs."""
        if not epoch.fix_given and (epoch.gga is not None or epoch.rmc is not None):
            epoch.fix_given = True
            yield self._fix(epoch, t_recv_ns)
        if epoch.fix_given and not epoch.velocity_given and self._is_valid and self._t_ns is not None:
            v_enu_m_s = self._velocity(epoch)
            if v_enu_m_s is not None:
                epoch.velocity_given = True
                self._counts["velocities"] += 1
                yield GpsVelocity(self._t_ns, t_recv_ns, v_enu_m_s)

    def _fix(self, epoch: Epoch, t_recv_ns: int) -> GpsFix:
        """Return the position of an epoch: GGA's, or RMC's where that is all there is."""
        said = epoch.gga or epoch.rmc
        assert said is not None
        if epoch.gga is not None:
            self.hdop, self.satellites_used = epoch.gga.hdop, epoch.gga.satellites_used
        self.quality = 0 if epoch.rmc is not None and epoch.rmc.quality == 0 else said.quality
        lat_deg, lon_deg = said.lat_deg, said.lon_deg
        self._is_valid = QUALITIES[self.quality].is_position and lat_deg is not None and lon_deg is not None
        if not self._is_valid or lat_deg is None or lon_deg is None:
            self._counts["no_fix"] += 1
            self._t_ns = self._after_the_last(epoch.t_first_ns, t_recv_ns)
            return GpsFix(self._t_ns, t_recv_ns, nan, nan, nan, (0.0,) * 9, valid=False)
        self._counts["fixes"] += 1
        self._t_ns = self._after_the_last(self._local_ns(epoch), t_recv_ns)
        h_m, cov_enu_m2 = self._height(epoch)
        return GpsFix(self._t_ns, t_recv_ns, lat_deg, lon_deg, h_m, cov_enu_m2)

    def _height(self, epoch: Epoch) -> tuple[float, tuple[float, ...]]:
        """Return the height above the ellipsoid, and the covariance of all three."""
        is_flat = False
        vdop = None
        gsa = _recent(self._gsa, epoch.t_first_ns)
        if gsa is not None:
            vdop, is_flat = gsa.vdop, gsa.dimensions == 2
        gst = epoch.gst or _recent(self._gst, epoch.t_first_ns)
        if epoch.gst is not None:
            self._gst = (epoch.t_first_ns, epoch.gst)
        gga = epoch.gga
        if gga is not None and gga.geoid_separation_m is not None:
            self._separation_m = gga.geoid_separation_m
        if gga is not None and gga.h_msl_m is not None:
            self._h_m = gga.h_msl_m + (self._separation_m or 0.0)
        else:
            is_flat = True
        cov_enu_m2 = covariance(
            self.quality,
            hdop=self.hdop,
            vdop=vdop,
            gst=gst,
            is_flat=is_flat,
            knows_geoid=self._separation_m is not None,
            knows_height=self._h_m is not None,
        )
        return self._h_m or 0.0, cov_enu_m2

    def _velocity(self, epoch: Epoch) -> Vector3 | None:
        """Return the velocity over the ground: RMC's, else VTG's; none where it moves and nobody says whither."""
        for said in (epoch.rmc, epoch.vtg):
            if said is None or said.quality == 0 or said.speed_m_s is None:
                continue
            if said.heading_rad is not None:
                east_m_s, north_m_s = said.speed_m_s * sin(said.heading_rad), said.speed_m_s * cos(said.heading_rad)
                return (east_m_s, north_m_s, 0.0)
            if said.speed_m_s < _STANDING_M_S:
                return (0.0, 0.0, 0.0)
        return None

    def _local_ns(self, epoch: Epoch) -> int:
        """Return when the epoch was, on the local clock."""
        if epoch.time_of_day_ns is None:
            return epoch.t_first_ns
        t_ns = epoch.time_of_day_ns
        if self._t_device_ns is not None:
            t_ns += round((self._t_device_ns - t_ns) / _DAY_NS) * _DAY_NS
        self._t_device_ns = t_ns
        return self.clock.local_ns(t_ns, epoch.t_first_ns)

    def _after_the_last(self, t_ns: int, t_recv_ns: int) -> int:
        if self._t_ns is not None and 0 <= self._t_ns - t_ns < _JITTER_NS:
            return min(self._t_ns + 1, t_recv_ns)
        return t_ns


def _recent(said: tuple[int, _Said] | None, t_ns: int) -> _Said | None:
    return said[1] if said is not None and abs(t_ns - said[0]) <= _HELD_NS else None
