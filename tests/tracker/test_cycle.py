"""One cycle of the paper's filter: what it sees, what it answers to, and that a recording of cycles serves every filter."""

from dataclasses import replace
from math import hypot, sqrt

import pytest

from tracker.cycle import Cycle, CycleFilter, InnovationReading
from tracker.fusion import FusionSettings
from tracker.fuzzy import MotionModel
from tracker.measurements import Measurement
from tracker.motion import ConstantMotion, FuzzyMotion, InteractingMotion, MotionSelector
from tracker.paper import PaperEstimator
from tracker.readings import SensorSettings
from tracker.sensor_pose import SensorPose
from tracker.simulate import AGORA_ORIGIN, Walk, WalkSettings, default_rig, simulate

SECOND_NS = 1_000_000_000
START = Cycle(SECOND_NS, (1.0, 2.0, 3.0), (4.0, 4.0, 9.0), (0.0, 0.0, 0.5))


class Listener(ConstantMotion):
    """CMM that keeps what it was told."""

    def __init__(self) -> None:
        self.told: list[tuple[float, float]] = []

    def following(self, y_p_m: float, y_r_rad: float, filter_: object, model: MotionModel) -> MotionModel:
        """Keep the sizes."""
        self.told.append((y_p_m, y_r_rad))
        return model


def _later(**changes: object) -> Cycle:
    return replace(START, t_ns=START.t_ns + SECOND_NS // 4, **changes)  # type: ignore[arg-type]


def _started(selector: MotionSelector, innovation: InnovationReading = "metres") -> CycleFilter:
    filter_ = CycleFilter(selector, FusionSettings(), innovation)
    assert filter_.step(START) is None
    return filter_


def test_the_first_cycle_is_the_start() -> None:
    filter_ = _started(ConstantMotion()).filter
    assert filter_ is not None
    assert filter_.position_m == START.m_P
    assert filter_.rpy_rad == START.m_R
    assert filter_.var_value[:3] == list(START.var_P_m2)


def test_an_innovation_is_what_the_start_did_not_foresee() -> None:
    """The filter starts at rest, so the second cycle's innovation is the step between the two measurements."""
    seen = _started(ConstantMotion()).step(_later(m_P=(1.5, 2.0, 3.0), m_R=(0.0, 0.0, 0.6)))
    assert seen is not None
    assert seen.position_m == pytest.approx((0.5, 0.0, 0.0))
    assert seen.rotation_rad == pytest.approx((0.0, 0.0, 0.1))
    assert seen.motion_model == "P1R1"


def test_the_selector_is_told_metres_and_radians() -> None:
    listener = Listener()
    _started(listener).step(_later(m_P=(1.3, 2.4, 3.0), m_R=(0.0, 0.0, 0.4)))
    assert listener.told == [pytest.approx((0.5, 0.1))]


def test_or_how_surprising_they_are() -> None:
    """`nis`: the square root of y' S^-1 y, S of the prediction; a larger R makes the same innovation less surprising."""
    listener = Listener()
    cycles = _started(listener, "nis")
    cycle = _later(m_P=(1.3, 2.4, 3.0), m_R=(0.0, 0.0, 0.4))
    reference = _started(ConstantMotion()).filter
    assert reference is not None
    reference.predict(0.25, MotionModel(1, 1))
    s = [v + r for v, r in zip(reference.var_value[:3], cycle.var_P_m2, strict=True)]
    cycles.step(cycle)
    told_p, told_r = listener.told[0]
    assert told_p == pytest.approx(sqrt(0.3**2 / s[0] + 0.4**2 / s[1]))
    assert told_r == pytest.approx(0.1 / sqrt(reference.var_value[5] + FusionSettings().rotation_sigma_rad ** 2))


@pytest.mark.parametrize("selector", [ConstantMotion, FuzzyMotion, InteractingMotion])
def test_a_turn_of_north_is_no_innovation(selector: type[MotionSelector]) -> None:
    """Where the sensors say that the whole past is turned, the filter turns with it."""
    turned = (START.m_R[0], START.m_R[1], START.m_R[2] + 1.0)
    seen = _started(selector()).step(_later(m_R=turned, turned_rad=1.0))
    assert seen is not None
    assert hypot(*seen.rotation_rad) < 1e-9


@pytest.mark.parametrize("selector", [ConstantMotion, FuzzyMotion, InteractingMotion])
def test_a_receiver_that_insists_is_followed(selector: type[MotionSelector]) -> None:
    seen = _started(selector()).step(_later(m_P=(100.0, 2.0, 3.0), moved_to=(100.0, 2.0, 3.0)))
    assert seen is not None
    assert hypot(*seen.position_m) < 1e-9


def test_doubt_makes_the_filter_follow_its_measurement() -> None:
    """After an outage the position is doubted, and the next measurement weighs more."""
    far = {"m_P": (11.0, 2.0, 3.0)}
    sure, doubting = _started(ConstantMotion()), _started(ConstantMotion())
    sure.step(_later(**far))
    doubting.step(_later(**far, widened_m2=100.0))
    assert sure.filter is not None
    assert doubting.filter is not None
    assert sure.filter.position_m[0] < doubting.filter.position_m[0] < 11.0


@pytest.mark.parametrize("selector", [ConstantMotion, FuzzyMotion, InteractingMotion])
def test_recorded_cycles_give_the_estimators_own_innovations(selector: type[MotionSelector]) -> None:
    """A study may filter a recording of cycles: the very numbers that the estimator finds among its sensors."""
    walk = Walk(WalkSettings(seed=2, duration_s=25.0), default_rig())
    measurements: list[Measurement] = list(simulate(walk))
    sensors = SensorPose(SensorSettings(), AGORA_ORIGIN, walk.rig, 0.1, uses_camera=False)
    cycles = []
    for measurement in measurements:
        sensors.step(measurement)
        cycle = sensors.take()
        if cycle is not None:
            cycles.append(cycle)
    alone = CycleFilter(selector(), FusionSettings())
    recorded = [seen for seen in map(alone.step, cycles) if seen is not None]
    whole = PaperEstimator(
        "gps-imu", selector(), origin=AGORA_ORIGIN, rig=walk.rig, declination_rad=0.1, uses_camera=False
    )
    for measurement in measurements:
        whole.step(measurement)
    assert recorded == whole.innovations()
    assert len(recorded) > 80


def test_cycles_keep_the_beat() -> None:
    """Four a second: between the first and the last, none is missing and none is doubled."""
    walk = Walk(WalkSettings(seed=3, duration_s=20.0), default_rig())
    sensors = SensorPose(SensorSettings(), AGORA_ORIGIN, walk.rig, 0.1, uses_camera=False)
    stamps = []
    for measurement in simulate(walk):
        sensors.step(measurement)
        cycle = sensors.take()
        if cycle is not None:
            stamps.append(cycle.t_ns)
    assert len(stamps) == pytest.approx((stamps[-1] - stamps[0]) / (SECOND_NS / 4) + 1, abs=0.1)
