"""`python -m server.paper.attitude`: what calibration and averaging do to the attitude, and the camera's rotation beside it.

Writes docs/paper/attitude.json: offsets and drift at rest as in the paper's section "Sensor calibration", on simulated Phidgets
and on recordings, beside vqf and imufusion; attitude against truth; camera against gyroscope. Recordings lie beside a checkout of
the project's own people and nowhere else: where one is missing, or a rival is not installed, what the file says of it is kept.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any, TypeAlias

import numpy as np
import typer
from rich.console import Console
from rich.progress import track

from server.paper import drift, turn
from server.paper.drift import Attitudes, Offsets
from tracker.choreography import DATASET_DURATION_S
from tracker.log import Log
from tracker.measurements import ImuSample, TruePose
from tracker.score import Figures
from tracker.simulate import Walk, WalkSettings, default_rig, simulate

ROOT = Path(__file__).parents[2]
OUT = ROOT / "docs" / "paper" / "attitude.json"
RECORDINGS = ROOT.parent / "shared" / "data"

#: The paper's completely stationary dataset.
AT_REST = 3
SEEDS = range(1, 17)
STILL_LOGS = ("broad-02", "broad-21", "broad-33", "tumvi-room1")
CAMERA_LOGS = ("transformflow-1606", "transformflow-avonhead-1611")
FULL_TURN = "transformflow-1606"
#: What the paper prints: a mean drift with offsets and averaging, and its table of offsets (in g and degrees a second).
PAPER: Figures = {
    "drift_deg_min": 0.5,
    "accel_g": [-0.000817, 0.158242, 0.987314],
    "gyro_deg_s": [-0.216527, -0.052387, -0.183611],
}

Samples: TypeAlias = list[ImuSample]


def attitudes(samples: Samples, offsets: Offsets) -> dict[str, Attitudes]:
    """Return the attitude by every way that is compared; rivals that are not installed are left out.

    raw: samples as they are. mean: the mean of four. offsets: the offset of the first 5000 samples subtracted. both: offset and
    mean, the paper's. agora: the tracker's own, which goes on following the offset while the rig lies still. vqf, imufusion: fed
    the samples without the offset, as `offsets` is.
    """
    without = drift.without(samples, offsets.gyro_rad_s)
    found: dict[str, Attitudes | None] = {
        "raw": drift.by_madgwick(samples, 1),
        "mean": drift.by_madgwick(samples),
        "offsets": drift.by_madgwick(without, 1),
        "both": drift.by_madgwick(without),
        "agora": drift.by_us(samples),
        "vqf": drift.by_vqf(without),
        "imufusion": drift.by_imufusion(without),
    }
    return {name: one for name, one in found.items() if one is not None}


def offset_figures(offsets: Offsets) -> Figures:
    """Return a row of the paper's table of offsets: g and degrees a second."""
    return {
        "samples": offsets.samples,
        "accel_g": [round(a / drift.G_M_S2, 6) for a in offsets.accel_m_s2],
        "gyro_deg_s": [round(float(np.degrees(w)), 6) for w in offsets.gyro_rad_s],
    }


def drift_figures(found: Mapping[str, Attitudes], begin_ns: int, end_ns: int) -> Figures:
    """Return degrees a minute by every way, over one rest; empty for a rest too short to say."""
    begin_ns += round(drift.SETTLING_S * 1e9)
    rates = {name: drift.drift_deg_min(one.between(begin_ns, end_ns)) for name, one in found.items()}
    return {name: round(rate, 3) for name, rate in rates.items() if rate is not None}


def simulated(seed: int) -> Figures:
    """Return offsets and drift of a rig that lies still for the paper's third dataset, with the simulator's Phidget noise."""
    walk = Walk(WalkSettings(seed=seed, dataset=AT_REST, duration_s=DATASET_DURATION_S[AT_REST]), default_rig())
    samples = [m for m in simulate(walk) if isinstance(m, ImuSample)]
    offsets = drift.calibrated(samples)
    found = attitudes(samples, offsets)
    end_ns = samples[-1].t_ns
    return {
        "seed": seed,
        "offsets": offset_figures(offsets),
        "drift_deg_min": drift_figures(found, offsets.end_ns, end_ns),
    }


def recorded(path: Path) -> Figures:
    """Return offsets, drift in every rest after the calibration, and the error against truth from the calibration on."""
    messages = list(Log.open(path).messages(camera=False))
    samples = [m for m in messages if isinstance(m, ImuSample)]
    truth = [m for m in messages if isinstance(m, TruePose)]
    offsets = drift.calibrated(samples)
    found = attitudes(samples, offsets)
    first_ns = offsets.end_ns if offsets.samples else samples[0].t_ns + round(drift.SETTLING_S * 1e9)
    t_true_ns = np.array([pose.t_ns for pose in truth], np.int64)
    wxyz_true = np.array([pose.wxyz_map_body for pose in truth])
    use = t_true_ns >= first_ns
    spans = [(max(begin, first_ns), end) for begin, end in drift.rests(samples)]
    rests = [
        {
            "from_s": round((begin - samples[0].t_ns) * 1e-9, 1),
            "to_s": round((end - samples[0].t_ns) * 1e-9, 1),
            "drift_deg_min": figures,
        }
        for begin, end in spans
        if (figures := drift_figures(found, begin, end))
    ]
    return {
        "log": path.stem,
        "offsets": offset_figures(offsets) if offsets.samples else None,
        "rests": rests,
        "error_deg": {
            name: _rounded(drift.error_figures(one, t_true_ns[use], wxyz_true[use]), 2) for name, one in found.items()
        },
    }


def camera(paths: list[Path], full_turn: Path) -> Figures:
    """Return how camera and gyroscope agree between keyframes: with the recordings' own axes, and with the phone's, fitted."""
    recordings = {path.stem: turn.turns(Log.open(path)) for path in paths}
    mounting = turn.fit(list(recordings.values()))
    log = Log.open(full_turn)
    return {
        "mounting": {
            "rotation_cam_deg": np.degrees(mounting.rotation_cam_rad).round(2).tolist(),
            "gyro_offset_deg_s": np.degrees(mounting.gyro_offset_rad_s).round(3).tolist(),
            "lag_ms": round(mounting.lag_s * 1e3, 1),
        },
        "logs": [
            {
                "log": name,
                "as_recorded": _rounded(turn.agreement(recording, turn.AS_RECORDED), 2),
                "fitted": _rounded(turn.agreement(recording, mounting), 2),
            }
            for name, recording in recordings.items()
        ],
        "full_turn": {
            "log": full_turn.stem,
            "camera_off_deg": round(turn.camera_closing_deg(log), 2),
            "gyro_off_deg": round(turn.closing_deg(log, "gps-imu/famm"), 2),
            "together_off_deg": round(turn.closing_deg(log, "camera-gps-imu/famm"), 2),
        },
    }


def _rounded(figures: Figures, digits: int) -> Figures:
    return {name: round(value, digits) for name, value in figures.items()}


def summary(rows: list[Figures]) -> Figures:
    """Return mean and largest drift over seeds, by every way."""
    names = list(rows[0]["drift_deg_min"])
    rates = {name: np.array([row["drift_deg_min"][name] for row in rows]) for name in names}
    return {
        "mean": {name: round(float(rate.mean()), 3) for name, rate in rates.items()},
        "largest": {name: round(float(rate.max()), 3) for name, rate in rates.items()},
    }


def kept(new: Any, old: Any) -> Any:
    """Return new figures with what only the old ones have: a rival that is not installed here was measured where it was."""
    if isinstance(new, dict) and isinstance(old, dict):
        return {**{k: v for k, v in old.items() if k not in new}, **{k: kept(v, old.get(k)) for k, v in new.items()}}
    if isinstance(new, list) and isinstance(old, list) and len(new) == len(old):
        return [kept(a, b) for a, b in zip(new, old, strict=True)]
    return new


def measure(
    recordings: Path, old: Figures, progress: Callable[[list[Any]], Any], seeds: Sequence[int] = SEEDS
) -> Figures:
    """Return the whole file's contents.

    Args:
        recordings: The folder of the recordings; those that it lacks are kept from `old`.
        old: What the file says now; empty where there is none.
        progress: Wraps the list of works, as `rich.progress.track`.
        seeds: Of the simulated rests.
    """
    stills = [recordings / f"{name}.mcap" for name in STILL_LOGS]
    phones = [recordings / f"{name}.mcap" for name in CAMERA_LOGS]
    works: list[tuple[str, Callable[[], Figures]]] = [("seed", partial(simulated, seed)) for seed in seeds]
    works += [(path.stem, partial(recorded, path)) for path in stills if path.is_file()]
    if all(path.is_file() for path in phones):
        works.append(("camera", partial(camera, phones, recordings / f"{FULL_TURN}.mcap")))
    done = [(name, work()) for name, work in progress(works)]
    rows = [figures for name, figures in done if name == "seed"]
    found = dict(done)
    before = {row["log"]: row for row in old.get("recorded", [])}
    logs = [kept(found.get(name, before.get(name)), before.get(name)) for name in STILL_LOGS]
    new = {
        "paper": PAPER,
        "simulated": {"dataset": AT_REST, **summary(rows), "seeds": rows},
        "recorded": [row for row in logs if row is not None],
        "camera": found.get("camera", old.get("camera")),
    }
    new["simulated"] = kept(new["simulated"], old.get("simulated"))
    return new


def main(recordings: Annotated[Path, typer.Option(help="The folder of the recordings.")] = RECORDINGS) -> None:
    """Measure attitudes and write docs/paper/attitude.json."""
    console = Console(stderr=True)
    old: Figures = json.loads(OUT.read_text(encoding="utf-8")) if OUT.is_file() else {}
    new = measure(recordings, old, lambda works: track(works, "attitudes", console=console, transient=True))
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(new, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    console.print(f"{OUT.relative_to(ROOT)} written")


if __name__ == "__main__":
    typer.run(main)
