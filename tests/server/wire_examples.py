"""Messages of the wire format, between the fields of `tests/golden/wire.json` and the classes of `server.wire`."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from server.wire import FrameMeta, PoseUpdate
from tracker.rig import CameraModel

GOLDEN_PATH = Path(__file__).parents[1] / "golden" / "wire.json"
TINY_JPEG = b"\xff\xd8\xff\xd9"
_FLAGS = ("pose_valid", "heading_known", "is_truth", "did_seek")


def golden_messages() -> list[dict[str, Any]]:
    """Return the entries of the golden file: `hex` and `fields`."""
    messages: list[dict[str, Any]] = json.loads(GOLDEN_PATH.read_text())["messages"]
    return messages


def flag_fields(bits: int) -> dict[str, bool]:
    """Return the four flags by name."""
    return {name: bool(bits >> i & 1) for i, name in enumerate(_FLAGS)}


def frame_of(fields: dict[str, Any]) -> tuple[FrameMeta, bytes]:
    """Return the frame that golden fields describe (64-bit integers are decimal strings there, for JavaScript)."""
    fx_px, fy_px, cx_px, cy_px = fields["intrinsics"]
    size_px = (fields["width"], fields["height"])
    cov = np.zeros((6, 6))
    cov[np.triu_indices(6)] = fields["cov_upper"]
    meta = FrameMeta(
        frame_id=fields["frame_id"],
        t_capture_ns=int(fields["t_capture_ns"]),
        t_sent_ns=int(fields["t_sent_ns"]),
        T_site_cam=np.array(fields["T_site_cam"]).reshape(4, 4),
        cov=cov + np.triu(cov, 1).T,
        camera=CameraModel(*size_px, fx_px, fy_px, cx_px, cy_px, fields["distortion_model"], fields["distortion"]),
        motion_model=fields["motion_model"],
        estimator=fields["estimator"],
        v_site_m_s=tuple(fields["velocity"]),
        position_s=fields["position_s"],
        quarter_turns=fields["quarter_turns"],
        **flag_fields(fields["flags"]),
    )
    return meta, bytes.fromhex(fields["jpeg_hex"])


def pose_of(fields: dict[str, Any]) -> PoseUpdate:
    """Return the pose that golden fields describe."""
    return PoseUpdate(
        seq=fields["seq"],
        t_ns=int(fields["t_ns"]),
        p_site_body_m=tuple(fields["p_site_body"]),
        wxyz_site_body=tuple(fields["wxyz_site_body"]),
        variance=tuple(fields["variance"]),
        v_site_m_s=tuple(fields["velocity"]),
        motion_model=fields["motion_model"],
        **flag_fields(fields["flags"]),
    )


def example_frame(frame_id: int = 7, *, position_s: float = 1.5, did_seek: bool = False) -> FrameMeta:
    """Return a plain frame: the camera at (2, 3, 1.7) in site, looking north."""
    return FrameMeta(
        frame_id=frame_id,
        t_capture_ns=1_000_000_000 + frame_id,
        t_sent_ns=5,
        # Right is east, down is down, forward is north.
        T_site_cam=np.array([[1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 1.0, 3.0], [0.0, -1.0, 0.0, 1.7], [0.0, 0.0, 0.0, 1.0]]),
        cov=np.diag([0.25, 0.25, 1.0, 0.01, 0.01, 0.04]),
        camera=CameraModel(640, 480, 500.0, 500.0, 319.5, 239.5),
        motion_model="P1R0",
        estimator="gps-imu/famm",
        v_site_m_s=(0.0, 1.5, 0.0),
        position_s=position_s,
        did_seek=did_seek,
    )


def example_pose(seq: int = 1) -> PoseUpdate:
    """Return a plain pose: the rig at (2, 3, 1.7) in site, facing east."""
    return PoseUpdate(
        seq=seq,
        t_ns=1_000_000_000 + seq,
        p_site_body_m=(2.0, 3.0, 1.7),
        wxyz_site_body=(1.0, 0.0, 0.0, 0.0),
        variance=(0.25, 0.25, 1.0, 0.01, 0.01, 0.04),
        v_site_m_s=(1.5, 0.0, 0.0),
        motion_model="P1R0",
    )
