"""An estimator that forgets what somebody has said, when it is taken back: as if it had never been said, bit for bit.

Before each sighting or standpoint the estimator is copied, and the copy lives on beside it for a while, fed with everything
else. Taking back puts the copy in its place. That costs as much again as the estimator itself, as long as there are copies.
"""

from collections.abc import Callable
from typing import NamedTuple

from tracker.estimator import Estimator, Innovation, Pose, Snapshot
from tracker.measurements import Measurement, Outcome, Retraction, Sighting, Standpoint
from tracker.precise.estimator import PreciseEstimator
from tracker.precise.memory import Memory

#: Who has looked at the result for so long has kept it.
KEPT_S = 60.0
#: So many can be taken back, one after another.
MOST = 3


class _Before(NamedTuple):
    """The estimator that was not told."""

    told_ns: int
    """When the other one was."""
    estimator: Estimator


class Retractable:
    """Another estimator, and for a while what it would be without what was said last."""

    def __init__(self, make: Callable[[], Estimator]) -> None:
        """`make` returns a new estimator; all that it returns are built alike."""
        self._make = make
        self._estimator = make()
        self._before: list[_Before] = []

    def memory(self) -> Memory | None:
        """Return what the other has learned that is worth keeping for the next start, if it is of the kind that learns."""
        return self._estimator.memory() if isinstance(self._estimator, PreciseEstimator) else None

    @property
    def name(self) -> str:
        """The other's."""
        return self._estimator.name

    @property
    def uses_camera(self) -> bool:
        """Whether the other wants `VisualMotion`."""
        return self._estimator.uses_camera

    def step(self, measurement: Measurement) -> Outcome:
        """Pass on a measurement, or take the last word back."""
        if self._before:
            oldest_ns = measurement.t_recv_ns - round(KEPT_S * 1e9)
            self._before = [one for one in self._before if one.told_ns >= oldest_ns]
        if isinstance(measurement, Retraction):
            return self._take_back()
        if isinstance(measurement, Sighting | Standpoint):
            return self._tell(measurement)
        for one in self._before:
            one.estimator.step(measurement)
        return self._estimator.step(measurement)

    def _tell(self, said: Sighting | Standpoint) -> Outcome:
        before = self._copy(self._estimator.snapshot())
        outcome = self._estimator.step(said)
        if outcome is Outcome.USED or outcome is Outcome.WAITING:
            self._before = [*self._before[1 - MOST :], _Before(said.t_recv_ns, before)]
        return outcome

    def _take_back(self) -> Outcome:
        if not self._before:
            return Outcome.REJECTED_STALE
        self._estimator = self._before.pop().estimator
        return Outcome.USED

    def _copy(self, snapshot: Snapshot) -> Estimator:
        copy = self._make()
        copy.restore(snapshot)
        return copy

    def predict(self, t_ns: int) -> Pose | None:
        """Return the other's pose."""
        return self._estimator.predict(t_ns)

    def innovations(self) -> list[Innovation]:
        """Return the other's filter updates."""
        for one in self._before:
            one.estimator.innovations()
        return self._estimator.innovations()

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return self._estimator.snapshot(), [(one.told_ns, one.estimator.snapshot()) for one in self._before]

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        estimator, before = snapshot
        self._estimator.restore(estimator)
        self._before = [_Before(told_ns, self._copy(of)) for told_ns, of in before]
