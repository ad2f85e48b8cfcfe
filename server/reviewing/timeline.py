"""What happened when on a recorded walk, told by its sensors: silences, disturbances and stops. Pure but for the log that it reads.

No estimator has a part in it: changes of motion models are in `course.py`.
"""

from collections.abc import Iterable
from math import ceil, hypot, sqrt
from typing import Final, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from tracker.blank import RATE_HZ
from tracker.log import Log
from tracker.measurements import GpsFix, ImuSample, MagSample, Measurement
from tracker.precise.activity import Activity

Kind = Literal["silence", "magnetic", "weak_gps", "stop", "cut"]
Sensor = Literal["imu", "mag", "gps", "camera"]

#: A sensor is silent where it says nothing for so many of its usual intervals, and for so long, seconds.
_MISSED: Final = 4.0
_LEAST_SILENCE_S: Final = {"imu": 0.25, "mag": 1.0, "gps": 2.5, "camera": 1.0}
#: The Earth's field is as long everywhere on a site: iron, or a magnet, changes it by more than this share of it.
_FIELD_SHARE: Final = 0.15
#: A receiver is weak where it says that it is off by so many times as much as usual, and by so much, metres.
_WEAK_TIMES, _WEAK_M = 2.5, 6.0
#: Shorter ones are no events.
_LEAST_S: Final[dict[Kind, float]] = {"magnetic": 1.0, "weak_gps": 2.0, "stop": 2.0}
#: Two of a kind that are nearer than this are one.
_JOINED_S: Final = 1.5
#: The most of a kind that are told: more would be a picture of noise.
_MOST: Final = 60


class Event(msgspec.Struct, frozen=True, omit_defaults=True):
    """Something that happened, from one place of the walk to another, seconds from its start."""

    kind: Kind
    from_s: float
    until_s: float
    sensor: Sensor | None = None
    """Whose silence it is."""


class Timeline(msgspec.Struct, frozen=True):
    """A walk's length, its pictures and its events."""

    duration_s: float
    pictures_s: list[float]
    """When each picture arrived, seconds from the start, in order."""
    events: list[Event]
    """By their beginning."""
    has_truth: bool


def timeline_of(log: Log) -> Timeline:
    """Return the timeline of a walk; one without camera has the empty pictures that it is shown with."""
    info, notes = log.info, _Notes(log.info.t_start_ns)
    for measurement in log.messages(camera=False, truth=False):
        notes.take(measurement)
    arrivals_s = [(t_ns - info.t_start_ns) * 1e-9 for t_ns in log.picture_times_ns]
    pictures_s = arrivals_s or [index / RATE_HZ for index in range(int(info.duration_s * RATE_HZ) + 1)]
    events = [*notes.events(info.duration_s), *_silences("camera", arrivals_s, info.duration_s)]
    if info.truncated:
        events.append(Event("cut", info.duration_s, info.duration_s))
    events.sort(key=lambda event: (event.from_s, event.kind))
    # upwards: at the place that is told, the picture is there
    return Timeline(info.duration_s, [ceil(t_s * 1e4) / 1e4 for t_s in pictures_s], events, info.has_truth)


class _Notes:
    """What one reading of the sensors finds."""

    def __init__(self, t_start_ns: int) -> None:
        self._t_start_ns = t_start_ns
        self._arrivals_s: dict[Sensor, list[float]] = {"imu": [], "mag": [], "gps": []}
        self._field_t: list[tuple[float, float]] = []
        self._sigma_m: list[tuple[float, float]] = []
        self._activity = Activity()
        self._stands: list[tuple[float, float]] = []

    def take(self, measurement: Measurement) -> None:
        t_s = (measurement.t_recv_ns - self._t_start_ns) * 1e-9
        match measurement:
            case ImuSample():
                self._arrivals_s["imu"].append(t_s)
                if self._activity.step(measurement):
                    self._stands.append((t_s, 1.0 if self._activity.stands else 0.0))
            case MagSample():
                self._arrivals_s["mag"].append(t_s)
                self._field_t.append((t_s, hypot(*measurement.field_body_t)))
            case GpsFix() if measurement.valid:
                self._arrivals_s["gps"].append(t_s)
                variance_m2 = (measurement.cov_enu_m2[0] + measurement.cov_enu_m2[1]) / 2.0
                self._sigma_m.append((t_s, sqrt(max(0.0, variance_m2))))

    def events(self, duration_s: float) -> list[Event]:
        found = [event for sensor, times in self._arrivals_s.items() for event in _silences(sensor, times, duration_s)]
        t_s, field_t = _columns(self._field_t)
        usual = float(np.median(field_t)) if len(field_t) else 0.0
        found += _spans("magnetic", t_s, np.abs(field_t - usual) > _FIELD_SHARE * usual)
        t_s, sigma_m = _columns(self._sigma_m)
        usual = float(np.median(sigma_m)) if len(sigma_m) else 0.0
        found += _spans("weak_gps", t_s, (sigma_m > _WEAK_TIMES * usual) & (sigma_m > _WEAK_M))
        t_s, stands = _columns(self._stands)
        return found + _spans("stop", t_s, stands > 0.5)


def _silences(sensor: Sensor, arrivals_s: list[float], duration_s: float) -> list[Event]:
    """Return where a sensor that speaks at all does not; the ends of the walk are its first and last words too."""
    if len(arrivals_s) < 3:
        return []
    times = np.array([0.0, *arrivals_s, duration_s])
    gaps = np.diff(times)
    least_s = max(_LEAST_SILENCE_S[sensor], _MISSED * float(np.median(gaps[1:-1])))
    return [
        Event("silence", round(float(times[i]), 3), round(float(times[i + 1]), 3), sensor)
        for i in np.flatnonzero(gaps > least_s)[:_MOST]
    ]


def _spans(kind: Kind, t_s: NDArray[np.float64], holds: NDArray[np.bool_]) -> list[Event]:
    """Return where something holds for long enough."""
    spans: list[list[float]] = []
    for begin, end in _runs(holds):
        if spans and t_s[begin] - spans[-1][1] < _JOINED_S:
            spans[-1][1] = float(t_s[end])
        else:
            spans.append([float(t_s[begin]), float(t_s[end])])
    long = [span for span in spans if span[1] - span[0] >= _LEAST_S[kind]]
    return [Event(kind, round(begin, 3), round(end, 3)) for begin, end in long[:_MOST]]


def _runs(holds: NDArray[np.bool_]) -> Iterable[tuple[int, int]]:
    """Return first and last index of each stretch that is true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(np.int8)))
    return ((int(begin), int(end) - 1) for begin, end in zip(edges[::2], edges[1::2], strict=True))


def _columns(pairs: list[tuple[float, float]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    table = np.array(pairs, np.float64).reshape(-1, 2)
    return table[:, 0], table[:, 1]
