"""One walk with every kind of measurement in it, and how to feed it; helpers of the tests beside this file."""

from collections.abc import Iterable, Iterator
from functools import cache

import numpy as np

from tests.tracker.precise.points import seen_from
from tracker.estimator import Pose
from tracker.geometry import exp, matrix_from_wxyz
from tracker.measurements import Measurement, Sighting, Standpoint, TruePose, VisualMotion, VisualTracks
from tracker.precise.compass import Compass
from tracker.precise.estimator import PreciseEstimator
from tracker.precise.ground import EyeHeight
from tracker.precise.memory import Memory
from tracker.precise.tracks import seen_in
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

S = 1_000_000_000
NAMES = ("gps-imu/precise", "camera-gps-imu/precise")
_CAMERA_HZ, _KEY_EVERY, _POINTS = 8.0, 3, 600


def estimator(
    name: str = NAMES[1], *, eyes_z_m: EyeHeight | None = None, memory: Memory | None = None
) -> PreciseEstimator:
    """Return a new one."""
    return PreciseEstimator(
        name,
        origin=AGORA_ORIGIN,
        rig=default_rig(),
        compass=Compass(0.0957),
        uses_camera=name.startswith("camera"),
        eyes_z_m=eyes_z_m,
        memory=memory,
    )


@cache
def walk(seconds: float = 45.0, seed: int = 12) -> Walk:
    """Return a walk that stands for four seconds first, with few samples a second."""
    settings = WalkSettings(seed=seed, duration_s=seconds, still_s=4.0, imu_hz=50.0, mag_hz=5.0)
    return Walk(settings, default_rig())


@cache
def stream(seconds: float = 45.0, seed: int = 12) -> tuple[Measurement, ...]:
    """Return all that is measured on it and said about it, in order of arrival, without the truth."""
    of = walk(seconds, seed)
    sensors = (m for m in simulate(of) if not isinstance(m, TruePose))
    return tuple(sorted([*sensors, *_seen(of), *_said(of)], key=lambda m: m.t_recv_ns))


def _seen(of: Walk) -> Iterator[VisualMotion]:
    """Yield the camera's motions against every third picture, with a little noise, and the features of these."""
    rng, times = np.random.default_rng(of.settings.seed), of.stamps(_CAMERA_HZ).tolist()
    points_m = np.column_stack([rng.uniform(-60.0, 60.0, (_POINTS, 2)), rng.uniform(0.0, 8.0, _POINTS)])
    for index in range(1, len(times)):
        t_ns, t_key_ns = times[index], times[(index - 1) // _KEY_EVERY * _KEY_EVERY]
        T_site_cam = np.stack([of.T_site_cam(t_key_ns), of.T_site_cam(t_ns)])
        T_key_cam = np.linalg.inv(T_site_cam[0]) @ T_site_cam[1]
        base = T_key_cam[:3, 3] + rng.normal(0.0, 0.003, 3)
        a, b, c = rng.normal(0.0, 0.002, 3).tolist()
        R_key_cam = T_key_cam[:3, :3] @ matrix_from_wxyz(exp((a, b, c)))
        far = float(np.linalg.norm(base)) > 0.1
        x, y, z = (base / np.linalg.norm(base)).tolist() if far else (0.0, 0.0, 0.0)
        is_key, xy = index % _KEY_EVERY == 0, seen_from(T_site_cam[:, :3, :3], T_site_cam[:, :3, 3], points_m)
        ids = np.flatnonzero(seen_in(xy).all(axis=1))
        rays = (xy[ids] + rng.normal(0.0, 0.001, (len(ids), 2, 2))).astype(np.float32)
        tracks = VisualTracks(ids, rays.reshape(-1, 4)) if is_key else None
        arrived_ns, parallax_px = t_ns + 38_000_000, 9.0 if far else 1.0
        yield VisualMotion(t_ns, arrived_ns, index, t_key_ns, R_key_cam, (x, y, z), 90, parallax_px, is_key, tracks)


def _said(of: Walk) -> Iterator[Measurement]:
    """Yield two landmarks pointed out in one picture, one in another, and a place."""
    for at_s, right_m in ((25.0, -6.0), (25.0, 8.0), (33.0, 3.0)):
        t_ns = START_NS + round(at_s * S)
        T_site_cam = of.T_site_cam(t_ns)
        x, y, z = (T_site_cam @ np.array([right_m, -1.0, 12.0, 1.0]))[:3].tolist()
        a, b, c = (np.array([right_m, -1.0, 12.0]) / np.linalg.norm([right_m, -1.0, 12.0])).tolist()
        yield Sighting(t_ns, t_ns + S // 5, (x, y, z), (a, b, c), 0.004)
    t_ns = START_NS + 37 * S
    x, y, z = of.at(np.array([t_ns])).p_m[0].tolist()
    yield Standpoint(t_ns, t_ns + S // 10, (x, y, z), 0.2)


def feed(into: PreciseEstimator, measurements: Iterable[Measurement]) -> list[tuple[object, ...]]:
    """Step all, and return what was to be seen after each tenth, for comparison bit by bit."""
    rows = []
    for index, measurement in enumerate(measurements):
        into.step(measurement)
        if index % 10 == 0:
            rows.append(row(into.predict(measurement.t_recv_ns)))
    return rows


def row(pose: Pose | None) -> tuple[object, ...]:
    """Return all of a pose as something that is equal only to its like."""
    if pose is None:
        return ()
    known = (pose.motion_model, pose.heading_known)
    return (pose.t_ns, pose.p_site_m, pose.wxyz_site_body, pose.v_site_m_s, pose.cov.tobytes(), *known)
