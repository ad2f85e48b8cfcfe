"""A simulated walk: the truth, and what sensors with faults say of it. Deterministic by its seed.

The renderer that makes camera pictures of it is `assets/render.py`; the command line joins the two.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tracker.choreography import AGORA_TOUR, PATTERNS, Draft, Pattern, Tour, choreograph
from tracker.estimator import Origin
from tracker.gait import Body, Ground, Motion
from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.geomagnetism import magnetic_field
from tracker.geometry import wxyz_from_matrix
from tracker.itinerary import AGORA_DEMO, Itinerary, follow, planned_s
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, MagSample, Matrix, Measurement, TruePose, Vector3
from tracker.rig import R_BODY_CAM_FORWARD, CameraModel, Rig

#: 2026-06-21 08:00 UTC: eleven in the morning at Ephesus, on the longest day.
START_NS = 1_782_028_800_000_000_000
AGORA_ORIGIN = Origin(37.9366, 27.3447, 88.4)
EYE_HEIGHT_M = 1.65


@dataclass(frozen=True)
class SensorNoise:
    """Faults, of the size of the paper's Phidgets and a good single-frequency receiver (research/tracking.md)."""

    gyro_rad_s: float = 0.0017
    """White, each sample."""
    gyro_bias_rad_s: float = 0.004
    gyro_walk_rad_s_sqrt_s: float = 3e-5
    accel_m_s2: float = 0.01
    accel_bias_m_s2: float = 0.04
    mag_t: float = 0.3e-6
    hard_iron_t: float = 1.0e-6
    gps_slow_m: Vector3 = (1.6, 1.6, 3.0)
    """First-order Gauss-Markov, each axis."""
    gps_slow_s: float = 60.0
    gps_white_m: Vector3 = (0.4, 0.4, 0.6)
    gps_velocity_m_s: float = 0.1
    gps_late_s: tuple[float, float] = (0.12, 0.3)
    camera_late_s: float = 0.038


@dataclass(frozen=True)
class WalkSettings:
    """What walk, and what the rig carries."""

    seed: int = 1
    duration_s: float = 75.0
    dataset: int = 0
    """0, or 1 to 5 for a walk in the manner of the paper's."""
    still_s: float = 12.0
    imu_hz: float = 250.0
    mag_hz: float = 25.0
    gps_hz: float = 1.0
    camera_hz: float = 12.0
    truth_hz: float = 100.0
    tour: Tour = AGORA_TOUR
    itinerary: Itinerary | None = None
    """A walk by plan instead of one by chance on the tour."""
    origin: Origin = AGORA_ORIGIN
    eye_height_m: float = EYE_HEIGHT_M
    noise: SensorNoise = field(default_factory=SensorNoise)


#: The demo's walk lasts as long as its plan; nine seconds at its start are enough to calibrate at rest.
DEMO_WALK = WalkSettings(duration_s=planned_s(AGORA_DEMO, 9.0), still_s=9.0, itinerary=AGORA_DEMO)


def default_rig() -> Rig:
    """Return a head-mounted rig: a webcam 10 cm before the IMU, a lens with a little barrel distortion."""
    T_body_cam = np.eye(4)
    T_body_cam[:3, :3] = R_BODY_CAM_FORWARD
    T_body_cam[:3, 3] = (0.10, 0.0, 0.02)
    camera = CameraModel(640, 480, 520.0, 520.0, 321.3, 238.6, "plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0))
    return Rig(T_body_cam=T_body_cam, camera=camera)


def flat_ground(e_m: Matrix, n_m: Matrix) -> Matrix:
    """Return zero height everywhere."""
    return np.zeros_like(e_m)


class Walk:
    """The truth of one walk."""

    def __init__(self, settings: WalkSettings, rig: Rig, ground_z_m: Ground = flat_ground) -> None:
        self.settings, self.rig = settings, rig
        pattern = PATTERNS[settings.dataset]
        self._body = Body(_draft(settings, pattern), ground_z_m, settings.eye_height_m, pattern.sways)

    def at(self, t_ns: NDArray[np.int64]) -> Motion:
        """Return the motion of the body at (n,) stamps."""
        return self._body.at(np.asarray((t_ns - START_NS) * 1e-9, np.float64))

    def T_site_cam(self, t_ns: int) -> Matrix:
        """Return where the camera is at a stamp, (4, 4)."""
        motion = self.at(np.array([t_ns]))
        T_site_body = np.eye(4)
        T_site_body[:3, :3], T_site_body[:3, 3] = motion.R_site_body[0], motion.p_m[0]
        return T_site_body @ self.rig.T_body_cam

    def stamps(self, rate_hz: float) -> NDArray[np.int64]:
        """Return evenly spaced stamps from the start, without the last second's end."""
        count = int(self.settings.duration_s * rate_hz)
        return START_NS + (np.arange(count) * (1e9 / rate_hz)).astype(np.int64)

    def frame_times(self) -> list[tuple[int, int]]:
        """Return capture and arrival of every picture."""
        late_ns = int(self.settings.noise.camera_late_s * 1e9)
        return [(int(t), int(t) + late_ns) for t in self.stamps(self.settings.camera_hz)]


def _draft(settings: WalkSettings, pattern: Pattern) -> Draft:
    # a little longer than asked for: the last pictures are interpolated as all others are
    length_s = settings.duration_s + 1.0
    if settings.itinerary is not None:
        return follow(settings.itinerary, length_s, settings.still_s, settings.eye_height_m)
    rng = np.random.default_rng([settings.seed, 0])
    return choreograph(pattern, settings.tour, length_s, settings.still_s, settings.eye_height_m, rng)


def simulate(walk: Walk) -> Iterator[Measurement]:
    """Yield everything but pictures, in order of arrival."""
    found: list[Measurement] = [*_imu(walk), *_magnetometer(walk), *_gps(walk), *_truth(walk)]
    found.sort(key=lambda measurement: measurement.t_recv_ns)
    yield from found


def _rng(walk: Walk, sensor: int) -> np.random.Generator:
    return np.random.default_rng([walk.settings.seed, sensor])


def _tuple(values: Matrix) -> Vector3:
    x, y, z = values.tolist()
    return (x, y, z)


def _imu(walk: Walk) -> Iterator[ImuSample]:
    settings, noise, rng = walk.settings, walk.settings.noise, _rng(walk, 1)
    stamps = walk.stamps(settings.imu_hz)
    motion, shape = walk.at(stamps), (len(stamps), 3)
    gravity = np.array([0.0, 0.0, gravity_m_s2(settings.origin.lat_deg, settings.origin.h_ellipsoid_m)])
    force = np.einsum("nji,nj->ni", motion.R_site_body, motion.a_m_s2 + gravity)
    walked = np.cumsum(rng.normal(0.0, noise.gyro_walk_rad_s_sqrt_s / np.sqrt(settings.imu_hz), shape), axis=0)
    gyro_bias = rng.uniform(-1.0, 1.0, 3) * noise.gyro_bias_rad_s + walked
    accel_bias = rng.uniform(-1.0, 1.0, 3) * noise.accel_bias_m_s2
    gyro = motion.omega_body_rad_s + gyro_bias + rng.normal(0.0, noise.gyro_rad_s, shape)
    accel = force + accel_bias + rng.normal(0.0, noise.accel_m_s2, shape)
    for t, w, f in zip(stamps.tolist(), gyro, accel, strict=True):
        yield ImuSample(t, t + 2_000_000, _tuple(w), _tuple(f))


def _magnetometer(walk: Walk) -> Iterator[MagSample]:
    settings, noise, rng = walk.settings, walk.settings.noise, _rng(walk, 2)
    stamps = walk.stamps(settings.mag_hz)
    origin = settings.origin
    field_site = np.array(magnetic_field(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, START_NS).enu_t)
    field_body = np.einsum("nji,j->ni", walk.at(stamps).R_site_body, field_site)
    field_body += rng.normal(0.0, noise.hard_iron_t, 3) + rng.normal(0.0, noise.mag_t, field_body.shape)
    for t, m in zip(stamps.tolist(), field_body, strict=True):
        yield MagSample(t, t + 3_000_000, _tuple(m))


def _gps(walk: Walk) -> Iterator[GpsFix | GpsVelocity]:
    settings, noise, rng = walk.settings, walk.settings.noise, _rng(walk, 3)
    stamps = walk.stamps(settings.gps_hz)
    motion = walk.at(stamps)
    site = SiteFrame(settings.origin)
    slow_m, white_m = np.array(noise.gps_slow_m), np.array(noise.gps_white_m)
    keep = np.exp(-1.0 / (settings.gps_hz * noise.gps_slow_s))
    variance = slow_m**2 + white_m**2
    cov = tuple(np.diag(variance).ravel().tolist())
    error_m = rng.normal(0.0, slow_m)
    for t, p, v in zip(stamps.tolist(), motion.p_m, motion.v_m_s, strict=True):
        late_ns = int(rng.uniform(*noise.gps_late_s) * 1e9)
        lat, lon, h = site.geodetic_from_site(_tuple(p + error_m + rng.normal(0.0, white_m)))
        yield GpsFix(t, t + late_ns, lat, lon, h, cov)
        yield GpsVelocity(t, t + late_ns, _tuple(v + rng.normal(0.0, noise.gps_velocity_m_s, 3)))
        error_m = keep * error_m + np.sqrt(1.0 - keep**2) * rng.normal(0.0, slow_m)


def _truth(walk: Walk) -> Iterator[TruePose]:
    stamps = walk.stamps(walk.settings.truth_hz)
    motion = walk.at(stamps)
    for t, p, v, R in zip(stamps.tolist(), motion.p_m, motion.v_m_s, motion.R_site_body, strict=True):
        yield TruePose(t, t, _tuple(p), wxyz_from_matrix(R), _tuple(v), True, True, True, True, 0.0)
