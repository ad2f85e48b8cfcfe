"""What the front end makes of a whole walk, kept by the content of everything behind it: estimators differ, motions do not."""

from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from assets.kept import kept_arrays
from tracker.feature_camera import Faults, FeatureCamera, World
from tracker.log import Log
from tracker.measurements import Frame, Image, Matrix, VisualMotion, VisualTracks
from tracker.simulate import Walk
from tracker.vision import VisionFrontEnd, VisionSettings

VERSION = 3
"""Of the front end and the feature camera: raise it when their motions change for the same settings."""
FOLDER = Path("build/tracks")


class KeyedWorld(World, Protocol):
    """A world whose content has a name."""

    @property
    def key(self) -> str:
        """What tells it from others."""
        ...


class Unseen:
    """The picture of a frame that nobody draws."""

    def gray(self) -> Image:
        """Never asked for: a feature camera looks at poses."""
        raise NotImplementedError

    def jpeg(self) -> bytes:
        """Never asked for."""
        raise NotImplementedError


def feature_motions(
    walk: Walk,
    world: KeyedWorld,
    settings: Faults | None = None,
    vision: VisionSettings | None = None,
    folder: Path = FOLDER,
) -> list[VisualMotion]:
    """Return what the front end makes of a walk's features, in order of arrival.

    Args:
        walk: The walk; its rig must have a camera.
        world: What the camera looks at.
        settings: The faults of following; None for those measured.
        vision: The front end's; None for the defaults.
        folder: Where motions are kept; several processes may share it.
    """
    camera = walk.rig.camera
    if camera is None:
        raise ValueError("a rig with a camera")
    faults, vision = settings or Faults(), vision or VisionSettings()
    poses = poses_of(walk)
    content = sha256(repr((walk.settings.seed, world.key, camera, faults, vision, walk.frame_times())).encode())
    for pose in poses.values():
        content.update(pose.tobytes())
    source = FeatureCamera(camera, world, poses.__getitem__, walk.settings.seed, faults)
    front_end = VisionFrontEnd(camera, vision, source)
    frames = (Frame(t_ns, t_recv_ns, i, Unseen()) for i, (t_ns, t_recv_ns) in enumerate(walk.frame_times()))
    return _kept(folder, content.hexdigest(), front_end, frames)


def rendered_motions(log: Log, vision: VisionSettings | None = None, folder: Path = FOLDER) -> list[VisualMotion]:
    """Return what the front end makes of a log's pictures, in order of arrival."""
    camera = log.rig.camera
    if camera is None:
        raise ValueError(f"{log.name} has no camera whose lens is known")
    vision = vision or VisionSettings()
    content = sha256(repr((log.info, camera, vision, cv2.__version__)).encode())
    with log.path.open("rb") as file:
        while block := file.read(1 << 20):
            content.update(block)
    frames = (measurement for measurement in log.messages(truth=False) if isinstance(measurement, Frame))
    return _kept(folder, content.hexdigest(), VisionFrontEnd(camera, vision), frames)


def poses_of(walk: Walk) -> dict[int, Matrix]:
    """Return the camera's pose (4, 4) at every picture's stamp."""
    stamps = np.array([t_ns for t_ns, _ in walk.frame_times()], np.int64)
    motion = walk.at(stamps)
    T_site_body = np.tile(np.eye(4), (len(stamps), 1, 1))
    T_site_body[:, :3, :3], T_site_body[:, :3, 3] = motion.R_site_body, motion.p_m
    return dict(zip(stamps.tolist(), T_site_body @ walk.rig.T_body_cam, strict=True))


def _kept(folder: Path, content: str, front_end: VisionFrontEnd, frames: Iterator[Frame]) -> list[VisualMotion]:
    path = folder / f"{content[:32]}-{VERSION}.npz"
    kept = kept_arrays(path, lambda: _arrays([m for m in map(front_end.step, frames) if m is not None]))
    return _motions(kept)


def _arrays(motions: list[VisualMotion]) -> dict[str, NDArray[np.generic]]:
    tracks = [m.tracks for m in motions if m.tracks is not None]
    return {
        "stamps": np.array([(m.t_ns, m.t_recv_ns, m.frame_id, m.t_key_ns) for m in motions], np.int64).reshape(-1, 4),
        "R_key_cam": np.array([m.R_key_cam for m in motions], np.float64).reshape(-1, 3, 3),
        "direction_key": np.array([m.direction_key for m in motions], np.float64).reshape(-1, 3),
        "inliers": np.array([m.inliers for m in motions], np.int64),
        "parallax_px": np.array([m.parallax_px for m in motions], np.float64),
        "is_keyframe": np.array([m.is_keyframe for m in motions], np.bool_),
        "track_counts": np.array([-1 if m.tracks is None else len(m.tracks.ids) for m in motions], np.int64),
        "track_ids": np.concatenate([np.zeros(0, np.int64), *(t.ids for t in tracks)]),
        "track_rays": np.concatenate([np.zeros((0, 4), np.float32), *(t.rays for t in tracks)]),
    }


def _motions(kept: dict[str, NDArray[np.generic]]) -> list[VisualMotion]:
    rest = (kept[name].tolist() for name in ("stamps", "direction_key", "inliers", "parallax_px", "is_keyframe"))
    return [
        VisualMotion(t_ns, t_recv_ns, frame_id, t_key_ns, R, (x, y, z), inliers, parallax_px, is_keyframe, tracks)
        for R, tracks, (t_ns, t_recv_ns, frame_id, t_key_ns), (x, y, z), inliers, parallax_px, is_keyframe in zip(
            kept["R_key_cam"].astype(np.float64), _tracks(kept), *rest, strict=True
        )
    ]


def _tracks(kept: dict[str, NDArray[np.generic]]) -> Iterator[VisualTracks | None]:
    ids, rays, end = kept["track_ids"].astype(np.int64), kept["track_rays"].astype(np.float32), 0
    for count in kept["track_counts"].tolist():
        begin, end = end, end + max(0, count)
        yield None if count < 0 else VisualTracks(ids[begin:end], rays[begin:end])
