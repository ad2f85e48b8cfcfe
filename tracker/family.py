"""Several motion models of one set of sensors: the sensors are stepped once, and each filter is given every cycle.

What the sensors say does not depend on the filter, so each member's run is the one that its estimator would have had alone, bit
for bit, at a part of the cost: a study compares rivals that have seen exactly the same.
"""

from collections.abc import Iterable, Mapping
from copy import deepcopy

import numpy as np

from tracker.cycle import Cycle
from tracker.estimator import Innovation, Origin, Pose, Snapshot
from tracker.evaluate import Run, feed, ticks
from tracker.measurements import Matrix, Measurement, Outcome
from tracker.motion import MotionSelector
from tracker.paper import PaperEstimator, PaperSettings
from tracker.pipeline import Pipeline
from tracker.rig import Rig
from tracker.sensor_pose import SensorPose


class PaperFamily:
    """An estimator whose `members` share its sensors; what it says itself is what its first member says."""

    def __init__(
        self,
        sensors_name: str,
        selectors: Mapping[str, MotionSelector],
        *,
        origin: Origin,
        rig: Rig,
        declination_rad: float,
        settings: PaperSettings | None = None,
    ) -> None:
        """Build one member for each of `selectors`, named for instance `gps-imu/famm`; `sensors_name` is its first half."""
        if not selectors:
            raise ValueError("a family has at least one member")
        self._name = sensors_name
        self._uses_camera = sensors_name.startswith("camera")
        settings = settings or PaperSettings()
        self._sensors = SensorPose(settings.sensors, origin, rig, declination_rad, self._uses_camera)
        self.members = [
            PaperEstimator(
                f"{sensors_name}/{name}",
                selector,
                origin=origin,
                rig=rig,
                declination_rad=declination_rad,
                uses_camera=self._uses_camera,
                settings=settings,
                sensors=self._sensors,
            )
            for name, selector in selectors.items()
        ]
        self.cycles: list[Cycle] = []
        """All that the sensors have made so far."""

    @property
    def name(self) -> str:
        """The sensors: `gps-imu` or `camera-gps-imu`."""
        return self._name

    @property
    def uses_camera(self) -> bool:
        """Whether it wants `VisualMotion`."""
        return self._uses_camera

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement in order of arrival."""
        outcome = self._sensors.step(measurement)
        cycle = self._sensors.take()
        if cycle is not None:
            self.cycles.append(cycle)
            for member in self.members:
                member.filter(cycle)
        return outcome

    def predict(self, t_ns: int) -> Pose | None:
        """Return the first member's pose at t_ns."""
        return self.members[0].predict(t_ns)

    def poses(self, t_ns: int) -> list[Pose | None]:
        """Return every member's pose at t_ns: how far the sensors have carried it is looked up once."""
        path = self._sensors.path
        then, cycle = path.at(t_ns), path.at(self.cycles[-1].t_ns if self.cycles else 0)
        return [member.carried(t_ns, then, cycle) for member in self.members]

    def innovations(self) -> list[Innovation]:
        """Return the first member's updates since the last call and forget them."""
        return self.members[0].innovations()

    def snapshot(self) -> Snapshot:
        """Return the whole state: in one copy, so that its members go on sharing their sensors."""
        return deepcopy((self._sensors, self.members, self.cycles))

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._sensors, self.members, self.cycles = deepcopy(snapshot)


def follow_family(family: PaperFamily, measurements: Iterable[Measurement], template: Run) -> list[Run]:
    """Feed measurements, in order of arrival, and return what comes out: a run for each member, without times taken.

    Args:
        family: Newly built.
        measurements: May be read once.
        template: Says what is run (`log`, start, duration, origins); nothing is written into it.
    """
    pipeline = Pipeline(family)
    shared = _blank(template, family.name)
    runs = [_blank(template, member.name) for member in family.members]
    sigmas: list[list[Matrix]] = [[] for _ in runs]
    for due_ns, measurement in ticks(measurements, template.t_start_ns):
        if measurement is not None:
            feed(pipeline, measurement, shared)
            continue
        on_second = (due_ns - template.t_start_ns) % 1_000_000_000 < 20_000_000
        for member, pose, run, sigma in zip(family.members, family.poses(due_ns), runs, sigmas, strict=True):
            if pose is not None:
                run.poses.append(pose)
            Sigma = member.state_covariance() if on_second else None
            if Sigma is not None:
                sigma.append(Sigma)
    for member, run, sigma in zip(family.members, runs, sigmas, strict=True):
        run.truth, run.fixes, run.counts, run.rejected = shared.truth, shared.fixes, shared.counts, pipeline.rejected
        run.innovations = member.innovations()
        run.state_covariance = np.mean(sigma, axis=0) if sigma else None
    return runs


def _blank(template: Run, estimator: str) -> Run:
    return Run(
        template.log,
        estimator,
        template.t_start_ns,
        template.duration_s,
        template.origin,
        template.truth_origin,
    )
