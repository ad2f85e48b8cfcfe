"""Pictures with their poses on their way out: to the server over a rig's link, and onto the operator's console."""

from time import monotonic_ns

from server.console import Console
from server.push import RigLink, frame_message, pose_message
from tracker.errors import MalformedInput
from tracker.estimator import Pose
from tracker.geometry import transform
from tracker.playback import Shown
from tracker.rig import CameraModel, Rig


class Presenter:
    """Sends what a walk shows. Its methods are called by one thread."""

    def __init__(self, link: RigLink, rig: Rig, console: Console | None = None) -> None:
        """`rig` has a camera, if only a guessed one: without intrinsics nothing can be drawn."""
        self._link, self._rig, self._console = link, rig, console
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
        if pose is None:
            return
        self.show_pose(pose, estimator)
        if self._console is not None and self._rig.camera is not None:
            if did_seek:
                self._console.clear()
            T_site_cam = transform(pose.wxyz_site_body, pose.p_site_m) @ self._rig.T_body_cam
            self._console.show(T_site_cam, self._rig.camera, pose.motion_model)

    def show_pose(self, pose: Pose, estimator: str) -> None:
        """Send a pose for those who show no picture."""
        self._sequence += 1
        self._link.send_pose(pose_message(pose, seq=self._sequence, estimator=estimator))
