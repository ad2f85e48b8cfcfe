"""Pictures with their poses on their way out to the server, over a rig's link."""

from time import monotonic_ns

from server.push import RigLink, frame_message, pose_message
from tracker.errors import MalformedInput
from tracker.estimator import Pose
from tracker.playback import Shown
from tracker.rig import CameraModel, Rig


class Presenter:
    """Sends what a walk shows. Its methods are called by one thread."""

    def __init__(self, link: RigLink, rig: Rig) -> None:
        """`rig` has a camera, if only a guessed one: without intrinsics nothing can be drawn."""
        self._link, self._rig = link, rig
        self._sequence = 0

    @property
    def camera(self) -> CameraModel:
        """Of the pictures that are sent."""
        assert self._rig.camera is not None
        return self._rig.camera

    def show(
        self, shown: Shown, pose: Pose | None, *, estimator: str, position_s: float, did_seek: bool = False
    ) -> None:
        """Send a picture with a pose of its own capture, as it is to be shown."""
        try:
            message = frame_message(
                shown.frame,
                pose,
                self._rig,
                estimator=estimator,
                position_s=position_s,
                t_sent_ns=monotonic_ns(),
                quarter_turns=shown.quarter_turns,
                did_seek=did_seek,
            )
        except MalformedInput:
            return  # a picture that does not decode is left out, as vision leaves it out
        self._link.send_frame(message)

    def show_pose(self, pose: Pose, estimator: str, *, did_seek: bool = False) -> None:
        """Send a pose for those who show no picture: later than what was sent before, or after a seek."""
        self._sequence += 1
        self._link.send_pose(pose_message(pose, seq=self._sequence, estimator=estimator, did_seek=did_seek))
