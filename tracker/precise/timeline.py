"""What has arrived, in order of when it was measured: a filter some way behind the newest sample takes everything in its turn."""

from bisect import bisect_left
from dataclasses import dataclass
from typing import TypeAlias

from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Sighting,
    Standpoint,
    VisualMotion,
)


@dataclass(frozen=True, slots=True)
class Keyframe:
    """A moment whose pose is to be held: pictures after it are measured against the one taken then."""

    t_ns: int


Timed: TypeAlias = (
    ImuSample | MagSample | CompassHeading | GpsFix | GpsVelocity | VisualMotion | Sighting | Standpoint | Keyframe
)
#: Order among measurements of one instant: the inertial sample that ends there comes first.
_RANK: dict[type, int] = {
    ImuSample: 0,
    GpsFix: 1,
    GpsVelocity: 2,
    MagSample: 3,
    CompassHeading: 4,
    VisualMotion: 5,
    Sighting: 6,
    Standpoint: 7,
    Keyframe: 8,
}
#: Before the first inertial sample nothing is taken; what is older than this then is of no use to anyone.
_WAITS_NS = 2_000_000_000
_Key: TypeAlias = tuple[int, int, tuple[float, ...]]


def _key(measurement: Timed) -> _Key:
    # in one picture several landmarks can be pointed out, but each of them once
    point = measurement.point_site_m if isinstance(measurement, Sighting) else ()
    return measurement.t_ns, _RANK[type(measurement)], point


class Timeline:
    """Inertial samples and everything else, each sorted by stamp; one measurement of a kind for a stamp."""

    def __init__(self) -> None:
        self._imu: list[ImuSample] = []
        self._others: list[Timed] = []
        self._taken_ns: int | None = None

    def add(self, measurement: Timed) -> bool:
        """Take a measurement; False where its turn is over, or where it is a second one of its kind and stamp."""
        if self._taken_ns is not None and measurement.t_ns <= self._taken_ns:
            return False
        if isinstance(measurement, ImuSample):
            return self._add_imu(measurement)
        key = _key(measurement)
        place = bisect_left(self._others, key, key=_key)
        if place < len(self._others) and _key(self._others[place]) == key:
            return False
        self._others.insert(place, measurement)
        if self.newest_ns is None:
            del self._others[: bisect_left(self._others, measurement.t_ns - _WAITS_NS, key=_stamp)]
        return True

    def _add_imu(self, sample: ImuSample) -> bool:
        imu = self._imu
        if not imu or imu[-1].t_ns < sample.t_ns:
            imu.append(sample)
            return True
        place = bisect_left(imu, sample.t_ns, key=_stamp)
        if imu[place].t_ns == sample.t_ns:
            return False
        imu.insert(place, sample)
        return True

    @property
    def newest_ns(self) -> int | None:
        """Stamp of the newest inertial sample."""
        return self._imu[-1].t_ns if self._imu else self._taken_ns

    @property
    def waiting(self) -> list[Timed]:
        """All that has not been taken: inertial samples, then everything else, each oldest first."""
        return [*self._imu, *self._others]

    def take(self, before_ns: int) -> list[tuple[Timed, ImuSample | None]]:
        """Return all up to the last inertial sample before a time, in order, and forget it.

        What lies between that sample and the time waits until it is known which sample follows: so it does not matter
        in which order they arrive.

        Returns:
            Each measurement with the inertial sample after it, which is None for what needs none: it is at the last sample's stamp.
        """
        imu, others, first = self._imu, self._others, 0
        while first < len(imu) and imu[first].t_ns < before_ns:
            first += 1
        if first == 0:
            return []
        self._taken_ns = imu[first - 1].t_ns
        taken: list[Timed] = [*imu[:first]]
        del imu[:first]
        if others and others[0].t_ns <= self._taken_ns:
            second = bisect_left(others, self._taken_ns + 1, key=_stamp)
            taken += others[:second]
            taken.sort(key=_key)
            del others[:second]
        return _with_following(taken)


def _stamp(measurement: Timed) -> int:
    return measurement.t_ns


def _with_following(taken: list[Timed]) -> list[tuple[Timed, ImuSample | None]]:
    following: ImuSample | None = None
    pairs: list[tuple[Timed, ImuSample | None]] = []
    for measurement in reversed(taken):
        pairs.append((measurement, following))
        if isinstance(measurement, ImuSample):
            following = measurement
    pairs.reverse()
    return pairs
