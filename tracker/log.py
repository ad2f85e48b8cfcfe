"""A recorded walk: a ROS 2 bag in one MCAP file (LOG_FORMAT.md), read as measurements in order of arrival.

What does not parse is left out and counted; none of it ends the reading.
"""

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Literal

import numpy as np

from tracker import ros_messages as ros
from tracker.container import Container, Stored
from tracker.errors import MalformedInput
from tracker.estimator import Origin
from tracker.log_nmea import TOPIC as NMEA
from tracker.log_nmea import LoggedSentences, SentenceContents
from tracker.measurements import Frame, GpsFix, Matrix, Measurement
from tracker.pictures import EncodedPicture
from tracker.rig import CameraModel, Rig
from tracker.soundness import Soundness
from tracker.video import VideoDecoder, is_key

#: Topic of each sensor, the type that it must have, and the name under which it is counted.
TOPICS: dict[str, tuple[str, str]] = {
    "/imu/data_raw": (ros.IMU, "imu"),
    "/imu/mag": (ros.MAG, "mag"),
    "/compass/heading": (ros.COMPASS, "compass"),
    "/gps/fix": (ros.FIX, "gps"),
    "/gps/vel": (ros.VELOCITY, "gps_velocity"),
    NMEA: (ros.SENTENCE, "gps"),
    "/camera/image/compressed": (ros.IMAGE, "frames"),
    "/camera/video": (ros.VIDEO, "frames"),
    "/camera/motion": (ros.MOTION, "motions"),
    "/visitor/sighting": (ros.SIGHTING, "said"),
    "/visitor/standpoint": (ros.STANDPOINT, "said"),
    "/visitor/retraction": (ros.RETRACTION, "said"),
    "/ground_truth/odom": (ros.ODOMETRY, "truth"),
    "/camera/camera_info": (ros.CAMERA_INFO, ""),
    "/tf_static": (ros.TF, ""),
    "/ground_truth/origin": (ros.FIX, ""),
}
#: Name of the metadata that our recorder writes.
RECORDING = "agora"
#: Stamps before 2001 are no dates: a rig counts from when it was switched on.
_DATED_NS = 1_000_000_000_000_000_000
_CAMERA = ("/camera/image/compressed", "/camera/video")


@dataclass(frozen=True)
class LogInfo:
    """What a log holds."""

    t_start_ns: int
    """Arrival of the first message."""
    t_end_ns: int
    counts: dict[str, int]
    """Messages by sensor: imu, mag, compass, gps, gps_velocity, frames, truth.

    And `motions`, what a front end made of frames, and `said`, what visitors have said.
    """
    first_fix: GpsFix | None
    truth_origin: Origin | None
    camera_encoding: Literal["jpeg", "png", "h264"] | None
    truncated: bool
    utc_start_ns: int | None = None
    """Nanoseconds since 1970 at the start, where a recorder says so; None where the stamps themselves are meant so."""

    @property
    def date_ns(self) -> int:
        """When the walk was, nanoseconds since 1970."""
        return self.t_start_ns if self.utc_start_ns is None else self.utc_start_ns

    @property
    def utc_offset_s(self) -> float | None:
        """What a stamp needs for the seconds since 1970; None where nobody has written down when the walk was."""
        if self.utc_start_ns is not None:
            return (self.utc_start_ns - self.t_start_ns) * 1e-9
        return 0.0 if self.t_start_ns >= _DATED_NS else None

    @property
    def duration_s(self) -> float:
        """From the first arrival to the last."""
        return (self.t_end_ns - self.t_start_ns) * 1e-9

    @property
    def has_truth(self) -> bool:
        """Whether there is ground truth."""
        return self.counts["truth"] > 0


class Log:
    """An opened walk. It may be read any number of times, from any place."""

    def __init__(self, container: Container, contents: "_Contents") -> None:
        self._container = container
        self._contents = contents
        self.path = container.path
        self.name = container.path.stem
        self.metadata = container.metadata
        self.info = contents.info(container.truncated, _utc_start_ns(container.metadata))
        self.rig = contents.rig()
        self.skipped: Counter[str] = Counter()
        """What the last reading left out, by reason."""

    @classmethod
    def open(cls, path: Path) -> "Log":
        """Open a walk.

        Raises:
            MalformedInput: There is no such file, it is no MCAP, or it holds neither IMU nor GPS.
        """
        contents = _Contents()
        container = Container(path, contents.visit)
        contents.choose_receiver()
        counts = contents.counts
        if not counts["imu"] and not counts["gps"]:
            raise MalformedInput(
                f"{path} holds no IMU and no GPS: a walk needs /imu/data_raw, or /gps/fix or /gps/nmea, or both (it has "
                f"{', '.join(sorted(contents.topics)) or 'no messages'})."
            )
        return cls(container, contents)

    def messages(
        self, *, start_ns: int | None = None, camera: bool = True, truth: bool = True
    ) -> Iterator[Measurement]:
        """Yield measurements in order of arrival, in body axes.

        Args:
            start_ns: Leave out what arrived before; None for all.
            camera: Whether pictures are wanted.
            truth: Whether ground truth is wanted.
        """
        return _Reading(self, start_ns or 0, camera, truth).measurements()

    def pictures(self, at_ns: int) -> Iterator[Frame]:
        """Yield the pictures alone, from the one on that was the newest at at_ns; from the first, where none was there yet."""
        times_ns = self._contents.camera_times_ns
        newest = bisect_right(times_ns, at_ns) - 1
        start_ns = times_ns[newest] if newest >= 0 else 0
        reading = _Reading(self, start_ns, camera=True, truth=False, others=False)
        return (picture for picture in reading.measurements() if isinstance(picture, Frame))

    @property
    def picture_times_ns(self) -> Sequence[int]:
        """When pictures arrived, in order, those too that do not decode."""
        return self._contents.camera_times_ns


class _Contents:
    """What the one pass over a newly opened file finds."""

    def __init__(self) -> None:
        self.counts = {name: 0 for _, name in TOPICS.values() if name}
        self.topics: set[str] = set()
        self.camera_times_ns: list[int] = []
        self.key_times_ns: list[int] = []
        self._times_ns: tuple[int, int] | None = None
        self.speaks_nmea = False
        """Whether fixes and velocities come from the receiver's own sentences, and `/gps/fix` and `/gps/vel` are left alone."""
        self._sentences = SentenceContents()
        self._first_fix: GpsFix | None = None
        self._truth_origin: Origin | None = None
        self._encoding: Literal["jpeg", "png", "h264"] | None = None
        self._camera: CameraModel | None = None
        self._transforms: dict[tuple[str, str], Matrix] = {}

    def visit(self, stored: Stored) -> None:
        """Take note of one message."""
        t_ns = stored.t_recv_ns
        first, last = self._times_ns or (t_ns, t_ns)
        self._times_ns = (min(first, t_ns), max(last, t_ns))
        self.topics.add(stored.topic)
        ros_type, sensor = TOPICS.get(stored.topic, ("", ""))
        if stored.ros_type != ros_type:
            return
        if stored.topic == NMEA:
            self._sentences.visit(stored.data, t_ns)
            return
        if sensor:
            self.counts[sensor] += 1
        if stored.topic in _CAMERA:
            self._visit_picture(stored)
        elif not sensor or (sensor == "gps" and self._first_fix is None):
            try:
                self._visit_once(stored.topic, ros.decode(stored.data, ros_type), t_ns)
            except MalformedInput:
                return  # counted when it is read

    def _visit_picture(self, stored: Stored) -> None:
        self.camera_times_ns.append(stored.t_recv_ns)
        if stored.topic == "/camera/video":
            self._encoding = "h264"
            if is_key(stored.data[24:]) or not self.key_times_ns:
                self.key_times_ns.append(stored.t_recv_ns)
        elif self._encoding is None:
            self._encoding = "png" if b"\x89PNG" in stored.data[:96] else "jpeg"

    def _visit_once(self, topic: str, message: ros.RosMessage, t_ns: int) -> None:
        if topic == "/camera/camera_info":
            self._camera = self._camera or ros.camera_model(message)
        elif topic == "/tf_static":
            self._transforms |= ros.transforms(message)
        elif topic == "/ground_truth/origin":
            origin = ros.origin(message)
            if isfinite(origin.lat_deg + origin.lon_deg + origin.h_ellipsoid_m):
                self._truth_origin = self._truth_origin or origin
        else:
            fix = ros.gps_fix(message, t_ns)
            if fix.valid and isfinite(fix.lat_deg + fix.lon_deg + fix.h_ellipsoid_m):
                self._first_fix = fix

    def choose_receiver(self) -> None:
        """Choose between the receiver's sentences and what a driver made of them, once everything was visited."""
        if self._sentences.fixes:
            self.speaks_nmea, self._first_fix = True, self._sentences.first_fix
            self.counts |= {"gps": self._sentences.fixes, "gps_velocity": self._sentences.velocities}

    def info(self, truncated: bool, utc_start_ns: int | None) -> LogInfo:
        """Return what was found."""
        first, last = self._times_ns or (0, 0)
        origin = self._truth_origin if self.counts["truth"] else None
        self.camera_times_ns.sort()
        self.key_times_ns.sort()
        return LogInfo(first, last, self.counts, self._first_fix, origin, self._encoding, truncated, utc_start_ns)

    def rig(self) -> Rig:
        """Return the extrinsics of `/tf_static`, and the camera."""
        return rig_of(self._transforms, self._camera if self.counts["frames"] else None)


class _Reading:
    """One pass over a log."""

    def __init__(self, log: Log, start_ns: int, camera: bool, truth: bool, *, others: bool = True) -> None:
        self._container, self._contents, self._start_ns = log._container, log._contents, start_ns
        self._skipped = Counter(log._container.damage)
        if others:
            log.skipped = self._skipped  # what reads pictures alone tells nothing of the log
        if log.info.truncated:
            self._skipped["truncated"] += 1
        self._wanted = {
            topic
            for topic, (_, sensor) in TOPICS.items()
            if sensor and (camera if sensor == "frames" else others and (truth or sensor != "truth"))
        } - ({"/gps/fix", "/gps/vel"} if log._contents.speaks_nmea else {NMEA})
        R_body_imu = log.rig.T_body_imu[:3, :3]
        self._R_body_imu = None if np.array_equal(R_body_imu, np.eye(3)) else R_body_imu
        self._soundness = Soundness()
        self._decoder = VideoDecoder()
        self._waiting: dict[int, tuple[int, int]] = {}
        self._sentences = LoggedSentences()

    def measurements(self) -> Iterator[Measurement]:
        """Yield them."""
        begin_ns = self._start_ns
        if "/camera/video" in self._wanted and self._contents.key_times_ns:
            keys = self._contents.key_times_ns
            begin_ns = min(begin_ns, keys[max(0, bisect_right(keys, begin_ns) - 1)])
        frame_id = bisect_left(self._contents.camera_times_ns, begin_ns)
        t_last_ns = self._start_ns
        if self._start_ns and NMEA in self._wanted:
            self._hear_what_was_said_before()
        for stored in self._container.messages(begin_ns, self._is_wanted):
            t_last_ns = stored.t_recv_ns
            is_camera = stored.topic in _CAMERA
            if is_camera:
                frame_id += 1
            if stored.t_recv_ns < self._start_ns and stored.topic != "/camera/video":
                continue
            for measurement in self._parse(stored, frame_id - 1):
                if measurement.t_recv_ns >= self._start_ns and self._is_sound(measurement):
                    yield measurement
        yield from filter(self._is_sound, self._sentences.close(t_last_ns))

    def _hear_what_was_said_before(self) -> None:
        """Bring the reader of sentences to where it would be: what a receiver says now depends on what it has said."""
        for stored in self._container.messages(0, lambda topic: topic == NMEA):
            if stored.t_recv_ns >= self._start_ns:
                return
            for _ in self._parse(stored, 0):
                pass

    def _is_wanted(self, topic: str) -> bool:
        if topic not in TOPICS:
            self._skipped["unknown_topic"] += 1
        return topic in self._wanted

    def _parse(self, stored: Stored, frame_id: int) -> Iterator[Measurement]:
        if stored.ros_type != TOPICS[stored.topic][0]:
            self._skipped["unknown_type"] += 1
            return
        try:
            message = ros.decode(stored.data, stored.ros_type)
        except MalformedInput:
            self._skipped["bad_message"] += 1
            return
        t_ns = stored.t_recv_ns
        match stored.topic:
            case "/imu/data_raw":
                yield ros.imu_sample(message, t_ns, self._R_body_imu)
            case "/imu/mag":
                yield ros.mag_sample(message, t_ns, self._R_body_imu)
            case "/compass/heading":
                yield ros.compass_heading(message, t_ns)
            case "/gps/fix":
                yield ros.gps_fix(message, t_ns)
            case "/gps/vel":
                yield ros.gps_velocity(message, t_ns)
            case "/gps/nmea":
                yield from self._sentences.take(message, t_ns)
                self._skipped |= Counter(
                    self._sentences.left_out
                )  # the larger of each: it counts on from the beginning
            case "/camera/motion":
                yield ros.visual_motion(message, t_ns)
            case "/visitor/sighting":
                yield ros.sighting(message, t_ns)
            case "/visitor/standpoint":
                yield ros.standpoint(message, t_ns)
            case "/visitor/retraction":
                yield ros.retraction(message, t_ns)
            case "/ground_truth/odom":
                yield ros.true_pose(message, t_ns)
            case "/camera/image/compressed":
                yield from self._picture(message, t_ns, frame_id)
            case _:
                yield from self._video(message, t_ns, frame_id)

    def _picture(self, message: ros.RosMessage, t_recv_ns: int, frame_id: int) -> Iterator[Frame]:
        data = bytes(message.data)
        is_whole = data.startswith(b"\x89PNG") or (data.startswith(b"\xff\xd8") and b"\xff\xd9" in data[-64:])
        if not is_whole:
            self._skipped["corrupt_image"] += 1
            return
        yield Frame(ros.stamp_ns(message.header.stamp), t_recv_ns, frame_id, EncodedPicture(data))

    def _video(self, message: ros.RosMessage, t_recv_ns: int, frame_id: int) -> Iterator[Frame]:
        self._waiting[frame_id] = (ros.stamp_ns(message.timestamp), t_recv_ns)
        for number, picture in self._decoder.decode(bytes(message.data), frame_id):
            times = self._waiting.pop(number, None)
            if times is not None:
                yield Frame(times[0], times[1], number, picture)
        for number in [number for number in self._waiting if number < frame_id - 8]:
            del self._waiting[number]
            self._skipped["corrupt_image"] += 1

    def _is_sound(self, measurement: Measurement) -> bool:
        """Return whether a measurement may go on; count it by reason where not."""
        fault = self._soundness.fault(measurement)
        if fault is not None:
            self._skipped[fault] += 1
        return fault is None


def _utc_start_ns(metadata: dict[str, dict[str, str]]) -> int | None:
    text = metadata.get(RECORDING, {}).get("utc_start_ns", "")
    return int(text) if text.isascii() and text.isdigit() and len(text) < 20 else None


def rig_of(transforms: Mapping[tuple[str, str], Matrix], camera: CameraModel | None) -> Rig:
    """Return the rig of `/tf_static` as `ros_messages.transforms` reads it, and its camera."""
    default = Rig()
    T = {child: transform for (parent, child), transform in transforms.items() if parent == "base_link"}
    return Rig(
        T.get("imu_link", default.T_body_imu),
        T.get("gps_link", default.T_body_gps),
        T.get("camera_optical_frame", default.T_body_cam),
        camera,
    )
