"""Threads: what fails in one is raised where it is missed, and none stays."""

from collections.abc import Iterable, Iterator
from threading import current_thread
from threading import enumerate as all_threads
from time import monotonic, sleep

import numpy as np
import pytest

from tracker.estimator import Snapshot
from tracker.measurements import Frame, ImuSample, Measurement, VisualMotion
from tracker.pictures import ArrayPicture
from tracker.pipeline import Pipeline
from tracker.playback import Playback
from tracker.rig import Rig
from tracker.runner import Player, ReadAhead, SensorThread, VisionThread
from tracker.upright import Upright


def _samples(count: int, fails_at: int | None = None) -> Iterator[Measurement]:
    for index in range(count):
        if index == fails_at:
            raise OSError("the disk went away")
        yield ImuSample(index, index, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81))


@pytest.fixture(autouse=True)
def _no_thread_is_left() -> Iterator[None]:
    before = set(all_threads())
    yield
    deadline = monotonic() + 5.0
    while set(all_threads()) - before and monotonic() < deadline:
        sleep(0.01)
    assert set(all_threads()) == before


def test_a_sensor_thread_loses_nothing_and_keeps_the_order() -> None:
    """Many more than its queue holds."""
    assert [m.t_ns for m in SensorThread(_samples(3000))] == list(range(3000))


def test_a_readers_failure_is_raised_where_its_message_is_missed() -> None:
    """After all that came before it; and the thread has ended."""
    thread = SensorThread(_samples(500, fails_at=321))
    assert [next(thread).t_ns for _ in range(321)] == list(range(321))
    with pytest.raises(OSError, match="the disk went away"):
        next(thread)


def test_closing_early_ends_a_reader_that_waits() -> None:
    """Its queue is full and nobody takes anything: it must not wait for ever. What follows is the end."""
    thread = SensorThread(_samples(100_000))
    next(thread)
    thread.close()
    assert list(thread) == []


class Recording:
    """A recording that says how often it was opened."""

    def __init__(self) -> None:
        self.opened: list[int | None] = []

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return samples."""
        self.opened.append(start_ns)
        return (m for m in _samples(50_000) if m.t_recv_ns >= (start_ns or 0))

    def pictures(self, at_ns: int) -> Iterable[Frame]:
        """Return none."""
        return ()


def test_reading_ahead_from_another_place_ends_the_reading_before() -> None:
    """Two threads at most, then one."""
    recording = Recording()
    ahead = ReadAhead(recording)
    first = iter(ahead.messages())
    next(first)
    second = iter(ahead.messages(start_ns=40_000))
    assert next(second).t_ns == 40_000
    assert list(first) == []
    assert recording.opened == [None, 40_000]
    ahead.close()
    ahead.close()


class Eyes:
    """A front end that fails on one picture."""

    def __init__(self) -> None:
        self.threads: set[str] = set()

    def step(self, frame: Frame) -> VisualMotion | None:
        """Fail or return a motion."""
        self.threads.add(current_thread().name)
        if frame.frame_id == 2:
            raise RuntimeError("no such picture")
        return VisualMotion(frame.t_ns, frame.t_ns, frame.frame_id, 0, np.eye(3), (0.0, 0.0, 0.0), 50, 1.0, False)

    def snapshot(self) -> Snapshot:
        """Return something."""
        return "state"

    def restore(self, snapshot: Snapshot) -> None:
        """Check it."""
        assert snapshot == "state"


def _frame(number: int) -> Frame:
    return Frame(number, number, number, ArrayPicture(np.zeros((4, 4, 3), np.uint8)))


def test_vision_looks_on_its_own_thread_and_survives_a_failure() -> None:
    """The exception belongs to the picture; the next one is looked at."""
    eyes = Eyes()
    thread = VisionThread(eyes)
    with pytest.raises(RuntimeError, match="no such picture"):
        thread.step(_frame(2))
    motion = thread.step(_frame(3))
    assert motion is not None
    assert motion.frame_id == 3
    assert eyes.threads == {"vision"}
    thread.restore(thread.snapshot())
    thread.close()


def test_a_player_that_dies_says_why_and_cancels_what_was_asked() -> None:
    """A recording that cannot be read any more ends the thread, not the program."""

    class Broken(Recording):
        def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
            return _samples(10, fails_at=0)

    def no_pipeline(name: str) -> Pipeline:
        raise AssertionError("the recording is opened after the pipeline is made")

    playback = Playback(Broken(), 0, no_pipeline, Upright(Rig()))
    player = Player(playback, (0, 10), estimator="truth", looping=False, show=lambda *_: None, report=lambda _: None)
    player.start()
    deadline = monotonic() + 5.0
    while player.error is None and monotonic() < deadline:
        sleep(0.01)
    assert isinstance(player.error, AssertionError)
    waiting = player.command("pause")
    player.close()
    assert waiting.cancelled()
