"""`agora simulate`: the tracker's walk and the assets' renderer joined into one log."""

from collections.abc import Callable, Iterable, Iterator
from hashlib import sha256
from heapq import merge
from pathlib import Path
from shutil import rmtree
from typing import Literal

import cv2
import numpy as np

from assets import exposure
from assets.exposure import Exposure
from assets.lens import Pinhole
from assets.render import Renderer
from assets.scene import Scene, content_of, expanded
from assets.sun import SUN_UNIX_S
from tracker.errors import InputError
from tracker.gait import Ground
from tracker.log import RECORDING
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Image, Matrix, Measurement, Sighting
from tracker.pictures import ArrayPicture
from tracker.rig import CameraModel
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

Progress = Callable[[float], None]
#: So many moments of one exposure smooth its picture's edges by themselves.
COARSE_MOMENTS = 3


def write_walk(
    path: Path,
    settings: WalkSettings,
    *,
    ground_z_m: Ground,
    scene: Scene | None,
    video: Literal["jpeg", "h264"],
    progress: Progress,
    pointed: Callable[[Walk], Iterable[Sighting]] = lambda walk: (),
) -> int:
    """Write a simulated walk and return its size in bytes.

    Rendering is slow, so pictures are kept beside the log until it is done: a walk that was interrupted goes on where it was.

    Args:
        path: The log; written over where it exists.
        settings: The walk.
        ground_z_m: What the visitor walks on.
        scene: What the camera sees; None for a walk without camera.
        video: How pictures are stored.
        progress: Called with the share that is done.
        pointed: Returns what the visitor points out on the way, in order of arrival (`server.pointing`); with a camera only.

    Raises:
        InputError: The log cannot be written.
        GraphicsMissing: There is no off-screen OpenGL.
    """
    scene = None if scene is None else expanded(scene)
    rig = default_rig()
    walk = Walk(settings, rig, ground_z_m)
    if scene is None:
        rig = type(rig)(rig.T_body_imu, rig.T_body_gps, rig.T_body_cam, None)
    kept = path.with_name(path.name + ".frames")
    pictures = _pictures(walk, scene, kept / _key(settings, scene), progress) if scene else iter(())
    said = pointed(walk) if scene else ()
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with LogWriter(
            part,
            rig,
            settings.origin,
            t_start_ns=START_NS,
            video=video,
            rate_hz=settings.camera_hz,
            metadata={RECORDING: {"utc_start_ns": str(SUN_UNIX_S * 1_000_000_000)}},
        ) as writer:
            measurements: list[Iterable[Measurement]] = [simulate(walk), pictures, said]
            for measurement in merge(*measurements, key=lambda m: m.t_recv_ns):
                writer.write(measurement)
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror}.") from error
    progress(1.0)
    rmtree(kept, ignore_errors=True)
    return path.stat().st_size


def _key(settings: WalkSettings, scene: Scene) -> str:
    """Return what the pictures depend on, as a folder's name: another walk or world must not go on with these."""
    content = sha256(repr(settings).encode())
    for part in content_of(scene):
        content.update(part)
    return content.hexdigest()[:16]


def _pictures(walk: Walk, scene: Scene, kept: Path, progress: Progress) -> Iterator[Frame]:
    """Yield what the camera takes. Pictures are kept as the lens throws them; exposure and noise follow from them again."""
    camera = walk.rig.camera
    if camera is None:
        raise ValueError("a rig with a camera")
    kept.mkdir(parents=True, exist_ok=True)
    times, period_s = walk.frame_times(), 1.0 / walk.settings.camera_hz
    exposed, falloff = Exposure(), exposure.vignette(_pinhole(camera))
    with Renderer(scene, camera.width_px, camera.height_px) as renderer:
        eye = _Eye(renderer, walk, camera)
        for frame_id, (t_ns, t_recv_ns) in enumerate(times):
            file = kept / f"{frame_id:06d}.png"
            bgr = cv2.imread(str(file)) if file.is_file() else None
            if bgr is None:
                bgr = eye.taken(t_ns, exposed)
                part = file.with_suffix(".part.png")
                cv2.imwrite(str(part), bgr)
                part.replace(file)
            light = np.asarray(bgr, np.uint8)
            rng = np.random.default_rng([walk.settings.seed, 4, frame_id])
            yield Frame(t_ns, t_recv_ns, frame_id, ArrayPicture(exposure.sensed(light, falloff, rng)))
            exposed = exposed.after(light, period_s)
            progress((frame_id + 1) / len(times))


class _Eye:
    """What falls on the camera's sensor. A visitor who stands quite still sees the same picture again, which is drawn once."""

    def __init__(self, renderer: Renderer, walk: Walk, camera: CameraModel) -> None:
        self._renderer, self._walk, self._camera = renderer, walk, camera
        self._last: tuple[bytes, Image] | None = None

    def taken(self, t_ns: int, exposed: Exposure) -> Image:
        """Return the light of an exposure with `t_ns` at its middle."""
        half_s = exposed.time_s / 2.0
        moved_px = exposure.motion_px(self._pose(t_ns, -half_s), self._pose(t_ns, half_s), _pinhole(self._camera))
        moments = exposure.moments(exposed.time_s, moved_px).tolist()
        poses = np.array([self._pose(t_ns, after_s) for after_s in moments])
        key = poses.tobytes() + repr(exposed.time_s).encode()
        if self._last is None or self._last[0] != key:
            # where much of a picture is blurred anyway, its moments need not be fine ones
            fine = len(poses) < COARSE_MOMENTS
            pictures = [self._drawn(pose, exposed.brightness, fine) for pose in poses]
            self._last = key, exposure.mean_of(pictures)
        return self._last[1]

    def _pose(self, t_ns: int, after_s: float) -> Matrix:
        return self._walk.T_site_cam(t_ns + round(after_s * 1e9))

    def _drawn(self, T_site_cam: Matrix, brightness: float, fine: bool) -> Image:
        camera = self._camera
        return self._renderer.render(
            T_site_cam,
            camera.fx_px,
            camera.fy_px,
            camera.cx_px,
            camera.cy_px,
            camera.distortion_model,
            camera.distortion,
            brightness=brightness,
            fine=fine,
        )


def _pinhole(camera: CameraModel) -> Pinhole:
    return Pinhole(camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px)
