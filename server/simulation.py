"""`agora simulate`: the tracker's walk and the assets' renderer joined into one log."""

from collections.abc import Callable, Iterator
from hashlib import sha256
from heapq import merge
from pathlib import Path
from shutil import rmtree
from typing import Literal

import cv2
import numpy as np

from assets.render import Renderer
from tracker.errors import InputError
from tracker.gait import Ground
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Image, Measurement
from tracker.pictures import ArrayPicture
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

Progress = Callable[[float], None]
#: Standard deviation of the camera's noise, levels of 255.
PICTURE_NOISE = 2.0


def write_walk(
    path: Path,
    settings: WalkSettings,
    *,
    ground_z_m: Ground,
    model: Path | None,
    video: Literal["jpeg", "h264"],
    progress: Progress,
) -> int:
    """Write a simulated walk and return its size in bytes.

    Rendering is slow, so pictures are kept beside the log until it is done: a walk that was interrupted goes on where it was.

    Args:
        path: The log; written over where it exists.
        settings: The walk.
        ground_z_m: What the visitor walks on.
        model: A GLB of what the camera sees; None for a walk without camera.
        video: How pictures are stored.
        progress: Called with the share that is done.

    Raises:
        InputError: The log cannot be written.
        GraphicsMissing: There is no off-screen OpenGL.
    """
    rig = default_rig()
    walk = Walk(settings, rig, ground_z_m)
    if model is None:
        rig = type(rig)(rig.T_body_imu, rig.T_body_gps, rig.T_body_cam, None)
    kept = path.with_name(path.name + ".frames")
    pictures = _pictures(walk, model, kept / _key(settings, model), progress) if model else iter(())
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with LogWriter(
            part, rig, settings.origin, t_start_ns=START_NS, video=video, rate_hz=settings.camera_hz
        ) as writer:
            measurements: list[Iterator[Measurement]] = [simulate(walk), pictures]
            for measurement in merge(*measurements, key=lambda m: m.t_recv_ns):
                writer.write(measurement)
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror}.") from error
    progress(1.0)
    rmtree(kept, ignore_errors=True)
    return path.stat().st_size


def _key(settings: WalkSettings, model: Path) -> str:
    """Return what the pictures depend on, as a folder's name: another walk or world must not go on with these."""
    return sha256(repr(settings).encode() + sha256(model.read_bytes()).digest()).hexdigest()[:16]


def _pictures(walk: Walk, model: Path, kept: Path, progress: Progress) -> Iterator[Frame]:
    camera = walk.rig.camera
    if camera is None:
        raise ValueError("a rig with a camera")
    kept.mkdir(parents=True, exist_ok=True)
    times = walk.frame_times()
    lens = (camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.distortion_model, camera.distortion)
    with Renderer(model, camera.width_px, camera.height_px) as renderer:
        for frame_id, (t_ns, t_recv_ns) in enumerate(times):
            file = kept / f"{frame_id:06d}.png"
            bgr = cv2.imread(str(file)) if file.is_file() else None
            if bgr is None:
                bgr = renderer.render(walk.T_site_cam(t_ns), *lens)
                part = file.with_suffix(".part.png")
                cv2.imwrite(str(part), bgr)
                part.replace(file)
            yield Frame(t_ns, t_recv_ns, frame_id, ArrayPicture(_noisy(np.asarray(bgr, np.uint8), walk, frame_id)))
            progress((frame_id + 1) / len(times))


def _noisy(bgr: Image, walk: Walk, frame_id: int) -> Image:
    rng = np.random.default_rng([walk.settings.seed, 4, frame_id])
    noise = rng.normal(0.0, PICTURE_NOISE, bgr.shape[:2])[:, :, None]
    return np.clip(bgr + noise, 0, 255).astype(np.uint8)
