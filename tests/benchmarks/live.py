"""How Python, OpenCV and BLAS are best set for a live walk, measured on the program itself: a recording played as its sensors.

    python -m tests.benchmarks.live LOG [--seconds 40] [--rounds 3]

Every setting has a process of its own, and they take turns, so that a busy machine is as hard on each. ARCHITECTURE.md has the
figures that `server/tuning.py` rests on.
"""

import argparse
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import monotonic_ns, process_time, sleep

from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Setting:
    """One way to run."""

    name: str
    switch_ms: float = 5.0
    cv2_threads: int = 1
    blas_threads: int = 1


SETTINGS = (
    Setting("as Python is: 5 ms, OpenCV and BLAS one thread"),
    Setting("1 ms", switch_ms=1.0),
    Setting("0.5 ms", switch_ms=0.5),
    Setting("0.1 ms", switch_ms=0.1),
    Setting("OpenCV two threads", cv2_threads=2),
    Setting("BLAS two threads", blas_threads=2),
)


def walk(log_path: Path, seconds: float) -> dict[str, float]:
    """Walk for a time, recording and showing, and return the figures."""
    from server.live_rig import LiveRig
    from server.placing import Placing
    from tracker.log import Log
    from tracker.simulate import AGORA_ORIGIN
    from tracker.sources.played import Played

    played = Played(Log.open(log_path), looping=True)
    placing = Placing(AGORA_ORIGIN, lambda e, n: 0.0, lambda e, n: 1.65, 1.65)
    with TemporaryDirectory() as folder:
        sources = [played.source(name) for name in ("gps", "imu", "camera")]
        rig = LiveRig(sources, played.log.rig, placing, record=Path(folder) / "walk.mcap")
        rig.start()
        began_s, began_ns = process_time(), monotonic_ns()
        sleep(seconds)
        state = rig.state
        cpu = (process_time() - began_s) / ((monotonic_ns() - began_ns) * 1e-9)
        rig.close()
    return {
        "p50_ms": state.latency_p50_ms or 0.0,
        "p99_ms": state.latency_p99_ms or 0.0,
        "longest_ms": state.latency_longest_ms,
        "poses_hz": state.poses_hz,
        "vision_hz": state.looks_hz,
        "cpu": cpu,
        "lost": float(sum(state.lost.values())),
    }


def measured(log_path: Path, seconds: float, setting: Setting) -> dict[str, float]:
    """Walk in a process of its own."""
    threads = str(setting.blas_threads)
    command = [sys.executable, "-m", "tests.benchmarks.live", str(log_path), "--seconds", str(seconds)]
    command += ["--one", str(setting.switch_ms), str(setting.cv2_threads)]
    environment = {**os.environ, "OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads}
    done = subprocess.run(command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True)
    return {name: float(value) for name, value in json.loads(done.stdout).items()}


def main() -> None:
    """Measure, and print a table: the median of the rounds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=Path)
    parser.add_argument("--seconds", type=float, default=40.0)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--one", nargs=2, metavar=("SWITCH_MS", "CV2_THREADS"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one is not None:
        import cv2

        sys.setswitchinterval(float(options.one[0]) * 1e-3)
        cv2.setNumThreads(int(options.one[1]))
        sys.stdout.write(json.dumps(walk(options.log, options.seconds)))
        return
    found = [[measured(options.log, options.seconds, setting) for setting in SETTINGS] for _ in range(options.rounds)]
    table = Table("setting", "p50 ms", "p99 ms", "longest ms", "poses/s", "pictures/s", "CPU", "lost")
    for index, setting in enumerate(SETTINGS):
        rounds = [one[index] for one in found]
        cells = [f"{median(one[name] for one in rounds):.2f}" for name in rounds[0]]
        table.add_row(setting.name, *cells)
    Console(width=150).print(table)


if __name__ == "__main__":
    main()
