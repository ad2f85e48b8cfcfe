"""A live walk on its threads: sensors that die and come back, pictures with poses of their own, a recording that replays alike."""

from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from threading import Event
from threading import enumerate as all_threads
from time import monotonic, monotonic_ns, sleep, time_ns

import pytest

from tests.tracker.precise.stream import row
from tests.tracker.running.walking import rows_of
from tests.walks import write_walk
from tracker.assembly import assemble
from tracker.errors import InputError, SourceLost
from tracker.estimator import Innovation, Pose
from tracker.evaluate import make_pipeline
from tracker.log import Log
from tracker.measurements import (
    Frame,
    GpsFix,
    ImuSample,
    Measurement,
    Outcome,
    Retraction,
    Sighting,
    Standpoint,
    VisualMotion,
)
from tracker.pipeline import Pipeline
from tracker.playback import Shown
from tracker.rig import Rig
from tracker.running.core import MakePipeline, WalkCore
from tracker.running.health import SensorState
from tracker.running.recorder import Recorder, as_read, recorded
from tracker.running.walk import LiveWalk
from tracker.simulate import AGORA_ORIGIN
from tracker.sources.played import Played
from tracker.sources.source import Put, Source, SourceStatus

NAMES = ("gps", "imu", "camera")


@pytest.fixture(autouse=True)
def _no_thread_is_left() -> Iterator[None]:
    before = set(all_threads())
    yield
    until(lambda: set(all_threads()) <= before)


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Log:
    """Thirty seconds with pictures."""
    return Log.open(write_walk(tmp_path_factory.mktemp("logs") / "wall.mcap", 30.0, pictures=True))


def until(condition: Callable[[], object], seconds: float = 60.0) -> None:
    deadline = monotonic() + seconds
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.01)


def pipelines(name: str, rig: Rig, utc_ns: int) -> MakePipeline:
    return lambda fix: assemble(name, origin=AGORA_ORIGIN, rig=rig, date_ns=utc_ns)


def test_a_replay_of_a_live_recording_gives_the_same_poses(log: Log, tmp_path: Path) -> None:
    """With real threads: vision leaves out pictures and is late, sensors overtake each other; bit for bit nevertheless."""
    name, rig, utc_ns = "camera-gps-imu/precise", recorded(log.rig), time_ns()
    path, rows, shown = tmp_path / "live.mcap", list[tuple[object, ...]](), list[Shown]()
    recorder = Recorder(path, rig, t_start_ns=monotonic_ns(), utc_start_ns=utc_ns, about={})

    def note(measurement: Measurement) -> None:
        recorder.put(measurement)
        rows.append(row(core.pose(measurement.t_recv_ns)))

    rig = as_read(rig)
    core = WalkCore(pipelines(name, rig, utc_ns), rig, dict.fromkeys(NAMES, monotonic_ns()), record=note)
    played = Played(log)
    with LiveWalk(core, [played.source(name) for name in NAMES], show=shown.append, recorder=recorder) as walk:
        until(lambda: len([one for one in shown if one.pose]) > 20)
        t_ns = shown[-1].frame.t_ns
        seen = Sighting(t_ns, t_ns, (20.0, 5.0, 3.0), (0.0, 0.0, 1.0), 0.05)
        for said in (seen, Standpoint(t_ns + 1, t_ns + 1, (0.0, 0.0, 1.65), 5.0), Retraction(t_ns, t_ns)):
            assert walk.say(said).result(10.0) is Outcome.USED
        until(lambda: len([one for one in shown if one.pose]) > 30)
        state = walk.state
    again = Log.open(path)
    assert again.info.counts["motions"] > 10
    assert again.info.counts["said"] == 3
    assert not set(state.lost) - {"camera"}, "a busy machine may cost pictures, and nothing else"
    pipeline = make_pipeline(name, again, AGORA_ORIGIN)
    assert rows_of(pipeline, again.messages()) == rows
    assert all(one.pose is None or one.pose.t_ns == one.frame.t_ns for one in shown)
    assert {health.state for health in state.sensors.values()} == {SensorState.STREAMING}


class Fragile:
    """A sensor that says samples until it is told to fail, and how."""

    def __init__(self, name: str = "imu") -> None:
        self.name = name
        self.runs = 0
        self.failure: BaseException | None = None

    def status(self) -> SourceStatus:
        """Nothing special."""
        return SourceStatus(self.failure is None, "a sensor of the test's")

    def run(self, put: Put, stop: Event) -> None:
        """Speak, or fail."""
        self.runs += 1
        while not stop.wait(0.005):
            if self.failure is not None:
                raise self.failure
            t_ns = monotonic_ns()
            spread = (t_ns % 1000) * 1e-6
            if self.name == "imu":
                put(ImuSample(t_ns, t_ns, (spread, 0.0, 0.0), (0.0, 0.0, 9.81)))
            else:
                put(
                    GpsFix(
                        t_ns,
                        t_ns,
                        37.9366 + 1e-6 * spread,
                        27.3447,
                        88.0,
                        (4.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 9.0),
                    )
                )


def fragile_walk(sources: list[Fragile], show_pose: Callable[[Pose | None], None] = lambda pose: None) -> LiveWalk:
    rig = Rig()
    core = WalkCore(pipelines("gps-imu/precise", rig, 0), rig, {source.name: monotonic_ns() for source in sources})
    given: list[Source] = [*sources]
    return LiveWalk(core, given, show_pose=show_pose)


@pytest.mark.parametrize("failure", [SourceLost("it was pulled out: put it back"), RuntimeError("a driver's mistake")])
def test_one_sensor_that_dies_is_restarted_and_the_other_goes_on(failure: Exception) -> None:
    """Whether it says so, or falls over."""
    imu, gps = Fragile("imu"), Fragile("gps")
    with fragile_walk([imu, gps]) as walk:
        until(lambda: walk.state.pose is not None)
        gps.failure = failure
        until(lambda: walk.state.sensors["gps"].state is SensorState.LOST)
        health = walk.state.sensors["gps"]
        assert str(failure) in health.sentence
        before = walk.state.sensors["imu"].count
        until(lambda: gps.runs > 2)
        until(lambda: walk.state.sensors["imu"].count > before)
        assert walk.state.pose is not None
        gps.failure = None
        until(lambda: walk.state.sensors["gps"].state is SensorState.STREAMING)
        assert walk.state.sensors["gps"].restarts >= 2


def test_a_source_that_can_never_work_is_not_tried_again() -> None:
    """And says why; the walk goes on."""
    imu, gps = Fragile("imu"), Fragile("gps")
    gps.failure = InputError("walk.txt is no receiver: name another")
    with fragile_walk([imu, gps]) as walk:
        until(lambda: "gps" in walk.state.sensors and walk.state.sensors["gps"].state is SensorState.FAILED)
        sleep(0.6)
        assert gps.runs == 1
        assert walk.state.sensors["imu"].state is SensorState.STREAMING


class Failing:
    """An estimator that fails at one measurement of many."""

    name, uses_camera = "failing", False

    def __init__(self) -> None:
        self.steps = 0

    def step(self, measurement: Measurement) -> Outcome:
        """Count, and fail at the hundredth."""
        self.steps += 1
        if self.steps == 100:
            raise FloatingPointError("a matrix of nothing")
        return Outcome.USED

    def predict(self, t_ns: int) -> None:
        """Know nothing."""

    snapshot = restore = predict

    def innovations(self) -> list[Innovation]:
        """Have none."""
        return []


def test_an_estimator_that_fails_is_begun_anew(caplog: pytest.LogCaptureFixture) -> None:
    """It is logged, and the walk goes on with a new one."""
    made: list[Failing] = []

    def make(fix: GpsFix | None) -> Pipeline:
        made.append(Failing())
        return Pipeline(made[-1])  # type: ignore[arg-type]  # it stands for one

    imu = Fragile("imu")
    with LiveWalk(WalkCore(make, Rig(), {"imu": monotonic_ns()}), [imu]) as walk:
        until(lambda: len(made) == 2 and made[1].steps > 10)
        assert walk.error is None
    assert "begins anew" in caplog.text


def test_without_a_camera_empty_pictures_are_shown() -> None:
    """Ten a second, with the pose of now; none is recorded."""
    shown: list[Shown] = []
    imu, gps = Fragile("imu"), Fragile("gps")
    fed: list[Measurement] = []
    core = WalkCore(
        pipelines("gps-imu/precise", Rig(), 0), Rig(), {"imu": monotonic_ns(), "gps": monotonic_ns()}, record=fed.append
    )
    with LiveWalk(core, [imu, gps], show=shown.append):
        until(lambda: any(one.pose for one in shown))
    assert not any(isinstance(m, Frame | VisualMotion) for m in fed)


def test_a_walk_can_wait_for_its_first_fix() -> None:
    """Nothing is fed before it, and the fix makes the pipeline."""
    fixes: list[GpsFix | None] = []
    make = pipelines("gps-imu/precise", Rig(), 0)

    def noted(fix: GpsFix | None) -> Pipeline:
        fixes.append(fix)
        return make(fix)

    fed: list[Measurement] = []
    core = WalkCore(noted, Rig(), {"imu": 0, "gps": 0}, waits_for_fix=True, record=fed.append)
    assert core.take("imu", ImuSample(1, 1, (0.1, 0.0, 0.0), (0.0, 0.0, 9.8)), 1) is None
    none = GpsFix(2, 2, 0.0, 0.0, 0.0, (0.0,) * 9, valid=False)
    assert core.take("gps", none, 2) is None
    fix = GpsFix(3, 3, 37.9, 27.3, 88.0, (0.0,) * 9)
    assert core.take("gps", fix, 3) == fix
    assert (fixes, fed) == ([fix], [fix])


def test_a_recording_is_played_as_sensors_at_its_own_pace(log: Log) -> None:
    """Stamps are of the local clock; its sensors stay together; it ends, or begins again."""
    played = Played(log)
    sources = [played.source(name) for name in NAMES]
    heard: dict[str, list[Measurement]] = {name: [] for name in NAMES}
    stop = Event()
    imu, began_ns = sources[1], monotonic_ns()

    def put(measurement: Measurement) -> None:
        heard["imu"].append(measurement)
        if len(heard["imu"]) == 200:
            stop.set()

    imu.run(put, stop)
    assert 0.6 < (monotonic_ns() - began_ns) * 1e-9 < 10.0
    assert all(m.t_recv_ns >= m.t_ns >= began_ns - 1_000_000_000 for m in heard["imu"])
    assert imu.status().counts["played"] >= 199
    with pytest.raises(InputError, match="has no camera"):
        Played(Log.open(write_walk(log.path.parent / "dark.mcap", 3.0))).source("camera")


def test_a_recording_that_has_ended_is_lost(tmp_path: Path) -> None:
    """Unless it begins again."""
    short = Log.open(write_walk(tmp_path / "short.mcap", 1.0))
    with pytest.raises(SourceLost, match="has ended"):
        Played(short).source("imu").run(lambda measurement: None, Event())
    stop, stamps = Event(), list[int]()

    def put(measurement: Measurement) -> None:
        stamps.append(measurement.t_ns)
        if len(stamps) > 400:
            stop.set()

    Played(short, looping=True).source("imu").run(put, stop)
    assert max(b - a for a, b in pairwise(stamps)) < 300_000_000, "one lap follows the other without a gap"
