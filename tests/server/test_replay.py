"""A log shown: what viewers get of it, what they may ask for, and that nothing is left behind."""

import json
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from websockets.sync.connection import Connection

from assets.site import load_site
from assets.terrain import build_terrain
from server.cli import SITE
from server.replay import Replay, ReplaySettings
from server.sessions import session_name
from server.showing import Showing
from server.wire import MOTION_MODELS, FrameMeta, decode_frame, is_frame
from tests.server.serving import HELD_S, until, viewer
from tests.walks import write_walk
from tracker.errors import MissingSensor, UnknownEstimator
from tracker.estimator import Origin
from tracker.estimators import ESTIMATORS
from tracker.log import Log
from tracker.measurements import Frame
from tracker.simulate import AGORA_ORIGIN

ELSEWHERE = Origin(-43.5, 172.6, 20.0)
EYES_M = 1.65


@pytest.fixture(scope="module")
def wall(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Eight seconds with pictures."""
    return write_walk(tmp_path_factory.mktemp("logs") / "wall.mcap", 8.0, pictures=True)


@pytest.fixture(scope="module")
def dark(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six seconds without."""
    return write_walk(tmp_path_factory.mktemp("logs") / "dark.mcap", 6.0)


class Watcher:
    """A viewer that acknowledges every frame and keeps what it was told."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._asked = 0
        self._unseen: deque[FrameMeta] = deque()
        self.session: dict[str, Any] = {}
        self._replies: dict[str, dict[str, Any]] = {}
        self.figures: list[dict[str, Any]] = []

    def frames(self, count: int = 10_000) -> Iterator[FrameMeta]:
        """Yield the next frames, those first that came while a reply was waited for."""
        for _ in range(count):
            while not self._unseen:
                self._receive()
            yield self._unseen.popleft()

    def ask(self, action: str, value: object = None) -> dict[str, Any]:
        """Send a request and return its reply."""
        self._asked += 1
        key = str(self._asked)
        self._unseen.clear()
        self._connection.send(json.dumps({"type": "control", "request_id": key, "action": action, "value": value}))
        while key not in self._replies:
            self._receive()
        return self._replies[key]

    def frame_where(self, condition: Callable[[FrameMeta], bool]) -> FrameMeta:
        """Return the next frame of which something is true."""
        return next(meta for meta in self.frames() if condition(meta))

    def _receive(self) -> None:
        message = self._connection.recv(HELD_S)
        if isinstance(message, bytes):
            if is_frame(message):
                meta, _ = decode_frame(message)
                self._connection.send(json.dumps({"type": "ack", "frame_id": meta.frame_id}))
                self._unseen.append(meta)
            return
        heard = json.loads(message)
        if heard["type"] == "reply":
            self._replies[heard["request_id"]] = heard
        elif heard["type"] == "figures":
            self.figures.append(heard)
        elif heard["type"] != "company":
            self.session = heard["session"]


@contextmanager
def watching(path: Path, settings: ReplaySettings, folder: Path) -> Iterator[Watcher]:
    """Show a log on a server of its own, and watch it."""
    site = replace(load_site(SITE), folder=folder)
    with Showing(site, Log.open(path), settings, port=0, web=folder) as shown:
        until(lambda: httpx.get(f"{shown.url}api/sessions").json()["sessions"])
        with viewer(shown, session_name(path.stem)) as connection:
            yield Watcher(connection)


def replay_of(path: Path, settings: ReplaySettings) -> Replay:
    return Replay(
        Log.open(path),
        settings,
        site_origin=AGORA_ORIGIN,
        ground_z_m=lambda e, n: 0.25,
        eyes_z_m=lambda e, n: 0.25 + EYES_M,
        eye_height_m=EYES_M,
    )


def test_every_frame_carries_the_pose_of_its_own_picture(wall: Path, tmp_path: Path) -> None:
    settings = ReplaySettings(estimator="gps-imu/famm", looping=True)
    with watching(wall, settings, tmp_path) as watcher:
        posed = [meta for meta in watcher.frames(60) if meta.pose_valid]
        stamps = {frame.frame_id: frame.t_ns for frame in Log.open(wall).messages() if isinstance(frame, Frame)}
        assert len(posed) > 30
        assert all(meta.t_capture_ns == stamps[meta.frame_id] for meta in posed)
        assert {meta.estimator for meta in posed} == {"gps-imu/famm"}
        assert watcher.session["log"] == "wall"
        assert watcher.session["estimators"] == list(ESTIMATORS)
        assert watcher.session["unavailable"] == {}
        assert watcher.session["notice"] is None


def test_a_viewer_pauses_seeks_and_changes_the_estimator(wall: Path, tmp_path: Path) -> None:
    with watching(wall, ReplaySettings(), tmp_path) as watcher:
        first = watcher.frame_where(lambda meta: meta.pose_valid)
        assert first.estimator == "camera-gps-imu/precise"
        assert watcher.ask("pause")["ok"]
        assert watcher.session["playback"]["playing"] is False
        reply = watcher.ask("seek", 6.0)
        assert (reply["ok"], reply["did_seek"]) == (True, True)
        found = watcher.frame_where(lambda meta: meta.did_seek)
        assert found.position_s == pytest.approx(6.0, abs=0.1)
        reply = watcher.ask("estimator", "truth")
        assert reply["ok"]
        again = watcher.frame_where(lambda meta: meta.estimator == "truth")
        assert again.is_truth
        assert again.frame_id == found.frame_id
        assert watcher.ask("speed", 4.0)["ok"]
        assert watcher.ask("play")["ok"]
        later = watcher.frame_where(lambda meta: meta.frame_id > again.frame_id)
        assert later.estimator == "truth"
        assert watcher.session["playback"]["speed"] == 4.0


def test_an_operator_changes_a_setting_and_takes_it_back(wall: Path, tmp_path: Path) -> None:
    with watching(wall, ReplaySettings(estimator="gps-imu/precise"), tmp_path) as watcher:
        watcher.ask("pause")
        watcher.ask("seek", 6.0)
        usual = watcher.frame_where(lambda meta: meta.pose_valid)
        assert watcher.ask("settings", "precise.gps_floor_m=25.0")["ok"]
        other = watcher.frame_where(lambda meta: meta.pose_valid)
        assert "precise.gps_floor_m=25.0" in watcher.session["notice"]
        assert other.frame_id == usual.frame_id
        assert np.trace(other.cov[:2, :2]) > 4.0 * np.trace(usual.cov[:2, :2])
        assert watcher.ask("settings", "")["ok"]
        again = watcher.frame_where(lambda meta: meta.pose_valid)
        assert watcher.session["notice"] is None
        np.testing.assert_array_equal(again.T_site_cam, usual.T_site_cam)


def test_an_operator_sees_the_filter_at_work(wall: Path, tmp_path: Path) -> None:
    with watching(wall, ReplaySettings(estimator="gps-imu/famm", looping=True), tmp_path) as watcher:
        assert watcher.ask("figures")["ok"]
        while not any(told["updates"] for told in watcher.figures):
            next(watcher.frames())
        assert watcher.figures[0]["anew"]
        update = next(told for told in watcher.figures if told["updates"])["updates"][0]
        assert 0.0 <= update["t_s"] < 10.0
        assert update["motion_model"] in MOTION_MODELS
        assert update["position_m"] < 30.0


def test_nothing_is_left_behind(wall: Path, tmp_path: Path) -> None:
    before = set(threading.enumerate())
    with watching(wall, ReplaySettings(), tmp_path) as watcher:
        list(watcher.frames(3))
    until(lambda: set(threading.enumerate()) <= before)


def test_an_estimator_that_cannot_run_is_refused_before_anything_starts(dark: Path) -> None:
    before = threading.active_count()
    with pytest.raises(MissingSensor, match="no camera"):
        replay_of(dark, ReplaySettings(estimator="camera-gps-imu/famm"))
    with pytest.raises(UnknownEstimator):
        replay_of(dark, ReplaySettings(estimator="nonsense"))
    assert threading.active_count() == before


@pytest.fixture(scope="module")
def watched_dark(dark: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Watcher]:
    """The six seconds without pictures, again and again."""
    with watching(dark, ReplaySettings(looping=True), tmp_path_factory.mktemp("dark")) as watcher:
        yield watcher


@pytest.mark.parametrize(
    ("action", "value", "word"),
    [
        ("settings", "nonsense=1", "no setting"),
        ("settings", "gps_floor_m", "no value"),
        ("settings", "gps_floor_m=-1", "gps_floor_m"),
        ("settings", 7.0, "KEY=VALUE"),
        ("estimator", "nonsense", "gps-imu/famm"),
        ("estimator", "camera-gps-imu/famm", "no camera"),
        ("seek", -1.0, "position"),
        ("seek", 1e6, "position"),
        ("speed", 0.0, "speed"),
        ("speed", "fast", "speed"),
    ],
)
def test_a_request_that_makes_no_sense_gets_a_sentence_and_changes_nothing(
    watched_dark: Watcher, action: str, value: object, word: str
) -> None:
    watched_dark.frame_where(lambda meta: meta.pose_valid)
    reply = watched_dark.ask(action, value)
    assert not reply["ok"]
    assert word in reply["error"]
    after = watched_dark.frame_where(lambda meta: meta.pose_valid)
    assert after.estimator == "gps-imu/precise"
    assert watched_dark.session["playback"]["speed"] == 1.0


def test_a_walk_without_camera_is_shown_over_empty_pictures(watched_dark: Watcher) -> None:
    meta = watched_dark.frame_where(lambda meta: meta.pose_valid)
    assert (meta.camera.width_px, meta.camera.height_px) == (640, 480)
    assert "no camera" in watched_dark.session["notice"]
    assert set(watched_dark.session["unavailable"]) == {name for name in ESTIMATORS if name.startswith("camera")}


def test_the_log_itself_can_be_had(dark: Path, tmp_path: Path) -> None:
    site = replace(load_site(SITE), folder=tmp_path)
    with Showing(site, Log.open(dark), ReplaySettings(), port=0, web=tmp_path) as shown:
        assert httpx.get(f"{shown.url}api/logs").json() == {"logs": [{"name": "dark", "bytes": dark.stat().st_size}]}
        assert httpx.get(f"{shown.url}api/logs/dark").content == dark.read_bytes()
        assert httpx.get(f"{shown.url}api/logs/..%2Fwall").status_code == 404


def test_a_walk_from_elsewhere_says_how_to_see_it(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "christchurch.mcap", 3.0, origin=ELSEWHERE)
    with watching(path, ReplaySettings(looping=True), tmp_path) as watcher:
        next(watcher.frames())
        assert "--anchor here" in watcher.session["notice"]


def test_anchored_here_the_walk_begins_at_the_origin_with_its_feet_on_the_ground(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "christchurch.mcap", 6.0, origin=ELSEWHERE)
    with watching(path, ReplaySettings(anchor="here", looping=True), tmp_path) as watcher:
        first = watcher.frame_where(lambda meta: meta.pose_valid)
        assert np.hypot(*first.T_site_cam[:2, 3]) < 6.0
        ground_z_m = build_terrain(load_site(SITE)).ground_z_m
        height_m = first.T_site_cam[2, 3] - ground_z_m(*first.T_site_cam[:2, 3])
        assert height_m == pytest.approx(EYES_M, abs=0.1)
        assert "camera" in watcher.session["notice"]


def test_anchored_here_the_truth_too_begins_one_eye_height_above_the_paving(tmp_path: Path) -> None:
    """A receiver's first height is off by metres; the walk's own ups and downs stay."""
    path = write_walk(tmp_path / "christchurch.mcap", 6.0, origin=ELSEWHERE)
    settings = ReplaySettings(estimator="truth", anchor="here", height="gps", looping=True)
    with watching(path, settings, tmp_path) as watcher:
        heights_m = [meta.T_site_cam[2, 3] for meta in watcher.frames(20) if meta.pose_valid]
        assert heights_m == pytest.approx([EYES_M] * len(heights_m), abs=0.15)
        assert len(heights_m) > 5


def test_the_precise_estimator_measures_by_the_ground_itself(wall: Path, tmp_path: Path) -> None:
    """Its height is known to decimetres and has a velocity, which a pose that is put onto the ground has not."""
    with watching(wall, ReplaySettings("gps-imu/precise", looping=True), tmp_path) as watcher:
        posed = [meta for meta in watcher.frames(50) if meta.pose_valid]
    last = max(
        posed, key=lambda meta: meta.position_s
    )  # a full machine leaves pictures out, and the walk begins anew meanwhile
    ground_z_m = build_terrain(load_site(SITE)).ground_z_m
    assert last.T_site_cam[2, 3] - ground_z_m(*last.T_site_cam[:2, 3]) == pytest.approx(EYES_M, abs=0.1)
    assert last.cov[2, 2] < 0.3**2
    assert all(meta.v_site_m_s[2] != 0.0 for meta in posed)


def test_a_name_that_a_session_cannot_have_is_made_into_one(tmp_path: Path) -> None:
    path = write_walk(tmp_path / "Meine Tour, März (2).mcap", 3.0)
    with watching(path, ReplaySettings(looping=True), tmp_path) as watcher:
        next(watcher.frames())
        assert watcher.session["name"] == "Meine-Tour-M-rz-2"
        assert watcher.session["log"] == path.stem
