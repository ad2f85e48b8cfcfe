"""How soon a jump in a ten-minute replay shows its picture: from the request to the message that carries it, on one thread of two.

Places are drawn anywhere in the walk. Right after opening the estimator has worked out little of it: then the picture comes
without a pose, and that follows, unless one has jumped elsewhere by then. Later all of the walk is worked out.
`python -m tests.benchmarks.seeking [--estimator NAME]` measures and prints it.
"""

import argparse
import sys
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from time import perf_counter, sleep

import numpy as np

from server.fitting import best_estimator, display_rig
from server.push import frame_message
from tests.benchmarks.soak.to_and_fro import demo_pictures, write_log
from tracker.estimator import Origin
from tracker.evaluate import make_pipeline
from tracker.log import Log
from tracker.playback import Playback, Shown
from tracker.runner import Player, PlayerState, ReadAhead
from tracker.simulate import AGORA_ORIGIN
from tracker.upright import Upright

ROOT = Path(__file__).parents[2]
SECONDS = 600.0
JUMPS = 60
TARGET_MS = 150.0


@dataclass(frozen=True)
class Jumps:
    """What was measured."""

    fresh_p95_ms: float
    """Right after opening, one after the other."""
    known_p95_ms: float
    """Once all of the walk is worked out."""
    whole_s: float
    """How long that took after the last of the fresh ones."""


class _Watched:
    """A player whose newest picture can be waited for."""

    def __init__(self, log: Log, origin: Origin, estimator: str) -> None:
        self._rig, self._shown, self._estimator = display_rig(log), Event(), estimator
        self.last_s = log.info.duration_s
        self._reading = ReadAhead(log)
        self.playback = Playback(
            self._reading, log.info.t_start_ns, lambda name: make_pipeline(name, log, origin), Upright(log.rig)
        )
        self.player = Player(
            self.playback,
            (log.info.t_start_ns, log.info.t_end_ns),
            estimator=estimator,
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
            estimator=self._estimator,
            position_s=state.position_s,
            t_sent_ns=0,
            did_seek=did_seek,
        )
        if did_seek:
            self._shown.set()

    def jump_ms(self, position_s: float) -> float:
        """Jump and return how long its picture took, with or without a pose."""
        self._shown.clear()
        began = perf_counter()
        self.player.command("seek", position_s)
        self._shown.wait()
        return 1e3 * (perf_counter() - began)

    def work_out(self) -> float:
        """Let all of the walk be worked out; return how long that took, seconds."""
        began = perf_counter()
        self.player.command("seek", self.last_s)
        while not self.playback.is_whole:
            if self.player.error is not None:
                raise self.player.error
            sleep(0.1)
        return perf_counter() - began

    def close(self) -> None:
        """End every thread."""
        self.player.close()
        self._reading.close()


def measure(folder: Path, estimator: str | None = None) -> Jumps:
    """Jump about in a walk of ten minutes, which is written into a folder where it is not there yet.

    `estimator` is the one that a replay takes by itself, if None.
    """
    path = folder / "soak" / f"to-and-fro-{SECONDS:.0f}.mcap"
    write_log(path, SECONDS, demo_pictures())
    log, chance = Log.open(path), np.random.default_rng(1)
    with closing(_Watched(log, AGORA_ORIGIN, estimator or best_estimator(log))) as watched:
        places_s = chance.uniform(0.0, watched.last_s, 2 * JUMPS).tolist()
        fresh = [watched.jump_ms(place_s) for place_s in places_s[:JUMPS]]
        whole_s = watched.work_out()
        known = [watched.jump_ms(place_s) for place_s in places_s[JUMPS:]]
    return Jumps(float(np.percentile(fresh, 95.0)), float(np.percentile(known, 95.0)), whole_s)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser("python -m tests.benchmarks.seeking", description=__doc__)
    parser.add_argument("--estimator")
    jumps = measure(ROOT / "build", parser.parse_args().estimator)
    sys.stdout.write(
        f"to the new picture, p95: {jumps.fresh_p95_ms:.0f} ms right after opening, {jumps.known_p95_ms:.0f} ms once all is "
        f"worked out, which took {jumps.whole_s:.0f} s more; at most {TARGET_MS:g} ms\n"
    )


if __name__ == "__main__":
    main()
