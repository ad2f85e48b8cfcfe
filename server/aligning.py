"""What a visitor's alignment means on a rig: taps in pictures that were shown, places on the plan, and taking back."""

from math import dist, isfinite

from server.messages import ControlRequest, Here, TakeBack, Tap
from server.placing import Placing
from tracker.errors import InputError
from tracker.estimator import Pose
from tracker.measurements import Frame, Retraction, Said, Standpoint
from tracker.rig import CameraModel
from tracker.said import sighting

#: Pictures that a visitor may still be looking at: a minute of them.
_MOST_FRAMES = 1800


class Aligner:
    """Knows the pictures that were shown. Noted by one thread, asked by another; no step of either is seen half done."""

    def __init__(self, placing: Placing) -> None:
        self._placing = placing
        self._frames: dict[int, int] = {}
        self._pose: Pose | None = None

    def note(self, frame: Frame, pose: Pose | None) -> None:
        """Take note of a picture that goes out, and of its pose as it is shown."""
        self._frames.pop(frame.frame_id, None)  # a replay shows one again, and it is the newest then
        self._frames[frame.frame_id] = frame.t_ns
        while len(self._frames) > _MOST_FRAMES:
            del self._frames[next(iter(self._frames))]
        self._pose = pose or self._pose

    def said(self, request: ControlRequest, camera: CameraModel) -> Said:
        """Return what a request says; `camera` is that of the pictures.

        A place and a retraction are of the moment at which they are fed, whatever their stamps.

        Raises:
            InputError: It is no alignment, or of a picture that nobody remembers.
        """
        match request.value:
            case Tap() as tap:
                t_ns = self._frames.get(tap.frame_id)
                if t_ns is None:
                    raise InputError("That picture is too long ago: tap again in a newer one.")
                away_m = None if self._pose is None else dist(self._pose.p_site_m, tap.point_site_m)
                return sighting(
                    camera, tap.place_px, tap.sigma_px, tap.point_site_m, t_ns=t_ns, t_recv_ns=t_ns, distance_m=away_m
                )
            case Here() as here:
                return Standpoint(0, 0, (here.e_m, here.n_m, self._eyes_z_m(here)), here.sigma_m)
            case TakeBack():
                return Retraction(0, 0)
        raise InputError("An alignment is a tap, a place, or the taking back of one.")

    def _eyes_z_m(self, here: Here) -> float:
        """Return how high the eyes of who stands there are: by where one can stand, else by the ground."""
        z_m = (
            self._placing.eyes_z_m(here.e_m, here.n_m) if self._placing.anchor == "site" else self._placing.eye_height_m
        )
        return z_m if isfinite(z_m) else self._placing.ground_z_m(here.e_m, here.n_m) + self._placing.eye_height_m
