"""The pipeline: who gets pictures, and what is counted."""

import numpy as np

from tracker.estimator import Innovation, Pose, Snapshot
from tracker.measurements import Frame, ImuSample, Measurement, Outcome, VisualMotion
from tracker.pictures import ArrayPicture
from tracker.pipeline import Pipeline

PICTURE = ArrayPicture(np.zeros((4, 4, 3), np.uint8))
MOTION = VisualMotion(1, 1, 0, 0, np.eye(3), (0.0, 0.0, 0.0), 50, 1.0, False)


class Recorder:
    """An estimator that remembers what it was fed, and rejects stale samples."""

    name = "recorder"

    def __init__(self, uses_camera: bool) -> None:
        self.uses_camera = uses_camera
        self.fed: list[Measurement] = []

    def step(self, measurement: Measurement) -> Outcome:
        """Remember it."""
        self.fed.append(measurement)
        return Outcome.REJECTED_STALE if measurement.t_ns == 0 else Outcome.USED

    def predict(self, t_ns: int) -> Pose | None:
        """Know nothing."""
        return None

    def innovations(self) -> list[Innovation]:
        """Return nothing."""
        return []

    def snapshot(self) -> Snapshot:
        """Return what was fed."""
        return list(self.fed)

    def restore(self, snapshot: Snapshot) -> None:
        """Go back."""
        self.fed = list(snapshot)


class Eyes:
    """A front end that sees motion in every second picture."""

    def __init__(self) -> None:
        self.seen = 0

    def step(self, frame: Frame) -> VisualMotion | None:
        """Count."""
        self.seen += 1
        return MOTION if self.seen % 2 == 0 else None

    def snapshot(self) -> Snapshot:
        """Return the count."""
        return self.seen

    def restore(self, snapshot: Snapshot) -> None:
        """Go back."""
        self.seen = snapshot


def _frame(number: int) -> Frame:
    return Frame(number, number, number, PICTURE)


def test_pictures_become_motions_for_those_with_eyes() -> None:
    """A picture that shows none is counted as weak; others never see one."""
    seeing = Pipeline(Recorder(uses_camera=True), Eyes())
    assert [seeing.step(_frame(n)) for n in (1, 2, 3)] == [Outcome.REJECTED_WEAK, Outcome.USED, Outcome.REJECTED_WEAK]
    assert seeing.estimator.snapshot() == [MOTION]
    assert seeing.rejected == {"weak": 2}
    blind = Pipeline(Recorder(uses_camera=False), Eyes())
    assert blind.step(_frame(1)) is Outcome.IGNORED
    assert blind.estimator.snapshot() == []
    assert blind.front_end is None


def test_rejections_are_counted_and_a_snapshot_takes_everything_back() -> None:
    """Estimator, eyes and counts."""
    pipeline = Pipeline(Recorder(uses_camera=True), Eyes())
    sample = ImuSample(0, 0, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81))
    pipeline.step(sample)
    pipeline.step(_frame(1))
    snapshot = pipeline.snapshot()
    for _ in range(3):
        pipeline.step(sample)
        pipeline.step(_frame(2))
    pipeline.restore(snapshot)
    assert pipeline.rejected == {"stale": 1, "weak": 1}
    assert pipeline.step(_frame(2)) is Outcome.USED
    assert pipeline.estimator.snapshot() == [sample, MOTION]
    assert pipeline.predict(5) is None
    assert pipeline.innovations() == []
