"""A live rig as its viewers see it: pictures with poses, what is said of it, and what they may not ask for."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from websockets.sync.connection import Connection

from server.live_rig import LiveRig
from server.placing import Placing
from server.wire import FrameMeta, decode_frame, is_frame
from tests.server.serving import serving, text_of, token, until, viewer
from tests.walks import write_walk
from tracker.errors import MissingSensor, UnknownEstimator
from tracker.estimator import Origin
from tracker.evaluate import make_pipeline
from tracker.geometry import transform
from tracker.log import Log
from tracker.measurements import Matrix
from tracker.playback import Playback
from tracker.precise.memory import from_toml
from tracker.rig import CameraModel, Rig
from tracker.rig_memory import memory_place
from tracker.simulate import AGORA_ORIGIN
from tracker.sources.played import Played
from tracker.upright import Upright

PLACING = Placing(AGORA_ORIGIN, lambda e, n: 0.0, lambda e, n: 1.65, 1.65)
ELSEWHERE = Origin(-43.5, 172.6, 20.0)


@pytest.fixture(scope="module")
def wall(tmp_path_factory: pytest.TempPathFactory) -> Log:
    """A minute with pictures of 640 x 480."""
    return Log.open(write_walk(tmp_path_factory.mktemp("logs") / "wall.mcap", 60.0, pictures=True))


@contextmanager
def watching(
    log: Log,
    folder: Path,
    names: tuple[str, ...] = ("gps", "imu", "camera"),
    placing: Placing = PLACING,
    **options: Any,
) -> Iterator[Connection]:
    """Watch a rig on a server of its own."""
    played = Played(log)
    rig = LiveRig([played.source(name) for name in names], options.pop("rig", log.rig), placing, **options)
    with serving(folder) as server:
        rig.start(server.rig_url("walk"), token("rig", "walk"))
        try:
            until(lambda: rig.link is not None and rig.link.connected)
            with viewer(server) as connection:
                yield connection
        finally:
            rig.close()


def frame_where(connection: Connection, condition: Callable[[FrameMeta], bool]) -> FrameMeta:
    """Return the next frame of which something is true; all are acknowledged."""
    while True:
        message = connection.recv(10.0)
        if isinstance(message, bytes) and is_frame(message):
            meta, _ = decode_frame(message)
            connection.send(json.dumps({"type": "ack", "frame_id": meta.frame_id}))
            if condition(meta):
                return meta


def notice_of(connection: Connection, condition: Callable[[str | None], bool]) -> str | None:
    """Return the first notice of which something is true."""
    while True:
        notice: str | None = text_of(connection, "state")["session"]["notice"]
        if condition(notice):
            return notice


def test_pictures_come_with_poses_and_nothing_is_amiss(wall: Log, tmp_path: Path) -> None:
    with watching(wall, tmp_path) as connection:
        meta = frame_where(connection, lambda meta: meta.pose_valid)
        assert meta.estimator == "camera-gps-imu/precise"
        assert wall.rig.camera is not None
        assert meta.camera.fx_px == wall.rig.camera.fx_px
        session = text_of(connection, "state")["session"]
        assert (session["kind"], session["notice"], session["playback"]) == ("live", None, None)
        assert {name: one["trouble"] for name, one in session["health"].items()} == dict.fromkeys(
            ("gps", "imu", "camera"), False
        )


def test_a_replay_of_the_recording_shows_what_the_viewers_saw(wall: Log, tmp_path: Path) -> None:
    """Every picture with the same pose, to the last bit: through threads, a file, and the wire."""
    path, live = tmp_path / "live.mcap", list[FrameMeta]()
    with watching(wall, tmp_path, record=path) as connection:
        for _ in range(40):
            live.append(frame_where(connection, lambda meta: meta.pose_valid))
    log = Log.open(path)
    playback = Playback(
        log,
        log.info.t_start_ns,
        lambda name: make_pipeline(name, log, AGORA_ORIGIN, eyes_z_m=PLACING.eyes_z_m),
        Upright(log.rig),
    )
    playback.choose("camera-gps-imu/precise")
    again: dict[int, Matrix] = {}
    while playback.t_next_ns is not None:
        shown = playback.step()
        if shown is not None and (pose := shown.pose) is not None:
            again[shown.frame.t_ns] = transform(pose.wxyz_site_body, pose.p_site_m) @ log.rig.T_body_cam
    assert log.info.counts["motions"] > 20
    for meta in live:
        np.testing.assert_array_equal(again[meta.t_capture_ns], meta.T_site_cam)


def test_a_live_walk_cannot_be_paused(wall: Log, tmp_path: Path) -> None:
    with watching(wall, tmp_path) as connection:
        connection.send(json.dumps({"type": "control", "request_id": "p", "action": "pause"}))
        reply = text_of(connection, "reply")
        assert not reply["ok"]
        assert "live" in reply["error"]


def test_pictures_of_another_size_are_drawn_through_the_scaled_lens(wall: Log, tmp_path: Path) -> None:
    """And of another shape it is said that the square does not fit."""
    half = CameraModel(320, 240, 260.0, 260.0, 159.5, 119.5)
    with watching(wall, tmp_path, rig=replace(wall.rig, camera=half)) as connection:
        meta = frame_where(connection, lambda meta: True)
        assert (meta.camera.width_px, meta.camera.fx_px, meta.camera.cx_px) == (640, 520.0, 319.5)
    wide = CameraModel(1280, 720, 900.0, 900.0, 639.5, 359.5)
    with watching(wall, tmp_path, rig=replace(wall.rig, camera=wide)) as connection:
        assert "calibrate it anew" in str(notice_of(connection, lambda notice: notice is not None))


def test_a_camera_that_was_never_calibrated_is_guessed_and_said_so(wall: Log, tmp_path: Path) -> None:
    with watching(wall, tmp_path, rig=Rig()) as connection:
        meta = frame_where(connection, lambda meta: True)
        assert meta.estimator == "gps-imu/precise"
        assert meta.camera.fx_px == pytest.approx(0.87 * 640)
        assert "never calibrated" in str(notice_of(connection, lambda notice: notice is not None))


def test_without_a_camera_the_square_is_drawn_over_an_empty_picture(wall: Log, tmp_path: Path) -> None:
    with watching(wall, tmp_path, names=("gps", "imu")) as connection:
        meta = frame_where(connection, lambda meta: meta.pose_valid)
        assert (meta.camera.width_px, meta.camera.height_px) == (640, 480)
        assert "no camera" in str(notice_of(connection, lambda notice: notice is not None))


def test_elsewhere_the_walk_says_how_to_see_the_square(tmp_path: Path) -> None:
    log = Log.open(write_walk(tmp_path / "far.mcap", 20.0, origin=ELSEWHERE))
    with watching(log, tmp_path, names=("gps", "imu")) as connection:
        assert "--anchor here" in str(notice_of(connection, lambda notice: notice is not None and " km " in notice))
    with watching(log, tmp_path, ("gps", "imu"), replace(PLACING, anchor="here")) as connection:
        meta = frame_where(connection, lambda meta: meta.pose_valid)
        assert np.hypot(*meta.T_site_cam[:2, 3]) < 6.0
        assert meta.T_site_cam[2, 3] == pytest.approx(1.65, abs=0.2)


def test_what_no_estimator_can_do_is_refused_before_anything_starts(wall: Log) -> None:
    played = Played(wall)
    with pytest.raises(MissingSensor, match="no IMU"):
        LiveRig([played.source("gps")], wall.rig, PLACING)
    with pytest.raises(MissingSensor, match="no GPS"):
        LiveRig([played.source("imu")], wall.rig, PLACING, estimator="gps-imu/famm")
    with pytest.raises(UnknownEstimator):
        LiveRig([played.source("imu")], wall.rig, PLACING, estimator="nonsense")


def test_what_a_rig_has_learned_is_there_at_its_next_start_and_in_its_recording(wall: Log, tmp_path: Path) -> None:
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text("")
    memory = memory_place(rig_file)
    with watching(wall, tmp_path, record=tmp_path / "first.mcap", rig_file=rig_file) as connection:
        frame_where(connection, lambda meta: meta.pose_valid)
    assert memory.is_file()
    with watching(wall, tmp_path, record=tmp_path / "second.mcap", rig_file=rig_file) as connection:
        frame_where(connection, lambda meta: meta.pose_valid)
    first, second = (Log.open(tmp_path / f"{name}.mcap").metadata["agora"]["memory"] for name in ("first", "second"))
    assert first == ""
    kept = from_toml(second)
    assert kept.t_ns < Log.open(tmp_path / "second.mcap").info.t_start_ns, "by the clock of the second walk"


def ask(connection: Connection, action: str, value: object) -> dict[str, Any]:
    """Send a request and return its reply."""
    connection.send(json.dumps({"type": "control", "request_id": "x", "action": action, "value": value}))
    return text_of(connection, "reply")


def test_an_operator_sees_the_innovations_of_a_live_walk(wall: Log, tmp_path: Path) -> None:
    with watching(wall, tmp_path, estimator="camera-gps-imu/famm") as connection:
        frame_where(connection, lambda meta: meta.pose_valid)
        assert ask(connection, "figures", None)["ok"]
        updates: list[dict[str, Any]] = []
        while len(updates) < 8:
            updates += text_of(connection, "figures")["updates"]
        times_s = [update["t_s"] for update in updates]
        assert times_s == sorted(set(times_s)), "none is told twice"
        assert all(0.0 < update["position_m"] < 50.0 for update in updates)
        assert {update["motion_model"] for update in updates} <= {f"P{p}R{r}" for p in range(3) for r in range(3)}


def test_a_landmark_is_pointed_out_and_taken_back(wall: Log, tmp_path: Path) -> None:
    """In a picture that was shown; what is recorded holds both."""
    path = tmp_path / "aligned.mcap"
    with watching(wall, tmp_path, record=path) as connection:
        meta = frame_where(connection, lambda meta: meta.pose_valid)
        ahead = (meta.T_site_cam @ np.array([0.0, 0.0, 30.0, 1.0]))[:3].tolist()
        tap = {"kind": "tap", "frame_id": meta.frame_id, "place_px": [320, 240], "sigma_px": 4, "point_site_m": ahead}
        assert ask(connection, "align", tap)["ok"]
        assert ask(connection, "align", {"kind": "here", "e_m": 0.0, "n_m": 0.0, "sigma_m": 50.0})["ok"]
        assert ask(connection, "align", {"kind": "undo"})["ok"]
        assert ask(connection, "align", {"kind": "undo"})["ok"]
        nothing = ask(connection, "align", {"kind": "undo"})
        assert not nothing["ok"]
        assert "within a minute" in nothing["error"]
        never = ask(connection, "align", tap | {"frame_id": 4_000_000})
        assert "newer one" in never["error"]
        outside = ask(connection, "align", tap | {"place_px": [900, 240]})
        assert "outside the picture" in outside["error"]
        assert "live" in ask(connection, "pause", None)["error"]
    assert Log.open(path).info.counts["said"] == 5
