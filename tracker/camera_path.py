"""The camera's own path: keyframes and pictures chained by `Tr` (eq. 1), each translation as long as something else says."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from tracker.measurements import Matrix, Vector3, VisualMotion
from tracker.transformation import transformation

#: Five seconds of a 12 Hz camera: no fix comes later than that.
_KEPT = 64
#: A picture further than this from a fix does not say where the camera was then.
_NEAR_NS = 500_000_000


@dataclass(frozen=True, slots=True)
class Sight:
    """A picture: where it was by the chain of keyframes (only differences mean something), and how it looked.

    `R_level_cam` is in the attitude filter's own frame: north may become better known after the picture was taken.
    """

    t_ns: int
    p_m: Vector3
    R_level_cam: Matrix
    path_m: Vector3
    """The inertial path's place then: what carries on where no picture follows."""


class CameraPath:
    """The recent pictures, in site axes."""

    def __init__(self) -> None:
        self._sights: deque[Sight] = deque(maxlen=_KEPT)
        self.Tr: Matrix = np.eye(4)
        """(4, 4), eq. 1, of the newest picture; the identity before the first."""
        self.R_site_level: Matrix = np.eye(3)
        """North as it is known now."""

    @property
    def newest(self) -> Sight | None:
        """The last picture."""
        return self._sights[-1] if self._sights else None

    def near(self, t_ns: int) -> Sight | None:
        """Return the picture nearest to a time; None where none is near."""
        sight = min(self._sights, key=lambda sight: abs(sight.t_ns - t_ns), default=None)
        return sight if sight is not None and abs(sight.t_ns - t_ns) <= _NEAR_NS else None

    def held(self, t_ns: int) -> Sight | None:
        """Return the picture of exactly this time."""
        return next((sight for sight in reversed(self._sights) if sight.t_ns == t_ns), None)

    def R_site_cam(self, sight: Sight) -> Matrix:
        """Return how a picture looked, by what is known of north now."""
        return self.R_site_level @ sight.R_level_cam

    def begin(self, t_ns: int, R_level_cam: Matrix, path_m: Vector3) -> Sight:
        """Return a picture that nothing is chained to: at the end of the camera's path, carried on by the IMU."""
        last = self.newest
        if last is None:
            return Sight(t_ns, path_m, R_level_cam, path_m)
        x, y, z = (p + new - old for p, new, old in zip(last.p_m, path_m, last.path_m, strict=True))
        return Sight(t_ns, (x, y, z), R_level_cam, path_m)

    def chain(self, motion: VisualMotion, key: Sight, moved_m: Vector3, R_level_cam: Matrix, path_m: Vector3) -> None:
        """Add a picture that stands off its keyframe by `moved_m`, in site; Tr is that step in the keyframe's own axes."""
        x, y, z = (self.R_site_cam(key).T @ np.array(moved_m)).tolist()
        self.Tr = transformation(motion.R_key_cam, (x, y, z))
        (kx, ky, kz), (mx, my, mz) = key.p_m, moved_m
        self._sights.append(Sight(motion.t_ns, (kx + mx, ky + my, kz + mz), R_level_cam, path_m))
