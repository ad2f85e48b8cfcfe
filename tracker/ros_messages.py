"""ROS 2 messages of a walk (LOG_FORMAT.md) to measurements and back, field by field; `rosbags` does the CDR.

Whatever bytes a message holds, only `MalformedInput` leaves this file.
"""

from typing import Any, TypeAlias, get_args

import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tracker.errors import MalformedInput
from tracker.estimator import Origin
from tracker.geometry import matrix_from_wxyz, normalise
from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Matrix,
    Retraction,
    Sighting,
    Standpoint,
    TruePose,
    Vector3,
    VisualMotion,
    VisualTracks,
    Wxyz,
)
from tracker.rig import CameraModel, DistortionModel

RosMessage: TypeAlias = Any
"""A message as `rosbags` makes it: a dataclass named after its type."""

IMU, MAG, COMPASS = "sensor_msgs/msg/Imu", "sensor_msgs/msg/MagneticField", "geometry_msgs/msg/QuaternionStamped"
FIX, VELOCITY, ODOMETRY = "sensor_msgs/msg/NavSatFix", "geometry_msgs/msg/TwistStamped", "nav_msgs/msg/Odometry"
IMAGE, VIDEO = "sensor_msgs/msg/CompressedImage", "foxglove_msgs/msg/CompressedVideo"
MOTION = "agora_msgs/msg/VisualMotion"
SIGHTING, STANDPOINT, RETRACTION = (f"agora_msgs/msg/{name}" for name in ("Sighting", "Standpoint", "Retraction"))
SENTENCE = "nmea_msgs/msg/Sentence"
CAMERA_INFO, TF = "sensor_msgs/msg/CameraInfo", "tf2_msgs/msg/TFMessage"

_VIDEO_DEFINITION = "builtin_interfaces/Time timestamp\nstring frame_id\nuint8[] data\nstring format\n"
_SENTENCE_DEFINITION = "std_msgs/Header header\nstring sentence\n"

#: Ours, since ROS has none: what the camera's front end made of a picture. `header.stamp` is the picture's.
_FORMER_MOTION_DEFINITION = """std_msgs/Header header
builtin_interfaces/Time key_stamp
uint32 frame_id
float64[9] r_key_cam
geometry_msgs/Vector3 direction_key
uint32 inliers
float64 parallax_px
bool is_keyframe
"""
_MOTION_DEFINITION = f"""{_FORMER_MOTION_DEFINITION}int64[] track_ids
float32[] track_rays
"""
#: Recorded before features were.
FORMER_MOTION = "agora_msgs/msg/FormerVisualMotion"

#: Ours: what visitors say. `header.stamp` is of the picture that they point at, or when they say it.
_SIGHTING_DEFINITION = """std_msgs/Header header
geometry_msgs/Point point
geometry_msgs/Vector3 ray
float64 sigma_rad
"""
_STANDPOINT_DEFINITION = """std_msgs/Header header
geometry_msgs/Point place
float64 sigma_m
"""
_RETRACTION_DEFINITION = "std_msgs/Header header\n"

TYPES = get_typestore(Stores.ROS2_HUMBLE)
TYPES.register(get_types_from_msg(_VIDEO_DEFINITION, VIDEO))
TYPES.register(get_types_from_msg(_SENTENCE_DEFINITION, SENTENCE))
TYPES.register(get_types_from_msg(_MOTION_DEFINITION, MOTION))
TYPES.register(get_types_from_msg(_FORMER_MOTION_DEFINITION, FORMER_MOTION))
TYPES.register(get_types_from_msg(_SIGHTING_DEFINITION, SIGHTING))
TYPES.register(get_types_from_msg(_STANDPOINT_DEFINITION, STANDPOINT))
TYPES.register(get_types_from_msg(_RETRACTION_DEFINITION, RETRACTION))

NS = 1_000_000_000


def decode(data: bytes, ros_type: str) -> RosMessage:
    """Return the message in CDR bytes; MalformedInput for bytes that are none of that type."""
    try:
        return TYPES.deserialize_cdr(data, ros_type)
    except Exception as error:  # whatever hostile bytes make generated code raise
        if ros_type == MOTION:
            return decode(data, FORMER_MOTION)
        raise MalformedInput(
            f"A {ros_type} message does not decode: it is {len(data)} bytes of something else."
        ) from error


def encode(message: RosMessage) -> bytes:
    """Return a message as CDR bytes."""
    return bytes(TYPES.serialize_cdr(message, message.__msgtype__))


def message(ros_type: str, **fields: Any) -> RosMessage:
    """Return a new message of a type."""
    return TYPES.types[ros_type](**fields)


def definition(ros_type: str) -> str:
    """Return the text that an MCAP schema of encoding `ros2msg` holds."""
    text, _ = TYPES.generate_msgdef(ros_type, ros_version=2)
    return str(text)


def stamp_ns(stamp: RosMessage) -> int:
    """Return a ROS time in nanoseconds."""
    return int(stamp.sec) * NS + int(stamp.nanosec)


def time(t_ns: int) -> RosMessage:
    """Return nanoseconds as a ROS time."""
    return message("builtin_interfaces/msg/Time", sec=t_ns // NS, nanosec=t_ns % NS)


def header(t_ns: int, frame_id: str) -> RosMessage:
    """Return a header."""
    return message("std_msgs/msg/Header", stamp=time(t_ns), frame_id=frame_id)


def vector(v: Vector3, kind: str = "Vector3") -> RosMessage:
    """Return a `Vector3` or a `Point`."""
    return message(f"geometry_msgs/msg/{kind}", x=v[0], y=v[1], z=v[2])


def quaternion(q: Wxyz) -> RosMessage:
    """Return a quaternion, which ROS writes x, y, z, w."""
    return message("geometry_msgs/msg/Quaternion", x=q[1], y=q[2], z=q[3], w=q[0])


def _xyz(v: RosMessage) -> Vector3:
    return (float(v.x), float(v.y), float(v.z))


def _wxyz(q: RosMessage) -> Wxyz:
    return (float(q.w), float(q.x), float(q.y), float(q.z))


def imu_sample(m: RosMessage, t_recv_ns: int, R_body_imu: Matrix | None) -> ImuSample:
    """Return a sample in body axes; `R_body_imu` is None where the axes are the same."""
    gyro, accel = _xyz(m.angular_velocity), _xyz(m.linear_acceleration)
    if R_body_imu is not None:
        gyro, accel = _turned(R_body_imu, gyro), _turned(R_body_imu, accel)
    return ImuSample(stamp_ns(m.header.stamp), t_recv_ns, gyro, accel)


def mag_sample(m: RosMessage, t_recv_ns: int, R_body_imu: Matrix | None) -> MagSample:
    """Return a field in body axes."""
    field = _xyz(m.magnetic_field)
    return MagSample(
        stamp_ns(m.header.stamp), t_recv_ns, _turned(R_body_imu, field) if R_body_imu is not None else field
    )


def _turned(R: Matrix, v: Vector3) -> Vector3:
    x, y, z = R @ v
    return (float(x), float(y), float(z))


def compass_heading(m: RosMessage, t_recv_ns: int) -> CompassHeading:
    """Return the yaw of a yaw-only quaternion."""
    w, x, y, z = _wxyz(m.quaternion)
    yaw_rad = float(np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))
    return CompassHeading(stamp_ns(m.header.stamp), t_recv_ns, yaw_rad)


def gps_fix(m: RosMessage, t_recv_ns: int) -> GpsFix:
    """Return a fix; covariance type 0 means that the receiver states none."""
    cov = tuple(float(c) for c in m.position_covariance) if m.position_covariance_type else (0.0,) * 9
    h = float(m.altitude)
    lat, lon = float(m.latitude), float(m.longitude)
    return GpsFix(stamp_ns(m.header.stamp), t_recv_ns, lat, lon, h, cov, valid=int(m.status.status) >= 0)


def gps_velocity(m: RosMessage, t_recv_ns: int) -> GpsVelocity:
    """Return a velocity."""
    return GpsVelocity(stamp_ns(m.header.stamp), t_recv_ns, _xyz(m.twist.linear))


def visual_motion(m: RosMessage, t_recv_ns: int) -> VisualMotion:
    """Return the motion that a front end had found."""
    return VisualMotion(
        stamp_ns(m.header.stamp),
        t_recv_ns,
        int(m.frame_id),
        stamp_ns(m.key_stamp),
        np.array(m.r_key_cam, np.float64).reshape(3, 3),
        _xyz(m.direction_key),
        int(m.inliers),
        float(m.parallax_px),
        bool(m.is_keyframe),
        _tracks(m),
    )


def _tracks(m: RosMessage) -> VisualTracks | None:
    """Return the features of a motion; None where it has none, or was recorded before features were."""
    ids, rays = np.array(getattr(m, "track_ids", ()), np.int64), np.array(getattr(m, "track_rays", ()), np.float32)
    if len(ids) == 0 or len(rays) != 4 * len(ids):
        return None
    return VisualTracks(ids, rays.reshape(-1, 4))


def sighting(m: RosMessage, t_recv_ns: int) -> Sighting:
    """Return a landmark that somebody pointed out."""
    return Sighting(stamp_ns(m.header.stamp), t_recv_ns, _xyz(m.point), _xyz(m.ray), float(m.sigma_rad))


def standpoint(m: RosMessage, t_recv_ns: int) -> Standpoint:
    """Return where somebody said to stand."""
    return Standpoint(stamp_ns(m.header.stamp), t_recv_ns, _xyz(m.place), float(m.sigma_m))


def retraction(m: RosMessage, t_recv_ns: int) -> Retraction:
    """Return that somebody took a word back."""
    return Retraction(stamp_ns(m.header.stamp), t_recv_ns)


def true_pose(m: RosMessage, t_recv_ns: int) -> TruePose:
    """Return ground truth; diagonal entries of -1 in the covariance mark what is not known."""
    cov, twist_cov = m.pose.covariance, m.twist.covariance
    tilt, heading = bool(cov[21] >= 0 and cov[28] >= 0), bool(cov[35] >= 0)
    q = _wxyz(m.pose.pose.orientation)
    try:
        q = normalise(q)
    except ValueError:
        tilt, heading, q = False, False, (1.0, 0.0, 0.0, 0.0)
    v: Vector3 | None = _xyz(m.twist.twist.linear) if twist_cov[0] >= 0 else None
    if v is not None:
        v = _turned(matrix_from_wxyz(q), v)
    return TruePose(
        stamp_ns(m.header.stamp),
        t_recv_ns,
        _xyz(m.pose.pose.position),
        q,
        v,
        position_known=bool(cov[0] >= 0),
        height_known=bool(cov[14] >= 0),
        tilt_known=tilt,
        heading_known=heading,
        sigma_h_m=float(np.sqrt(max(0.0, 0.5 * (cov[0] + cov[7])))),
    )


def origin(m: RosMessage) -> Origin:
    """Return where the map frame of ground truth is laid."""
    return Origin(float(m.latitude), float(m.longitude), float(m.altitude))


def camera_model(m: RosMessage) -> CameraModel | None:
    """Return the camera, or None where its intrinsics are not known (all zero) or make no sense."""
    k = [float(value) for value in m.k]
    names = {str(name): name for name in get_args(DistortionModel)}
    model = names.get(str(m.distortion_model), "plumb_bob")
    distortion = tuple(float(value) for value in m.d)
    finite = np.all(np.isfinite([*k, *distortion]))
    if not finite or k[0] <= 0.0 or k[4] <= 0.0 or not (0 < m.width < 20_000 and 0 < m.height < 20_000):
        return None
    if (m.distortion_model and m.distortion_model not in names) or len(distortion) > 8:
        return None
    return CameraModel(int(m.width), int(m.height), k[0], k[4], k[2], k[5], model, distortion)


def transforms(m: RosMessage) -> dict[tuple[str, str], Matrix]:
    """Return the (4, 4) transforms of a TF message as {(parent, child): T_parent_child}; those that are none are left out."""
    found = {}
    for stamped in m.transforms:
        T = np.eye(4)
        try:
            T[:3, :3] = matrix_from_wxyz(normalise(_wxyz(stamped.transform.rotation)))
        except ValueError:
            continue
        T[:3, 3] = _xyz(stamped.transform.translation)
        if np.all(np.isfinite(T)):
            found[str(stamped.header.frame_id).lstrip("/"), str(stamped.child_frame_id).lstrip("/")] = T
    return found
