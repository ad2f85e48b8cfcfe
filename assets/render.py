"""Pictures of a model as a camera on the site takes them: off-screen OpenGL, exact to OpenCV's pinhole, lens by remapping.

One renderer belongs to the thread that made it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import TracebackType
from typing import Any, TypeAlias

import cv2
import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from assets.axes import Array
from assets.chunks import Chunk, chunked, seen
from assets.errors import GraphicsMissing
from assets.lens import NONE, Lens, Pinhole, finer
from assets.projection import depths, projection_from_pinhole
from assets.scene import Scene, expanded
from assets.shaders import (
    DISC_FRAGMENT,
    DISC_VERTEX,
    SCENE_FRAGMENT,
    SCENE_VERTEX,
    SHADE_FRAGMENT,
    SHADE_VERTEX,
    SKY_FRAGMENT,
    SKY_VERTEX,
)
from assets.sun import sun_direction, sun_projection

Picture: TypeAlias = NDArray[np.uint8]
FINER = 2
"""Pixels are drawn as so many by so many."""
SHADE_PX = 4096
"""Of the shadows' picture."""
DISC_CORNERS = 24


@dataclass(frozen=True)
class _Part:
    """All meshes of one material, and the buffers under them."""

    texture: Any
    array: Any
    vertices: Any
    elements: Any
    chunks: tuple[Chunk, ...]


class Renderer:
    """Draws one model. `render` gives camera pictures, `target_scene` the same with coloured targets at known points."""

    def __init__(self, scene: Scene, width: int, height: int) -> None:
        """Load `scene` for pictures of `width` by `height` pixels.

        Raises:
            GraphicsMissing: There is no off-screen OpenGL.
        """
        scene = expanded(scene)
        self.width, self.height = width, height
        self._gl = _context()
        self._targets: dict[tuple[int, int], Any] = {}
        self._scene = self._gl.program(vertex_shader=SCENE_VERTEX, fragment_shader=SCENE_FRAGMENT)
        self._sky = self._gl.program(vertex_shader=SKY_VERTEX, fragment_shader=SKY_FRAGMENT)
        self._disc = self._gl.program(vertex_shader=DISC_VERTEX, fragment_shader=DISC_FRAGMENT)
        self._sky_corners = self._gl.vertex_array(self._sky, [])
        for program in (self._scene, self._sky):
            program["sun"].value = sun_direction()
        self._parts = [self._load(scene, material) for material in scene.textures]
        self._shade = self._shadows()

    def __enter__(self) -> "Renderer":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give the graphics memory back."""
        self._gl.release()

    def render(
        self,
        T_site_cam: ArrayLike,
        fx: float,
        fy: float,
        cx: float,
        cy: float,
        distortion_model: str = "none",
        distortion: Sequence[float] = (),
        brightness: float = 1.0,
        fine: bool = True,
    ) -> Picture:
        """Return the picture (height, width, 3), blue green red, that a camera at `T_site_cam` (4, 4) takes.

        A point at (X, Y, Z) of the camera's frame has its centre where `cv2.projectPoints` says, pixel (0, 0) being the
        centre of the top-left pixel. Models: none, plumb_bob, rational_polynomial, equidistant (cv2.fisheye).
        `brightness` is light over that of a usual exposure; pictures that are not `fine` have hard edges and cost half.
        """
        lens = Lens(Pinhole(self.width, self.height, fx, fy, cx, cy), distortion_model, tuple(distortion))
        return self._taken(lens, T_site_cam, np.zeros((0, 3)), (), 1.0, brightness, FINER if fine else 1)

    def target_scene(
        self,
        points_m: ArrayLike,
        colours: Sequence[tuple[int, int, int]],
        T_site_cam: ArrayLike,
        fx: float,
        fy: float,
        cx: float,
        cy: float,
        distortion_model: str = "none",
        distortion: Sequence[float] = (),
        radius_px: float = 4.0,
    ) -> Picture:
        """Return the same picture with a disc of one plain colour over all else at each of `points_m` (n, 3), site frame.

        The graphics pipeline projects the discs' corners, nothing else does. `colours` are blue green red.
        """
        lens = Lens(Pinhole(self.width, self.height, fx, fy, cx, cy), distortion_model, tuple(distortion))
        points = np.asarray(points_m, dtype=np.float64).reshape(-1, 3)
        return self._taken(lens, T_site_cam, points, colours, radius_px, 1.0, FINER)

    def seen(self, T_site_cam: ArrayLike, fx: float, fy: float, cx: float, cy: float) -> tuple[Picture, Array]:
        """Return the picture of a straight lens, and (height, width) how far what it shows is along the line of sight.

        Metres; of the pixels that cover one the nearest, and infinite where it shows only sky.
        """
        lens = Lens(Pinhole(self.width, self.height, fx, fy, cx, cy), NONE, ())
        picture = self._taken(lens, T_site_cam, np.zeros((0, 3)), (), 1.0, 1.0, FINER)
        target = self._target(FINER * self.width, FINER * self.height)
        stored = np.frombuffer(target.read(components=1, attachment=-1, dtype="f4"), np.float32)
        fine = stored.reshape(self.height, FINER, self.width, FINER)
        return picture, depths(fine.min(axis=(1, 3)).astype(np.float64))

    def _taken(
        self,
        lens: Lens,
        T_site_cam: ArrayLike,
        points: Array,
        colours: Sequence[tuple[int, int, int]],
        radius_px: float,
        brightness: float,
        times: int,
    ) -> Picture:
        pose = np.asarray(T_site_cam, dtype=np.float64)
        if pose.shape != (4, 4) or len(points) != len(colours):
            raise ValueError(
                f"expected a (4, 4) pose and one colour per point, got {pose.shape} and {len(colours)} for {len(points)}"
            )
        for program in (self._scene, self._sky):
            program["brightness"].value = brightness
        if lens.is_straight:
            return self._draw(lens.pinhole, pose, points, colours, radius_px, times)
        wide, place = _oversized(lens)
        drawn = self._draw(wide, pose, points, colours, radius_px, times)
        return np.asarray(cv2.remap(drawn, place[..., 0], place[..., 1], cv2.INTER_LINEAR), dtype=np.uint8)

    def _draw(
        self,
        camera: Pinhole,
        pose: Array,
        points: Array,
        colours: Sequence[tuple[int, int, int]],
        radius_px: float,
        times: int,
    ) -> Picture:
        """Draw finer than asked for and average: in software that is twice as fast as the driver's own multisampling."""
        size = camera.width_px, camera.height_px
        camera = finer(camera, times)
        target = self._target(camera.width_px, camera.height_px)
        target.use()
        self._gl.viewport = (0, 0, camera.width_px, camera.height_px)
        self._gl.clear()
        T_cam_site = np.linalg.inv(pose).astype(np.float64)
        projection = projection_from_pinhole(camera)
        self._gl.enable(moderngl.DEPTH_TEST)
        self._scene["clip_site"].write((projection @ T_cam_site).T.astype(np.float32).tobytes())
        self._scene["eye_m"].value = tuple(float(x) for x in pose[:3, 3])
        self._shade.use(1)
        drawn = [
            (near, i, chunk)
            for i, part in enumerate(self._parts)
            for near, chunk in seen(part.chunks, T_cam_site, camera)
        ]
        for _, i, chunk in sorted(drawn, key=lambda item: item[:2]):
            self._parts[i].texture.use(0)
            self._parts[i].array.render(vertices=chunk.count, first=chunk.first)
        self._sky["R_site_cam"].write(pose[:3, :3].T.astype(np.float32).tobytes())
        self._sky["scale"].value = (camera.width_px / camera.fx_px, camera.height_px / camera.fy_px)
        self._sky["centre"].value = ((camera.cx_px + 0.5) / camera.width_px, (camera.cy_px + 0.5) / camera.height_px)
        self._sky_corners.render(moderngl.TRIANGLE_STRIP, vertices=4)
        if len(points):
            self._gl.disable(moderngl.DEPTH_TEST)
            self._discs(camera, points @ T_cam_site[:3, :3].T + T_cam_site[:3, 3], colours, times * radius_px)
        pixels = np.frombuffer(target.read(components=3, alignment=1), dtype=np.uint8)
        fine = pixels.reshape(camera.height_px, camera.width_px, 3)
        return np.asarray(
            cv2.cvtColor(cv2.resize(fine, size, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2BGR), np.uint8
        )

    def _discs(
        self, camera: Pinhole, points_cam_m: Array, colours: Sequence[tuple[int, int, int]], radius_px: float
    ) -> None:
        """Discs parallel to the picture: their outlines project to circles about their centres' projections."""
        angle = np.linspace(0.0, 2.0 * np.pi, DISC_CORNERS + 1)
        rim = np.stack([np.cos(angle) / camera.fx_px, np.sin(angle) / camera.fy_px], -1) * radius_px
        rows = []
        for point, (blue, green, red) in zip(points_cam_m, colours, strict=True):
            corners = point + np.pad(rim, ((0, 0), (0, 1))) * point[2]
            fan = np.stack([np.broadcast_to(point, corners[1:].shape), corners[:-1], corners[1:]], axis=1).reshape(
                -1, 3
            )
            rows.append(np.hstack([fan, np.broadcast_to(np.array([red, green, blue]) / 255.0, fan.shape)]))
        self._disc["clip_cam"].write(projection_from_pinhole(camera).T.astype(np.float32).tobytes())
        buffer = self._gl.buffer(np.concatenate(rows).astype(np.float32).tobytes())
        array = self._gl.vertex_array(self._disc, [(buffer, "3f 3f", "position", "colour")])
        array.render()
        array.release()
        buffer.release()

    def _target(self, width: int, height: int) -> Any:
        if (width, height) not in self._targets:
            size = width, height
            colour, depth = self._gl.renderbuffer(size, 3), self._gl.depth_renderbuffer(size)
            self._targets[(width, height)] = self._gl.framebuffer([colour], depth)
        return self._targets[(width, height)]

    def _shadows(self) -> Any:
        """The depth of everything as the sun sees it: nothing moves, so it is drawn once."""
        program = self._gl.program(vertex_shader=SHADE_VERTEX, fragment_shader=SHADE_FRAGMENT)
        depth = self._gl.depth_texture((SHADE_PX, SHADE_PX))
        depth.compare_func = "<="
        seen = sun_projection().T.astype(np.float32).tobytes()
        program["shade_site"].write(seen)
        self._scene["shade_site"].write(seen)
        self._scene["surface"].value, self._scene["shade"].value = 0, 1
        target = self._gl.framebuffer(depth_attachment=depth)
        target.use()
        target.clear()
        self._gl.enable(moderngl.DEPTH_TEST)
        for part in self._parts:
            array = self._gl.vertex_array(program, [(part.vertices, "3f 32x", "position")], part.elements)
            array.render()
            array.release()
        target.release()
        return depth

    def _load(self, scene: Scene, material: str) -> _Part:
        picture = scene.textures[material]
        rgb = np.ascontiguousarray(picture[..., ::-1])
        texture = self._gl.texture(rgb.shape[1::-1], 3, rgb.tobytes(), alignment=1)
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        meshes = [mesh for node in scene.nodes for mesh in node.meshes if mesh.material == material]
        starts = np.cumsum([0] + [len(mesh.positions_m) for mesh in meshes[:-1]])
        floats = [np.hstack([m.positions_m, m.normals, m.uvs, m.colours / np.float32(255.0)]) for m in meshes]
        table = np.concatenate(floats).astype(np.float32)
        triangles = np.concatenate([m.triangles + s for m, s in zip(meshes, starts, strict=True)]).astype(np.uint32)
        triangles, chunks = chunked(table[:, :3], triangles)
        vertices, elements = self._gl.buffer(table.tobytes()), self._gl.buffer(triangles.tobytes())
        layout = [(vertices, "3f 3f 2f 3f", "position", "normal", "uv", "colour")]
        return _Part(texture, self._gl.vertex_array(self._scene, layout, elements), vertices, elements, chunks)


def _context() -> Any:
    try:
        return moderngl.create_context(standalone=True, backend="egl")  # type: ignore[arg-type]  # moderngl annotates **settings as a dict
    except Exception as exc:  # moderngl raises plain Exception, and ImportError or OSError for a missing library
        raise GraphicsMissing(
            f"no off-screen OpenGL on this machine ({exc}); on Debian or Ubuntu run: apt-get install libegl1 libgl1 libgl1-mesa-dri"
        ) from exc


@lru_cache(maxsize=4)
def _oversized(lens: Lens) -> tuple[Pinhole, NDArray[np.float32]]:
    return lens.oversized()
