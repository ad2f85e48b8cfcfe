"""What has arrived, in order of when it was measured: a filter some way behind the newest sample takes everything in its turn."""

from bisect import insort
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
_Key: TypeAlias = tuple[int, int]


def _key(measurement: Timed) -> _Key:
    return measurement.t_ns, _RANK[type(measurement)]


class Timeline:
    """Inertial samples and everything else, each sorted by stamp; one measurement of a kind for a stamp."""

    def __init__(self) -> None:
        self._imu: list[ImuSample] = []
        self._others: list[Timed] = []
        self._taken_ns: int | None = None

    def add(self, measurement: Timed) -> bool:
        """Take a measurement; False where it is too old, or a second one of its kind and stamp."""
        if self._taken_ns is not None and measurement.t_ns <= self._taken_ns:
            return False
        items: list[Timed] = self._imu if isinstance(measurement, ImuSample) else self._others  # type: ignore[assignment]
        if not items or _key(items[-1]) < _key(measurement):
            items.append(measurement)
            return True
        if any(_key(item) == _key(measurement) for item in reversed(items) if item.t_ns >= measurement.t_ns):
            return False
        insort(items, measurement, key=_key)
        return True

    @property
    def newest_ns(self) -> int | None:
        """Stamp of the newest inertial sample."""
        return self._imu[-1].t_ns if self._imu else None

    @property
    def imu(self) -> list[ImuSample]:
        """Inertial samples that have not been taken, oldest first."""
        return self._imu

    @property
    def others(self) -> list[Timed]:
        """Everything else that has not been taken, oldest first."""
        return self._others

    def take(self, until_ns: int) -> list[Timed]:
        """Return all up to a time, in order, and forget it."""
        first = next((i for i, s in enumerate(self._imu) if s.t_ns > until_ns), len(self._imu))
        second = next((i for i, m in enumerate(self._others) if m.t_ns > until_ns), len(self._others))
        taken: list[Timed] = [*self._imu[:first], *self._others[:second]]
        del self._imu[:first], self._others[:second]
        if second:
            taken.sort(key=_key)
        if taken:
            self._taken_ns = until_ns
        return taken
