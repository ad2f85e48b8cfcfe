"""Ten minutes in real time: `agora walk` itself with a log as its sensors, its own server and a recording, watched from outside."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np

from tests.benchmarks.soak.process import usage
from tests.benchmarks.soak.rows import Row

AGORA = Path(sys.executable).with_name("agora")
#: The first figures are of programs that start.
_SETTLED_S = 10.0
_FIRST_MINUTE_S = 60.0
#: How long after its end a log's last measurements may still be on their way.
_LATE_S = 20.0
_FAREWELL_S = 60.0


@dataclass(frozen=True)
class Sample:
    """How the walk was at one time; as `agora walk --json` says it, and as the machine does."""

    t_s: float
    poses_hz: float
    vision_hz: float
    p50_ms: float | None
    p99_ms: float | None
    longest_ms: float
    lost: dict[str, int]
    counts: dict[str, int]
    """Measurements of each sensor that came out of the mailbox so far."""
    played: dict[str, int]
    """Measurements that each sensor's thread has put into it."""
    rss_mb: float
    own_s: float
    busy_s: float


def walk(log: Path, recording: Path, seconds: float, prefix: Sequence[str] = ()) -> Iterator[Sample]:
    """Walk through a log, and yield a sample a second until it has ended.

    Args:
        log: What the sensors say.
        recording: The file to record into; its folder has no other recording.
        seconds: How long the log is.
        prefix: What comes before the command: `chrt -r 10`.

    Raises:
        RuntimeError: The walk ended by itself, or with an error.
    """
    spec = f"log:{log}"
    command: list[str | Path] = [
        *prefix,
        AGORA,
        "walk",
        "--gps",
        spec,
        "--imu",
        spec,
        "--camera",
        spec,
        "--record",
        recording.parent,
    ]
    command += ["--port", "0", "--no-browser", "--json"]
    # a rig file of whoever runs this is of another rig
    environment = {**os.environ, "HOME": str(recording.parent), "OMP_NUM_THREADS": "1"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        try:
            yield from _samples(process, seconds)
        finally:
            process.send_signal(signal.SIGINT)
            code = process.wait(_FAREWELL_S)
    if code:
        raise RuntimeError(f"agora walk ended with code {code}")
    next(recording.parent.glob("walk-*.mcap")).replace(recording)


def _samples(process: subprocess.Popen[str], seconds: float) -> Iterator[Sample]:
    assert process.stdout is not None
    began_s: float | None = None
    for line in process.stdout:
        if not line.startswith("{"):
            continue
        told = json.loads(line)
        if began_s is None:
            if not told["sensors"] or not told["sensors"]["imu"]["count"]:
                continue
            began_s = monotonic()
        t_s = monotonic() - began_s
        yield _sample(t_s, told, process.pid)
        if _has_ended(told) or t_s > seconds + _LATE_S:
            return
    raise RuntimeError("agora walk ended before its log")


def _has_ended(told: dict[str, Any]) -> bool:
    return all("has ended" in health["sentence"] for health in told["sensors"].values())


def _sample(t_s: float, told: dict[str, Any], pid: int) -> Sample:
    latency, machine, sensors = told["latency_ms"], usage(pid), told["sensors"]
    counts = {name: health["count"] for name, health in sensors.items()}
    played = {name: health["counts"].get("played", 0) for name, health in sensors.items()}
    return Sample(
        t_s, told["poses_hz"], told["vision_hz"], latency["p50"], latency["p99"], latency["longest"], told["lost"],
        counts, played, machine.rss_mb, machine.own_s, machine.busy_s,
    )  # fmt: skip


def rows(samples: Sequence[Sample], length_s: float, kept: Mapping[str, int]) -> list[Row]:
    """Return the figures.

    Args:
        samples: Of the whole walk.
        length_s: Of its log.
        kept: How many measurements of each kind its recording has.
    """
    settled = [sample for sample in samples if _SETTLED_S <= sample.t_s < length_s - 1.0] or list(samples)
    last, imu = samples[-1], kept["imu"] + kept["mag"]
    poses, vision = ([getattr(sample, name) for sample in settled] for name in ("poses_hz", "vision_hz"))
    return [
        Row("inertial samples played that no mailbox had a place for", last.lost.get("imu", 0), "", most=0),
        Row(
            "inertial samples played that the estimator was not fed",
            last.played["imu"] - last.counts["imu"],
            "",
            most=0,
        ),
        Row("inertial samples played that the recording lacks", last.played["imu"] - imu, "", most=0),
        Row("sample to pose, p99", last.p99_ms or np.inf, "ms", most=5.0),
        Row("sample to pose, median", last.p50_ms or np.inf, "ms"),
        Row("sample to pose, longest", last.longest_ms, "ms"),
        Row("poses a second, least of any two seconds", min(poses), "", least=60.0),
        Row("poses a second, median", float(np.median(poses)), ""),
        Row("vision's estimates a second, as recorded", kept["motions"] / length_s, "", least=10.0),
        Row("pictures looked at a second, least of any two seconds", min(vision), ""),
        Row("pictures played that no mailbox had a place for", last.lost.get("camera", 0), ""),
        Row("memory's growth after the first minute", growth_mb_min(samples), "MB/min", most=1.0),
        Row("memory at the end", last.rss_mb, "MB"),
        Row("cores that it took", _cores(settled, "own_s"), ""),
        Row("cores that others' work took", _cores(settled, "busy_s") - _cores(settled, "own_s"), ""),
    ]


def growth_mb_min(samples: Sequence[Sample]) -> float:
    """Return the slope of the memory after the first minute, or after the first half of a walk that is shorter than two."""
    begin_s = min(_FIRST_MINUTE_S, 0.5 * samples[-1].t_s)
    later = [sample for sample in samples if sample.t_s >= begin_s]
    if len(later) < 2:
        return 0.0
    slope = np.polyfit([sample.t_s for sample in later], [sample.rss_mb for sample in later], 1)[0]
    return float(slope) * 60.0


def _cores(samples: Sequence[Sample], name: str) -> float:
    span_s = samples[-1].t_s - samples[0].t_s
    return float(getattr(samples[-1], name) - getattr(samples[0], name)) / max(span_s, 1e-3)
