"""Playback and its threads: the poses of a straight run wherever one seeks, commands obeyed, nothing left behind."""

from collections.abc import Iterable
from itertools import count
from queue import Queue
from threading import active_count

import numpy as np
import pytest

from tracker.errors import InputError
from tracker.estimator import Estimator
from tracker.estimators import build
from tracker.measurements import Frame, Measurement, Outcome, Retraction, Said, Sighting, Standpoint
from tracker.pictures import ArrayPicture
from tracker.pipeline import Pipeline
from tracker.playback import Playback, Shown
from tracker.retractable import Retractable
from tracker.runner import Player, PlayerState, ReadAhead, VisionThread
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate
from tracker.upright import Upright
from tracker.vision import VisionFrontEnd

SECONDS = 16
RIG = default_rig()


class Recorded:
    """A recording in memory."""

    def __init__(self) -> None:
        self.walk = walk = Walk(WalkSettings(seed=2, duration_s=SECONDS, still_s=2.0), RIG)
        rng = np.random.default_rng(0)
        wall = rng.integers(0, 255, (480, 1280, 3), np.uint8)
        pictures: list[Measurement] = [
            Frame(t, late, i, ArrayPicture(wall[:, i * 4 : i * 4 + 640]))
            for i, (t, late) in enumerate(walk.frame_times())
        ]
        self._measurements = sorted([*simulate(walk), *pictures], key=lambda m: m.t_recv_ns)
        self.end_ns = self._measurements[-1].t_recv_ns

    def landmark(self, t_ns: int) -> Sighting:
        """Return what a visitor says who points at a landmark 30 m straight ahead."""
        x, y, z, _ = (self.walk.T_site_cam(t_ns) @ np.array([0.0, 0.0, 30.0, 1.0])).tolist()
        return Sighting(t_ns, 0, (x, y, z), (0.0, 0.0, 1.0), 0.01)

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return those from a time on."""
        return [m for m in self._measurements if m.t_recv_ns >= (start_ns or 0)]

    def pictures(self, at_ns: int) -> Iterable[Frame]:
        """Return the newest picture at a time, and those after it."""
        frames = [m for m in self._measurements if isinstance(m, Frame)]
        return frames[max(0, sum(frame.t_recv_ns <= at_ns for frame in frames) - 1) :]


@pytest.fixture(scope="module")
def recorded() -> Recorded:
    """Sixteen seconds with pictures of a wall that slides by."""
    return Recorded()


def _pipeline(name: str) -> Pipeline:
    estimator = build(name, origin=AGORA_ORIGIN, rig=RIG, declination_rad=0.0, truth_origin=AGORA_ORIGIN)
    camera = RIG.camera
    return Pipeline(estimator, VisionFrontEnd(camera) if camera else None)


def _listening(name: str) -> Pipeline:
    def make() -> Estimator:
        return build(name, origin=AGORA_ORIGIN, rig=RIG, declination_rad=0.0)

    return Pipeline(Retractable(make))


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
        playback.go_to(START_NS + second * 1_000_000_000)
        for shown in _run(playback):
            assert _key(shown) == straight[shown.frame.frame_id]


def test_the_same_log_gives_the_same_poses_whatever_was_done_with_it(recorded: Recorded) -> None:
    """Watched from the start, or jumped about in while the estimator is anywhere behind or ahead."""
    straight, wild = (Playback(recorded, START_NS, _pipeline, Upright(RIG)) for _ in range(2))
    for playback in (straight, wild):
        playback.choose("camera-gps-imu/famm")
    expected = {shown.frame.frame_id: _key(shown) for shown in _run(straight)}
    rng = np.random.default_rng(3)
    for _ in range(40):
        wild.go_to(START_NS + int(rng.integers(SECONDS * 1_000_000_000)))
        for _ in range(int(rng.integers(200))):
            wild.run_ahead()
        shown = wild.step()
        assert shown is not None
        assert _key(shown) == expected[shown.frame.frame_id]


def test_a_place_that_was_worked_out_is_shown_without_the_estimator(recorded: Recorded) -> None:
    playback = Playback(recorded, START_NS, _pipeline, Upright(RIG))
    playback.choose("gps-imu/famm")
    playback.go_to(START_NS + 9_000_000_000)
    known = [playback.is_known]
    bare = playback.peek()
    assert bare is not None
    assert bare.pose is None
    while not playback.is_whole:
        playback.run_ahead()
    known.append(playback.is_known)
    assert known == [False, True]
    shown = playback.step()
    assert shown is not None
    assert shown.frame is bare.frame
    assert shown.pose is not None


def test_what_is_refused_leaves_everything_as_it_was(recorded: Recorded) -> None:
    """Said far behind the estimator, which comes back for it."""
    playback = Playback(recorded, START_NS, _pipeline, Upright(RIG))
    playback.choose("gps-imu/famm")
    expected = {shown.frame.frame_id: _key(shown) for shown in _run(playback)}
    playback.go_to(START_NS + 7_000_000_000)
    playback.step()
    assert playback.say(recorded.landmark(START_NS + 7_000_000_000)) is Outcome.IGNORED
    assert playback.is_known
    assert all(_key(shown) == expected[shown.frame.frame_id] for shown in _run(playback))


def test_what_is_said_of_a_place_is_said_again_when_the_walk_comes_by(recorded: Recorded) -> None:
    """A landmark and a place: from every checkpoint as in the straight run, and never before they were said."""
    playback = Playback(recorded, START_NS, _listening, Upright(RIG))
    playback.choose("gps-imu/precise")
    silent = {shown.frame.frame_id: _key(shown) for shown in _run(playback)}
    playback.go_to(START_NS)
    told: dict[int, tuple[object, ...]] = {}
    while playback.t_next_ns is not None:
        shown = playback.step()
        assert shown is not None
        told[shown.frame.frame_id] = _key(shown)
        t_ns = shown.frame.t_ns
        if shown.frame.frame_id == 7 * 12:
            assert playback.say(recorded.landmark(t_ns)) is Outcome.USED
        elif shown.frame.frame_id == 11 * 12:
            assert playback.say(Standpoint(t_ns, 0, (1.0, 1.0, 1.65), 0.5)) is Outcome.USED
    changed = [number for number in told if told[number] != silent[number]]
    assert min(changed) > 7 * 12
    assert len(changed) > 60
    for second in (14, 3, 8, 0):
        playback.go_to(START_NS + second * 1_000_000_000)
        for shown in _run(playback):
            assert _key(shown) == told[shown.frame.frame_id]


def test_a_word_taken_back_leaves_the_walk_as_it_was(recorded: Recorded) -> None:
    playback = Playback(recorded, START_NS, _listening, Upright(RIG))
    playback.choose("gps-imu/precise")
    silent = {shown.frame.frame_id: _key(shown) for shown in _run(playback)}
    playback.go_to(START_NS + 8_000_000_000)
    shown = playback.step()
    assert shown is not None
    t_ns = shown.frame.t_ns
    assert playback.say(Retraction(t_ns, 0)) is Outcome.REJECTED_STALE
    assert playback.say(recorded.landmark(t_ns)) is Outcome.USED
    for _ in range(20):
        playback.step()
    assert playback.say(Retraction(t_ns, 0)) is Outcome.USED
    rest = _run(playback)
    assert len(rest) > 40
    assert all(_key(shown) == silent[shown.frame.frame_id] for shown in rest)


def test_what_is_said_at_one_place_again_and_again_is_all_heard(recorded: Recorded) -> None:
    """Though the estimator has run on after each word, and must come back for the next."""
    playback = Playback(recorded, START_NS, _listening, Upright(RIG))
    playback.choose("gps-imu/precise")
    playback.go_to(START_NS + 8_000_000_000)
    shown = playback.step()
    assert shown is not None
    t_ns = shown.frame.t_ns
    place = Standpoint(t_ns, 0, (1.0, 1.0, 1.65), 0.5)
    words: list[Said] = [recorded.landmark(t_ns), place, *(Retraction(t_ns, 0) for _ in range(3))]
    outcomes = []
    for word in words:
        outcomes.append(playback.say(word))
        for _ in range(500):
            playback.run_ahead()
    assert outcomes == [Outcome.USED] * 4 + [Outcome.REJECTED_STALE]


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

    def __init__(self, recorded: Recorded, looping: bool = False, estimator: str = "truth") -> None:
        self.shown: Queue[tuple[Shown, PlayerState, bool]] = Queue()
        self.states: Queue[PlayerState] = Queue()
        self.player = Player(
            Playback(recorded, START_NS, _pipeline, Upright(RIG)),
            (START_NS, recorded.end_ns),
            estimator=estimator,
            looping=looping,
            show=lambda *what: self.shown.put(what),
            report=self.states.put,
        )

    def start(self) -> "Watched":
        """Start it."""
        self.player.start()
        return self

    def until_sought(self) -> tuple[Shown, PlayerState]:
        """Return the first picture after a seek; one that comes alone while its pose is worked out is passed by."""
        while True:
            shown, state, sought = self.shown.get(timeout=10.0)
            if sought and not state.seeking:
                return shown, state


def test_commands(recorded: Recorded) -> None:
    """Pause, seek, another estimator, and a picture of the place each time; nonsense is refused in a sentence."""
    before = active_count()
    watched = Watched(recorded).start()
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
    seen = Sighting(0, 0, (1.0, 2.0, 3.0), (0.0, 0.0, 1.0), 0.01)
    with pytest.raises(InputError, match="gps-imu/cmm takes no alignment"):
        player.command("say", seen).result(10.0)
    assert player.command("loop", True).result(10.0) is False
    assert player.state.looping
    nonsense = (
        ("loop", "yes"),
        ("seek", "soon"),
        ("seek", -1.0),
        ("speed", float("nan")),
        ("estimator", "kalman"),
        ("say", "here"),
    )
    for action, value in nonsense:
        with pytest.raises(InputError):
            player.command(action, value).result(10.0)  # type: ignore[arg-type]
    assert player.state.estimator == "gps-imu/cmm"
    player.close()
    assert player.error is None
    assert active_count() == before


def test_who_jumped_too_far_jumps_elsewhere_at_once(recorded: Recorded, monkeypatch: pytest.MonkeyPatch) -> None:
    """The picture of a place comes before its pose, and another jump does not wait for that."""
    now_ns = count(0, 5_000_000)  # so little is worked out between two looks at the clock
    monkeypatch.setattr("tracker.runner.monotonic_ns", lambda: next(now_ns))
    watched = Watched(recorded, estimator="gps-imu/cmm")
    watched.player.command("pause")
    far, near = [watched.player.command("seek", position_s) for position_s in (SECONDS - 1.0, 2.0)]
    watched.start()
    try:
        assert far.result(10.0)
        assert near.result(10.0)
        places_s = []
        while True:
            shown, state, _ = watched.shown.get(timeout=10.0)
            places_s.append(round((shown.frame.t_recv_ns - START_NS) * 1e-9))
            if not state.seeking:
                break
    finally:
        watched.player.close()
    assert places_s == [SECONDS - 1, 2, 2]
    straight = Playback(recorded, START_NS, _pipeline, Upright(RIG))
    straight.choose("gps-imu/cmm")
    assert _key(shown) in [_key(one) for one in _run(straight)]
    assert watched.player.error is None


def test_plays_to_the_end_and_again(recorded: Recorded) -> None:
    """A loop begins anew with a seek; without one it pauses there."""
    looping, once = Watched(recorded, looping=True).start(), Watched(recorded).start()
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
