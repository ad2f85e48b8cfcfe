"""An estimator with the camera's front end before it: what a log or a rig's sensors are fed to."""

from collections import Counter
from typing import Protocol

from tracker.estimator import Estimator, Innovation, Pose, Snapshot
from tracker.measurements import Frame, Measurement, Outcome, VisualMotion


class FrontEnd(Protocol):
    """What makes motion of pictures."""

    def step(self, frame: Frame) -> VisualMotion | None:
        """Return the motion since a keyframe; None where the picture tells none."""
        ...

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        ...

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        ...


class Pipeline:
    """Feeds an estimator: pictures go through the front end first, where the estimator has eyes."""

    def __init__(self, estimator: Estimator, front_end: FrontEnd | None = None) -> None:
        self.estimator = estimator
        self.front_end = front_end if estimator.uses_camera else None
        self.rejected: Counter[str] = Counter()
        """Measurements that were not used, by reason."""

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement, in order of arrival."""
        if isinstance(measurement, Frame):
            if self.front_end is None:
                return Outcome.IGNORED
            return self.step_vision(self.front_end.step(measurement))
        if isinstance(measurement, VisualMotion) and self.front_end is not None:
            return Outcome.IGNORED  # what a live front end had made of a picture that this one looks at itself
        return self._feed(measurement)

    def step_vision(self, motion: VisualMotion | None) -> Outcome:
        """Take what the front end made of a picture."""
        if motion is None:
            self.rejected[Outcome.REJECTED_WEAK.value] += 1
            return Outcome.REJECTED_WEAK
        return self._feed(motion)

    def _feed(self, measurement: Measurement) -> Outcome:
        outcome = self.estimator.step(measurement)
        if outcome.name.startswith("REJECTED"):
            self.rejected[outcome.value] += 1
        return outcome

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at t_ns."""
        return self.estimator.predict(t_ns)

    def innovations(self) -> list[Innovation]:
        """Return the filter updates since the last call."""
        return self.estimator.innovations()

    def snapshot(self) -> Snapshot:
        """Return the state of estimator, front end and counts."""
        front_end = self.front_end.snapshot() if self.front_end else None
        return self.estimator.snapshot(), front_end, self.rejected.copy()

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        estimator, front_end, rejected = snapshot
        self.estimator.restore(estimator)
        if self.front_end is not None:
            self.front_end.restore(front_end)
        self.rejected = rejected.copy()
