"""The binary messages, version 1: a frame with its pose, and a pose alone. Little endian, fixed offsets, pure.

`web/src/wire.ts` reads the same bytes; `tests/golden/wire.json` holds both to it. Quaternions travel as wxyz and change their
order nowhere in Python. The JSON messages are in `messages.py`.
"""

import math
import struct
from dataclasses import dataclass
from typing import Final

import numpy as np

from server.errors import MalformedMessage
from tracker.estimator import NO_MOTION_MODEL
from tracker.measurements import Matrix, Vector3, Wxyz
from tracker.rig import CameraModel, DistortionModel

VERSION: Final = 1
#: What both sides name in the WebSocket's handshake (Sec-WebSocket-Protocol) to agree on the version.
SUBPROTOCOL: Final = f"agora.v{VERSION}"
FRAME_HEADER_BYTES: Final = 384
POSE_BYTES: Final = 112
MAX_FRAME_BYTES: Final = 4 * 1024 * 1024
MOTION_MODELS: Final = tuple(f"P{i}R{j}" for i in range(3) for j in range(3))

_FRAME = struct.Struct("<4sHHIIqq16d21f4f8fHHBBBB32s3fd32s")
_POSE = struct.Struct("<4sHHIB3sq3d4f6f3f12s")
_FRAME_MAGIC = b"AGF1"
_POSE_MAGIC = b"AGP1"
_JPEG_START = b"\xff\xd8"
_POSE_VALID, _HEADING_KNOWN, _IS_TRUTH, _DID_SEEK = 1, 2, 4, 8
_ALL_FLAGS = 15
_NO_MOTION_CODE = 255
_UPPER = np.triu_indices(6)
_ROTATION_TOLERANCE = 1e-3
#: Code on the wire, and how many coefficients the model has.
_DISTORTION: Final[tuple[tuple[DistortionModel, int], ...]] = (
    ("plumb_bob", 0),
    ("plumb_bob", 5),
    ("rational_polynomial", 8),
    ("equidistant", 4),
)


@dataclass(frozen=True, eq=False, kw_only=True)
class FrameMeta:
    """Everything that travels with one picture. The pose is the pose of that picture's capture."""

    frame_id: int
    """Index of the picture in its log or on its rig, 0 <= frame_id < 2**32."""
    t_capture_ns: int
    t_sent_ns: int
    """The rig's monotonic clock when the message was built; tells latency and nothing else."""
    T_site_cam: Matrix
    """(4, 4); the identity where `pose_valid` is False."""
    cov: Matrix
    """(6, 6) symmetric: position in site (m²), then rotation vector in site (rad²)."""
    camera: CameraModel
    """Of the stored picture. No coefficients means no distortion."""
    motion_model: str
    """`P0R0` … `P2R2` or `-`."""
    estimator: str
    v_site_m_s: Vector3
    position_s: float
    """Seconds from the start of the log, or of the walk."""
    quarter_turns: int = 0
    """Clockwise 90° turns that make the stored picture upright, 0..3."""
    pose_valid: bool = True
    heading_known: bool = True
    is_truth: bool = False
    did_seek: bool = False
    """A seek happened just before this picture."""


@dataclass(frozen=True, kw_only=True)
class PoseUpdate:
    """The newest estimate, for those who show no picture."""

    seq: int
    t_ns: int
    p_site_body_m: Vector3
    wxyz_site_body: Wxyz
    variance: tuple[float, float, float, float, float, float]
    """Diagonal of the covariance: m², then rad²."""
    v_site_m_s: Vector3
    motion_model: str
    pose_valid: bool = True
    heading_known: bool = True
    is_truth: bool = False
    did_seek: bool = False


def encode_frame(meta: FrameMeta, jpeg: bytes) -> bytes:
    """Return the frame message: 384 bytes of header, then the JPEG as it is.

    Raises:
        ValueError: A shape, range or number that the format cannot carry (the caller's mistake), or no JPEG.
    """
    camera = meta.camera
    if meta.T_site_cam.shape != (4, 4) or meta.cov.shape != (6, 6):
        raise ValueError(f"expected T_site_cam (4, 4) and cov (6, 6), got {meta.T_site_cam.shape} and {meta.cov.shape}")
    if not jpeg.startswith(_JPEG_START) or FRAME_HEADER_BYTES + len(jpeg) > MAX_FRAME_BYTES:
        raise ValueError(
            f"expected a JPEG of at most {MAX_FRAME_BYTES - FRAME_HEADER_BYTES} bytes, got {len(jpeg)} bytes"
        )
    code, coefficients = _distortion_code(camera)
    try:
        header = _FRAME.pack(
            *(_FRAME_MAGIC, FRAME_HEADER_BYTES, _flags(meta), meta.frame_id, meta.frame_id),
            *(meta.t_capture_ns, meta.t_sent_ns, *meta.T_site_cam.ravel().tolist(), *meta.cov[_UPPER].tolist()),
            *(camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, *coefficients, camera.width_px, camera.height_px),
            *(code, _motion_code(meta.motion_model), meta.quarter_turns, 0, _name_bytes(meta.estimator)),
            *(*meta.v_site_m_s, meta.position_s, b""),
        )
        _decode_header(header)
    except (struct.error, OverflowError, MalformedMessage) as exc:
        raise ValueError(f"frame {meta.frame_id} does not fit the wire format: {exc}") from exc
    return header + jpeg


def decode_frame(data: bytes) -> tuple[FrameMeta, bytes]:
    """Return what `encode_frame` was given. What decodes encodes to the same bytes.

    Raises:
        MalformedMessage: Any byte that version 1 does not allow.
    """
    if len(data) < FRAME_HEADER_BYTES + len(_JPEG_START):
        raise MalformedMessage(f"expected a frame message of more than {FRAME_HEADER_BYTES} bytes, got {len(data)}")
    if len(data) > MAX_FRAME_BYTES:
        raise MalformedMessage(f"expected a frame message of at most {MAX_FRAME_BYTES} bytes, got {len(data)}")
    jpeg = data[FRAME_HEADER_BYTES:]
    _require(jpeg.startswith(_JPEG_START), "the picture is no JPEG")
    return _decode_header(data), jpeg


def _decode_header(data: bytes) -> FrameMeta:
    fields = _FRAME.unpack_from(data)
    magic, header_bytes, flags, frame_id, pose_frame_id, t_capture_ns, t_sent_ns = fields[:7]
    _require(magic == _FRAME_MAGIC and header_bytes == FRAME_HEADER_BYTES, "no frame message of version 1")
    _require(flags & ~_ALL_FLAGS == 0, f"unknown flags {flags:#x}")
    _require(pose_frame_id == frame_id, f"picture {frame_id} with the pose of picture {pose_frame_id}")
    _require(t_capture_ns >= 0 and t_sent_ns >= 0, "a time before zero")
    quarter_turns, reserved, name, tail = fields[60], fields[61], fields[62], fields[67]
    _require(quarter_turns <= 3 and reserved == 0 and not any(tail), "reserved bytes in use")
    _require_finite((*fields[7:56], *fields[63:67]))
    T_site_cam = np.array(fields[7:23]).reshape(4, 4)
    _require(_is_rigid(T_site_cam), "T_site_cam is no rigid motion")
    return FrameMeta(
        frame_id=frame_id,
        t_capture_ns=t_capture_ns,
        t_sent_ns=t_sent_ns,
        T_site_cam=T_site_cam,
        cov=_symmetric(fields[23:44]),
        camera=_camera(fields[44:48], fields[48:56], fields[56], fields[57], fields[58]),
        motion_model=_motion_model(fields[59]),
        estimator=_name(name),
        v_site_m_s=fields[63:66],
        position_s=fields[66],
        quarter_turns=quarter_turns,
        **_flag_fields(flags),
    )


def encode_pose(pose: PoseUpdate) -> bytes:
    """Return the pose message, 112 bytes.

    Raises:
        ValueError: A number that the format cannot carry (the caller's mistake).
    """
    numbers = (*pose.p_site_body_m, *pose.wxyz_site_body, *pose.variance, *pose.v_site_m_s)
    try:
        data = _POSE.pack(
            *(_POSE_MAGIC, POSE_BYTES, _flags(pose), pose.seq, _motion_code(pose.motion_model), b"", pose.t_ns),
            *(*numbers, b""),
        )
        decode_pose(data)
    except (struct.error, OverflowError, MalformedMessage) as exc:
        raise ValueError(f"pose {pose.seq} does not fit the wire format: {exc}") from exc
    return data


def decode_pose(data: bytes) -> PoseUpdate:
    """Return what `encode_pose` was given. What decodes encodes to the same bytes.

    Raises:
        MalformedMessage: Any byte that version 1 does not allow.
    """
    _require(len(data) == POSE_BYTES, f"expected a pose message of {POSE_BYTES} bytes, got {len(data)}")
    magic, size, flags, seq, motion, pad, t_ns, *numbers, tail = _POSE.unpack(data)
    _require(magic == _POSE_MAGIC and size == POSE_BYTES, "no pose message of version 1")
    _require(flags & ~_ALL_FLAGS == 0, f"unknown flags {flags:#x}")
    _require(not any(pad) and not any(tail), "reserved bytes in use")
    _require(t_ns >= 0, "a time before zero")
    _require_finite(numbers)
    w, x, y, z = numbers[3:7]
    _require(abs(math.hypot(w, x, y, z) - 1.0) < _ROTATION_TOLERANCE, "the quaternion is not of length one")
    return PoseUpdate(
        seq=seq,
        t_ns=t_ns,
        p_site_body_m=(numbers[0], numbers[1], numbers[2]),
        wxyz_site_body=(w, x, y, z),
        variance=(numbers[7], numbers[8], numbers[9], numbers[10], numbers[11], numbers[12]),
        v_site_m_s=(numbers[13], numbers[14], numbers[15]),
        motion_model=_motion_model(motion),
        **_flag_fields(flags),
    )


def is_frame(data: bytes) -> bool:
    """Whether a binary message claims to be a frame (else it must be a pose)."""
    return data.startswith(_FRAME_MAGIC)


def _require(holds: bool, what: str) -> None:
    if not holds:
        raise MalformedMessage(what)


def _require_finite(numbers: tuple[float, ...] | list[float]) -> None:
    _require(all(map(math.isfinite, numbers)), "a number that is not finite")


def _is_rigid(T: Matrix) -> bool:
    # Entries past any site on Earth would overflow the products below.
    if np.abs(T).max() > 1e9 or T[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
        return False
    R = T[:3, :3]
    return bool(np.abs(R @ R.T - np.eye(3)).max() < _ROTATION_TOLERANCE and np.linalg.det(R) > 0.0)


def _symmetric(upper: tuple[float, ...]) -> Matrix:
    cov = np.zeros((6, 6))
    cov[_UPPER] = upper
    cov.T[_UPPER] = upper
    return cov


def _flags(message: FrameMeta | PoseUpdate) -> int:
    return (
        _POSE_VALID * message.pose_valid
        | _HEADING_KNOWN * message.heading_known
        | _IS_TRUTH * message.is_truth
        | _DID_SEEK * message.did_seek
    )


def _flag_fields(flags: int) -> dict[str, bool]:
    return {
        "pose_valid": bool(flags & _POSE_VALID),
        "heading_known": bool(flags & _HEADING_KNOWN),
        "is_truth": bool(flags & _IS_TRUTH),
        "did_seek": bool(flags & _DID_SEEK),
    }


def _motion_code(motion_model: str) -> int:
    return _NO_MOTION_CODE if motion_model == NO_MOTION_MODEL else MOTION_MODELS.index(motion_model)


def _motion_model(code: int) -> str:
    if code == _NO_MOTION_CODE:
        return NO_MOTION_MODEL
    _require(code < len(MOTION_MODELS), f"unknown motion model {code}")
    return MOTION_MODELS[code]


def _distortion_code(camera: CameraModel) -> tuple[int, tuple[float, ...]]:
    given = tuple(camera.distortion)
    code = next(i for i, (model, n) in enumerate(_DISTORTION) if not given or (n and model == camera.distortion_model))
    if len(given) > _DISTORTION[code][1]:
        raise ValueError(f"{camera.distortion_model} has {_DISTORTION[code][1]} coefficients, got {len(given)}")
    return code, given + (0.0,) * (8 - len(given))


def _camera(
    intrinsics_px: tuple[float, float, float, float],
    coefficients: tuple[float, ...],
    width_px: int,
    height_px: int,
    distortion_code: int,
) -> CameraModel:
    _require(distortion_code < len(_DISTORTION), f"unknown distortion model {distortion_code}")
    _require(width_px > 0 and height_px > 0, "a picture without pixels")
    _require(intrinsics_px[0] > 0.0 and intrinsics_px[1] > 0.0, "a focal length that is not positive")
    model, n = _DISTORTION[distortion_code]
    # Compared as bytes: a minus zero would not come back as it was.
    _require(not any(struct.pack("<8f", *coefficients)[4 * n :]), "more distortion coefficients than the model has")
    return CameraModel(width_px, height_px, *intrinsics_px, model, coefficients[:n])


def _name_bytes(name: str) -> bytes:
    encoded = name.encode()
    if len(encoded) > 32 or not name.isprintable():
        raise ValueError(f"an estimator's name is at most 32 printable bytes, got {name!r}")
    return encoded


def _name(padded: bytes) -> str:
    encoded = padded.rstrip(b"\0")
    try:
        name = encoded.decode()
    except UnicodeDecodeError as exc:
        raise MalformedMessage("the estimator's name is no UTF-8") from exc
    _require(name.isprintable(), "the estimator's name is not printable")
    return name


def keep_seek(replaced: bytes | None, frame: bytes) -> bytes:
    """Return `frame`, marked as coming after a seek where the frame that it replaces, never sent, was so marked."""
    if replaced is None or not replaced[6] & _DID_SEEK or frame[6] & _DID_SEEK:
        return frame
    return frame[:6] + bytes((frame[6] | _DID_SEEK,)) + frame[7:]
