"""How a rival that runs live is asked: at each tick it knows what had arrived by then, and nothing else."""

from collections.abc import Sequence
from typing import Protocol

from tracker.estimator import Pose
from tracker.measurements import Measurement


class Online(Protocol):
    """A rival that runs live."""

    def add(self, measurement: Measurement) -> None:
        """Take the next measurement to arrive."""
        ...

    def pose(self, t_ns: int) -> Pose | None:
        """Return the pose at a time, which is now; None before there is one."""
        ...


def follow(rival: Online, measurements: Sequence[Measurement], ticks: Sequence[int]) -> list[Pose]:
    """Feed measurements in order of arrival and return the poses at ticks."""
    poses, rest = [], iter(measurements)
    measurement = next(rest, None)
    for t_ns in ticks:
        while measurement is not None and measurement.t_recv_ns <= t_ns:
            rival.add(measurement)
            measurement = next(rest, None)
        pose = rival.pose(t_ns)
        if pose is not None:
            poses.append(pose)
    return poses
