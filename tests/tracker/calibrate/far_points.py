"""What a turning camera sees of far points, as points alone: hundreds of recordings in the time that one takes to draw."""

from dataclasses import dataclass

import numpy as np

from tests.tracker.calibrate.rig_motion import RigMotion
from tracker import lens, two_view
from tracker.calibrate.camera_mount import CameraMount, aligned
from tracker.calibrate.gyro_track import GyroTrack
from tracker.calibrate.turns import PointPair, with_focal
from tracker.measurements import Matrix
from tracker.rig import CameraModel


@dataclass(frozen=True, eq=False)
class FarPoints:
    """A recording of a rig that turns on the spot, with a gyroscope and a camera that have clocks of their own."""

    motion: RigMotion
    camera: CameraModel
    R_body_cam: Matrix
    offset_s: float
    """Added to the camera's time: the rig's time of the same moment."""
    bias_rad_s: tuple[float, float, float] = (0.01, -0.02, 0.005)
    rate_hz: float = 8.0
    points: int = 40
    sigma_px: float = 0.3

    def pairs(self) -> list[PointPair]:
        """Return points of neighbouring pictures."""
        rng = np.random.default_rng([self.motion.seed, 8])
        times_s = np.arange(0.2, self.motion.duration_s - 0.2, 1.0 / self.rate_hz)
        attitudes = self.motion.R_start_body(times_s + self.offset_s) @ self.R_body_cam
        size_px = np.array([self.camera.width_px, self.camera.height_px])
        pairs = []
        for k in range(len(times_s) - 1):
            first_px = rng.uniform(0.0, 1.0, (self.points, 2)) * (size_px - 1)
            rays = two_view.bearings(lens.unproject(self.camera, first_px)) @ (attitudes[k + 1].T @ attitudes[k]).T
            second_px = lens.project(self.camera, rays[:, :2] / rays[:, 2:]) + rng.normal(
                0.0, self.sigma_px, first_px.shape
            )
            inside = np.all((second_px >= 0.0) & (second_px < size_px), axis=1)
            first_ns, second_ns = (round(t * 1e9) for t in times_s[k : k + 2].tolist())
            pairs.append(PointPair(first_ns, second_ns, first_px[inside], second_px[inside]))
        return pairs

    def mount(self) -> CameraMount:
        """Return what this recording tells alone, with no lens known; the rough place need not be looked for."""
        track = GyroTrack.of(self.motion.samples(0, bias_rad_s=self.bias_rad_s), 0)
        pairs, rough = self.pairs(), with_focal(self.camera, 1.05 * self.camera.fx_px)
        (found,), (turns,), camera = aligned(
            [(track, pairs, 0)], rough, self.R_body_cam, [self.offset_s + 0.01], focal_is_free=True
        )
        turn_rad = float(np.sum(np.linalg.norm(turns.vectors_rad, axis=1)))
        return CameraMount(found, camera, found.log_focal_sigma * camera.fx_px, 0.0, turn_rad, track, turns, pairs, 0)
