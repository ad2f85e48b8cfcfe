"""One cycle of the paper's filter: predict, measure, update, and the choice of the next motion model.

A cycle's measurements do not depend on the filter, so one recording of them serves every filter, motion model and setting: what
a study compares has seen the same.
"""

from dataclasses import dataclass
from math import hypot, sqrt
from typing import Literal, TypeAlias

from tracker.estimator import Innovation
from tracker.fusion import FusionSettings
from tracker.measurements import Vector3
from tracker.motion import MotionFilter, MotionSelector

#: What the controller is given: the innovation as it is (metres, radians), or divided by what the filter expected of it.
InnovationReading: TypeAlias = Literal["metres", "nis"]


@dataclass(frozen=True, slots=True)
class Cycle:
    """All that the sensors say at one time, and nothing of the filter."""

    t_ns: int
    m_P: Vector3
    """Measured position in site, m."""
    var_P_m2: Vector3
    m_R: Vector3
    """Measured roll, pitch, yaw of the body in site, rad."""
    turned_rad: float = 0.0
    """North has become known, or better known, since the last cycle: the whole past is turned about the vertical."""
    widened_m2: float = 0.0
    """What a late fix says of how far the position may have gone astray."""
    moved_to: Vector3 | None = None
    """A position that is to be taken as it is: the receiver has insisted on it."""


class CycleFilter:
    """A filter and its selector, fed cycle by cycle."""

    def __init__(
        self, selector: MotionSelector, settings: FusionSettings, innovation: InnovationReading = "metres"
    ) -> None:
        self._selector = selector
        self._settings = settings
        self._innovation = innovation
        self.filter: MotionFilter | None = None
        """None before the first cycle."""
        self.model = selector.first
        """What the next prediction is made with."""
        self.t_ns = 0
        """Of the last cycle."""

    def step(self, cycle: Cycle) -> Innovation | None:
        """Take one cycle; return what its update saw, None of the first."""
        filter_ = self.filter
        if filter_ is None:
            self.filter = self._selector.filter_kind.start(self._settings, cycle.m_P, cycle.m_R, cycle.var_P_m2)
            self.t_ns = cycle.t_ns
            return None
        filter_.widen(cycle.widened_m2)
        if cycle.moved_to is not None:
            filter_.move_to(cycle.moved_to)
        if cycle.turned_rad:
            filter_.turn(cycle.turned_rad)
        filter_.predict((cycle.t_ns - self.t_ns) * 1e-9, self.model)
        self.t_ns = cycle.t_ns
        y_p, y_r = filter_.innovation(cycle.m_P, cycle.m_R)
        size_p, size_r = self._sizes(filter_, y_p, y_r, cycle.var_P_m2)
        filter_.update(y_p, y_r, cycle.var_P_m2)
        seen = Innovation(cycle.t_ns, y_p, y_r, str(self.model))
        self.model = self._selector.following(size_p, size_r, filter_, self.model)
        return seen

    def _sizes(self, filter_: MotionFilter, y_p: Vector3, y_r: Vector3, var_P_m2: Vector3) -> tuple[float, float]:
        """Return the two magnitudes that a motion model is chosen by: metres and radians, or square roots of their NIS."""
        if self._innovation == "metres":
            return hypot(*y_p), hypot(*y_r)
        var, r = filter_.var_value, self._settings.rotation_sigma_rad**2
        nis_p = sum(y * y / (v + n) for y, v, n in zip(y_p, var[:3], var_P_m2, strict=True))
        nis_r = sum(y * y / (v + r) for y, v in zip(y_r, var[3:], strict=True))
        return sqrt(nis_p), sqrt(nis_r)
