"""Playback and its threads: the poses of a straight run wherever one seeks, commands obeyed, nothing left behind."""

from collections.abc import Iterable
from queue import Queue
from threading import active_count

import numpy as np
import pytest

from tracker.errors import InputError
from tracker.estimators import build
from tracker.measurements import Frame, Measurement
from tracker.pictures import ArrayPicture
from tracker.pipeline import Pipeline
from tracker.playback import Playback, Shown
from tracker.runner import Player, PlayerState, ReadAhead, VisionThread
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate
from tracker.upright import Upright
from tracker.vision import VisionFrontEnd

SECONDS = 16
RIG = default_rig()


class Recorded:
    """A recording in memory."""

    def __init__(self) -> None:
        walk = Walk(WalkSettings(seed=2, duration_s=SECONDS, still_s=2.0), RIG)
        rng = np.random.default_rng(0)
        wall = rng.integers(0, 255, (480, 1280, 3), np.uint8)
        pictures: list[Measurement] = [
            Frame(t, late, i, ArrayPicture(wall[:, i * 4 : i * 4 + 640]))
            for i, (t, late) in enumerate(walk.frame_times())
        ]
        self._measurements = sorted([*simulate(walk), *pictures], key=lambda m: m.t_recv_ns)
        self.end_ns = self._measurements[-1].t_recv_ns

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return those from a time on."""
        return [m for m in self._measurements if m.t_recv_ns >= (start_ns or 0)]


@pytest.fixture(scope="module")
def recorded() -> Recorded:
    """Sixteen seconds with pictures of a wall that slides by."""
    return Recorded()


def _pipeline(name: str) -> Pipeline:
    estimator = build(name, origin=AGORA_ORIGIN, rig=RIG, declination_rad=0.0, truth_origin=AGORA_ORIGIN)
    camera = RIG.camera
    return Pipeline(estimator, VisionFrontEnd(camera) if camera else None)


def _run(playback: Playback) -> list[Shown]:
    found = []
    while playback.t_next_ns is not None:
        shown = playback.step()
        if shown is not None:
            found.append(shown)
    return found


def _key(shown: Shown) -> tuple[object, ...]:
    pose = shown.pose
    return shown.frame.frame_id, pose and pose.p_site_m, pose and pose.wxyz_site_body, shown.quarter_turns


@pytest.mark.parametrize("name", ["camera-gps-imu/famm", "truth"])
def test_a_seek_shows_what_a_straight_run_shows(recorded: Recorded, name: str) -> None:
    """Bit for bit, from every checkpoint, forwards and backwards."""
    playback = Playback(recorded, START_NS, _pipeline, Upright(RIG))
    playback.choose(name)
    straight = {shown.frame.frame_id: _key(shown) for shown in _run(playback)}
    assert len(straight) == SECONDS * 12
    for second in (12, 3, 7, 0, 15):
        playback.rewind_to(START_NS + second * 1_000_000_000)
        for shown in _run(playback):
            assert _key(shown) == straight[shown.frame.frame_id]


def test_threads_change_nothing(recorded: Recorded) -> None:
    """The sensors' and the vision thread give the same poses as none, and end."""
    before = active_count()
    playback = Playback(recorded, START_NS, _pipeline, Upright(RIG))
    playback.choose("camera-gps-imu/cmm")
    expected = [_key(shown) for shown in _run(playback)]

    def threaded(name: str) -> Pipeline:
        pipeline = _pipeline(name)
        assert pipeline.front_end is not None
        pipeline.front_end = VisionThread(pipeline.front_end)
        return pipeline

    reading = ReadAhead(recorded)
    playback = Playback(reading, START_NS, threaded, Upright(RIG))
    playback.choose("camera-gps-imu/cmm")
    assert [_key(shown) for shown in _run(playback)] == expected
    reading.close()
    assert isinstance(playback.pipeline.front_end, VisionThread)
    playback.pipeline.front_end.close()
    assert active_count() == before


class Watched:
    """A player, and what it showed."""

    def __init__(self, recorded: Recorded, looping: bool = False) -> None:
        self.shown: Queue[tuple[Shown, PlayerState, bool]] = Queue()
        self.states: Queue[PlayerState] = Queue()
        self.player = Player(
            Playback(recorded, START_NS, _pipeline, Upright(RIG)),
            (START_NS, recorded.end_ns),
            estimator="truth",
            looping=looping,
            show=lambda *what: self.shown.put(what),
            report=self.states.put,
        )
        self.player.start()

    def until_sought(self) -> tuple[Shown, PlayerState]:
        """Return the first picture after a seek."""
        while True:
            shown, state, sought = self.shown.get(timeout=10.0)
            if sought:
                return shown, state


def test_commands(recorded: Recorded) -> None:
    """Pause, seek, another estimator, and a picture of the place each time; nonsense is refused in a sentence."""
    before = active_count()
    watched = Watched(recorded)
    player = watched.player
    assert player.command("pause").result(10.0) is False
    assert player.command("seek", 8.0).result(10.0) is True
    shown, state = watched.until_sought()
    assert shown.frame.t_recv_ns == pytest.approx(START_NS + 8e9, abs=0.1e9)
    assert not state.playing
    assert player.command("estimator", "gps-imu/cmm").result(10.0) is True
    shown, state = watched.until_sought()
    assert state.estimator == "gps-imu/cmm"
    assert shown.pose is not None
    assert shown.pose.motion_model == "P1R1"
    for action, value in (("seek", "soon"), ("seek", -1.0), ("speed", float("nan")), ("estimator", "kalman")):
        with pytest.raises(InputError):
            player.command(action, value).result(10.0)  # type: ignore[arg-type]
    assert player.state.estimator == "gps-imu/cmm"
    player.close()
    assert player.error is None
    assert active_count() == before


def test_plays_to_the_end_and_again(recorded: Recorded) -> None:
    """A loop begins anew with a seek; without one it pauses there."""
    looping, once = Watched(recorded, looping=True), Watched(recorded)
    for watched in (looping, once):
        watched.player.command("speed", 16.0).result(10.0)
        watched.player.command("seek", SECONDS - 0.5).result(10.0)
        watched.until_sought()
    shown, _ = looping.until_sought()
    assert shown.frame.frame_id == 0
    while once.states.get(timeout=10.0).playing:
        pass
    for watched in (looping, once):
        watched.player.close()
        assert watched.player.error is None
