"""A site laid one eye height below the first pose: every pose lifted by as much as the first, whatever is done in between."""

from dataclasses import replace

import pytest

from tracker.estimator import Estimator
from tracker.estimators import build
from tracker.levelled import Levelled
from tracker.measurements import Measurement, Outcome, Sighting, Standpoint
from tracker.rig import Rig
from tracker.simulate import AGORA_ORIGIN, START_NS, Walk, WalkSettings, default_rig, simulate

S = 1_000_000_000
EYES_M = 1.65
NAMES = ("gps-imu/famm", "gps-imu/precise", "truth")


@pytest.fixture(scope="module")
def measurements() -> list[Measurement]:
    """Twenty seconds."""
    return list(simulate(Walk(WalkSettings(seed=3, duration_s=20.0, still_s=4.0, imu_hz=100.0), default_rig())))


def _other(name: str) -> Estimator:
    return build(name, origin=AGORA_ORIGIN, rig=Rig(), declination_rad=0.0)


def _height_m(estimator: Estimator, t_ns: int) -> float:
    pose = estimator.predict(t_ns)
    assert pose is not None
    return pose.p_site_m[2]


@pytest.mark.parametrize("name", NAMES)
def test_the_first_pose_is_at_the_eyes_and_all_others_where_they_are_from_it(
    measurements: list[Measurement], name: str
) -> None:
    levelled, other = Levelled(_other(name), EYES_M), _other(name)
    lift_m = None
    for measurement in measurements:
        assert levelled.step(measurement) == other.step(measurement)
        t_ns = measurement.t_ns
        assert (levelled.predict(t_ns) is None) == (other.predict(t_ns) is None)
        if lift_m is None and other.predict(t_ns) is not None:
            assert _height_m(levelled, t_ns) == pytest.approx(EYES_M)
            lift_m = EYES_M - _height_m(other, t_ns)
    assert lift_m is not None
    assert _height_m(levelled, START_NS + 20 * S) == pytest.approx(_height_m(other, START_NS + 20 * S) + lift_m)
    assert (levelled.name, levelled.uses_camera) == (name, False)
    assert len(levelled.innovations()) == len(other.innovations())


def test_going_back_to_before_the_first_pose_finds_the_same_lift(measurements: list[Measurement]) -> None:
    levelled = Levelled(_other("gps-imu/precise"), EYES_M)
    fresh = levelled.snapshot()
    seen = []
    for _ in range(2):
        for measurement in measurements:
            levelled.step(measurement)
        seen.append(_height_m(levelled, START_NS + 20 * S))
        levelled.restore(fresh)
        assert levelled.predict(START_NS + 20 * S) is None
    assert seen[0] == seen[1]


def test_what_visitors_say_of_heights_is_lowered_as_poses_are_lifted(measurements: list[Measurement]) -> None:
    levelled, other = Levelled(_other("gps-imu/precise"), EYES_M), _other("gps-imu/precise")
    for measurement in measurements:
        levelled.step(measurement)
        other.step(measurement)
    t_ns = measurements[-1].t_ns
    lift_m = _height_m(levelled, t_ns) - _height_m(other, t_ns)
    assert abs(lift_m) > 0.1
    for of, up_m in ((levelled, lift_m), (other, 0.0)):
        assert of.step(Sighting(t_ns, t_ns, (9.0, 9.0, 3.0 + up_m), (0.0, 0.0, 1.0), 0.3)) is Outcome.USED
        assert of.step(Standpoint(t_ns, t_ns, (1.0, 2.0, 1.0 + up_m), 0.3)) is Outcome.USED
    lowered, told = levelled.snapshot()[0][1].waiting, other.snapshot()[1].waiting
    assert [_to_a_nanometre(one) for one in lowered] == [_to_a_nanometre(one) for one in told]


def _to_a_nanometre(waiting: Measurement) -> Measurement:
    """Return a measurement, what visitors said in it rounded: what is added and taken away again may end beside where it began."""
    match waiting:
        case Sighting():
            x, y, z = waiting.point_site_m
            return replace(waiting, point_site_m=(x, y, round(z, 9)))
        case Standpoint():
            x, y, z = waiting.p_site_m
            return replace(waiting, p_site_m=(x, y, round(z, 9)))
    return waiting
