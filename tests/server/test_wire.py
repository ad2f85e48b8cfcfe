"""The wire format: golden bytes, round trips, and that hostile bytes raise one exception only."""

import dataclasses
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from server.errors import MalformedMessage
from server.wire import (
    FRAME_HEADER_BYTES,
    MAX_FRAME_BYTES,
    POSE_BYTES,
    FrameMeta,
    decode_frame,
    decode_pose,
    encode_frame,
    encode_pose,
    is_frame,
)
from tests.server.wire_examples import (
    TINY_JPEG,
    example_frame,
    example_pose,
    frame_of,
    golden_messages,
    pose_of,
)
from tracker.rig import CameraModel

FRAMES = [m for m in golden_messages() if m["fields"]["kind"] == "frame"]
POSES = [m for m in golden_messages() if m["fields"]["kind"] == "pose"]


def assert_frames_equal(got: FrameMeta, expected: FrameMeta) -> None:
    for field in dataclasses.fields(FrameMeta):
        a, b = getattr(got, field.name), getattr(expected, field.name)
        if isinstance(a, np.ndarray):
            np.testing.assert_array_equal(a, b, err_msg=field.name)
        elif isinstance(a, CameraModel):
            assert (a.width_px, a.height_px, tuple(a.distortion)) == (b.width_px, b.height_px, tuple(b.distortion))
            np.testing.assert_array_equal(a.K, b.K)
            assert a.distortion_model == b.distortion_model
        else:
            assert a == b, field.name


def test_golden_file_has_frames_and_poses() -> None:
    assert len(FRAMES) >= 2
    assert POSES


@pytest.mark.parametrize("message", FRAMES)
def test_golden_frames_both_ways(message: dict[str, Any]) -> None:
    meta, jpeg = frame_of(message["fields"])
    assert encode_frame(meta, jpeg).hex() == message["hex"]
    decoded, decoded_jpeg = decode_frame(bytes.fromhex(message["hex"]))
    assert decoded_jpeg == jpeg
    assert_frames_equal(decoded, meta)


@pytest.mark.parametrize("message", POSES)
def test_golden_poses_both_ways(message: dict[str, Any]) -> None:
    assert encode_pose(pose_of(message["fields"])).hex() == message["hex"]
    assert decode_pose(bytes.fromhex(message["hex"])) == pose_of(message["fields"])


def test_sizes_and_kinds() -> None:
    frame, pose = encode_frame(example_frame(), TINY_JPEG), encode_pose(example_pose())
    assert len(frame) == FRAME_HEADER_BYTES + len(TINY_JPEG)
    assert len(pose) == POSE_BYTES
    assert is_frame(frame)
    assert not is_frame(pose)


@pytest.mark.parametrize("model", ["plumb_bob", "rational_polynomial", "equidistant"])
def test_distortion_comes_back_padded_to_its_model(model: Any) -> None:
    meta = dataclasses.replace(
        example_frame(), camera=CameraModel(64, 48, 50.0, 50.0, 31.5, 23.5, model, (0.5, -0.25, 0.125, 0.0625))
    )
    decoded, _ = decode_frame(encode_frame(meta, TINY_JPEG))
    assert decoded.camera.distortion_model == model
    assert decoded.camera.distortion[:4] == (0.5, -0.25, 0.125, 0.0625)
    assert not any(decoded.camera.distortion[4:])


@pytest.mark.parametrize(
    "change",
    [
        {"T_site_cam": np.eye(3)},
        {"T_site_cam": np.diag([2.0, 2.0, 2.0, 1.0])},
        {"T_site_cam": np.full((4, 4), np.nan)},
        {"cov": np.full((6, 6), np.inf)},
        {"cov": np.full((6, 6), 1e300)},
        {"frame_id": -1},
        {"t_capture_ns": 2**63},
        {"motion_model": "P3R0"},
        {"estimator": "x" * 33},
        {"quarter_turns": 4},
        {"camera": CameraModel(0, 480, 500.0, 500.0, 0.0, 0.0)},
        {"camera": CameraModel(640, 480, 500.0, 500.0, 0.0, 0.0, "equidistant", (0.1,) * 5)},
    ],
)
def test_a_frame_that_does_not_fit_is_the_callers_mistake(change: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        encode_frame(dataclasses.replace(example_frame(), **change), TINY_JPEG)


@pytest.mark.parametrize("jpeg", [b"", b"PNG", TINY_JPEG + bytes(MAX_FRAME_BYTES)])
def test_what_is_no_jpeg_or_too_large_is_refused(jpeg: bytes) -> None:
    with pytest.raises(ValueError, match="JPEG"):
        encode_frame(example_frame(), jpeg)
    with pytest.raises(MalformedMessage):
        decode_frame(encode_frame(example_frame(), TINY_JPEG)[:FRAME_HEADER_BYTES] + jpeg)


@pytest.mark.parametrize("wxyz", [(1.0, 1.0, 0.0, 0.0), (float("nan"), 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)])
def test_a_pose_that_does_not_fit_is_the_callers_mistake(wxyz: Any) -> None:
    with pytest.raises(ValueError, match="pose 1"):
        encode_pose(dataclasses.replace(example_pose(), wxyz_site_body=wxyz))


@pytest.mark.parametrize(
    ("offset", "patch", "says"),
    [
        (0, b"AGF2", "version 1"),
        (4, b"\x00\x00", "version 1"),
        (6, b"\x10\x00", "flags"),
        (12, b"\xff", "pose of picture"),
        (23, b"\x80", "before zero"),
        (32, struct.pack("<d", float("nan")), "not finite"),
        (32, struct.pack("<d", 3.0), "rigid"),
        (32, struct.pack("<d", 1e300), "rigid"),
        (160, struct.pack("<f", float("inf")), "not finite"),
        (244, struct.pack("<f", -1.0), "focal"),
        (260, struct.pack("<f", 0.5), "coefficients"),
        (292, b"\0\0", "without pixels"),
        (296, b"\x04", "distortion"),
        (297, b"\x09", "motion model"),
        (298, b"\x04", "reserved"),
        (299, b"\x01", "reserved"),
        (300, b"\xff", "UTF-8"),
        (300, b"\x07", "printable"),
        (383, b"\x01", "reserved"),
    ],
)
def test_every_broken_field_of_a_frame_is_named(offset: int, patch: bytes, says: str) -> None:
    data = bytearray(encode_frame(example_frame(), TINY_JPEG))
    data[offset : offset + len(patch)] = patch
    with pytest.raises(MalformedMessage, match=says):
        decode_frame(bytes(data))


@settings(max_examples=200, deadline=None)
@given(data=st.binary(max_size=600))
def test_random_bytes_raise_only_malformed(data: bytes) -> None:
    for decode in (decode_frame, decode_pose):
        with pytest.raises(MalformedMessage):
            decode(data)


@settings(max_examples=300, deadline=None)
@given(
    golden=st.sampled_from(golden_messages()),
    patches=st.lists(st.tuples(st.integers(0, 399), st.binary(min_size=1, max_size=8)), min_size=1, max_size=3),
)
def test_patched_messages_are_refused_or_come_back_as_they_were(
    golden: dict[str, Any], patches: list[tuple[int, bytes]]
) -> None:
    data = bytearray(bytes.fromhex(golden["hex"]))
    for offset, patch in patches:
        data[offset : offset + len(patch)] = patch
    broken = bytes(data)
    try:
        if golden["fields"]["kind"] == "frame":
            assert encode_frame(*decode_frame(broken)) == broken
        else:
            assert encode_pose(decode_pose(broken)) == broken
    except MalformedMessage:
        pass
