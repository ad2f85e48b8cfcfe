"""A walk whose sensors fail, in simulated time: what the core makes of it beside the truth; helpers of the scenarios."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from math import degrees, hypot

import numpy as np

from tests.tracker.precise.stream import walk
from tests.tracker.running.walking import PICTURE, S, live_stream, new_core, sensor_of
from tracker.geometry import wrap_rad, wxyz_from_matrix, yaw_of
from tracker.measurements import Frame, GpsFix, GpsVelocity, ImuSample, MagSample, Measurement, VisualMotion
from tracker.running.core import WalkCore
from tracker.running.health import SensorState
from tracker.simulate import START_NS
from tracker.sources.source import SourceStatus

LENGTH_S = 110.0
#: Of the walk.
SEED = 12
TICK_NS = 50_000_000
GPS, IMU, CAMERA = (GpsFix, GpsVelocity), (ImuSample, MagSample), (Frame, VisualMotion)
Kinds = tuple[type, ...]
Stream = Iterable[Measurement]


@dataclass(frozen=True)
class Row:
    """What was to be seen at one moment."""

    t_s: float
    """Since the walk's start."""
    states: Mapping[str, SensorState]
    sentences: Mapping[str, str]
    has_pose: bool
    error_m: float
    """Horizontal, against the truth; infinite without a pose."""
    sigma_m: float
    """What the pose itself says of that, one axis."""
    heading_error_deg: float
    heading_known: bool


@cache
def healthy(seed: int = SEED) -> tuple[Measurement, ...]:
    """Return the walk with nothing amiss."""
    return tuple(live_stream(LENGTH_S, seed))


def at(t_s: float) -> int:
    """Return a time of the walk in nanoseconds."""
    return START_NS + round(t_s * S)


def without(stream: Stream, kinds: Kinds, from_s: float, to_s: float) -> Iterator[Measurement]:
    """Leave out what was measured in a time."""
    return (m for m in stream if not (isinstance(m, kinds) and at(from_s) <= m.t_ns < at(to_s)))


def changed(
    stream: Stream, kinds: Kinds, from_s: float, to_s: float, change: Callable[[Measurement], Measurement]
) -> Iterator[Measurement]:
    """Change what was measured in a time."""
    return (change(m) if isinstance(m, kinds) and at(from_s) <= m.t_ns < at(to_s) else m for m in stream)


def run(
    stream: Stream,
    *,
    gone: Mapping[str, tuple[float, float]] | None = None,
    name: str = "camera-gps-imu/precise",
    until_s: float = LENGTH_S,
    seed: int = SEED,
) -> list[Row]:
    """Let a core take a stream of the walk of this seed; `gone` says when each sensor's source finds no device."""
    core, rows, due_ns = new_core(name, lambda measurement: None), [], START_NS
    for measurement in sorted(stream, key=lambda m: m.t_recv_ns):
        if measurement.t_recv_ns > at(until_s):
            break
        while measurement.t_recv_ns > due_ns:
            rows.append(_row(core, due_ns, gone or {}, seed))
            due_ns += TICK_NS
        _take(core, measurement)
    return rows


def _take(core: WalkCore, measurement: Measurement) -> None:
    now_ns = measurement.t_recv_ns
    if isinstance(measurement, VisualMotion):
        frame = Frame(measurement.t_ns, now_ns, measurement.frame_id, PICTURE)
        # a motion without an inlier stands for a picture in which nothing was seen
        core.take_look(frame, measurement if measurement.inliers else None, now_ns)
    else:
        core.take(sensor_of(measurement), measurement, now_ns)


def _row(core: WalkCore, now_ns: int, gone: Mapping[str, tuple[float, float]], seed: int) -> Row:
    t_s = (now_ns - START_NS) / S
    absent = SourceStatus(False, "it was pulled out: put it back")
    statuses = {name: absent for name, (from_s, to_s) in gone.items() if from_s <= t_s < to_s}
    health = core.health(now_ns, statuses)
    states = {sensor: one.state for sensor, one in health.items()}
    sentences = {sensor: one.sentence for sensor, one in health.items()}
    pose = core.pose(now_ns)
    if pose is None:
        return Row(t_s, states, sentences, False, np.inf, np.inf, 180.0, False)
    truth = walk(LENGTH_S, seed).at(np.array([now_ns]))
    (east, north, _), (x, y, _) = truth.p_m[0], pose.p_site_m
    yaw_rad = yaw_of(wxyz_from_matrix(truth.R_site_body[0]))
    off_deg = abs(degrees(wrap_rad(yaw_of(pose.wxyz_site_body) - yaw_rad)))
    sigma_m = float(np.sqrt(max(pose.cov[0, 0], pose.cov[1, 1])))
    return Row(t_s, states, sentences, True, hypot(x - east, y - north), sigma_m, off_deg, pose.heading_known)


def stepped_back(measurement: Measurement) -> Measurement:
    """Return it with a stamp a second earlier."""
    return replace(measurement, t_ns=measurement.t_ns - S)
