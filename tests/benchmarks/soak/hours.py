"""Eight hours of a rig without camera as fast as possible: what the walk's core keeps must not grow.

The measurements are made while they are fed, a lap at a time; the core is that of a live walk, with its guard and its watches, and
is asked for a pose as often as a live walk's fusion asks.
"""

import gc
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from time import monotonic

from assets.site import load_site
from server.options import SITE
from server.standing import eye_heights
from tests.benchmarks.soak.process import usage
from tests.benchmarks.soak.rows import Row
from tests.benchmarks.soak.to_and_fro import demo_walk, endless_sensors
from tracker.assembly import assemble
from tracker.measurements import GpsFix, GpsVelocity
from tracker.pipeline import Pipeline
from tracker.running.core import WalkCore
from tracker.simulate import START_NS

ESTIMATOR = "gps-imu/precise"
_POSE_NS = 10_000_000
#: What is the same memory: an allocator's pages come and go, a leak of one float a sample would be 180 MB in eight hours.
_SAME_MB = 2.0


@dataclass(frozen=True)
class Mark:
    """How it was when so much of the log had been replayed."""

    replayed_s: float
    took_s: float
    rss_mb: float
    samples: int
    has_pose: bool


def rows(marks: Sequence[Mark]) -> list[Row]:
    """Return the figures of a replay; the first mark is after the first half hour."""
    first, last = marks[0], marks[-1]
    return [
        Row("memory at the end over that after the first half hour", last.rss_mb - first.rss_mb, "MB", most=_SAME_MB),
        Row("memory after the first half hour", first.rss_mb, "MB"),
        Row("memory at the end", last.rss_mb, "MB"),
        Row("most memory at any half hour", max(mark.rss_mb for mark in marks), "MB"),
        Row("half hours at whose end there was no pose", sum(not mark.has_pose for mark in marks), "", most=0),
        Row("measurements fed", last.samples, ""),
        Row("times as fast as it was walked", last.replayed_s / last.took_s, ""),
    ]


def replay(seconds: float, every_s: float) -> Iterator[Mark]:
    """Replay so much, and tell how it is after every so much of it."""
    core = WalkCore(_pipeline, demo_walk().rig, {"gps": START_NS, "imu": START_NS})
    began_s = monotonic()
    pose_due_ns, mark_due_s = START_NS, every_s
    for samples, measurement in enumerate(endless_sensors()):
        now_ns = measurement.t_recv_ns
        replayed_s = (now_ns - START_NS) * 1e-9
        if replayed_s >= mark_due_s:
            gc.collect()
            has_pose = core.pose(now_ns) is not None
            yield Mark(mark_due_s, monotonic() - began_s, usage(os.getpid()).rss_mb, samples, has_pose)
            mark_due_s += every_s
            if replayed_s >= seconds:
                return
        core.take("gps" if isinstance(measurement, GpsFix | GpsVelocity) else "imu", measurement, now_ns)
        if now_ns >= pose_due_ns:
            pose_due_ns = now_ns + _POSE_NS
            core.pose(now_ns)


def _pipeline(_fix: GpsFix | None) -> Pipeline:
    site, walk = load_site(SITE), demo_walk()
    return assemble(ESTIMATOR, origin=walk.settings.origin, rig=walk.rig, date_ns=START_NS, eyes_z_m=eye_heights(site))
