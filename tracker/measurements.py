"""What sensors say: frozen values, in SI units and the rig's own frames, and nothing else.

Every measurement carries `t_ns` (when it was measured) and `t_recv_ns` (when it arrived, never before). Small vectors are
tuples of floats, because at 250 Hz a numpy array of three costs more than the arithmetic on it.
"""

from dataclasses import dataclass
from enum import Enum
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

Vector3: TypeAlias = tuple[float, float, float]
Wxyz: TypeAlias = tuple[float, float, float, float]
Matrix: TypeAlias = NDArray[np.float64]
Image: TypeAlias = NDArray[np.uint8]


class Outcome(Enum):
    """What an estimator did with a measurement. A bad measurement is a value, not an exception."""

    USED = "used"
    """Accepted into the state or into what the next update will use."""
    IGNORED = "ignored"
    """Of no concern to this estimator (a frame for one without a camera)."""
    WAITING = "waiting"
    """Kept, but the estimator is not initialised yet."""
    REJECTED_NOT_FINITE = "not_finite"
    REJECTED_STALE = "stale"
    """Older than what the estimator can still use, or a second sample with one stamp."""
    REJECTED_GATE = "gate"
    """Too far from what was expected."""
    REJECTED_WEAK = "weak"
    """Too little information: no fix, too few inliers, too little parallax."""


@dataclass(frozen=True, slots=True)
class ImuSample:
    """One inertial sample in the body frame (the source has applied `R_body_imu`)."""

    t_ns: int
    t_recv_ns: int
    gyro_rad_s: Vector3
    accel_m_s2: Vector3
    """Specific force: (0, 0, +9.81) at rest and level."""


@dataclass(frozen=True, slots=True)
class MagSample:
    """The magnetic field in the body frame, tesla."""

    t_ns: int
    t_recv_ns: int
    field_body_t: Vector3


@dataclass(frozen=True, slots=True)
class CompassHeading:
    """The direction of body x that a phone worked out itself."""

    t_ns: int
    t_recv_ns: int
    yaw_rad: float
    """Counter-clockwise from true east."""


@dataclass(frozen=True, slots=True)
class GpsFix:
    """A position. `valid` is False where the receiver says so, and coordinates may then be NaN."""

    t_ns: int
    t_recv_ns: int
    lat_deg: float
    lon_deg: float
    h_ellipsoid_m: float
    cov_enu_m2: tuple[float, ...]
    """Nine numbers, row major, east north up; all zero where the receiver states none."""
    valid: bool = True


@dataclass(frozen=True, slots=True)
class GpsVelocity:
    """Velocity over the ground, ENU (of no particular origin: ENU axes turn by 0.01 mrad across a site)."""

    t_ns: int
    t_recv_ns: int
    v_enu_m_s: Vector3


class Picture(Protocol):
    """An undecoded camera picture: decoding costs milliseconds, and an estimator without a camera never pays them.

    Both methods raise `MalformedInput` for bytes that do not decode.
    """

    def gray(self) -> Image:
        """The picture as (height, width) uint8."""
        ...

    def jpeg(self) -> bytes:
        """The picture as JPEG bytes, colour, as stored (not turned upright)."""
        ...


@dataclass(frozen=True, slots=True)
class Frame:
    """One camera picture. `frame_id` counts the camera's messages in the log from 0, decodable or not."""

    t_ns: int
    t_recv_ns: int
    frame_id: int
    picture: Picture


@dataclass(frozen=True, slots=True)
class VisualMotion:
    """Motion of the camera from a held keyframe to a later picture: `Tr` of the paper's eq. 1, scale unknown."""

    t_ns: int
    t_recv_ns: int
    frame_id: int
    t_key_ns: int
    """When the keyframe was taken."""
    R_key_cam: Matrix
    """(3, 3) maps present camera coordinates to the keyframe's."""
    direction_key: Vector3
    """Unit vector from the keyframe's centre to the present one, in the keyframe's axes; zero when parallax is too small."""
    inliers: int
    parallax_px: float
    """Median displacement of the inliers that rotation does not explain."""
    is_keyframe: bool
    """The present picture becomes the next keyframe."""
    tracks: "VisualTracks | None" = None
    """Of a keyframe, and now and then of a picture between two: where its features are, and where in the keyframe before."""


@dataclass(frozen=True, slots=True, eq=False)
class VisualTracks:
    """Features followed from a keyframe to a later picture, as rays on the plane z = 1 of the camera, lens undone."""

    ids: NDArray[np.int64]
    """(N,) of each feature, the same from its first picture to its last."""
    rays: NDArray[np.float32]
    """(N, 4) x and y where it was in the keyframe before, x and y where it is now."""

    @property
    def xy_key(self) -> NDArray[np.float32]:
        """(N, 2) in the keyframe before."""
        return self.rays[:, :2]

    @property
    def xy(self) -> NDArray[np.float32]:
        """(N, 2) now."""
        return self.rays[:, 2:]


@dataclass(frozen=True, slots=True)
class TruePose:
    """Ground truth in the log's map frame. Fed to the estimator `truth` and to scores, never to any other."""

    t_ns: int
    t_recv_ns: int
    p_map_body_m: Vector3
    wxyz_map_body: Wxyz
    v_map_m_s: Vector3 | None
    position_known: bool
    height_known: bool
    tilt_known: bool
    heading_known: bool
    sigma_h_m: float
    """The log's own claim of its horizontal accuracy; 0 where exact."""


@dataclass(frozen=True, slots=True)
class Sighting:
    """Somebody has said: this direction is that landmark."""

    t_ns: int
    """Of the picture that it was pointed out in."""
    t_recv_ns: int
    point_site_m: Vector3
    ray_cam: Vector3
    """Unit vector towards it, in the camera's axes."""
    sigma_rad: float


@dataclass(frozen=True, slots=True)
class Standpoint:
    """Somebody has said: I stand at this surveyed point. Its height is the eyes'."""

    t_ns: int
    t_recv_ns: int
    p_site_m: Vector3
    sigma_m: float


@dataclass(frozen=True, slots=True)
class Retraction:
    """Somebody has taken back what was said last: the newest sighting or standpoint that was not taken back yet."""

    t_ns: int
    t_recv_ns: int


Said: TypeAlias = Sighting | Standpoint | Retraction
"""What visitors say."""
Measurement: TypeAlias = (
    ImuSample | MagSample | CompassHeading | GpsFix | GpsVelocity | Frame | VisualMotion | Said | TruePose
)
