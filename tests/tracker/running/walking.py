"""A walk as sensors and vision say it, and a core that takes it; helpers of the tests beside this file."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

import numpy as np

from tests.tracker.precise.stream import row, stream
from tracker.assembly import assemble
from tracker.estimator import Pose
from tracker.geometry import exp, matrix_from_wxyz
from tracker.measurements import (
    Frame,
    GpsFix,
    GpsVelocity,
    Measurement,
    Sighting,
    Standpoint,
    VisualMotion,
)
from tracker.pictures import EncodedPicture
from tracker.pipeline import Pipeline
from tracker.rig import Rig
from tracker.running.core import WalkCore
from tracker.running.recorder import as_read, recorded
from tracker.simulate import AGORA_ORIGIN, START_NS, default_rig

S = 1_000_000_000
UTC_NS = START_NS
"""The walk's date."""
PICTURE = EncodedPicture(b"\xff\xd8 a picture that nobody looks at \xff\xd9")
SENSORS = {"gps": START_NS, "imu": START_NS, "camera": START_NS}


def rig() -> Rig:
    """Return the rig of the walk as it is recorded, its camera looking a little aside."""
    rig = recorded(default_rig())
    T_aside = np.eye(4)
    T_aside[:3, :3] = matrix_from_wxyz(exp((0.01, 0.02, -0.03)))
    return replace(rig, T_body_cam=T_aside @ rig.T_body_cam)


def make(name: str) -> Callable[[GpsFix | None], Pipeline]:
    """Return what makes a pipeline that is fed what a front end made of pictures."""

    def pipeline(fix: GpsFix | None) -> Pipeline:
        return assemble(name, origin=AGORA_ORIGIN, rig=as_read(rig()), date_ns=UTC_NS, looks=False)

    return pipeline


def live_stream(seconds: float = 20.0, seed: int = 12) -> list[Measurement]:
    """Return a walk as sensors say it: what people say left out, and the pictures whose motions there are put in."""
    measurements: list[Measurement] = []
    for measurement in stream(seconds, seed):
        if isinstance(measurement, Sighting | Standpoint):
            continue
        if isinstance(measurement, VisualMotion):
            t_ns = measurement.t_ns
            measurements.append(Frame(t_ns, t_ns + 20_000_000, measurement.frame_id, PICTURE))
            measurement = replace(measurement, t_recv_ns=t_ns + 90_000_000)
        measurements.append(measurement)
    return sorted(measurements, key=lambda m: m.t_recv_ns)


def sensor_of(measurement: Measurement) -> str:
    """Return which sensor says it."""
    if isinstance(measurement, GpsFix | GpsVelocity):
        return "gps"
    return "camera" if isinstance(measurement, Frame) else "imu"


def drive(core: WalkCore, measurements: Iterable[Measurement]) -> None:
    """Hand a core measurements, each at its arrival."""
    for measurement in measurements:
        now_ns = measurement.t_recv_ns
        if isinstance(measurement, VisualMotion):
            frame = Frame(measurement.t_ns, now_ns, measurement.frame_id, PICTURE)
            core.take_look(frame, measurement, now_ns)
        else:
            core.take(sensor_of(measurement), measurement, now_ns)


class Noted:
    """What was fed, each with the pose just before it."""

    def __init__(self) -> None:
        self.fed: list[Measurement] = []
        self.rows: list[tuple[object, ...]] = []
        self.core: WalkCore | None = None

    def __call__(self, measurement: Measurement) -> None:
        assert self.core is not None
        self.fed.append(measurement)
        self.rows.append(row(self.core.pose(measurement.t_recv_ns)))


def new_core(name: str, record: Callable[[Measurement], None], sensors: Mapping[str, int] = SENSORS) -> WalkCore:
    """Return a core for that walk."""
    return WalkCore(make(name), as_read(rig()), sensors, record=record)


def rows_of(pipeline: Pipeline, measurements: Iterable[Measurement]) -> list[tuple[object, ...]]:
    """Feed a pipeline, and return the pose just before each measurement."""
    rows = []
    for measurement in measurements:
        pose: Pose | None = pipeline.predict(measurement.t_recv_ns)
        rows.append(row(pose))
        pipeline.step(measurement)
    return rows
