"""The rig's link: order, reconnection, refusal, control, and the frame message that it carries."""

import json
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from server.messages import ControlReply, ControlRequest
from server.push import RigLink, frame_message, pose_message
from server.web_server import WebServer
from server.wire import decode_frame, decode_pose, encode_frame
from tests.server.serving import bytes_of, rig, serving, text_of, token, until, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame
from tracker.errors import InputError, MissingSensor
from tracker.estimator import Pose
from tracker.measurements import Frame, Image
from tracker.rig import CameraModel, Rig


class Tiny:
    """A picture of which only the bytes matter."""

    def gray(self) -> Image:
        return np.zeros((480, 640), dtype=np.uint8)

    def jpeg(self) -> bytes:
        return TINY_JPEG


FRAME = Frame(1000, 1100, 7, Tiny())
RIG = Rig(camera=CameraModel(640, 480, 500.0, 500.0, 319.5, 239.5))
#: The rig at (2, 3, 1.7), facing north.
POSE = Pose(1000, (2.0, 3.0, 1.7), (0.5**0.5, 0.0, 0.0, 0.5**0.5), (0.0, 1.0, 0.0), np.eye(6), "P1R0", True)


def obey(request: ControlRequest) -> ControlReply:
    if request.action == "speed":
        raise InputError("The speed must be a number.")
    return ControlReply(request.request_id, ok=True, did_seek=request.action == "seek")


def test_frame_message_places_the_camera_on_the_body() -> None:
    T_body_cam = RIG.T_body_cam.copy()
    T_body_cam[:3, 3] = (0.1, 0.0, 0.0)
    data = frame_message(
        FRAME,
        POSE,
        replace(RIG, T_body_cam=T_body_cam),
        estimator="truth",
        position_s=1.5,
        t_sent_ns=5,
        quarter_turns=1,
    )
    meta, jpeg = decode_frame(data)
    assert jpeg == TINY_JPEG
    # Facing north: the lens is 0.1 m further north, looks north, and its right is east.
    np.testing.assert_allclose(meta.T_site_cam[:3, 3], (2.0, 3.1, 1.7), atol=1e-12)
    np.testing.assert_allclose(meta.T_site_cam[:3, 2], (0.0, 1.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(meta.T_site_cam[:3, 0], (1.0, 0.0, 0.0), atol=1e-12)
    assert (meta.frame_id, meta.is_truth, meta.pose_valid, meta.quarter_turns) == (7, True, True, 1)


def test_frame_message_without_a_pose_or_intrinsics() -> None:
    meta, _ = decode_frame(frame_message(FRAME, None, RIG, estimator="a", position_s=0.0, t_sent_ns=0))
    assert not meta.pose_valid
    assert not meta.heading_known
    with pytest.raises(MissingSensor, match="calibrate"):
        frame_message(FRAME, POSE, Rig(), estimator="a", position_s=0.0, t_sent_ns=0)


def test_pose_message() -> None:
    pose = decode_pose(pose_message(POSE, seq=3, estimator="gps-imu/cmm"))
    assert (pose.seq, pose.p_site_body_m, pose.variance) == (3, POSE.p_site_m, (1.0,) * 6)


def test_frames_state_and_controls_go_both_ways(tmp_path: Path) -> None:
    with serving(tmp_path) as server, RigLink(server.rig_url("walk"), token("rig", "walk"), obey) as link:
        link.send_state({"kind": "replay", "duration_s": 60.0})
        until(lambda: link.connected)
        with viewer(server) as watching:
            link.send_state({"estimator": "truth"})
            until(lambda: text_of(watching, "state")["session"]["estimator"] == "truth")
            link.send_frame(encode_frame(example_frame(9), TINY_JPEG))
            assert decode_frame(bytes_of(watching))[0].frame_id == 9
            watching.send(json.dumps({"type": "control", "request_id": "s", "action": "seek", "value": 2.5}))
            assert text_of(watching, "reply")["did_seek"] is True
            watching.send(json.dumps({"type": "control", "request_id": "v", "action": "speed", "value": "x"}))
            assert text_of(watching, "reply")["error"] == "The speed must be a number."


def test_a_link_survives_its_server_and_tells_the_new_one_everything(tmp_path: Path) -> None:
    before = set(threading.enumerate())
    with serving(tmp_path) as first:
        port, app = first.port, first.app
        link = RigLink(first.rig_url("walk"), token("rig", "walk"), obey)
        link.send_state({"log": "a.mcap"})
        until(lambda: link.connected)
    until(lambda: not link.connected)
    link.send_state({"estimator": "truth"})
    with WebServer(app, port=port) as second:
        until(lambda: link.connected)
        with viewer(second) as watching:
            if text_of(watching, "hello")["session"]["estimator"] != "truth":
                # the viewer came before what the link had still to tell
                until(lambda: text_of(watching, "state")["session"]["estimator"] == "truth")
        link.close()
        link.close()
    assert link.refused is None
    until(lambda: set(threading.enumerate()) <= before)


@pytest.mark.parametrize(("session", "shown"), [("walk", "wrong"), ("a%20b", token("rig", "walk"))])
def test_a_refused_link_gives_up(tmp_path: Path, session: str, shown: str) -> None:
    with serving(tmp_path) as server, RigLink(server.rig_url(session), shown, obey) as link:
        until(lambda: link.refused is not None)
        assert "check its token" in str(link.refused)


def test_a_replaced_link_does_not_fight_for_its_session(tmp_path: Path) -> None:
    with serving(tmp_path) as server, RigLink(server.rig_url("walk"), token("rig", "walk"), obey) as link:
        until(lambda: link.connected)
        with rig(server):
            until(lambda: link.refused is not None)


def test_a_link_without_a_server_closes_at_once() -> None:
    link = RigLink("ws://127.0.0.1:9/ws/rig/walk", token("rig", "walk"), obey)
    for i in range(1000):
        link.send_state({"duration_s": float(i)})
    link.close()
    assert not link.connected
