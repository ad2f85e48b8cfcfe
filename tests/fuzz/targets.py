"""What is fuzzed: each target takes any bytes, and raises only where a law is broken.

The laws: the same bytes give the same result, whole, byte by byte or a second time; what comes out is sound; and nothing but the
one documented exception, `MalformedInput`, leaves a reader.
"""

import tempfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np

from tests.tracker.sources.receivers import sentence
from tracker import ros_messages as ros
from tracker.container import Container, Stored
from tracker.errors import MalformedInput
from tracker.log import TOPICS, Log
from tracker.measurements import Frame, GpsFix, GpsVelocity, Measurement
from tracker.salvage import cut_chunk
from tracker.sources.gpsd_protocol import GpsdProtocol
from tracker.sources.nmea import NmeaReader

T_NS = 1_000_000_000_000
#: The kinds of message that a log may hold, in an order that a byte can choose from.
ROS_TYPES = tuple(sorted({ros_type for ros_type, _ in TOPICS.values()}))
_CONVERSIONS: dict[str, Callable[[ros.RosMessage], object]] = {
    ros.IMU: lambda m: ros.imu_sample(m, T_NS, np.diag([-1.0, -1.0, 1.0])),
    ros.MAG: lambda m: ros.mag_sample(m, T_NS, None),
    ros.COMPASS: lambda m: ros.compass_heading(m, T_NS),
    ros.FIX: lambda m: (ros.gps_fix(m, T_NS), ros.origin(m)),
    ros.VELOCITY: lambda m: ros.gps_velocity(m, T_NS),
    ros.ODOMETRY: lambda m: ros.true_pose(m, T_NS),
    ros.MOTION: lambda m: ros.visual_motion(m, T_NS),
    ros.CAMERA_INFO: ros.camera_model,
    ros.TF: ros.transforms,
}


def nmea(data: bytes) -> None:
    """Read a receiver's stream."""
    whole, split = NmeaReader(), NmeaReader()
    expected = whole.feed(data, T_NS) + whole.close(T_NS)
    found = [m for at in range(len(data)) for m in split.feed(data[at : at + 1], T_NS)] + split.close(T_NS)
    assert repr(found) == repr(expected), "in pieces it is another stream"
    assert split.counts == whole.counts
    assert split.facts(T_NS) == whole.facts(T_NS)
    for m in expected:
        assert m.t_ns <= m.t_recv_ns
        assert isinstance(m, GpsVelocity) or not m.valid or _is_sound(m), m


def _is_sound(fix: GpsFix) -> bool:
    in_range = abs(fix.lat_deg) <= 90.0 and abs(fix.lon_deg) <= 180.0
    return (
        in_range and bool(np.all(np.isfinite((fix.h_ellipsoid_m, *fix.cov_enu_m2)))) and min(fix.cov_enu_m2[::4]) > 0.0
    )


def sentences(data: bytes) -> None:
    """Read lines as sentences whose checksums are right, so that what they say is what is fuzzed."""
    nmea(b"".join(sentence(line.decode("latin-1")) for line in data.replace(b"$", b"").splitlines()))


def gpsd(data: bytes) -> None:
    """Read a connection to gpsd."""
    expected = _by_gpsd([data])
    assert _by_gpsd([data[at : at + 1] for at in range(len(data))]) == expected, "in pieces it is another connection"


def _by_gpsd(pieces: list[bytes]) -> tuple[object, ...]:
    protocol, reader = GpsdProtocol(), NmeaReader()
    try:
        found = [protocol.feed(piece) for piece in pieces]
    except MalformedInput:
        return ("refused",)
    reader.feed(b"".join(found), T_NS)
    reader.close(T_NS)
    return b"".join(found), dict(reader.counts), protocol.devices


def message(data: bytes) -> None:
    """Decode one message, whose kind the first byte chooses."""
    if not data:
        return
    ros_type = ROS_TYPES[data[0] % len(ROS_TYPES)]
    try:
        decoded = ros.decode(data[1:], ros_type)
    except MalformedInput:
        return
    if ros_type in _CONVERSIONS:
        _CONVERSIONS[ros_type](decoded)


def log(data: bytes) -> None:
    """Open a log and read it twice, and once from its middle."""
    with tempfile.NamedTemporaryFile(suffix=".mcap") as file:
        file.write(data)
        file.flush()
        path = Path(file.name)
        try:
            opened = Log.open(path)
        except MalformedInput:
            return
        first = [_named(m) for m in opened.messages()]
        skipped = dict(opened.skipped)
        assert [_named(m) for m in opened.messages()] == first, "another reading, another walk"
        assert dict(opened.skipped) == skipped
        middle_ns = (opened.info.t_start_ns + opened.info.t_end_ns) // 2
        for m in opened.messages(start_ns=middle_ns):
            assert m.t_recv_ns >= middle_ns


def container(data: bytes) -> None:
    """Open a file's messages; what is cut off its end takes no message before the cut along."""
    with tempfile.NamedTemporaryFile(suffix=".mcap") as file:
        file.write(data)
        file.flush()
        seen: list[Stored] = []
        try:
            opened = Container(Path(file.name), seen.append)
        except MalformedInput:
            return
        found = list(opened.messages())
        assert sorted(s.t_recv_ns for s in found) == [s.t_recv_ns for s in found], "out of order"
        assert len(found) <= len(seen)


def salvage(data: bytes) -> None:
    """Look for messages in the bytes of a chunk that does not end."""
    found = list(cut_chunk(BytesIO(data), 0))
    assert found == list(cut_chunk(BytesIO(data), 0))


def _named(measurement: Measurement) -> str:
    """Return a measurement in words; a picture by whether it can be seen."""
    if not isinstance(measurement, Frame):
        return repr(measurement)
    try:
        picture = str(measurement.picture.gray().shape)
    except MalformedInput:
        picture = "none"
    return f"{measurement.t_ns} {measurement.t_recv_ns} {measurement.frame_id} {picture}"


TARGETS: dict[str, Callable[[bytes], None]] = {
    "nmea": nmea,
    "sentences": sentences,
    "gpsd": gpsd,
    "message": message,
    "log": log,
    "container": container,
    "salvage": salvage,
}
