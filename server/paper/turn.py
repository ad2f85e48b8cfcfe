"""How far the camera's rotation between keyframes agrees with the gyroscope's, and how well a full turn on the spot closes.

The recordings' axes are nominal: how a phone's camera stands to its gyroscope, the gyroscope's offset (no recording begins at
rest) and how late its stamps are were never measured. `fit` finds these seven numbers, one set for every recording of a phone.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation, Slerp

from tracker import lens, two_view
from tracker.errors import MissingSensor
from tracker.evaluate import log_origin, make_pipeline
from tracker.geometry import exp, matrix_from_wxyz, multiply
from tracker.log import Log
from tracker.measurements import Frame, Image, ImuSample, Matrix, Wxyz
from tracker.rig import CameraModel
from tracker.score import Figures
from tracker.vision import VisionFrontEnd

#: Keyframes nearer to a recording's ends than this are left out: with a lag they would reach beyond it.
ENDS_S = 0.2
#: A disagreement above this, rad, counts for less in the fit (0.3 degrees).
OUTLIER_RAD = 0.005
#: The picture that a full turn is measured from: in the first ones the heading is not known.
FIRST_PICTURE = 6


@dataclass(frozen=True)
class Mounting:
    """How a camera stands to the gyroscope beside it, as far as the recording's own extrinsics leave it open."""

    rotation_cam_rad: Matrix
    """(3,) rotation vector, camera axes."""
    gyro_offset_rad_s: Matrix
    """(3,), body axes."""
    lag_s: float
    """By how much the gyroscope's stamps run behind the camera's."""


AS_RECORDED = Mounting(np.zeros(3), np.zeros(3), 0.0)


@dataclass(frozen=True)
class Turns:
    """The rotations between consecutive keyframes of one recording, and the gyroscope beside them."""

    key_s: Matrix
    """(k, 2) from when to when, seconds since the first sample."""
    R_key_cam: Matrix
    """(k, 3, 3) by the camera."""
    t_s: Matrix
    """(n,) stamps of the gyroscope."""
    gyro_rad_s: Matrix
    """(n, 3), body axes."""
    R_body_cam: Matrix
    """(3, 3) as recorded."""

    def by_gyro(self, mounting: Mounting) -> Rotation:
        """Return the gyroscope's rotations between the same keyframes, camera axes; its rate is linear between samples."""
        rate = 0.5 * (self.gyro_rad_s[1:] + self.gyro_rad_s[:-1]) - mounting.gyro_offset_rad_s
        turned: list[Wxyz] = [(1.0, 0.0, 0.0, 0.0)]
        for x, y, z in (rate * np.diff(self.t_s)[:, None]).tolist():
            turned.append(multiply(turned[-1], exp((x, y, z))))
        at = Slerp(self.t_s, Rotation.from_quat(turned, scalar_first=True))
        body = at(self.key_s[:, 0] + mounting.lag_s).inv() * at(self.key_s[:, 1] + mounting.lag_s)
        body_cam = Rotation.from_matrix(self.R_body_cam) * Rotation.from_rotvec(mounting.rotation_cam_rad)
        return body_cam.inv() * body * body_cam

    def apart_rad(self, mounting: Mounting) -> Matrix:
        """Return (k, 3) rotation vectors from the gyroscope's answer to the camera's."""
        return np.asarray((self.by_gyro(mounting).inv() * Rotation.from_matrix(self.R_key_cam)).as_rotvec())


def turns(log: Log) -> Turns:
    """Return what a recording's camera and gyroscope say of its keyframes.

    Raises:
        MissingSensor: It has no camera, or one of unknown focal length.
    """
    front_end = VisionFrontEnd(_camera(log))
    messages = list(log.messages(truth=False))
    samples = [m for m in messages if isinstance(m, ImuSample)]
    t_s = np.array([sample.t_ns - samples[0].t_ns for sample in samples]) * 1e-9
    spans, rotations = [], []
    for frame in sorted((m for m in messages if isinstance(m, Frame)), key=lambda frame: frame.t_ns):
        motion = front_end.step(frame)
        if motion is None or not motion.is_keyframe:
            continue
        begin_s, end_s = ((t - samples[0].t_ns) * 1e-9 for t in (motion.t_key_ns, motion.t_ns))
        if begin_s >= ENDS_S and end_s <= t_s[-1] - ENDS_S:
            spans.append((begin_s, end_s))
            rotations.append(motion.R_key_cam)
    gyro = np.array([sample.gyro_rad_s for sample in samples])
    return Turns(np.array(spans), np.array(rotations), t_s, gyro, log.rig.T_body_cam[:3, :3])


def fit(recordings: Sequence[Turns]) -> Mounting:
    """Return the one mounting with which camera and gyroscope agree best in all recordings (least squares, outliers softened)."""

    def apart(p: NDArray[np.float64]) -> NDArray[np.float64]:
        mounting = _mounting(p)
        return np.concatenate([recording.apart_rad(mounting).ravel() for recording in recordings])

    found = least_squares(apart, np.zeros(7), loss="soft_l1", f_scale=OUTLIER_RAD, diff_step=[1e-3] * 7, x_scale=0.01)
    return _mounting(found.x)


def _mounting(p: NDArray[np.float64]) -> Mounting:
    return Mounting(p[:3], p[3:6], float(p[6]))


def agreement(recording: Turns, mounting: Mounting) -> Figures:
    """Return median and ninth decile of the disagreement, degrees, and the median turn from keyframe to keyframe."""
    apart_deg = np.degrees(np.linalg.norm(recording.apart_rad(mounting), axis=1))
    turned_deg = np.degrees(recording.by_gyro(mounting).magnitude())
    return {
        "keyframes": len(apart_deg),
        "turn_median_deg": float(np.median(turned_deg)),
        "median_deg": float(np.median(apart_deg)),
        "p90_deg": float(np.percentile(apart_deg, 90)),
    }


def closing_deg(log: Log, estimator: str, wait_s: float = 0.0) -> float:
    """Return by how much a full turn does not close: an estimator's poses against what its first and last picture show.

    The pictures look at one scene from one place, so that features matched between them tell the rotation that is left.

    Args:
        log: The turn.
        estimator: By name.
        wait_s: How long after its picture each pose is asked for: one that begins late still tells of the first picture.
    """
    pipeline, waiting = make_pipeline(estimator, log, log_origin(log)), deque[Frame]()
    seen: list[tuple[Frame, Matrix]] = []

    def ask(until_ns: float) -> None:
        while waiting and waiting[0].t_ns <= until_ns - wait_s * 1e9:
            frame = waiting.popleft()
            pose = pipeline.predict(frame.t_ns)
            if pose is not None:
                seen.append((frame, matrix_from_wxyz(pose.wxyz_site_body) @ log.rig.T_body_cam[:3, :3]))

    for measurement in log.messages(truth=False):
        pipeline.step(measurement)
        if isinstance(measurement, Frame):
            waiting.append(measurement)
        ask(measurement.t_recv_ns)
    ask(inf)
    first, R_site_first = next(one for one in seen if one[0].frame_id >= FIRST_PICTURE)
    last, R_site_last = seen[-1]
    return _off_deg(_camera(log), first, last, R_site_first.T @ R_site_last)


def camera_closing_deg(log: Log) -> float:
    """Return by how much a full turn does not close by the camera alone, keyframe chained to keyframe."""
    camera = _camera(log)
    front_end = VisionFrontEnd(camera)
    frames = sorted((m for m in log.messages(truth=False) if isinstance(m, Frame)), key=lambda frame: frame.t_ns)
    R_first_key, R_first_last = np.eye(3), np.eye(3)
    for frame in frames:
        motion = front_end.step(frame)
        if motion is not None:
            R_first_last = R_first_key @ motion.R_key_cam
            R_first_key = R_first_last if motion.is_keyframe else R_first_key
    return _off_deg(camera, frames[0], frames[-1], R_first_last)


def _off_deg(camera: CameraModel, first: Frame, last: Frame, R_first_last: Matrix) -> float:
    by_pictures = _rotation_by_pictures(camera, first.picture.gray(), last.picture.gray())
    return float(np.degrees(Rotation.from_matrix(by_pictures.T @ R_first_last).magnitude()))


def _rotation_by_pictures(camera: CameraModel, a: Image, b: Image) -> Matrix:
    """Return R_a_b by features of two pictures of one scene, taken from one place."""
    sift, matcher = cv2.SIFT.create(1500), cv2.BFMatcher()
    (points_a, found_a), (points_b, found_b) = (sift.detectAndCompute(picture, None) for picture in (a, b))
    pairs = [m for m, second in matcher.knnMatch(found_a, found_b, k=2) if m.distance < 0.7 * second.distance]
    pixels_a = np.array([p.pt for p in points_a])[[m.queryIdx for m in pairs]]
    pixels_b = np.array([p.pt for p in points_b])[[m.trainIdx for m in pairs]]
    rays_a, rays_b = (two_view.bearings(lens.unproject(camera, px)) for px in (pixels_a, pixels_b))
    return two_view.fit_rotation(rays_a, rays_b, 0.002)


def _camera(log: Log) -> CameraModel:
    if log.rig.camera is None:
        raise MissingSensor(f"{log.name} has no calibrated camera.")
    return log.rig.camera
