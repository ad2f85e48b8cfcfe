"""Every thread of the tracker, as in the paper's "Multi-threaded approach": sensors, vision, and fusion with the camera.

Each is a thin shell around code that knows nothing of threads, and each hands over through one mailbox:

- `SensorThread` reads and stamps; its queue is bounded and loses nothing.
- `VisionThread` looks at pictures; one picture in, one motion out.
- `Player` owns the playback and its estimator, paces a recording, and obeys commands between two messages.

On a recording fusion waits for vision, so the poses are the same, bit for bit, on a fast machine and on a slow one.
"""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, replace
from queue import Empty, Full, Queue
from threading import Event, Thread
from time import monotonic_ns
from typing import Literal

from tracker.errors import InputError
from tracker.estimator import Snapshot
from tracker.measurements import Frame, Measurement, Said, VisualMotion
from tracker.pipeline import FrontEnd
from tracker.playback import Playback, Recording, Shown
from tracker.said import refusal_words

#: Messages read ahead: half a second of a 400 Hz IMU.
_READ_AHEAD = 200
#: How long a wait may last before it looks whether it should end.
_LOOK_UP_S = 0.1
#: Work ahead is done in pieces of at least this; after each, the processor is others' for as long as that took.
_PIECE_NS = 4_000_000
#: How soon the longest of them is forgotten.
_FORGET = 0.98
#: A seek that takes longer shows its picture without a pose meanwhile.
_PATIENCE_NS = 30_000_000
#: A playback later than this has lost its time for good and goes on from where it is, instead of racing after the clock.
_LATEST_NS = 300_000_000


class SensorThread(Iterator[Measurement]):
    """Reads measurements ahead of their use: an iterator whose work is done on a thread of its own."""

    def __init__(self, measurements: Iterable[Measurement]) -> None:
        self._queue: Queue[Measurement | BaseException | None] = Queue(_READ_AHEAD)
        self._stop = Event()
        self._thread = Thread(target=self._read, args=(measurements,), name="sensors", daemon=True)
        self._thread.start()

    def _read(self, measurements: Iterable[Measurement]) -> None:
        try:
            for measurement in measurements:
                if not self._put(measurement):
                    return
            self._put(None)
        except Exception as error:
            self._put(error)  # the reader's failure is the caller's to handle, there where the message is missed

    def _put(self, item: Measurement | BaseException | None) -> bool:
        while not self._stop.is_set():
            try:
                self._queue.put(item, timeout=_LOOK_UP_S)
                return True
            except Full:
                continue
        return False

    def __next__(self) -> Measurement:
        if self._stop.is_set():
            raise StopIteration
        item = self._queue.get()
        if isinstance(item, BaseException):
            self.close()
            raise item
        if item is None:
            self.close()
            raise StopIteration
        return item

    def close(self) -> None:
        """Stop reading and wait for the thread."""
        self._stop.set()
        self._thread.join()


class ReadAhead:
    """A recording read on a `SensorThread`; reading from another place ends the reading before."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._thread: SensorThread | None = None

    def messages(self, *, start_ns: int | None = None) -> Iterable[Measurement]:
        """Return the measurements that arrived at or after start_ns."""
        self.close()
        self._thread = SensorThread(self._recording.messages(start_ns=start_ns))
        return self._thread

    def pictures(self, at_ns: int) -> Iterable[Frame]:
        """Return the pictures alone; they are read when they are asked for."""
        return self._recording.pictures(at_ns)

    def close(self) -> None:
        """End the reading."""
        if self._thread is not None:
            self._thread.close()


class VisionThread:
    """A front end on its own thread; `step` hands it a picture and waits for the motion."""

    def __init__(self, front_end: FrontEnd) -> None:
        self._front_end = front_end
        self._pictures: Queue[tuple[Frame, Future[VisualMotion | None]] | None] = Queue(1)
        self._thread = Thread(target=self._look, name="vision", daemon=True)
        self._thread.start()

    def _look(self) -> None:
        while (item := self._pictures.get()) is not None:
            frame, future = item
            try:
                future.set_result(self._front_end.step(frame))
            except Exception as error:
                future.set_exception(error)

    def step(self, frame: Frame) -> VisualMotion | None:
        """Return the motion that a picture shows."""
        future: Future[VisualMotion | None] = Future()
        self._pictures.put((frame, future))
        return future.result()

    def snapshot(self) -> Snapshot:
        """Return the front end's state; it is idle, since `step` has waited for it."""
        return self._front_end.snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._front_end.restore(snapshot)

    def close(self) -> None:
        """End the thread."""
        self._pictures.put(None)
        self._thread.join()


Action = Literal["play", "pause", "seek", "speed", "loop", "estimator", "say"]


@dataclass(frozen=True, slots=True)
class PlayerState:
    """What a playback bar shows."""

    estimator: str
    playing: bool
    position_s: float
    speed: float
    looping: bool
    seeking: bool = False


class Player:
    """Plays a recording at the pace of the clock and hands every picture out with its pose."""

    def __init__(
        self,
        playback: Playback,
        span_ns: tuple[int, int],
        *,
        estimator: str,
        looping: bool,
        show: Callable[[Shown, PlayerState, bool], None],
        report: Callable[[PlayerState], None],
    ) -> None:
        """Prepare a player; `start` starts it.

        Args:
            playback: Used by the player's thread alone from now on.
            span_ns: Arrival of the first and last message.
            estimator: Its name.
            looping: Begin again at the end, else pause there.
            show: Called with each picture, the state, and whether a seek came just before.
            report: Called when the state has changed other than by time.
        """
        self._playback = playback
        self._start_ns, self._end_ns = span_ns
        self._show, self._report = show, report
        self._state = PlayerState(estimator, playing=True, position_s=0.0, speed=1.0, looping=looping)
        self._commands: Queue[tuple[Action, object, Future[bool]]] = Queue()
        self._stop = Event()
        self._clock_ns = 0
        self._clock_log_ns = 0
        self._just_sought = False
        self._rest_until_ns = 0
        self._piece_ns = float(_PIECE_NS)
        self.error: BaseException | None = None
        """What ended the thread, where it was not `close`."""
        self._thread = Thread(target=self._run, name="fusion", daemon=True)

    @property
    def state(self) -> PlayerState:
        """The state now."""
        return self._state

    def start(self) -> None:
        """Start playing."""
        self._thread.start()

    def command(self, action: Action, value: object = None) -> "Future[bool]":
        """Ask for something; the result tells whether the position jumped.

        It fails with InputError where the value makes no sense, and the playback goes on as before.
        """
        future: Future[bool] = Future()
        self._commands.put((action, value, future))
        return future

    def close(self) -> None:
        """Stop and wait for the thread; commands that were not obeyed are cancelled."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join()
        while not self._commands.empty():
            self._commands.get()[2].cancel()

    # -- the thread ---------------------------------------------------------------------------------------------------

    def _run(self) -> None:
        try:
            self._playback.choose(self._state.estimator)
            self._set_clock()
            self._report(self._state)
            while not self._stop.is_set():
                self._turn()
        except Exception as error:
            self.error = error

    def _turn(self) -> None:
        """Obey a command, or play the next picture when it is due, or work ahead, or wait a little."""
        if self._state.seeking and self._commands.empty():
            self._find(_PIECE_NS)
            return
        t_next_ns = self._playback.t_next_ns
        if self._state.playing and t_next_ns is None:
            self._at_end()
            return
        wait_s = _LOOK_UP_S
        if self._state.playing and t_next_ns is not None:
            wait_s = (self._due_ns(t_next_ns) - monotonic_ns()) * 1e-9
        if self._commands.empty() and not self._playback.is_whole:
            if self._work_ahead(wait_s):
                return
            wait_s = min(wait_s, 1e-9 * _PIECE_NS)
        if wait_s > 0.0005 or not self._commands.empty():
            with suppress(Empty):
                self._obey(*self._commands.get(timeout=max(0.0, min(wait_s, _LOOK_UP_S))))
            return
        if wait_s < -_LATEST_NS * 1e-9:
            self._set_clock()
        self._play()

    def _work_ahead(self, spare_s: float) -> bool:
        """Work at poses further on for a moment, where there is the time; return whether that was done."""
        now_ns = monotonic_ns()
        if now_ns < self._rest_until_ns or spare_s * 1e9 < self._piece_ns:
            return False
        until_ns = now_ns + _PIECE_NS
        while monotonic_ns() < until_ns and not self._playback.is_whole:
            self._playback.run_ahead()
        took_ns = monotonic_ns() - now_ns
        self._rest_until_ns = now_ns + 2 * took_ns
        self._piece_ns = max(_FORGET * self._piece_ns, took_ns)
        return True

    def _play(self) -> None:
        shown = self._playback.step()
        if shown is not None:
            self._state = replace(self._state, position_s=(shown.frame.t_recv_ns - self._start_ns) * 1e-9)
            self._hand_out(shown)

    def _hand_out(self, shown: Shown) -> None:
        sought, self._just_sought = self._just_sought, False
        self._show(shown, self._state, sought)

    def _at_end(self) -> None:
        if self._state.looping:
            self._seek(0.0)
        else:
            self._change(playing=False)

    def _due_ns(self, t_log_ns: int) -> int:
        return self._clock_ns + int((t_log_ns - self._clock_log_ns) / self._state.speed)

    def _set_clock(self) -> None:
        self._clock_ns = monotonic_ns()
        self._clock_log_ns = self._start_ns + round(self._state.position_s * 1e9)

    def _change(self, **changes: object) -> None:
        self._state = replace(self._state, **changes)  # type: ignore[arg-type]
        self._set_clock()
        self._report(self._state)

    # -- commands -----------------------------------------------------------------------------------------------------

    def _obey(self, action: Action, value: object, future: "Future[bool]") -> None:
        try:
            future.set_result(self._do(action, value))
        except InputError as error:
            future.set_exception(error)

    def _do(self, action: Action, value: object) -> bool:
        match action:
            case "play":
                at_end = self._playback.t_next_ns is None
                if at_end:
                    self._seek(0.0)
                self._change(playing=True)
                return at_end
            case "pause":
                self._change(playing=False)
                return False
            case "speed":
                self._change(speed=_number(value, "speed", 0.1, 16.0))
                return False
            case "loop":
                if not isinstance(value, bool):
                    raise InputError("Looping is switched by true or false.")
                self._change(looping=value)
                return False
            case "seek":
                self._seek(_number(value, "position", 0.0, (self._end_ns - self._start_ns) * 1e-9))
                return True
            case "estimator":
                self._playback.choose(str(value))
                self._state = replace(self._state, estimator=str(value))
                self._seek(self._state.position_s)
                return True
            case "say":
                self._say(value)
                return False

    def _say(self, said: object) -> None:
        """Take what a visitor says. While paused its effect is seen once half a second more was played."""
        if not isinstance(said, Said):
            raise InputError(f"Visitors say sightings and standpoints, not {said!r}.")
        refused = refusal_words(self._playback.say(said), self._state.estimator)
        if refused is not None:
            raise InputError(refused)

    def _seek(self, position_s: float) -> None:
        """Jump: the picture of the place is shown with its pose, and alone as long as the estimator has not come there.

        It runs up to there between commands: who has jumped too far jumps elsewhere at once.
        """
        self._playback.go_to(self._start_ns + round(position_s * 1e9))
        self._state = replace(self._state, position_s=position_s, seeking=False)
        self._just_sought = True
        if self._find(_PATIENCE_NS):
            return
        self._change(seeking=True)
        if (bare := self._playback.peek()) is not None:
            self._show(bare, self._state, True)

    def _find(self, most_ns: int) -> bool:
        """Run the estimator towards the place that was jumped to, for so long at most; show it and return True there."""
        until_ns = monotonic_ns() + most_ns
        while not self._playback.is_known and not self._playback.is_whole:
            self._playback.run_ahead()
            if monotonic_ns() > until_ns:
                return False
        shown = self._playback.step()
        position_s = self._state.position_s
        if shown is not None:
            position_s = max(position_s, (shown.frame.t_recv_ns - self._start_ns) * 1e-9)
        self._change(position_s=position_s, seeking=False)
        if shown is not None:
            self._hand_out(shown)
        return True


def _number(value: object, what: str, least: float, most: float) -> float:
    """Return a finite number within bounds; InputError says what was wrong."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
        raise InputError(f"The {what} must be a number from {least:g} to {most:g}, not {value!r}.")
    return float(value)
