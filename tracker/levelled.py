"""An estimator whose first pose is lifted to a given height, and all others by as much: for a site laid where a walk began."""

from dataclasses import replace

from tracker.estimator import Estimator, Innovation, Pose, Snapshot
from tracker.measurements import Measurement, Outcome, Sighting, Standpoint


class Levelled:
    """Another estimator's poses, shifted in height."""

    def __init__(self, estimator: Estimator, first_z_m: float) -> None:
        """`first_z_m` is where the first pose is to be in site: one eye height for a paving below it."""
        self._estimator, self._first_z_m = estimator, first_z_m
        self._lift_m: float | None = None
        """None until the first pose."""

    @property
    def name(self) -> str:
        """The other's."""
        return self._estimator.name

    @property
    def uses_camera(self) -> bool:
        """Whether the other wants `VisualMotion`."""
        return self._estimator.uses_camera

    def step(self, measurement: Measurement) -> Outcome:
        """Pass on a measurement, and look out for the first pose."""
        outcome = self._estimator.step(self._lowered(measurement))
        if self._lift_m is None and (pose := self._estimator.predict(measurement.t_ns)) is not None:
            self._lift_m = self._first_z_m - pose.p_site_m[2]
        return outcome

    def _lowered(self, measurement: Measurement) -> Measurement:
        """Return what visitors say of heights, which they see lifted, as the other estimator has them."""
        lift_m = self._lift_m or 0.0
        if isinstance(measurement, Sighting):
            e, n, u = measurement.point_site_m
            return replace(measurement, point_site_m=(e, n, u - lift_m))
        if isinstance(measurement, Standpoint):
            e, n, u = measurement.p_site_m
            return replace(measurement, p_site_m=(e, n, u - lift_m))
        return measurement

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at t_ns, lifted."""
        pose = self._estimator.predict(t_ns)
        if pose is None or self._lift_m is None:
            return None
        east_m, north_m, up_m = pose.p_site_m
        return replace(pose, p_site_m=(east_m, north_m, up_m + self._lift_m))

    def innovations(self) -> list[Innovation]:
        """Return the other's filter updates, which are differences and stay as they are."""
        return self._estimator.innovations()

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return self._estimator.snapshot(), self._lift_m

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        estimator, self._lift_m = snapshot
        self._estimator.restore(estimator)
