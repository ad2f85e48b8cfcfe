"""Who is measured: the precise filter, the paper's models, the raw receiver and rivals, each run on one recording."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from importlib import import_module
from time import thread_time_ns
from typing import TYPE_CHECKING

from tests.benchmarks.accuracy.raw import held_fixes
from tests.benchmarks.accuracy.told import STUDIED, TOLD
from tests.benchmarks.accuracy.world import Recording
from tracker.estimator import Estimator, Pose
from tracker.estimators import SELECTORS, SENSORS, Settings, build
from tracker.evaluate import Run, follow
from tracker.family import PaperFamily, follow_family
from tracker.geomagnetism import declination_rad, magnetic_field
from tracker.measurements import GpsFix, ImuSample, MagSample, Measurement, Outcome, TruePose
from tracker.pipeline import Pipeline
from tracker.score import RATE_HZ
from tracker.simulate import START_NS

if TYPE_CHECKING:
    from tests.benchmarks.accuracy.rivals import Rival

RAW = "gps"
PAPER_MODELS = ("cmm", "famm")
PERIOD_NS = round(1e9 / RATE_HZ)
AHEAD_NS = 50_000_000
"""How far ahead a pose is asked for: when a picture will be seen."""


@dataclass
class Watched:
    """A run, and what is noted beside it."""

    run: Run
    ahead: list[Pose] = field(default_factory=list)
    """For each pose, the one that was foreseen then for 50 ms later; empty where nobody asked."""
    cpu_us: float | None = None
    """Mean time of the processor for each inertial sample, all measurements together."""


class _Watch(Pipeline):
    """A pipeline that is also asked for the pose in 50 ms, and whose work is timed."""

    def __init__(self, estimator: Estimator) -> None:
        super().__init__(estimator)
        self.ahead: list[Pose] = []
        self.took_ns = 0

    def step(self, measurement: Measurement) -> Outcome:
        began_ns = thread_time_ns()
        outcome = super().step(measurement)
        self.took_ns += thread_time_ns() - began_ns
        return outcome

    def predict(self, t_ns: int) -> Pose | None:
        pose = super().predict(t_ns)
        foreseen = super().predict(t_ns + AHEAD_NS) if pose is not None else None
        if foreseen is not None:
            self.ahead.append(foreseen)
        return pose


def rivals() -> "dict[str, Rival]":
    """Return other people's filters by name; each library is imported by who runs it."""
    found: dict[str, Rival] = import_module("tests.benchmarks.accuracy.rivals").RIVALS
    return found


def precise(recording: Recording, name: str, settings: Settings | None = None) -> Watched:
    """Run `gps-imu/precise` or `camera-gps-imu/precise`."""
    walk = recording.walk
    origin = walk.settings.origin
    has_field = any(isinstance(m, MagSample) for m in recording.measurements)
    estimator = build(
        name,
        origin=origin,
        rig=walk.rig,
        declination_rad=declination_rad(origin, START_NS) if has_field else 0.0,
        earth_field=magnetic_field(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, START_NS),
        settings=settings,
        eyes_z_m=recording.eyes_z_m,
    )
    watch, run = _Watch(estimator), blank(recording, name)
    follow(watch, recording.measurements, run)
    return Watched(run, watch.ahead, watch.took_ns * 1e-3 / run.counts["imu"])


def paper(recording: Recording, sensors: str) -> Iterator[Watched]:
    """Run the paper's constant and fuzzy models on one set of sensors."""
    origin = recording.walk.settings.origin
    has_field = any(isinstance(m, MagSample) for m in recording.measurements)
    family = PaperFamily(
        sensors,
        {name: SELECTORS[name]() for name in PAPER_MODELS},
        origin=origin,
        rig=recording.walk.rig,
        declination_rad=declination_rad(origin, START_NS) if has_field else 0.0,
    )
    for run in follow_family(family, recording.measurements, blank(recording, sensors)):
        yield Watched(run)


def rival(recording: Recording, name: str) -> Watched:
    """Run a rival, or the raw receiver."""
    run = blank(recording, name)
    run.truth = [m for m in recording.measurements if isinstance(m, TruePose)]
    told = [m for m in recording.measurements if not isinstance(m, TruePose)]
    run.fixes = [m for m in told if isinstance(m, GpsFix) and m.valid]
    run.counts["imu"] = sum(isinstance(m, ImuSample) for m in told)
    ticks_ns = range(START_NS + PERIOD_NS, recording.measurements[-1].t_recv_ns, PERIOD_NS)
    work = held_fixes if name == RAW else rivals()[name]
    run.poses = work(told, run.origin, recording.walk.rig, ticks_ns)
    return Watched(run)


def blank(recording: Recording, name: str) -> Run:
    """Return a run in which nothing has happened yet."""
    settings = recording.walk.settings
    title = f"{recording.scenario.name}-{recording.seed}"
    return Run(title, name, START_NS, settings.duration_s, settings.origin, settings.origin)


def run_unit(recording: Recording, unit: str, settings: Settings | None = None) -> list[Watched]:
    """Run one unit of work: an estimator by name, or `SENSORS/paper`, both of the paper's models on the same sensors."""
    sensors, _, kind = unit.rpartition("/")
    if sensors in SENSORS and kind == "paper":
        return list(paper(recording, sensors))
    if unit == TOLD:
        watched = precise(recording, f"{sensors}/precise", STUDIED)
        watched.run.estimator = unit
        return [watched]
    if sensors in SENSORS and kind == "precise":
        return [precise(recording, unit, settings)]
    return [rival(recording, unit)]
