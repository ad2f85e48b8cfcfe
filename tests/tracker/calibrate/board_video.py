"""A simulated board video: a camera with a lens moves before a board; blur, noise and compression as in cheap webcams."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import cv2
import numpy as np

from tracker import lens
from tracker.calibrate.board import CELLS, Board
from tracker.measurements import Frame, Image, Matrix
from tracker.pictures import EncodedPicture
from tracker.rig import CameraModel

CELL_PX = 12
_FINER = 2


def rotation(rotation_rad: Matrix) -> Matrix:
    """Return (3, 3) of a rotation vector."""
    return np.asarray(cv2.Rodrigues(np.asarray(rotation_rad, np.float64))[0], np.float64)


@dataclass(frozen=True, eq=False)
class BoardVideo:
    """A board in front of a wall, drawn through a lens."""

    camera: CameraModel
    board: Board = field(default_factory=Board)
    seed: int = 1
    noise: float = 3.0
    """Of grey levels, one sigma."""
    blur_px: float = 0.7
    quality: int = 85

    @cached_property
    def _texture(self) -> Image:
        """The board on white paper, one square of margin."""
        cells = np.where(self.board.cells(), 225, 25).astype(np.uint8)
        paper = cv2.copyMakeBorder(
            np.kron(cells, np.ones((CELL_PX, CELL_PX), np.uint8)),
            *(CELLS * CELL_PX,) * 4,
            cv2.BORDER_CONSTANT,
            value=(225,),
        )
        return np.asarray(cv2.GaussianBlur(paper, (0, 0), 1.5), np.uint8)

    @cached_property
    def _rays(self) -> Matrix:
        """Rays of all finer pixels, (2, H, W), single as OpenCV wants them."""
        width, height = self.camera.width_px * _FINER, self.camera.height_px * _FINER
        u, v = np.meshgrid((np.arange(width) + 0.5) / _FINER - 0.5, (np.arange(height) + 0.5) / _FINER - 0.5)
        rays = lens.unproject(self.camera, np.column_stack([u.ravel(), v.ravel()]))
        return np.ascontiguousarray(rays.T.reshape(2, height, width), np.float32)

    def picture(self, R_cam_board: Matrix, p_cam_board_m: Matrix, number: int = 0) -> Image:
        """Return what the camera sees, grey."""
        # a ray x, y, 1 meets the plane where H (u, v, 1) ~ (x, y, 1)
        H = np.linalg.inv(np.column_stack([R_cam_board[:, 0], R_cam_board[:, 1], p_cam_board_m])).astype(np.float32)
        x, y = self._rays
        w = H[2, 0] * x + H[2, 1] * y + H[2, 2]
        px_per_m = CELLS * CELL_PX / self.board.square_m
        margin = CELLS * CELL_PX - 0.5
        with np.errstate(divide="ignore"):  # a ray along the board meets it nowhere
            u = (H[0, 0] * x + H[0, 1] * y + H[0, 2]) / w * px_per_m + margin
            v = (H[1, 0] * x + H[1, 1] * y + H[1, 2]) / w * px_per_m + margin
        wall = 90
        drawn = cv2.remap(
            self._texture,
            u,
            v,
            cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_CONSTANT,
            borderValue=(wall,),
        )
        small = cv2.resize(drawn, (self.camera.width_px, self.camera.height_px), interpolation=cv2.INTER_AREA)
        soft = cv2.GaussianBlur(small, (0, 0), self.blur_px).astype(np.float64)
        rng = np.random.default_rng([self.seed, number])
        return np.asarray(np.clip(soft + rng.normal(0.0, self.noise, soft.shape), 0, 255), np.uint8)

    def frame(self, t_ns: int, R_cam_board: Matrix, p_cam_board_m: Matrix, number: int) -> Frame:
        """Return it compressed, as a camera's frame."""
        picture = self.picture(R_cam_board, p_cam_board_m, number)
        _, data = cv2.imencode(".jpg", picture, (cv2.IMWRITE_JPEG_QUALITY, self.quality))
        return Frame(t_ns, t_ns + 20_000_000, number, EncodedPicture(data.tobytes()))


def shown_around(video: BoardVideo, count: int) -> Iterator[tuple[Matrix, Matrix]]:
    """Yield poses of a board that somebody shows in every part of the picture, near and far, and slanted to each side."""
    rng = np.random.default_rng([video.seed, 77])
    camera, board = video.camera, video.board
    middle = board.corners_m.mean(axis=0)
    for i in range(count):
        distance_m = rng.uniform(0.22, 0.5) * camera.fx_px / camera.width_px * 1.3
        ray = lens.unproject(
            camera,
            np.array([[rng.uniform(0.12, 0.88) * camera.width_px, rng.uniform(0.12, 0.88) * camera.height_px]]),
        )[0]
        slant = rng.uniform(-0.65, 0.65, 2) * (0.0 if i % 6 == 0 else 1.0)
        R = rotation(np.array([slant[0], slant[1], rng.uniform(-0.5, 0.5)]))
        yield R, np.array([*ray, 1.0]) * distance_m - R @ middle
