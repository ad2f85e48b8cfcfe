"""The operator's console: a viser scene with the path coloured by motion model, the camera's frustum and the model.

viser is imported when the console starts, because that takes longer than everything else at start-up.
"""

from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

import numpy as np

from server.errors import ConsoleUnavailable
from tracker.geometry import wxyz_from_matrix
from tracker.measurements import Matrix
from tracker.rig import CameraModel

#: The page's colours (web/src/words.ts): lightness by position's coefficient, hue by rotation's.
MOTION_COLOURS: Final = {
    "P0R0": (0x9C, 0x8F, 0x7C),
    "P0R1": (0x8F, 0xA3, 0x7E),
    "P0R2": (0xA8, 0x8F, 0x9E),
    "P1R0": (0xC9, 0xA3, 0x6A),
    "P1R1": (0xDB, 0xA2, 0x4F),
    "P1R2": (0xD9, 0x8A, 0x6A),
    "P2R0": (0xF0, 0xC9, 0x87),
    "P2R1": (0xF2, 0xB2, 0x5C),
    "P2R2": (0xEE, 0x7F, 0x55),
}
_NO_MODEL_COLOUR: Final = (0x7D, 0x75, 0x6A)
#: Points of the path closer than this tell nothing new.
_STEP_M: Final = 0.1
#: A jump longer than this is a seek or a restart, not a walk.
_JUMP_M: Final = 20.0
#: A piece of the path is sent whole each time it grows, so it stays short.
_PIECE: Final = 100
_PIECES: Final = 200
#: From the south-west and above, the whole square in view.
_START_VIEW_M: Final = (-30.0, -50.0, 45.0)
#: glTF's axes in the site frame: x east, y up, z south, so that y becomes z.
_WXYZ_SITE_GLTF: Final = (float(np.sqrt(0.5)), float(np.sqrt(0.5)), 0.0, 0.0)


class ColouredPath:
    """The path as pieces of coloured segments. Pure."""

    def __init__(self) -> None:
        self.pieces: list[list[tuple[Matrix, tuple[int, int, int]]]] = [[]]
        """Each segment is (2, 3) site metres and its colour; pieces that are no longer drawn are empty."""
        self._last: Matrix | None = None

    def add(self, p_site_m: Matrix, motion_model: str) -> bool:
        """Go on to a point, (3,); return whether there is a new segment."""
        last = self._last
        step_m = 0.0 if last is None else float(np.linalg.norm(p_site_m - last))
        if last is not None and step_m < _STEP_M:
            return False
        self._last = np.array(p_site_m)
        if last is None or step_m > _JUMP_M:
            return False
        if len(self.pieces[-1]) >= _PIECE:
            self.pieces.append([])
            if len(self.pieces) > _PIECES:
                self.pieces[-_PIECES - 1] = []  # no longer drawn; a day's walk has half a million segments
        colour = MOTION_COLOURS.get(motion_model, _NO_MODEL_COLOUR)
        self.pieces[-1].append((np.stack([last, self._last]), colour))
        return True


class Console:
    """A viser server on loopback. Its methods are to be called from one thread."""

    def __init__(self, port: int = 0, *, host: str = "127.0.0.1", model_path: Path | None = None) -> None:
        self._port, self._host, self._model_path = port, host, model_path
        self._server: Any = None
        self._path = ColouredPath()

    def start(self) -> str:
        """Start and return the console's address.

        Raises:
            ConsoleUnavailable: viser or its port will not have it.
        """
        try:
            import viser

            with redirect_stdout(StringIO()):  # viser prints a panel, and our standard output is for our own lines
                self._server = viser.ViserServer(self._host, self._port, label="Agora", verbose=False)
        except (ImportError, OSError, RuntimeError) as exc:
            raise ConsoleUnavailable(f"The console cannot start on port {self._port}: choose another port.") from exc
        scene = self._server.scene
        self._server.gui.configure_theme(dark_mode=True, show_share_button=False)
        self._server.initial_camera.position = _START_VIEW_M
        self._server.initial_camera.look_at = (0.0, 0.0, 0.0)
        scene.set_up_direction("+z")
        scene.add_grid("/site/grid", width=200.0, height=200.0, cell_size=10.0)
        if self._model_path is not None and self._model_path.is_file():
            scene.add_glb("/site/model", self._model_path.read_bytes(), wxyz=_WXYZ_SITE_GLTF)
        return f"http://{self._host}:{self._server.get_port()}/"

    def show(self, T_site_cam: Matrix, camera: CameraModel, motion_model: str) -> None:
        """Draw where the camera is now, (4, 4), and lengthen its path."""
        if self._server is None:
            return
        p_site_m = T_site_cam[:3, 3]
        self._server.scene.add_camera_frustum(
            "/rig/camera",
            fov=2.0 * float(np.arctan2(camera.height_px / 2.0, camera.fy_px)),
            aspect=camera.width_px / camera.height_px,
            scale=2.0,
            color=MOTION_COLOURS.get(motion_model, _NO_MODEL_COLOUR),
            wxyz=wxyz_from_matrix(T_site_cam[:3, :3]),
            position=p_site_m,
        )
        if self._path.add(p_site_m, motion_model):
            self._draw_piece()

    def clear(self) -> None:
        """Forget the path: another estimator, or the log from its start."""
        for i in range(len(self._path.pieces)):
            self._remove_piece(i)
        self._path = ColouredPath()

    def stop(self) -> None:
        """Stop serving. May be called twice."""
        if self._server is not None:
            with redirect_stdout(StringIO()):
                self._server.stop()
            self._server = None

    def __enter__(self) -> Self:
        """Start."""
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop."""
        self.stop()

    def _draw_piece(self) -> None:
        i = len(self._path.pieces) - 1
        piece = self._path.pieces[i]
        points = np.stack([points for points, _ in piece]).astype(np.float32)
        # viser takes the colours of lines as linear light, and those of everything else as sRGB.
        linear = 255.0 * (np.array([[colour, colour] for _, colour in piece]) / 255.0) ** 2.2
        colours = linear.astype(np.uint8)
        self._server.scene.add_line_segments(f"/path/{i}", points, colours, thickness=4.0, thickness_units="screen")
        if i >= _PIECES and len(piece) == 1:
            self._remove_piece(i - _PIECES)

    def _remove_piece(self, i: int) -> None:
        if self._server is not None:
            self._server.scene.remove_by_name(f"/path/{i}")
