"""Walks and square in viser: each walk's path, camera, ellipsoid and name, and the model in layers."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import cv2
import numpy as np

from server.console.ellipsoid import ellipsoid
from server.console.model import EVIDENCE_COLOURS, Part
from server.console.path import PIECES, colour_of
from server.console.walk import Walk
from tracker.errors import MalformedInput
from tracker.geometry import wxyz_from_matrix
from tracker.pictures import EncodedPicture

#: From the south-west and above, the whole square in view.
START_VIEW_M: Final = (-55.0, -95.0, 70.0)
#: glTF's axes in the site frame: x east, y up, z south, so that y becomes z.
_WXYZ_SITE_GLTF: Final = (float(np.sqrt(0.5)), float(np.sqrt(0.5)), 0.0, 0.0)
#: How far before the camera its picture is drawn.
_FRUSTUM_M: Final = 2.0
#: From the zenith to the horizon, behind everything: viser stretches it over the canvas.
SKY: Final = np.linspace((0x2B, 0x3A, 0x4C), (0xB9, 0xC4, 0xC9), 64)[:, None, :].repeat(2, axis=1).astype(np.uint8)
_THUMBNAIL_PX: Final = 240
_THUMBNAIL_EVERY_S: Final = 0.2
_ABOVE_M: Final = (0.0, 0.0, 1.2)
_ELLIPSOID_COLOUR: Final = (0x7F, 0xC4, 0xE8)


@dataclass
class Layers:
    """What is drawn."""

    buildings: bool = True
    land: bool = True
    today: bool = False
    paths: bool = True
    ellipsoids: bool = True
    pictures: bool = True
    evidence: bool = False
    opacity: float = 1.0


@dataclass
class _Nodes:
    """viser's handles of one walk."""

    pieces: int = 0
    frustum: Any = None
    ellipsoid: Any = None
    label: Any = None
    t_thumbnail_s: float = float("-inf")


class Scene:
    """All that the operators see in common. Its methods are called by one thread."""

    def __init__(self, server: Any, layers: Layers) -> None:
        """`server` is a `viser.ViserServer`."""
        self._scene, self._layers = server.scene, layers
        self._parts: list[tuple[Part, Any]] = []
        self._today: Any = None
        self._nodes: dict[str, _Nodes] = {}
        self._eyes: frozenset[str] = frozenset()
        server.initial_camera.position = START_VIEW_M
        server.initial_camera.look_at = (0.0, 0.0, 0.0)
        server.initial_camera.far = 5000.0
        self._scene.set_up_direction("+z")
        self._scene.set_background_image(SKY, format="png")

    def add_model(self, parts: Iterable[Part], today: bytes | None) -> None:
        """Show the square, and what stands today as a GLB."""
        for part in parts:
            handle = self._scene.add_mesh_simple(
                f"/site/{part.name}", part.positions_m, part.triangles, color=part.colour, flat_shading=True
            )
            self._parts.append((part, handle))
        if today is not None:
            self._today = self._scene.add_glb("/site/today", today, wxyz=_WXYZ_SITE_GLTF)
        self.show_layers()

    def show_layers(self, eyes: frozenset[str] = frozenset()) -> None:
        """Show what `layers` says by now.

        Through a walker's eyes, of the walks that are named, land and plants would hide the picture, and so would what is drawn of
        the walker: viser's own near plane cannot leave it out, since it would leave out the picture, too.
        """
        self._eyes = eyes
        layers = self._layers
        for part, handle in self._parts:
            handle.visible = layers.buildings if part.layer == "buildings" else layers.land and not eyes
            handle.color = EVIDENCE_COLOURS[part.evidence] if layers.evidence else part.colour
            handle.opacity = None if layers.opacity >= 1.0 else layers.opacity
        if self._today is not None:
            self._today.visible = layers.today
        for name, nodes in self._nodes.items():
            self._show_nodes(name, nodes)
            self._scene.add_frame(f"/walks/{name}/path", show_axes=False, visible=layers.paths)

    def _show_nodes(self, name: str, nodes: _Nodes) -> None:
        nodes.frustum.visible = nodes.label.visible = name not in self._eyes
        nodes.ellipsoid.visible = self._layers.ellipsoids and name not in self._eyes

    def draw(self, walk: Walk, now_s: float) -> None:
        """Draw where a walk is now; nothing happens before its first pose."""
        frame = walk.frame
        if frame is None or not frame.pose_valid:
            return
        nodes = self._nodes.get(walk.name) or self._new(walk)
        p_site_m, wxyz = frame.T_site_cam[:3, 3], wxyz_from_matrix(frame.T_site_cam[:3, :3])
        nodes.frustum.position, nodes.frustum.wxyz = p_site_m, wxyz
        nodes.frustum.color = colour_of(frame.motion_model)
        nodes.label.position, nodes.label.text = p_site_m + _ABOVE_M, walk.title
        axes_m, wxyz_axes = ellipsoid(frame.cov[:3, :3])
        nodes.ellipsoid.scale, nodes.ellipsoid.wxyz, nodes.ellipsoid.position = axes_m, wxyz_axes, p_site_m
        self._draw_path(walk, nodes)
        if now_s - nodes.t_thumbnail_s >= _THUMBNAIL_EVERY_S:
            nodes.t_thumbnail_s = now_s
            nodes.frustum.image = _thumbnail(walk.jpeg) if walk.has_picture and self._layers.pictures else None

    def remove(self, name: str) -> None:
        """Take a walk away."""
        if self._nodes.pop(name, None) is not None:
            self._scene.remove_by_name(f"/walks/{name}")

    def _new(self, walk: Walk) -> _Nodes:
        assert walk.frame is not None
        camera, place = walk.frame.camera, f"/walks/{walk.name}"
        nodes = self._nodes[walk.name] = _Nodes(
            frustum=self._scene.add_camera_frustum(
                f"{place}/camera",
                fov=2.0 * float(np.arctan2(camera.height_px / 2.0, camera.fy_px)),
                aspect=camera.width_px / camera.height_px,
                thickness=0.05,
                cast_shadow=False,
            ),
            ellipsoid=self._scene.add_icosphere(
                f"{place}/ellipsoid",
                color=_ELLIPSOID_COLOUR,
                opacity=0.35,
                cast_shadow=False,
                receive_shadow=False,
            ),
            label=self._scene.add_label(f"{place}/name", walk.title),
        )
        self._show_nodes(walk.name, nodes)
        nodes.frustum.scale = _FRUSTUM_M / nodes.frustum.compute_canonical_frustum_size()[2]
        self._scene.add_frame(f"{place}/path", show_axes=False, visible=self._layers.paths)
        return nodes

    def _draw_path(self, walk: Walk, nodes: _Nodes) -> None:
        """Draw the pieces of the path that have grown."""
        pieces = walk.path.pieces
        if len(pieces) < nodes.pieces:  # another estimator has begun
            for i in range(nodes.pieces):
                self._scene.remove_by_name(f"/walks/{walk.name}/path/{i}")
            nodes.pieces = 0
        for i in range(max(0, nodes.pieces - 1), len(pieces)):
            if pieces[i]:
                self._draw_piece(f"/walks/{walk.name}/path/{i}", pieces[i])
            if i >= PIECES:
                self._scene.remove_by_name(f"/walks/{walk.name}/path/{i - PIECES}")
        nodes.pieces = len(pieces)

    def _draw_piece(self, name: str, piece: list[Any]) -> None:
        points = np.stack([points for points, _ in piece]).astype(np.float32)
        # viser takes the colours of lines as linear light, and those of everything else as sRGB
        linear = 255.0 * (np.array([[colour, colour] for _, colour in piece]) / 255.0) ** 2.2
        self._scene.add_line_segments(name, points, linear.astype(np.uint8), thickness=5.0, thickness_units="screen")


def decoded(jpeg: bytes) -> "np.ndarray[Any, Any] | None":
    """Return a picture, (h, w, 3) red green blue; None where it does not decode."""
    try:
        return np.ascontiguousarray(EncodedPicture(jpeg).bgr()[..., ::-1])
    except MalformedInput:
        return None


def _thumbnail(jpeg: bytes) -> "np.ndarray[Any, Any] | None":
    picture = decoded(jpeg)
    if picture is None:
        return None
    height_px, width_px = picture.shape[:2]
    size = (_THUMBNAIL_PX, max(1, round(_THUMBNAIL_PX * height_px / width_px)))
    return cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
