"""A family of motion models: each member's run is the one that its estimator would have had alone."""

import numpy as np
import pytest

from tracker.estimators import SELECTORS, build
from tracker.evaluate import Run, figures, follow
from tracker.family import PaperFamily, follow_family
from tracker.geomagnetism import declination_rad
from tracker.measurements import Measurement, TruePose, VisualMotion
from tracker.pipeline import Pipeline
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

SECONDS = 32.0
DECLINATION_RAD = declination_rad(AGORA_ORIGIN, START_NS)


def _seen(walk: Walk) -> list[Measurement]:
    """What a perfect camera would say of the walk, four times a second, each picture against the one before."""
    stamps = walk.stamps(4.0)
    T = [walk.T_site_cam(int(t)) for t in stamps]
    motions: list[Measurement] = []
    for i in range(1, len(stamps)):
        T_key_cam = np.linalg.inv(T[i - 1]) @ T[i]
        x, y, z = (T_key_cam[:3, 3] / max(float(np.linalg.norm(T_key_cam[:3, 3])), 1e-9)).tolist()
        t_ns, key_ns = int(stamps[i]), int(stamps[i - 1])
        motions.append(VisualMotion(t_ns, t_ns + 38_000_000, key_ns, i, T_key_cam[:3, :3], (x, y, z), 80, 12.0, True))
    return motions


@pytest.fixture(scope="module")
def measurements() -> list[Measurement]:
    """Half a minute of walking, with a camera."""
    walk = Walk(WalkSettings(seed=6, duration_s=SECONDS, still_s=6.0, imu_hz=100.0, truth_hz=50.0), default_rig())
    return sorted([*simulate(walk), *_seen(walk)], key=lambda m: m.t_recv_ns)


def _family(sensors: str) -> PaperFamily:
    selectors = {name: selector() for name, selector in SELECTORS.items()}
    return PaperFamily(sensors, selectors, origin=AGORA_ORIGIN, rig=default_rig(), declination_rad=DECLINATION_RAD)


def _template(name: str) -> Run:
    return Run("walk", name, START_NS, SECONDS, AGORA_ORIGIN, AGORA_ORIGIN)


def _alone(name: str, measurements: list[Measurement]) -> Run:
    estimator = build(
        name, origin=AGORA_ORIGIN, rig=default_rig(), declination_rad=DECLINATION_RAD, truth_origin=AGORA_ORIGIN
    )
    result = _template(name)
    follow(Pipeline(estimator), measurements, result)
    return result


def _rows(run: Run) -> list[tuple[object, ...]]:
    return [
        (p.t_ns, p.p_site_m, p.wxyz_site_body, p.v_site_m_s, p.motion_model, p.heading_known, p.cov.tobytes())
        for p in run.poses
    ]


@pytest.mark.parametrize("sensors", ["gps-imu", "camera-gps-imu"])
def test_a_member_runs_as_if_alone(sensors: str, measurements: list[Measurement]) -> None:
    """Poses, innovations, Sigma and every figure that is not a time, bit for bit."""
    for run in follow_family(_family(sensors), measurements, _template("family")):
        alone = _alone(run.estimator, measurements)
        assert len(run.poses) > 1000
        assert _rows(run) == _rows(alone)
        assert run.innovations == alone.innovations
        assert run.state_covariance is not None
        assert alone.state_covariance is not None
        assert run.state_covariance.tobytes() == alone.state_covariance.tobytes()
        times = {"latency_ms", "realtime_factor"}
        mine, its = figures(run), figures(alone)
        assert {k: v for k, v in mine.items() if k not in times} == {k: v for k, v in its.items() if k not in times}


def test_members_differ_and_the_camera_counts(measurements: list[Measurement]) -> None:
    """The comparison is between different things: no two members, and no two sets of sensors, give the same."""
    ends = {
        run.estimator: run.poses[-1].p_site_m
        for sensors in ("gps-imu", "camera-gps-imu")
        for run in follow_family(_family(sensors), measurements, _template("family"))
    }
    assert ends["gps-imu/cmm"] != ends["gps-imu/famm"] != ends["gps-imu/imm"]
    assert ends["gps-imu/cmm"] != ends["camera-gps-imu/cmm"]


def test_its_cycles_are_what_its_members_took(measurements: list[Measurement]) -> None:
    """One more than there are updates: the first starts the filter."""
    family = _family("gps-imu")
    run = follow_family(family, measurements, _template("family"))[0]
    assert [c.t_ns for c in family.cycles[1:]] == [i.t_ns for i in run.innovations]


def test_after_a_restore_it_goes_on_as_one(measurements: list[Measurement]) -> None:
    """A snapshot holds sensors and members together: all go on, not the first alone."""
    sensed = [m for m in measurements if not isinstance(m, TruePose)]
    half = len(sensed) // 2
    family = _family("gps-imu")
    for measurement in sensed[:half]:
        family.step(measurement)
    snapshot = family.snapshot()
    ends = []
    for _ in range(2):
        for measurement in sensed[half:]:
            family.step(measurement)
        poses = [member.predict(sensed[-1].t_recv_ns) for member in family.members]
        ends.append([pose.p_site_m for pose in poses if pose is not None])
        family.restore(snapshot)
    assert len(ends[0]) == len(family.members)
    assert ends[0] == ends[1]


def test_a_family_has_members() -> None:
    """One of none has nothing to say."""
    with pytest.raises(ValueError, match="at least one"):
        PaperFamily("gps-imu", {}, origin=AGORA_ORIGIN, rig=default_rig(), declination_rad=0.0)
