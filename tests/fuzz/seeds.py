"""Small inputs of our own making, from which the fuzzer sets out."""

import struct
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType, Writer

from tests.fuzz.targets import ROS_TYPES
from tests.tracker.sources.receivers import MS, STYLES, Moment, burst, sentence
from tracker.container import Container, Stored
from tracker.estimator import Origin
from tracker.log_writer import LogWriter
from tracker.measurements import (
    CompassHeading,
    Frame,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    TruePose,
    VisualMotion,
)
from tracker.pictures import ArrayPicture
from tracker.rig import CameraModel, Rig

_T_NS = 1_000_000_000_000
_CAMERA = CameraModel(32, 24, 30.0, 30.0, 15.5, 11.5, "plumb_bob", (-0.1, 0.01, 0.0, 0.0, 0.0))
_GPSD = b"""{"class":"VERSION","release":"3.25","proto_major":3,"proto_minor":15}\r
{"class":"DEVICES","devices":[{"class":"DEVICE","path":"/dev/ttyACM0","native":0,"driver":"u-blox"}]}\r
{"class":"SKY","hdop":0.9,"uSat":11}\r
{"class":"TPV","mode":3,"status":2,"time":"2026-08-28T12:00:59.950Z","lat":37.9,"lon":-27.3,"altHAE":86.5,\
"geoidSep":29.0,"eph":1.5,"epv":2.5,"speed":1.4,"track":90.0}\r
{"class":"DEVICE","path":"/dev/ttyUSB0","activated":0}\r
"""


def seeds(target: str) -> list[bytes]:
    """Return the inputs of a target."""
    match target:
        case "nmea":
            return [*(burst(style, Moment(5.0)) for style in STYLES), *_odd_sentences()]
        case "sentences":
            return [b"\n".join(line[1:-3] for line in seed.splitlines()) for seed in seeds("nmea")]
        case "gpsd":
            return [
                _GPSD + burst("SiRF", Moment(5.0)),
                _GPSD.replace(b'"native":0', b'"native":1') + burst("u-blox", Moment(5.0)),
            ]
        case "salvage":
            return [_first_chunk(walk)[: len(walk) * share // 4] for walk in _walks("jpeg")[1:3] for share in (1, 3)]
        case "message":
            return [bytes([ROS_TYPES.index(s.ros_type)]) + s.data for s in _stored("jpeg")]
        case _:
            return [*_walks("jpeg"), *_walks("h264")[:1]]


def _odd_sentences() -> list[bytes]:
    moment = Moment(86_399.99, quality=5, separation_m=None, h_msl_m=None, heading_deg=None)
    return [
        moment.gga() + moment.rmc() + Moment(86_400.5).gga(),
        sentence("GPGGA,,,,,,0,,,,,,,,") + sentence("GPRMC,,V,,,,,,,,,,N"),
        sentence("PUBX,00,1") + b"\xb5\x62\x01$GPGGA*00\r\n$$$\r\n",
    ]


def _write(path: Path, video: Any) -> None:
    rng, cov = np.random.default_rng(1), (4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0)
    eye = np.eye(3)
    with LogWriter(path, Rig(camera=_CAMERA), Origin(37.9, 27.3, 80.0), t_start_ns=_T_NS, video=video) as writer:
        for number in range(4):
            t_ns = _T_NS + number * 250 * MS
            picture = ArrayPicture(rng.integers(0, 255, (24, 32, 3), np.uint8))
            writer.write(ImuSample(t_ns, t_ns, (0.1, 0.2, 0.3), (0.0, 0.1, 9.81)))
            writer.write(MagSample(t_ns, t_ns, (2e-5, 0.0, -4e-5)))
            writer.write(CompassHeading(t_ns, t_ns, 1.0))
            writer.write(GpsFix(t_ns, t_ns + MS, 37.9, 27.3, 90.0, cov))
            writer.write(GpsVelocity(t_ns, t_ns + MS, (1.0, 0.5, 0.0)))
            writer.write(Frame(t_ns, t_ns + 2 * MS, number, picture))
            writer.write(VisualMotion(t_ns, t_ns + 2 * MS, number, t_ns, eye, (1.0, 0.0, 0.0), 50, 3.0, False))
            pose = ((0.0, 1.0, 2.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
            writer.write(TruePose(t_ns, t_ns, *pose, True, True, True, True, 0.1))
            if video == "jpeg":
                for line in burst("RTK", Moment(float(number))).splitlines():
                    writer.write_sentence(t_ns + 3 * MS, line.decode())


def _stored(video: str) -> list[Stored]:
    """Return one message of each topic."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.mcap"
        _write(path, video)
        seen: dict[str, Stored] = {}
        Container(path, lambda stored: seen.update({stored.topic: stored}))
    return list(seen.values())


def _walks(video: str) -> list[bytes]:
    """Return a walk as our writer leaves it, and rewritten without compression, checksums and chunks: bytes that mutate deeply."""
    with tempfile.TemporaryDirectory() as folder:
        whole, plain, loose = (Path(folder) / name for name in ("whole.mcap", "plain.mcap", "loose.mcap"))
        _write(whole, video)
        found: list[Stored] = []
        Container(whole, found.append)
        _rewrite(plain, found, use_chunking=True)
        _rewrite(loose, found, use_chunking=False)
        cut = whole.read_bytes()
        return [loose.read_bytes(), plain.read_bytes(), cut, cut[: len(cut) * 2 // 3]]


def _first_chunk(walk: bytes) -> bytes:
    """Return what follows the magic and the header, which are as long as the header says."""
    (length,) = struct.unpack_from("<Q", walk, 9)
    return walk[8 + 9 + length :]


def _rewrite(path: Path, messages: list[Stored], *, use_chunking: bool) -> None:
    with path.open("wb") as file:
        writer: Any = Writer(
            file,
            compression=CompressionType.NONE,
            use_chunking=use_chunking,
            enable_crcs=False,
            enable_data_crcs=False,
            use_statistics=False,
            use_summary_offsets=False,
        )
        writer.start()
        channels: dict[str, int] = {}
        for stored in messages:
            if stored.topic not in channels:
                schema = writer.register_schema(stored.ros_type, "ros2msg", b"")
                channels[stored.topic] = writer.register_channel(stored.topic, "cdr", schema)
            writer.add_message(channels[stored.topic], stored.t_recv_ns, stored.data, stored.t_recv_ns)
        writer.finish()
