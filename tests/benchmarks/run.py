"""`make bench`: speed beside peers, in the same run on the same data; a table, ratio first, and build/bench.json.

A ratio is ours over the rival's where less is better, and ours over the target where more is; the unit says which.
Times are this process's CPU time on one core, so that a busy machine changes them little; the AR page's are the wall's.
"""

import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from time import process_time

import ahrs
import cv2
import imufusion
import numpy as np
from filterpy.kalman import KalmanFilter
from rich.console import Console
from rich.progress import track
from rich.table import Table
from vqf import VQF

from tests.benchmarks import ar_page, beside, failover, home_page, seeking, siege
from tests.benchmarks.endurance import endure
from tests.benchmarks.fanout import SERVERS, measure, rows_of
from tracker.attitude import Madgwick
from tracker.cycle import Cycle, CycleFilter
from tracker.estimators import ESTIMATORS, SELECTORS, missing_sensors
from tracker.evaluate import run
from tracker.fusion import FusionFilter, FusionSettings, transition
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Vector3
from tracker.motion import CONSTANT
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate
from tracker.vision import VisionFrontEnd

ROOT = Path(__file__).parents[2]
#: The demo's walk; a checkout that has none yet takes the walk that lies beside it.
CAMERA_LOGS = (
    ROOT / "assets" / "demo" / "state-agora-walk.mcap",
    ROOT.parent / "shared" / "data" / "sim-dev-camera.mcap",
)
OUT = ROOT / "build"
REPEATS = 5
MODEL_TURNS = 25
PAPER_ESTIMATES_HZ = 4.0


@dataclass(frozen=True)
class Row:
    """One comparison."""

    name: str
    value: float
    unit: str
    rival: str
    ratio: float
    """Of ours to the rival's value: for times less is better, for rates and real-time factors more."""


def seconds_per_call(work: Callable[[], int]) -> float:
    """Return the median over repeats of a call's time; `work` returns how many calls it made."""
    times = []
    for _ in range(REPEATS):
        began = process_time()
        calls = work()
        times.append((process_time() - began) / calls)
    return median(times)


def filter_rows() -> list[Row]:
    """The 12-state predict and update against filterpy's KalmanFilter, all of it in numpy matrices."""
    rng = np.random.default_rng(1)
    z = rng.normal(0.0, 1.0, (2000, 6))
    measured = [((a, b, c), (d, e, f)) for a, b, c, d, e, f in z.tolist()]

    def ours() -> int:
        kf = FusionFilter.start(FusionSettings(), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (4.0, 4.0, 9.0))
        for p, r in measured:
            kf.predict(0.25, CONSTANT)
            y_p, y_r = kf.innovation(p, r)
            kf.update(y_p, y_r, (4.0, 4.0, 9.0))
        return len(measured)

    def theirs() -> int:
        kf = KalmanFilter(dim_x=12, dim_z=6)
        kf.F = transition(0.25, CONSTANT)
        kf.H = np.zeros((6, 12))
        kf.H[:3, :3], kf.H[3:, 6:9] = np.eye(3), np.eye(3)
        kf.Q, kf.R = np.eye(12) * 0.01, np.diag([4.0, 4.0, 9.0, 1e-4, 1e-4, 1e-4])
        for row in z:
            kf.predict()
            kf.update(row)
        return len(z)

    a, b = seconds_per_call(ours), seconds_per_call(theirs)
    return [Row("12-state predict and update", a * 1e6, "us", f"filterpy {b * 1e6:.1f} us", a / b)]


def model_rows() -> list[Row]:
    """One update of the filter, the choice of its next model included, against the constant motion model's.

    The models take turns, and a ratio is the median over the turns of the times within one turn: so a change of the machine's
    pace, which would pass for a difference of a few per cent, falls on all of them. The paper promises no extra cost of rules.
    """
    rng = np.random.default_rng(3)
    # a walk that wanders, so that small, medium and large innovations come about
    z = np.cumsum(rng.normal(0.0, (0.3, 0.3, 0.3, 0.03, 0.03, 0.03), (1000, 6)), axis=0).tolist()
    var_m2 = (4.0, 4.0, 9.0)
    cycles = [Cycle(k * 250_000_000, (x, y, h), var_m2, (r, p, w)) for k, (x, y, h, r, p, w) in enumerate(z)]
    times: dict[str, list[float]] = {name: [] for name in SELECTORS}
    for _ in range(MODEL_TURNS):
        for name, selector in SELECTORS.items():
            filter_ = CycleFilter(selector(), FusionSettings())
            began = process_time()
            for cycle in cycles:
                filter_.step(cycle)
            times[name].append((process_time() - began) / len(cycles))
    constant_us = median(times["cmm"]) * 1e6
    return [
        Row(
            f"one filter update, {name}",
            median(times[name]) * 1e6,
            "us",
            f"cmm {constant_us:.1f} us",
            median(own / constant for own, constant in zip(times[name], times["cmm"], strict=True)),
        )
        for name in SELECTORS
    ]


def attitude_rows() -> list[Row]:
    """Madgwick's update against three libraries, one sample at a time as a rig's come."""
    rng = np.random.default_rng(2)
    gyro = rng.normal(0.0, 0.3, (4000, 3))
    accel = rng.normal(0.0, 0.2, (4000, 3)) + np.array([0.0, 0.0, 9.81])
    samples: list[tuple[Vector3, Vector3]] = [
        ((a, b, c), (d, e, f)) for (a, b, c), (d, e, f) in zip(gyro.tolist(), accel.tolist(), strict=True)
    ]

    def ours() -> int:
        filter_ = Madgwick()
        for w, f in samples:
            filter_.update(w, f, 0.004)
        return len(samples)

    def by_ahrs() -> int:
        filter_ = ahrs.filters.Madgwick(frequency=250.0, gain=0.033)
        q = np.array([1.0, 0.0, 0.0, 0.0])
        for w, f in zip(gyro[:1000], accel[:1000], strict=True):
            q = filter_.updateIMU(q, gyr=w, acc=f)
        return 1000

    def by_imufusion() -> int:
        filter_ = imufusion.Ahrs()
        filter_.set_sample_period(0.004)
        degrees, g = np.degrees(gyro), accel / 9.81
        for w, f in zip(degrees, g, strict=True):
            filter_.update_no_magnetometer(w, f)
        return len(degrees)

    def by_vqf() -> int:
        filter_ = VQF(0.004)
        for w, f in zip(gyro, accel, strict=True):
            filter_.update(w, f)
        return len(gyro)

    a = seconds_per_call(ours)
    rivals = {
        "ahrs (Python)": by_ahrs,
        "imufusion (C)": by_imufusion,
        "vqf (C++)": by_vqf,
    }
    return [
        Row(f"Madgwick update against {name}", a * 1e6, "us", f"{name} {b * 1e6:.2f} us", a / b)
        for name, b in ((name, seconds_per_call(work)) for name, work in rivals.items())
    ]


def endurance_rows() -> list[Row]:
    """What is left of the precise filter's covariance over a million samples, beside what rounding would leave of nothing."""
    least, rounding = min(one.least_eigenvalue for one in endure(1_000_000, 1_000)), float(np.finfo(np.float64).eps)
    name = "precise, a million samples: least eigenvalue of its correlations"
    return [Row(name, least, "1, more is better", f"rounding {rounding:.1e}", least / rounding)]


def vision_rows(log: Log) -> list[Row]:
    """The camera's front end at 640x480 on one core, against the paper's rate (video is decoded before, JPEG within)."""
    camera = log.rig.camera
    if camera is None:
        return []
    frames = [m for m in log.messages(truth=False) if isinstance(m, Frame)][:150]
    front_end = VisionFrontEnd(camera)
    times = []
    for frame in frames:
        began = process_time()
        motion = front_end.step(frame)
        if motion is not None:
            times.append(process_time() - began)
    rate = 1.0 / median(times)
    rival = f"the paper's {PAPER_ESTIMATES_HZ:g} a second"
    return [Row("vision, 640x480, one core", rate, "estimates/s", rival, rate / PAPER_ESTIMATES_HZ)]


def replay_rows(log: Log, what: str, target: float, repeats: int) -> list[Row]:
    """How much faster than life `evaluate` runs, log reading and scoring's poses included."""
    rows = []
    for name in ESTIMATORS:
        if name == "truth" or missing_sensors(name, log.info, log.rig):
            continue
        if name.startswith("camera") != what.startswith("with camera"):
            continue
        factor = log.info.duration_s / median(run_seconds(log, name) for _ in range(repeats))
        rows.append(Row(f"evaluate {name}, {what}", factor, "x real time", f"target {target:g}x", factor / target))
    return rows


def run_seconds(log: Log, name: str) -> float:
    """Return the CPU time of one run."""
    began = process_time()
    run(log, name)
    return process_time() - began


def page_rows(path: Path) -> list[Row]:
    """From the arrival of a message at the AR page to its last pixel, in software: wall time, so a busy machine is slower."""
    rows = []
    for drawn in ar_page.measure(path):
        target_ms = 20.0 if drawn.effort == ar_page.FIRST else 40.0
        name = f"AR page 640x480, {drawn.renderer}, {drawn.effort}, {drawn.triangles} triangles"
        rows += [
            Row(
                f"{name}: arrival to drawn, p50",
                drawn.p50_ms,
                "ms",
                f"target {target_ms:g} ms",
                drawn.p50_ms / target_ms,
            ),
            Row(f"{name}: drawn", drawn.pictures_hz, "pictures/s", "floor 10 a second", drawn.pictures_hz / 10.0),
        ]
    return rows


def home_rows() -> list[Row]:
    """The start page over 10 Mbit/s, in software: wall time, so a busy machine is slower."""
    rows = []
    for opened in home_page.measure():
        name = "start page 1280x720, SwiftShader, 10 Mbit/s"
        first_s, target_s = opened.first_picture_ms / 1e3, home_page.FIRST_PICTURE_MS / 1e3
        size_mb, most_mb = opened.first_picture_bytes / 1e6, home_page.FIRST_PICTURE_BYTES / 1e6
        long_ms, most_ms = opened.longest_task_ms, home_page.LONG_TASK_MS
        rows += [
            Row(f"{name}: first picture", first_s, "s", f"target {target_s:g} s", first_s / target_s),
            Row(f"{name}: came until then", size_mb, "MB", f"target {most_mb:g} MB", size_mb / most_mb),
            Row(f"{name}: longest task after it", long_ms, "ms", f"target {most_ms:g} ms", long_ms / most_ms),
        ]
    return rows


def beside_rows() -> list[Row]:
    """Five start pages beside a live walk: wall time, so a busy machine is slower."""
    found = beside.measure(whole=True)
    return [] if found is None else [Row(*fields) for fields in beside.rows_of(found)]


def simulated_log(seconds: float = 120.0) -> Log:
    """A walk without camera, IMU at 250 Hz."""
    rig = default_rig()
    settings = WalkSettings(seed=11, duration_s=seconds)
    path = OUT / "bench.mcap"
    with LogWriter(path, rig, settings.origin, t_start_ns=START_NS) as writer:
        for measurement in simulate(Walk(settings, rig)):
            writer.write(measurement)
    return Log.open(path)


def fanout_rows() -> list[Row]:
    """One rig to many viewers over loopback, with one that stalls and one on a slow line, beside others that could do it."""
    frames, poses = (measure(what, 8.0) for what in ("frames", "poses"))
    rivals = {server: measure("poses", 8.0, server) for server in SERVERS if server != "serve"}
    return [Row(*fields) for fields in rows_of(frames, poses, rivals)]


def failover_rows() -> list[Row]:
    """Three servers on three nodes of NATS, of which some are killed."""
    return [Row(*fields) for fields in failover.rows_of(failover.measure(5.0))]


def siege_rows() -> list[Row]:
    """A rig and its viewer while others abuse their server."""
    return [Row(*fields) for fields in siege.rows_of(siege.measure())]


def seeking_rows() -> list[Row]:
    """Jumps in a replay of ten minutes, to the message with the picture: wall time, so a busy machine is slower."""
    jumps, target_ms = seeking.measure(OUT), seeking.TARGET_MS
    name = "jump anywhere in a ten-minute replay, p95"
    found = {"right after opening": jumps.fresh_p95_ms, "worked out": jumps.known_p95_ms}
    return [
        Row(f"{name}, {when}", p95_ms, "ms", f"target {target_ms:g} ms", p95_ms / target_ms)
        for when, p95_ms in found.items()
    ]


def camera_works() -> list[Callable[[], list[Row]]]:
    """What needs pictures; nothing where no walk with a camera is at hand."""
    path = next((path for path in CAMERA_LOGS if path.is_file()), None)
    if path is None:
        return []
    log = Log.open(path)
    return [
        lambda: page_rows(path),
        lambda: vision_rows(log),
        seeking_rows,
        lambda: replay_rows(log, f"with camera, {log.name}", 5.0, repeats=1),
    ]


def main() -> None:
    """Run everything and print it."""
    cv2.setNumThreads(1)
    OUT.mkdir(exist_ok=True)
    console = Console(width=130, highlight=False)
    works: list[Callable[[], list[Row]]] = [
        filter_rows,
        model_rows,
        attitude_rows,
        endurance_rows,
        fanout_rows,
        beside_rows,
        home_rows,
        failover_rows,
        siege_rows,
        lambda: replay_rows(simulated_log(), "without camera, 250 Hz", 20.0, repeats=3),
    ]
    works += camera_works()
    rows = [row for work in track(works, "measuring", console=Console(stderr=True), transient=True) for row in work()]
    table = Table(title="ratio: times, less is better; rates and factors, more is better", title_justify="left")
    for heading in ("ratio", "what", "ours", "unit", "beside"):
        table.add_column(heading, justify="right" if heading in ("ratio", "ours") else "left")
    for row in rows:
        table.add_row(f"{row.ratio:.3g}", row.name, f"{row.value:.3g}", row.unit, row.rival)
    console.print(table)
    (OUT / "bench.json").write_text(json.dumps([asdict(row) for row in rows], indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
