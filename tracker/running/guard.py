"""What a broken sensor says is withheld from the estimator: stamps out of order, and one value again and again. Pure."""

from collections import Counter
from math import hypot

from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Measurement, Vector3
from tracker.soundness import Soundness

#: A sensor's noise makes six equal numbers twice in a row rare; from so many times on they tell nothing that is new,
_SAMES = 4
#: and so many times, and for so long, they are not measured.
_STUCK_SAMES, _STUCK_NS = 10, 100_000_000
#: A receiver may repeat a position while the rig stands. While it walks faster than this,
_WALKS_M_S = 0.5
#: no position stays the same for so long. And none stays
_STAYS_NS = 2_500_000_000
#: while the receiver's own velocity has carried it so far.
_CARRIED_M = 0.7


class Guard:
    """Sees every measurement in the order in which it would be fed."""

    def __init__(self) -> None:
        self._soundness = Soundness()
        self._imu = _Repeats()
        self._gps = _Repeats()
        self.imu_stuck = False
        """Whether the inertial unit repeats itself."""
        self.gps_stuck = False
        """Whether the receiver repeats a position while the rig walks."""
        self.withheld: Counter[str] = Counter()
        """By reason."""

    def withholds(self, measurement: Measurement, speed_m_s: float) -> bool:
        """Return whether a measurement must not be fed; `speed_m_s` is what the estimator believes of the rig."""
        fault = self._soundness.fault(measurement)
        if fault is None:
            fault = self._stuck(measurement, speed_m_s)
        if fault is not None:
            self.withheld[fault] += 1
        return fault is not None

    def _stuck(self, measurement: Measurement, speed_m_s: float) -> str | None:
        match measurement:
            case ImuSample():
                count, since_ns = self._imu.count((*measurement.gyro_rad_s, *measurement.accel_m_s2), measurement.t_ns)
                self.imu_stuck = count >= _STUCK_SAMES and measurement.t_ns - since_ns >= _STUCK_NS
                return "imu_repeats" if count >= _SAMES else None
            case GpsFix(valid=True):
                place: Vector3 = (measurement.lat_deg, measurement.lon_deg, measurement.h_ellipsoid_m)
                _, since_ns = self._gps.count(place, measurement.t_ns)
                stays = measurement.t_ns - since_ns
                # once stuck it is so until it says something else: standing still does not make it right again
                self.gps_stuck = stays > 0 and (self.gps_stuck or (stays >= _STAYS_NS and speed_m_s > _WALKS_M_S))
                return "gps_repeats" if self.gps_stuck else None
            case GpsVelocity():
                stays_s = self._gps.lasts_s(measurement.t_ns)
                if stays_s * hypot(*measurement.v_enu_m_s) > _CARRIED_M:
                    self.gps_stuck = True
                return "gps_repeats" if self.gps_stuck else None
        return None


class _Repeats:
    """How often, and since when, the same numbers have come."""

    def __init__(self) -> None:
        self._numbers: tuple[float, ...] = ()
        self._count = 0
        self._since_ns = self._newest_ns = 0

    def count(self, numbers: tuple[float, ...], t_ns: int) -> tuple[int, int]:
        """Take the next numbers; return how many there are of them in a row, and the stamp of the first."""
        if numbers != self._numbers:
            self._numbers, self._count, self._since_ns = numbers, 0, t_ns
        self._count += 1
        self._newest_ns = t_ns
        return self._count, self._since_ns

    def lasts_s(self, t_ns: int) -> float:
        """Return for how long the numbers had been the same when they came last, at this stamp; 0 where they did not come then."""
        return (t_ns - self._since_ns) * 1e-9 if self._count > 1 and t_ns == self._newest_ns else 0.0
