"""Small recorded walks of our own making, for tests of what reads them."""

from heapq import merge
from pathlib import Path

import numpy as np

from tracker.estimator import Origin
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Measurement
from tracker.pictures import ArrayPicture
from tracker.rig import Rig
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate


def write_walk(
    path: Path, seconds: float, *, pictures: bool = False, seed: int = 2, origin: Origin = AGORA_ORIGIN
) -> Path:
    """Write a simulated walk, with pictures of a patterned wall that slides by where they are asked for; return its path."""
    rig = default_rig()
    walk = Walk(WalkSettings(seed=seed, duration_s=seconds, still_s=2.0, origin=origin), rig)
    frames: list[Measurement] = _wall(walk) if pictures else []
    written = rig if pictures else Rig(rig.T_body_imu, rig.T_body_gps, rig.T_body_cam, None)
    with LogWriter(path, written, walk.settings.origin, t_start_ns=START_NS) as writer:
        for measurement in merge(simulate(walk), frames, key=lambda m: m.t_recv_ns):
            writer.write(measurement)
    return path


def _wall(walk: Walk) -> list[Measurement]:
    blocks = np.random.default_rng(0).integers(0, 255, (60, 160, 3), np.uint8)
    wall = np.kron(blocks, np.ones((8, 8, 1), np.uint8))
    return [
        Frame(t, late, i, ArrayPicture(np.ascontiguousarray(wall[:, (i * 4) % 640 : (i * 4) % 640 + 640])))
        for i, (t, late) in enumerate(walk.frame_times())
    ]
