"""Measurements into a log: a ROS 2 bag in one MCAP file, as LOG_FORMAT.md says; docs/recording.md says what is beside it."""

import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Literal

import numpy as np
from mcap.writer import CompressionType, Writer

from tracker import ros_messages as ros
from tracker.estimator import Origin
from tracker.geometry import conjugate, rotate, wxyz_from_matrix
from tracker.measurements import (
    CompassHeading,
    Frame,
    GpsFix,
    GpsVelocity,
    Image,
    ImuSample,
    MagSample,
    Measurement,
    Picture,
    Retraction,
    Sighting,
    Standpoint,
    TruePose,
    Vector3,
    VisualMotion,
)
from tracker.rig import CameraModel, Rig
from tracker.video import VideoEncoder

_STAMPED = "geometry_msgs/msg/TransformStamped"
_CHUNK_BYTES = 512 * 1024
_UNKNOWN = -1.0


class LogWriter:
    """Writes a walk. Use it as a context manager: a file that is not closed has no index, and readers of other kinds need one."""

    def __init__(
        self,
        path: Path,
        rig: Rig,
        origin: Origin | None = None,
        *,
        t_start_ns: int = 0,
        video: Literal["jpeg", "h264"] = "jpeg",
        rate_hz: float = 15.0,
        metadata: Mapping[str, Mapping[str, str]] | None = None,
    ) -> None:
        """Begin a log.

        Args:
            path: Written over where it exists.
            rig: Its extrinsics go to `/tf_static`, its camera to `/camera/camera_info`.
            origin: Where the map frame of ground truth is laid; None where there is no truth.
            t_start_ns: Arrival of the messages that come once; not after the first measurement.
            video: How pictures are stored; `h264` wants pictures with `bgr()`.
            rate_hz: Of the camera, for the encoder's rate control.
            metadata: Names and values that go to the file's head, by name of the record.
        """
        self._rig, self._video, self._rate_hz = rig, video, rate_hz
        R_imu_body = rig.T_body_imu[:3, :3].T
        self._R_imu_body = None if np.array_equal(R_imu_body, np.eye(3)) else R_imu_body
        self._file = path.open("wb")
        self._writer: Any = Writer(self._file, chunk_size=_CHUNK_BYTES, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2", library="agora")
        for name, values in (metadata or {}).items():
            self._writer.add_metadata(name, dict(values))
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._encoder: VideoEncoder | None = None
        self._once(origin, t_start_ns)

    def __enter__(self) -> "LogWriter":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def flush(self) -> None:
        """Bring all that was written so far to the disk: neither a kill nor a power cut loses it.

        Raises:
            OSError: The disk is full, or gone.
        """
        self._writer._Writer__finalize_chunk()  # mcap has no public way to end a chunk before it is full
        self._file.flush()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Write the index and close the file.

        Raises:
            OSError: The disk is full, or gone; the file is closed nevertheless.
        """
        if self._file.closed:
            return
        try:
            self._writer.finish()
        finally:
            self._file.close()

    def _once(self, origin: Origin | None, t_ns: int) -> None:
        for topic, message in rig_messages(self._rig, t_ns).items():
            self._put(topic, message, t_ns)
        if origin is not None:
            fix = GpsFix(t_ns, t_ns, origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, (0.0,) * 9)
            self._put("/ground_truth/origin", _fix(fix, "map"), t_ns)

    def write(self, measurement: Measurement) -> None:
        """Write one measurement.

        Raises:
            ValueError: A kind of measurement that logs do not hold.
        """
        t_ns = measurement.t_recv_ns
        match measurement:
            case ImuSample():
                self._put("/imu/data_raw", self._imu(measurement), t_ns)
            case MagSample():
                self._put("/imu/mag", self._mag(measurement), t_ns)
            case CompassHeading():
                self._put("/compass/heading", _compass(measurement), t_ns)
            case GpsFix():
                self._put("/gps/fix", _fix(measurement, "gps_link"), t_ns)
            case GpsVelocity():
                self._put("/gps/vel", _velocity(measurement), t_ns)
            case TruePose():
                self._put("/ground_truth/odom", _odometry(measurement), t_ns)
            case Frame():
                self._frame(measurement)
            case VisualMotion():
                self._put("/camera/motion", _motion(measurement), t_ns)
            case Sighting():
                self._put("/visitor/sighting", _sighting(measurement), t_ns)
            case Standpoint():
                self._put("/visitor/standpoint", _standpoint(measurement), t_ns)
            case Retraction():
                header = ros.header(measurement.t_ns, "map")
                self._put("/visitor/retraction", ros.message(ros.RETRACTION, header=header), t_ns)
            case _:
                raise ValueError(f"logs do not hold {type(measurement).__name__}")

    def write_sentence(self, t_recv_ns: int, sentence: str) -> None:
        """Write a line of NMEA as it was received. Readers take fixes and velocities from these where there are any."""
        header = ros.header(t_recv_ns, "gps_link")
        self._put("/gps/nmea", ros.message(ros.SENTENCE, header=header, sentence=sentence), t_recv_ns)

    def _put(self, topic: str, message: ros.RosMessage, t_recv_ns: int) -> None:
        ros_type = message.__msgtype__
        if topic not in self._channels:
            if ros_type not in self._schemas:
                text = ros.definition(ros_type).encode()
                self._schemas[ros_type] = self._writer.register_schema(ros_type, "ros2msg", text)
            self._channels[topic] = self._writer.register_channel(topic, "cdr", self._schemas[ros_type])
        self._writer.add_message(self._channels[topic], t_recv_ns, ros.encode(message), t_recv_ns)

    def _in_imu(self, v_body: Vector3) -> ros.RosMessage:
        if self._R_imu_body is None:
            return ros.vector(v_body)
        x, y, z = self._R_imu_body @ v_body
        return ros.vector((float(x), float(y), float(z)))

    def _imu(self, sample: ImuSample) -> ros.RosMessage:
        no_orientation, unknown = np.zeros(9), np.zeros(9)
        no_orientation[0] = _UNKNOWN
        return ros.message(
            ros.IMU,
            header=ros.header(sample.t_ns, "imu_link"),
            orientation=ros.quaternion((1.0, 0.0, 0.0, 0.0)),
            orientation_covariance=no_orientation,
            angular_velocity=self._in_imu(sample.gyro_rad_s),
            angular_velocity_covariance=unknown,
            linear_acceleration=self._in_imu(sample.accel_m_s2),
            linear_acceleration_covariance=unknown,
        )

    def _mag(self, sample: MagSample) -> ros.RosMessage:
        return ros.message(
            ros.MAG,
            header=ros.header(sample.t_ns, "imu_link"),
            magnetic_field=self._in_imu(sample.field_body_t),
            magnetic_field_covariance=np.zeros(9),
        )

    def _frame(self, frame: Frame) -> None:
        if self._video == "jpeg":
            data = np.frombuffer(frame.picture.jpeg(), np.uint8)
            header = ros.header(frame.t_ns, "camera_optical_frame")
            message = ros.message(ros.IMAGE, header=header, format="jpeg", data=data)
            self._put("/camera/image/compressed", message, frame.t_recv_ns)
            return
        picture = _pixels(frame.picture)
        if self._encoder is None:
            height, width = picture.shape[:2]
            self._encoder = VideoEncoder(width, height, self._rate_hz)
        data = np.frombuffer(self._encoder.encode(picture), np.uint8)
        stamp = ros.time(frame.t_ns)
        message = ros.message(ros.VIDEO, timestamp=stamp, frame_id="camera_optical_frame", data=data, format="h264")
        self._put("/camera/video", message, frame.t_recv_ns)


def rig_messages(rig: Rig, t_ns: int) -> dict[str, ros.RosMessage]:
    """Return what a log says of its rig, once, by topic."""
    links = (("imu_link", rig.T_body_imu), ("gps_link", rig.T_body_gps), ("camera_optical_frame", rig.T_body_cam))
    stamped = []
    for child, T in links:
        translation = ros.vector((float(T[0, 3]), float(T[1, 3]), float(T[2, 3])))
        rotation = ros.quaternion(wxyz_from_matrix(T[:3, :3]))
        transform = ros.message("geometry_msgs/msg/Transform", translation=translation, rotation=rotation)
        header = ros.header(t_ns, "base_link")
        stamped.append(ros.message(_STAMPED, header=header, child_frame_id=child, transform=transform))
    messages = {"/tf_static": ros.message(ros.TF, transforms=stamped)}
    if rig.camera is not None:
        messages["/camera/camera_info"] = _camera_info(rig.camera, t_ns)
    return messages


def _camera_info(camera: CameraModel, t_ns: int) -> ros.RosMessage:
    P = np.zeros((3, 4))
    P[:, :3] = camera.K
    roi = ros.message("sensor_msgs/msg/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
    return ros.message(
        ros.CAMERA_INFO,
        header=ros.header(t_ns, "camera_optical_frame"),
        height=camera.height_px,
        width=camera.width_px,
        distortion_model=camera.distortion_model,
        d=np.array(camera.distortion, float),
        k=camera.K.ravel(),
        r=np.eye(3).ravel(),
        p=P.ravel(),
        binning_x=0,
        binning_y=0,
        roi=roi,
    )


def _pixels(picture: Picture) -> Image:
    bgr: Any = getattr(picture, "bgr", None)
    if bgr is None:
        raise ValueError("video is made of pictures whose pixels are at hand")
    return np.asarray(bgr(), np.uint8)


def _compass(heading: CompassHeading) -> ros.RosMessage:
    half = 0.5 * heading.yaw_rad
    q = ros.quaternion((float(np.cos(half)), 0.0, 0.0, float(np.sin(half))))
    return ros.message(ros.COMPASS, header=ros.header(heading.t_ns, "map"), quaternion=q)


def _fix(fix: GpsFix, frame_id: str) -> ros.RosMessage:
    stated = any(fix.cov_enu_m2)
    return ros.message(
        ros.FIX,
        header=ros.header(fix.t_ns, frame_id),
        status=ros.message("sensor_msgs/msg/NavSatStatus", status=0 if fix.valid else -1, service=1),
        latitude=fix.lat_deg,
        longitude=fix.lon_deg,
        altitude=fix.h_ellipsoid_m,
        position_covariance=np.array(fix.cov_enu_m2, float),
        position_covariance_type=3 if stated else 0,
    )


def _velocity(velocity: GpsVelocity) -> ros.RosMessage:
    twist = ros.message(
        "geometry_msgs/msg/Twist", linear=ros.vector(velocity.v_enu_m_s), angular=ros.vector((0.0, 0.0, 0.0))
    )
    return ros.message(ros.VELOCITY, header=ros.header(velocity.t_ns, "gps_link"), twist=twist)


def _motion(motion: VisualMotion) -> ros.RosMessage:
    seen = motion.tracks
    ids, rays = (np.zeros(0, np.int64), np.zeros((0, 4), np.float32)) if seen is None else (seen.ids, seen.rays)
    return ros.message(
        ros.MOTION,
        header=ros.header(motion.t_ns, "camera_optical_frame"),
        key_stamp=ros.time(motion.t_key_ns),
        frame_id=motion.frame_id,
        r_key_cam=np.asarray(motion.R_key_cam, np.float64).ravel(),
        direction_key=ros.vector(motion.direction_key),
        inliers=motion.inliers,
        parallax_px=motion.parallax_px,
        is_keyframe=motion.is_keyframe,
        track_ids=ids,
        track_rays=rays.ravel(),
    )


def _sighting(seen: Sighting) -> ros.RosMessage:
    return ros.message(
        ros.SIGHTING,
        header=ros.header(seen.t_ns, "camera_optical_frame"),
        point=ros.vector(seen.point_site_m, "Point"),
        ray=ros.vector(seen.ray_cam),
        sigma_rad=seen.sigma_rad,
    )


def _standpoint(said: Standpoint) -> ros.RosMessage:
    place = ros.vector(said.p_site_m, "Point")
    return ros.message(ros.STANDPOINT, header=ros.header(said.t_ns, "map"), place=place, sigma_m=said.sigma_m)


def _odometry(truth: TruePose) -> ros.RosMessage:
    cov, twist_cov = np.zeros(36), np.zeros(36)
    cov[0] = cov[7] = truth.sigma_h_m**2 if truth.position_known else _UNKNOWN
    cov[14] = 0.0 if truth.height_known else _UNKNOWN
    cov[21] = cov[28] = 0.0 if truth.tilt_known else _UNKNOWN
    cov[35] = 0.0 if truth.heading_known else _UNKNOWN
    twist_cov[0] = 0.0 if truth.v_map_m_s is not None else _UNKNOWN
    twist_cov[21] = _UNKNOWN
    v_body = rotate(conjugate(truth.wxyz_map_body), truth.v_map_m_s or (0.0, 0.0, 0.0))
    pose = ros.message(
        "geometry_msgs/msg/Pose",
        position=ros.vector(truth.p_map_body_m, "Point"),
        orientation=ros.quaternion(truth.wxyz_map_body),
    )
    twist = ros.message("geometry_msgs/msg/Twist", linear=ros.vector(v_body), angular=ros.vector((0.0, 0.0, 0.0)))
    return ros.message(
        ros.ODOMETRY,
        header=ros.header(truth.t_ns, "map"),
        child_frame_id="base_link",
        pose=ros.message("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=cov),
        twist=ros.message("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=twist_cov),
    )
