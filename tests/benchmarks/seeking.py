"""How soon a jump in a ten-minute replay shows its picture: from the request to the message that carries it, on one thread of two.

The first jumps come while the estimator has worked out little of the walk: then the picture comes without a pose, and that follows.
"""

from dataclasses import dataclass
from pathlib import Path
from threading import Event
from time import perf_counter

import numpy as np

from server.fitting import display_rig
from server.push import frame_message
from tests.benchmarks.soak.to_and_fro import demo_pictures, write_log
from tracker.estimator import Origin
from tracker.evaluate import make_pipeline
from tracker.log import Log
from tracker.playback import Playback, Shown
from tracker.runner import Player, PlayerState, ReadAhead
from tracker.simulate import AGORA_ORIGIN
from tracker.upright import Upright

SECONDS = 600.0
ESTIMATOR = "gps-imu/famm"
JUMPS = 60
TARGET_MS = 150.0


@dataclass(frozen=True)
class Jumps:
    """What was measured."""

    cold_p95_ms: float
    """While the walk was being worked out."""
    warm_p95_ms: float
    """Once it was."""


class _Watched:
    """A player whose newest picture can be waited for."""

    def __init__(self, log: Log, origin: Origin) -> None:
        self._rig, self._shown = display_rig(log), Event()
        self.last_s = log.info.duration_s
        self._reading = ReadAhead(log)
        self.playback = Playback(
            self._reading, log.info.t_start_ns, lambda name: make_pipeline(name, log, origin), Upright(log.rig)
        )
        self.player = Player(
            self.playback,
            (log.info.t_start_ns, log.info.t_end_ns),
            estimator=ESTIMATOR,
            looping=False,
            show=self._show,
            report=lambda state: None,
        )
        self.player.start()
        self.player.command("pause").result()

    def _show(self, shown: Shown, state: PlayerState, did_seek: bool) -> None:
        frame_message(
            shown.frame,
            shown.pose,
            self._rig,
            estimator=ESTIMATOR,
            position_s=state.position_s,
            t_sent_ns=0,
            did_seek=did_seek,
        )
        if did_seek:
            self._shown.set()

    def jump_ms(self, position_s: float) -> float:
        """Jump and return how long that took."""
        self._shown.clear()
        began = perf_counter()
        done = self.player.command("seek", position_s)
        self._shown.wait()
        took_ms = 1e3 * (perf_counter() - began)
        done.result()
        return took_ms

    def close(self) -> None:
        """End every thread."""
        self.player.close()
        self._reading.close()


def measure(folder: Path) -> Jumps:
    """Jump about in a walk of ten minutes, which is written into a folder where it is not there yet."""
    path = folder / "ten-minutes.mcap"
    write_log(path, SECONDS, demo_pictures())
    watched, chance = _Watched(Log.open(path), AGORA_ORIGIN), np.random.default_rng(1)
    try:
        # one after another further on: each place is behind what was worked out
        cold = [watched.jump_ms((index + 1) * watched.last_s / 12) for index in range(10)]
        while not watched.playback.is_whole:
            watched.jump_ms(watched.last_s)
        warm = [watched.jump_ms(float(chance.uniform(0.0, watched.last_s))) for _ in range(JUMPS)]
    finally:
        watched.close()
    return Jumps(_p95(cold), _p95(warm))


def _p95(values: list[float]) -> float:
    return sorted(values)[int(0.95 * (len(values) - 1))]
