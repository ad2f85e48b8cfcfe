"""What a turning camera sees of a world that is far away: a sphere of blobs, drawn through a lens, as grey pictures."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from tests.tracker.calibrate.rig_motion import RigMotion
from tracker import lens, two_view
from tracker.calibrate.flow import Flow
from tracker.calibrate.turns import PointPair
from tracker.measurements import Frame, Image, Matrix
from tracker.pictures import EncodedPicture
from tracker.rig import CameraModel

_WIDTH, _HEIGHT = 4096, 2048


@dataclass(frozen=True, eq=False)
class PanVideo:
    """A camera on a rig that turns on the spot."""

    camera: CameraModel
    motion: RigMotion
    R_body_cam: Matrix
    offset_s: float
    """Added to the camera's time: the rig's time of the same moment."""
    rate_hz: float = 15.0
    readout_s: float = 0.0
    """From the first row to the last, about the middle of the picture's time."""

    @cached_property
    def _world(self) -> Image:
        rng = np.random.default_rng([self.motion.seed, 9])
        coarse = rng.integers(30, 226, (_HEIGHT // 16, _WIDTH // 16)).astype(np.uint8)
        return np.asarray(cv2.resize(coarse, (_WIDTH, _HEIGHT), interpolation=cv2.INTER_CUBIC), np.uint8)

    @cached_property
    def _rays(self) -> Matrix:
        u, v = np.meshgrid(np.arange(self.camera.width_px), np.arange(self.camera.height_px))
        return two_view.bearings(lens.unproject(self.camera, np.column_stack([u.ravel(), v.ravel()])))

    def picture(self, t_s: float, number: int) -> Image:
        """Return what is seen at a time of the camera's clock."""
        rows_s = self.readout_s * ((np.arange(self.camera.height_px) + 0.5) / self.camera.height_px - 0.5)
        R_rows = self.motion.R_start_body(t_s + self.offset_s + rows_s) @ self.R_body_cam
        rays = self._rays.reshape(self.camera.height_px, self.camera.width_px, 3)
        x, y, z = np.moveaxis(np.einsum("hij,hwj->hwi", R_rows, rays), 2, 0)
        # body x is ahead: the seam of the map lies behind
        u = (np.arctan2(y, x) / (2 * np.pi) + 0.5) * _WIDTH
        v = (np.arccos(np.clip(z, -1.0, 1.0)) / np.pi) * _HEIGHT
        seen = cv2.remap(self._world, u.astype(np.float32), v.astype(np.float32), cv2.INTER_LINEAR)
        noise = np.random.default_rng([self.motion.seed, number]).normal(0.0, 3.0, seen.shape)
        return np.asarray(np.clip(seen + noise, 0, 255), np.uint8)

    def frames(self, t_zero_ns: int) -> list[Frame]:
        """Return all pictures of the motion, compressed."""
        frames = []
        for number, t_s in enumerate(np.arange(0.1, self.motion.duration_s - 0.1, 1.0 / self.rate_hz).tolist()):
            _, data = cv2.imencode(".jpg", self.picture(t_s, number), (cv2.IMWRITE_JPEG_QUALITY, 85))
            t_ns = t_zero_ns + round(t_s * 1e9)
            frames.append(Frame(t_ns, t_ns + 30_000_000, number, EncodedPicture(data.tobytes())))
        return frames

    def pairs(self, t_zero_ns: int) -> list[PointPair]:
        """Return the corners that were followed."""
        flow = Flow()
        return [pair for frame in self.frames(t_zero_ns) if (pair := flow.step(frame)) is not None]
