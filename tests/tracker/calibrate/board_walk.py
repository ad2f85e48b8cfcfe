"""A rig that turns before a board: the board's views and the gyroscope, with planted mount and clock."""

from dataclasses import dataclass

import numpy as np

from tests.tracker.calibrate.board_video import BoardVideo, rotation
from tests.tracker.calibrate.rig_motion import RigMotion
from tracker.measurements import Frame, Matrix
from tracker.rig import R_BODY_CAM_FORWARD, CameraModel

CAMERA = CameraModel(640, 480, 560.0, 558.0, 325.3, 236.1, "plumb_bob", (-0.28, 0.09, 0.0008, -0.0005, 0.0))


@dataclass(frozen=True, eq=False)
class BoardWalk:
    """Everything follows from the seed: mount, time offset, motion, noise."""

    seed: int
    rate_hz: float = 12.0
    lively: bool = False
    """Comes nearer, turns further, and so shows the board in every part of the picture: that tells the lens as well."""

    @property
    def video(self) -> BoardVideo:
        """The camera before its board."""
        return BoardVideo(CAMERA, seed=self.seed)

    @property
    def motion(self) -> RigMotion:
        """Turns that leave the board in the picture most of the time."""
        return (
            RigMotion(self.seed, 15.0, (0.5, 0.35, 0.45))
            if self.lively
            else RigMotion(self.seed, 10.0, (0.3, 0.2, 0.25))
        )

    @property
    def R_body_cam(self) -> Matrix:
        """The mount: a few degrees from looking ahead."""
        return R_BODY_CAM_FORWARD @ rotation(np.random.default_rng([self.seed, 1]).normal(0.0, 0.06, 3))

    @property
    def offset_s(self) -> float:
        """Added to the camera's time: the gyroscope's."""
        return float(np.random.default_rng([self.seed, 2]).uniform(-0.08, 0.08))

    def frames(self, t_zero_ns: int) -> list[Frame]:
        """Return the pictures, in which the camera also moves to and fro."""
        video, R = self.video, self.R_body_cam
        times_s = np.arange(0.0, self.motion.duration_s, 1.0 / self.rate_hz)
        attitudes = self.motion.R_start_body(times_s + self.offset_s)
        R_first_board = rotation(np.array([0.1, 0.2, 0.05]))
        middle_m = video.board.corners_m.mean(axis=0)
        frames = []
        for number, (t_s, R_start_body) in enumerate(zip(times_s.tolist(), attitudes, strict=True)):
            R_cam_first = (R.T @ R_start_body @ R).T
            sway = np.array([0.05 * np.sin(t_s), 0.04 * np.cos(1.3 * t_s), 0.05 * np.sin(0.7 * t_s)])
            seen_m = np.array([0.0, 0.0, 0.33]) + 1.8 * sway if self.lively else np.array([0.0, 0.0, 0.42]) + sway
            R_cam_board = R_cam_first @ R_first_board
            place_m = R_cam_first @ seen_m - R_cam_board @ middle_m
            frames.append(video.frame(t_zero_ns + round(t_s * 1e9), R_cam_board, place_m, number))
        return frames
