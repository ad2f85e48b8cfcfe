"""How the filter starts: on the ground from its first pose on, and with what the rig learned of its sensors before."""

from dataclasses import replace
from functools import partial
from math import hypot

import numpy as np
import pytest

from tests.tracker.precise.stream import NAMES, S, estimator
from tracker.measurements import ImuSample, Measurement, Standpoint, TruePose
from tracker.precise.estimator import PreciseEstimator
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

ALIGNED_NS, STOPPED_NS, AGAIN_NS = START_NS + 38 * S, START_NS + 40 * S, START_NS + 50 * S
SEED = 104
begun = partial(estimator, NAMES[0])


@pytest.fixture(scope="module")
def walk() -> Walk:
    """A minute and a quarter."""
    return Walk(WalkSettings(seed=SEED, duration_s=75.0, imu_hz=100.0, mag_hz=5.0), default_rig())


@pytest.fixture(scope="module")
def measurements(walk: Walk) -> list[Measurement]:
    """Without truth."""
    return [m for m in simulate(walk) if not isinstance(m, TruePose)]


@pytest.fixture(scope="module")
def learned(walk: Walk, measurements: list[Measurement]) -> PreciseEstimator:
    """A first session, which was told where it stood two seconds before its end."""
    estimator = begun()
    for measurement in measurements:
        if measurement.t_recv_ns < STOPPED_NS:
            estimator.step(measurement)
        if isinstance(measurement, ImuSample) and measurement.t_ns == ALIGNED_NS:
            estimator.step(Standpoint(ALIGNED_NS, measurement.t_recv_ns, place(walk, ALIGNED_NS), 0.1))
    return estimator


def place(walk: Walk, t_ns: int) -> tuple[float, float, float]:
    x, y, z = walk.at(np.array([t_ns])).p_m[0].tolist()
    return (x, y, z)


def off_m(estimator: PreciseEstimator, walk: Walk, measurements: list[Measurement]) -> float:
    """Return how far it is off in the middle, over twenty seconds from its start on."""
    found = []
    for measurement in measurements:
        if measurement.t_ns >= AGAIN_NS and measurement.t_recv_ns < AGAIN_NS + 20 * S:
            estimator.step(measurement)
            pose = estimator.predict(measurement.t_ns)
            if isinstance(measurement, ImuSample) and pose is not None:
                x, y, _ = place(walk, measurement.t_ns)
                found.append(hypot(pose.p_site_m[0] - x, pose.p_site_m[1] - y))
    return float(np.median(found))


def test_the_first_pose_stands_on_the_ground(walk: Walk, measurements: list[Measurement]) -> None:
    estimator = begun(eyes_z_m=lambda east, north: 1.65)
    pose = None
    for measurement in measurements:
        estimator.step(measurement)
        pose = pose or estimator.predict(measurement.t_ns)
    assert pose is not None
    assert abs(pose.p_site_m[2] - place(walk, pose.t_ns)[2]) < 0.2


def test_a_known_place_still_helps_after_the_next_start(
    walk: Walk, measurements: list[Measurement], learned: PreciseEstimator
) -> None:
    memory = learned.memory()
    assert memory is not None
    assert off_m(begun(memory=memory), walk, measurements) < 0.6 * off_m(begun(), walk, measurements)


def test_before_a_first_fix_there_is_nothing_to_remember() -> None:
    assert begun().memory() is None


def test_remembering_changes_nothing(measurements: list[Measurement]) -> None:
    asked, silent = begun(), begun()
    for measurement in measurements[:3000]:
        asked.step(measurement)
        silent.step(measurement)
        asked.memory()
    one, other = (estimator.predict(measurements[3000].t_ns) for estimator in (asked, silent))
    assert one is not None
    assert other is not None
    assert (one.p_site_m, one.wxyz_site_body) == (other.p_site_m, other.wxyz_site_body)


def test_over_a_leap_of_the_clock_the_sensors_stay_known(
    measurements: list[Measurement], learned: PreciseEstimator
) -> None:
    """The filter begins anew, and a snapshot knows of it what the filter knows."""
    estimator = begun()
    estimator.restore(learned.snapshot())
    later = [
        replace(m, t_ns=m.t_ns + 120 * S, t_recv_ns=m.t_recv_ns + 120 * S)
        for m in measurements
        if isinstance(m, ImuSample) and m.t_ns < START_NS + S
    ]
    for measurement in later:
        estimator.step(measurement)
    before = learned.memory()
    assert before is not None
    assert estimator.snapshot()[-1].mean == pytest.approx(before.mean)
