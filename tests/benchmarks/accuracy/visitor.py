"""The truth of the walks: the project's own motion on hills, a person who is never quite still, and a look to both sides."""

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.benchmarks.accuracy.scenarios import LOOK_FROM_S, STILL_S
from tests.benchmarks.accuracy.terrain import EYE_HEIGHT_M, EYE_HEIGHT_SIGMA_M
from tracker.choreography import Tour
from tracker.estimator import Origin
from tracker.gait import Ground, Motion
from tracker.geometry import wxyz_from_matrix
from tracker.measurements import Matrix, TruePose
from tracker.rig import R_BODY_CAM_FORWARD, CameraModel, Rig
from tracker.simulate import START_NS, Walk, WalkSettings

#: Sway of a standing head, RMS: metres (horizontal, then up) and radians (roll, pitch, yaw).
SWAY_M = (0.006, 0.006, 0.0015)
SWAY_RAD = (0.005, 0.007, 0.010)
SWAY_HZ = (0.08, 1.2)
WAVES = 6
#: Looks: begin (after LOOK_FROM_S) and length of each turn of the head, and how far it turns.
LOOKS = ((0.0, 2.0, 1.05), (4.0, 3.0, -2.10), (9.0, 2.0, 1.05))
TRUTH_HZ = 100.0
#: Streams of chance of one walk, by their use; the choreography takes 0.
EYES, SWAY = 31, 32


@dataclass(frozen=True)
class Waves:
    """Sums of sines, three of them."""

    amplitude: Matrix
    """(3, k)"""
    rate_rad_s: Matrix
    phase_rad: Matrix

    @staticmethod
    def drawn(rng: np.random.Generator, rms: tuple[float, ...]) -> "Waves":
        """Return waves whose RMS is as asked, slow ones larger than fast ones."""
        hz = np.exp(rng.uniform(log(SWAY_HZ[0]), log(SWAY_HZ[1]), (3, WAVES)))
        size = 1.0 / hz
        size *= np.array(rms)[:, None] * np.sqrt(2.0 / np.sum(size**2, axis=1, keepdims=True))
        return Waves(size, 2.0 * np.pi * hz, rng.uniform(0.0, 2.0 * np.pi, (3, WAVES)))

    def at(self, t_s: Matrix) -> tuple[Matrix, Matrix, Matrix]:
        """Return value, rate and acceleration, each (n, 3)."""
        angle = self.rate_rad_s * t_s[:, None, None] + self.phase_rad
        value, rate = self.amplitude * np.sin(angle), self.amplitude * self.rate_rad_s * np.cos(angle)
        return value.sum(axis=2), rate.sum(axis=2), -(self.rate_rad_s**2 * value).sum(axis=2)


class Visitor(Walk):
    """A walk of the project's simulator by a person: the head sways, and once looks to both sides."""

    def __init__(self, settings: WalkSettings, rig: Rig, ground_z_m: Ground) -> None:
        super().__init__(settings, rig, ground_z_m)
        rng = np.random.default_rng([settings.seed, SWAY])
        self._sway_m, self._sway_rad = Waves.drawn(rng, SWAY_M), Waves.drawn(rng, SWAY_RAD)

    def at(self, t_ns: NDArray[np.int64]) -> Motion:
        """Return the motion of the body at (n,) stamps."""
        walk, t_s = super().at(t_ns), np.asarray((t_ns - START_NS) * 1e-9, np.float64)
        p, v, a = self._sway_m.at(t_s)
        phi, phi_rate, _ = self._sway_rad.at(t_s)
        psi, psi_rate = look_rad(t_s)
        R_look = Rotation.from_rotvec(psi[:, None] * [0.0, 0.0, 1.0]).as_matrix()
        R_sway = Rotation.from_rotvec(phi).as_matrix()
        up_body = walk.R_site_body[:, 2, :]
        omega = walk.omega_body_rad_s + psi_rate[:, None] * up_body
        omega = np.einsum("nji,nj->ni", R_sway, omega) + _right_jacobian(phi, phi_rate)
        return Motion(walk.p_m + p, walk.v_m_s + v, walk.a_m_s2 + a, R_look @ walk.R_site_body @ R_sway, omega)

    def truth(self) -> list[TruePose]:
        """Return the true poses, in order."""
        stamps = self.stamps(TRUTH_HZ)
        motion = self.at(stamps)
        rows = zip(stamps.tolist(), motion.p_m.tolist(), motion.v_m_s.tolist(), motion.R_site_body, strict=True)
        return [
            TruePose(t, t, (p[0], p[1], p[2]), wxyz_from_matrix(R), (v[0], v[1], v[2]), True, True, True, True, 0.0)
            for t, p, v, R in rows
        ]


def visitor(seed: int, duration_s: float, tour: Tour, origin: Origin, ground_z_m: Ground) -> Visitor:
    """Return the walk of a seed; the height of its eyes is its own."""
    eyes_m = EYE_HEIGHT_M + EYE_HEIGHT_SIGMA_M * float(np.random.default_rng([seed, EYES]).standard_normal())
    settings = WalkSettings(
        seed=seed, duration_s=duration_s, still_s=STILL_S, tour=tour, origin=origin, eye_height_m=eyes_m
    )
    return Visitor(settings, head_rig(), ground_z_m)


def head_rig() -> Rig:
    """Return a head-mounted rig: camera before the IMU, the receiver's antenna on top and a little behind."""
    T_body_cam, T_body_gps = np.eye(4), np.eye(4)
    T_body_cam[:3, :3], T_body_cam[:3, 3] = R_BODY_CAM_FORWARD, (0.09, 0.01, 0.03)
    T_body_gps[:3, 3] = (-0.05, 0.0, 0.11)
    camera = CameraModel(640, 480, 515.0, 515.0, 318.9, 241.2, "plumb_bob", (-0.07, 0.015, -0.0003, 0.0004, 0.0))
    return Rig(T_body_gps=T_body_gps, T_body_cam=T_body_cam, camera=camera)


def look_rad(t_s: Matrix) -> tuple[Matrix, Matrix]:
    """Return by how much the head is turned aside at (n,) instants, and how fast that changes."""
    turned, rate = np.zeros_like(t_s), np.zeros_like(t_s)
    for begin_s, length_s, angle_rad in LOOKS:
        x = np.clip((t_s - LOOK_FROM_S - begin_s) / length_s, 0.0, 1.0)
        turned += angle_rad * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
        rate += angle_rad / length_s * 30.0 * x**2 * (1.0 - x) ** 2
    return turned, rate


def _right_jacobian(phi: Matrix, rate: Matrix) -> Matrix:
    """Return the body's rate by a small rotation vector's, each (n, 3): its series to the second order (below 1e-6 here)."""
    once = np.cross(phi, rate)
    return np.asarray(rate - once / 2.0 + np.cross(phi, once) / 6.0)
