"""A walk played to the bus in real time: a GPS 1040 and a Spatial 1056, as a visitor carries them, or as they fail.

The walker stands where the walk begins until a second after the library listens to both devices, then walks, and at the end
stands where it ends. Whoever plays it may pull devices out and put them back, and take the sky away from the receiver (`do`).

The library takes a device that is silent for half a second for gone. So between its fixes the receiver lists its satellites, as
a real one does.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from math import atan2, degrees, hypot
from threading import Event, Thread
from time import monotonic_ns

from tests.tracker.sources.usb_standin.bus import (
    GPS_1040,
    SPATIAL_1056,
    Bus,
    Vector3,
    nmea,
    nmea_reports,
    spatial_report,
)
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, MagSample, Measurement

GPS_SERIAL, SPATIAL_SERIAL = 284771, 302934
#: Height of the geoid above the ellipsoid at Ephesus.
GEOID_M = 37.4
_HDOP, _VDOP = 1.1, 1.8
_G_M_S2 = 9.80665
_KNOT_M_S = 1852.0 / 3600.0
_NOON_MS = 12 * 3600 * 1000
_DAY_MS = 24 * 3600 * 1000
#: Standing: an inertial sample each 4 ms, and an epoch of the receiver with each 25th.
_STILL_NS = 4_000_000
_EPOCH_TICKS = 25
_STANDING = (0.0, 0.0, 0.0)
#: From the first transfer of a device to its data at the interval that was asked for; usually 0.1 s.
_ATTACH_NS = 1_000_000_000
_SATELLITES = nmea_reports(nmea("GPGSV,1,1,04,02,62,120,44,05,41,210,39,12,30,310,41,25,15,045,33"))
_SATELLITES_NS = 100_000_000


@dataclass(frozen=True, slots=True)
class Epoch:
    """What the receiver says of one moment."""

    fix: GpsFix
    v_enu_m_s: Vector3


@dataclass(frozen=True, slots=True)
class Sample:
    """What the inertial unit says at one moment; no field where the magnetometer has nothing new."""

    imu: ImuSample
    field_t: Vector3 | None


def devices_say(measurements: Iterable[Measurement]) -> Iterator[tuple[int, Sample | Epoch]]:
    """Yield what the two devices say of a walk, and when, in order; what a Phidget does not measure is left out.

    Args:
        measurements: In order of arrival, as from `tracker.log` and `tracker.simulate`.
    """
    field_t: Vector3 | None = None
    fix: GpsFix | None = None
    for measurement in measurements:
        match measurement:
            case MagSample():
                field_t = measurement.field_body_t
            case ImuSample():
                yield measurement.t_recv_ns, Sample(measurement, field_t)
                field_t = None
            case GpsFix() if fix is not None:
                yield fix.t_recv_ns, Epoch(fix, _STANDING)
                fix = measurement
            case GpsFix():
                fix = measurement
            case GpsVelocity() if fix is not None and fix.t_ns == measurement.t_ns:
                yield measurement.t_recv_ns, Epoch(fix, measurement.v_enu_m_s)
                fix = None
            case _:
                pass


class Walker:
    """Plays a walk to two devices that it adds to a bus, on a thread of its own."""

    def __init__(self, bus: Bus, measurements: Iterable[Measurement]) -> None:
        """Add the devices and prepare the walk.

        Raises:
            ValueError: The walk has no inertial sample, or no fix.
        """
        said = list(devices_say(measurements))
        samples = [what for _, what in said if isinstance(what, Sample)]
        epochs = [what for _, what in said if isinstance(what, Epoch)]
        if not samples or not epochs:
            raise ValueError("a walk for the walker needs inertial samples and fixes")
        self._bus, self._said = bus, said
        self._sample, self._epoch = samples[0], epochs[0]
        self.gps = bus.add(GPS_1040, GPS_SERIAL)
        self.spatial = bus.add(SPATIAL_1056, SPATIAL_SERIAL)
        self.walking, self.ended = Event(), Event()
        """Set when the walk begins, as the library listens to both devices, and when it has ended."""
        self._has_sky = True
        self._frozen: GpsFix | None = None
        self._zero_ns = 0
        self._t_receiver_ns = 0
        self._stop = Event()
        self._thread = Thread(target=self._play, name="walker", daemon=True)

    def start(self) -> None:
        """Begin to stand."""
        self._zero_ns = monotonic_ns()
        self._thread.start()

    def close(self) -> None:
        """End it, wherever the walker is."""
        self._stop.set()
        self._thread.join()

    def do(self, command: str) -> None:
        """Obey `unplug gps`, `plug gps`, `unplug imu`, `plug imu`, `nofix`, `fix`, `freeze` (the position stays) or `thaw`.

        Raises:
            ValueError: It cannot do that.
        """
        match command.split():
            case ["unplug" | "plug" as word, "gps" | "imu" as device]:
                self._bus.plug(self.gps if device == "gps" else self.spatial, word == "plug")
            case ["nofix" | "fix" as word]:
                self._has_sky = word == "fix"
            case ["freeze" | "thaw" as word]:
                self._frozen = self._epoch.fix if word == "freeze" else None
            case _:
                raise ValueError(f"the walker cannot {command!r}")

    def _play(self) -> None:
        self._stand(lambda: self._bus.listened_to(self.gps) and self._bus.listened_to(self.spatial))
        heard_ns = monotonic_ns()
        begin_ns = self._stand(lambda: monotonic_ns() - heard_ns > _ATTACH_NS)
        self.walking.set()
        first_ns = self._said[0][0]
        for t_ns, what in self._said:
            if not self._wait_for(begin_ns + t_ns - first_ns):
                return
            if isinstance(what, Sample):
                self._say_sample(what, begin_ns + what.imu.t_ns - first_ns)
            else:
                self._say_epoch(what, begin_ns + what.fix.t_ns - first_ns)
        self.ended.set()
        self._sample = replace(self._sample, imu=replace(self._sample.imu, gyro_rad_s=_STANDING))
        self._stand(lambda: False)

    def _stand(self, is_over: Callable[[], bool]) -> int:
        """Say the same until it is over, and return when that was, on the devices' clock."""
        tick = (monotonic_ns() - self._zero_ns) // _STILL_NS
        while self._wait_for(tick * _STILL_NS) and not is_over():
            self._say_sample(self._sample, tick * _STILL_NS)
            if tick % _EPOCH_TICKS == 0:
                self._say_epoch(replace(self._epoch, v_enu_m_s=_STANDING), tick * _STILL_NS)
            tick += 1
        return tick * _STILL_NS

    def _wait_for(self, t_ns: int) -> bool:
        """Wait for a time of the devices' clock; False where it is to end."""
        wait_ns = self._zero_ns + t_ns - monotonic_ns()
        return not self._stop.wait(wait_ns / 1e9) if wait_ns > 0 else not self._stop.is_set()

    def _say_sample(self, sample: Sample, t_ns: int) -> None:
        self._sample = sample
        report = spatial_report(
            round(t_ns / 1e6),
            _flipped(sample.imu.accel_m_s2, -1.0 / _G_M_S2),
            _flipped(sample.imu.gyro_rad_s, degrees(1.0)),
            None if sample.field_t is None else _flipped(sample.field_t, 1e4),
            SPATIAL_1056,
        )
        self._bus.push(self.spatial, report)
        if t_ns - self._t_receiver_ns >= _SATELLITES_NS:
            self._t_receiver_ns = t_ns
            for part in _SATELLITES:
                self._bus.push(self.gps, part)

    def _say_epoch(self, epoch: Epoch, t_ns: int) -> None:
        self._epoch = epoch
        fix = self._frozen or epoch.fix
        for report in nmea_reports(epoch_sentences(fix, epoch.v_enu_m_s, _NOON_MS + round(t_ns / 1e6), self._has_sky)):
            self._bus.push(self.gps, report)


def epoch_sentences(fix: GpsFix, v_enu_m_s: Vector3, utc_ms: int, has_sky: bool = True) -> bytes:
    """Return GGA, GSA and RMC of one epoch.

    Args:
        fix: Where.
        v_enu_m_s: How fast; the part upwards is not said.
        utc_ms: UTC since some midnight, milliseconds.
        has_sky: Whether the receiver sees satellites; without, it says the time only.
    """
    seconds, ms = divmod(utc_ms % _DAY_MS, 1000)
    time = f"{seconds // 3600:02d}{seconds // 60 % 60:02d}{seconds % 60:02d}.{ms:03d}"
    if not has_sky or not fix.valid:
        bodies = (f"GPGGA,{time},,,,,0,00,,,M,,M,,", "GPGSA,A,1,,,,,,,,,,,,,,,", f"GPRMC,{time},V,,,,,,,080407,,,N")
        return b"".join(map(nmea, bodies))
    place = f"{_angle(fix.lat_deg, 2, 'NS')},{_angle(fix.lon_deg, 3, 'EW')}"
    east, north, _ = v_enu_m_s
    course_deg = degrees(atan2(east, north)) % 360.0
    bodies = (
        f"GPGGA,{time},{place},1,08,{_HDOP},{fix.h_ellipsoid_m - GEOID_M:.3f},M,{GEOID_M},M,,",
        f"GPGSA,A,3,02,05,07,12,15,21,25,29,,,,,2.1,{_HDOP},{_VDOP}",
        f"GPRMC,{time},A,{place},{hypot(east, north) / _KNOT_M_S:.3f},{course_deg:.3f},080407,,,A",
    )
    return b"".join(map(nmea, bodies))


def _angle(degrees_: float, digits: int, signs: str) -> str:
    """Return degrees as NMEA writes them: whole degrees and minutes in one number, and a letter."""
    whole, minutes = divmod(round(abs(degrees_) * 60.0, 7), 60.0)
    return f"{int(whole):0{digits}d}{minutes:010.7f},{signs[degrees_ < 0.0]}"


def _flipped(values: Vector3, scale: float) -> Vector3:
    """Return a vector in the axes of a Spatial that lies with its components up: y and z are reversed."""
    x, y, z = values
    return x * scale, -y * scale, -z * scale
