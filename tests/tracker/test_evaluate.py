"""Evaluation of small simulated logs: every figure that is promised, and nothing learnt from ground truth."""

import re
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import numpy as np
import pytest

from tracker.errors import MissingSensor, UnknownEstimator
from tracker.estimators import ESTIMATORS
from tracker.evaluate import Run, figures, log_origin, run
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, GpsFix, GpsVelocity, ImuSample, MagSample, Measurement, TruePose
from tracker.pictures import ArrayPicture
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

RIG = default_rig()
SECONDS = 32.0
CAMERA = "camera-gps-imu/famm"
PRECISE = ("gps-imu/precise", "camera-gps-imu/precise")

Write = Callable[[str, Iterable[Measurement]], Log]


@pytest.fixture(scope="module")
def measurements() -> list[Measurement]:
    """Half a minute, IMU at 100 Hz, a picture of a sliding wall four times a second."""
    walk = Walk(WalkSettings(seed=6, duration_s=SECONDS, still_s=6.0, imu_hz=100.0, truth_hz=50.0, camera_hz=4.0), RIG)
    wall = np.random.default_rng(0).integers(0, 255, (480, 1280, 3), np.uint8)
    frames = [
        Frame(t, late, i, ArrayPicture(wall[:, i * 4 : i * 4 + 640])) for i, (t, late) in enumerate(walk.frame_times())
    ]
    return sorted([*simulate(walk), *frames], key=lambda m: m.t_recv_ns)


@pytest.fixture(scope="module")
def write(tmp_path_factory: pytest.TempPathFactory) -> Write:
    """Writes measurements as a log and opens it."""

    def to_log(name: str, measurements: Iterable[Measurement]) -> Log:
        path = tmp_path_factory.mktemp("evaluate") / f"{name}.mcap"
        measurements = list(measurements)
        has_truth = any(isinstance(m, TruePose) for m in measurements)
        with LogWriter(path, RIG, AGORA_ORIGIN if has_truth else None, t_start_ns=START_NS) as writer:
            for measurement in measurements:
                writer.write(measurement)
        return Log.open(path)

    return to_log


@pytest.fixture(scope="module")
def whole(write: Write, measurements: list[Measurement]) -> Log:
    """Everything."""
    return write("whole", measurements)


@pytest.fixture(scope="module")
def run_whole(whole: Log) -> Callable[[str], Run]:
    """Runs an estimator on everything, once."""
    return cache(lambda name: run(whole, name))


@pytest.fixture(scope="module")
def stripped(write: Write, measurements: list[Measurement]) -> Log:
    """Everything but the truth."""
    return write("stripped", (m for m in measurements if not isinstance(m, TruePose)))


def _rows(result: Run) -> list[tuple[object, ...]]:
    return [
        (p.t_ns, p.p_site_m, p.wxyz_site_body, p.v_site_m_s, p.cov.tobytes(), p.motion_model, p.heading_known)
        for p in result.poses
    ]


@pytest.mark.parametrize("name", ESTIMATORS)
def test_every_figure_is_there(run_whole: Callable[[str], Run], name: str) -> None:
    """The keys that other programs rely on, each a number, or None where the estimator has none."""
    found = figures(run_whole(name))
    is_truth, has_eyes = name == "truth", name.startswith("camera")
    is_paper = not is_truth and not name.endswith("precise")
    assert (found["log"], found["estimator"]) == ("whole", name)
    assert found["duration_s"] == pytest.approx(SECONDS, abs=0.5)
    assert found["realtime_factor"] > 0.0
    assert (found["updates"] > 100) == is_paper
    for key in ("filter_error_m", "filter_error_rad"):
        assert (found[key] is not None) == is_paper
        assert found[key] is None or (found[key]["mean"] > 0.0 and found[key]["std"] > 0.0)
    truth = found["truth"]
    assert set(truth) == {
        "ate_rmse_m", "ate_debiased_rmse_m", "height_rmse_m", "rpe_10s_m", "heading_rmse_deg", "tilt_rmse_deg",
        "orientation_rmse_deg", "jitter_rms_m", "jitter_rms_deg", "nees_per_dim", "nees_heading", "registration_px",
    }  # fmt: skip
    assert all(value is not None for value in truth.values())
    assert truth["ate_debiased_rmse_m"] <= truth["ate_rmse_m"]
    assert truth["ate_rmse_m"] < (1.25 * found["gps"]["held_ate_rmse_m"] if not is_truth else 0.01)
    for distance in ("at_20m", "at_50m"):
        assert truth["registration_px"][distance]["median"] <= truth["registration_px"][distance]["p95"]
    assert (found["latency_ms"]["vision_p50"] is not None) == has_eyes
    assert (found["latency_ms"]["imu_to_pose_p50"] is None) == is_truth
    assert (found["vision_rate_hz"] is not None) == has_eyes
    shares = found["motion_model_share"]
    assert sum(shares.values()) == pytest.approx(0.0 if is_truth else 1.0)
    assert all(re.fullmatch("P[012]R[012]", model) for model in shares)
    counts = found["counts"]
    assert (counts["imu"], counts["frames"] > 100) == (int(SECONDS * 100), has_eyes)
    assert counts["skipped"] == {}


@pytest.mark.parametrize("name", ["gps-imu/cmm", CAMERA, *PRECISE])
def test_ground_truth_teaches_nothing(whole: Log, stripped: Log, measurements: list[Measurement], name: str) -> None:
    """Stripped of it, a log gives bit-identical poses. Its origin is part of the question, so that it is given back."""
    assert not stripped.info.has_truth
    first = next(m for m in measurements if isinstance(m, GpsFix))
    assert log_origin(stripped).lat_deg == first.lat_deg
    with_truth = run(whole, name, origin=log_origin(stripped))
    without = run(stripped, name)
    assert len(without.poses) > 1000
    assert _rows(without) == _rows(with_truth)[: len(without.poses)]
    found = figures(without)
    assert found["truth"] is None
    assert found["gps"] is None


def test_the_same_answer_twice(whole: Log, run_whole: Callable[[str], Run]) -> None:
    """Pictures and RANSAC included."""
    assert _rows(run(whole, CAMERA)) == _rows(run_whole(CAMERA))


def test_truth_without_attitude_or_height_leaves_gaps(write: Write, measurements: list[Measurement]) -> None:
    """Null, never zero."""

    def blinded(m: Measurement) -> Measurement:
        if not isinstance(m, TruePose):
            return m
        v = (0.0, 0.0, 0.0)
        level = (1.0, 0.0, 0.0, 0.0)
        return TruePose(m.t_ns, m.t_recv_ns, m.p_map_body_m, level, v, True, False, False, False, 0.02)

    found = figures(run(write("blind", map(blinded, measurements)), "gps-imu/famm"))["truth"]
    unknown = {key for key, value in found.items() if value is None}
    assert unknown == {
        "height_rmse_m", "heading_rmse_deg", "tilt_rmse_deg", "orientation_rmse_deg", "jitter_rms_deg",
        "nees_heading", "registration_px",
    }  # fmt: skip


@pytest.mark.parametrize("name", ["gps-imu/famm", *PRECISE])
def test_poses_are_causal_and_regular(whole: Log, run_whole: Callable[[str], Run], name: str) -> None:
    """Fifty a second; what arrives after t changes no pose up to t."""
    result = run_whole(name)
    t = np.array([pose.t_ns for pose in result.poses])
    assert (np.diff(t) == 20_000_000).all()

    class Cut:
        """The log until its middle."""

        def __getattr__(self, name: str) -> Any:
            return getattr(whole, name)

        def messages(self, **options: Any) -> Iterable[Measurement]:
            return (m for m in whole.messages(**options) if m.t_recv_ns < START_NS + 20_000_000_000)

    half = run(Cut(), name)  # type: ignore[arg-type]
    assert _rows(half) == _rows(result)[: len(half.poses)]
    assert len(half.poses) > 900


def test_without_a_receiver_precise_is_an_attitude_filter(write: Write, measurements: list[Measurement]) -> None:
    """Tilt and jitter are scored; of its place it says that it may be anywhere."""
    log = write("indoors", (m for m in measurements if not isinstance(m, GpsFix | GpsVelocity | Frame)))
    result = run(log, PRECISE[0])
    found = figures(result)["truth"]
    assert found["tilt_rmse_deg"] < 1.0
    assert min(pose.cov[0, 0] for pose in result.poses) > 1e5


def test_what_is_missing_is_said(write: Write, measurements: list[Measurement]) -> None:
    """A log without a camera cannot run one, an unknown name is named."""
    log = write("plain", (m for m in measurements if not isinstance(m, Frame | MagSample)))
    with pytest.raises(MissingSensor, match=r"plain cannot run camera-gps-imu/famm: it has no camera"):
        run(log, CAMERA)
    with pytest.raises(UnknownEstimator, match="kalman"):
        run(log, "kalman")
    blind = write("blind", (m for m in measurements if not isinstance(m, ImuSample)))
    for name in PRECISE:
        with pytest.raises(MissingSensor, match=rf"blind cannot run {name}: it has no IMU\."):
            run(blind, name)
    done: list[float] = []
    run(log, "gps-imu/cmm", progress=done.append)
    assert done == sorted(done)
    assert 0.9 < done[-1] <= 1.0
