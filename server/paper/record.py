"""What the sensors of a case say, cycle by cycle, beside the truth: recorded once, filtered as often as a sweep likes."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import hypot
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.paper.cases import Case, Seen, see
from tracker.cycle import Cycle, CycleFilter, InnovationReading
from tracker.estimators import SELECTORS, SENSORS
from tracker.family import PaperFamily
from tracker.fusion import FusionSettings
from tracker.geomagnetism import declination_rad
from tracker.measurements import Measurement, TruePose, Vector3
from tracker.motion import MotionSelector
from tracker.score import SETTLING_S, Figures, Vector
from tracker.simulate import START_NS


@dataclass(frozen=True, eq=False)
class Recording:
    """The cycles of one case with some sensors."""

    dataset: int
    seed: int
    sensors: str
    cycles: list[Cycle]
    """The first starts a filter, each other is an update."""
    truth_m: Vector
    """(n, 3): where the rig was at each cycle, in site."""

    @property
    def cell(self) -> str:
        """For instance `3/camera-gps-imu`: a cell of the paper's two tables of errors."""
        return f"{self.dataset}/{self.sensors}"


def record_case(dataset: int, seed: int) -> list[dict[str, Any]]:
    """Return a case's recordings, without and with the camera, as JSON holds them (all digits of a float are kept)."""
    seen = see(Case(dataset, seed))
    return [{"dataset": dataset, "seed": seed, "sensors": sensors, **recorded(seen, sensors)} for sensors in SENSORS]


def recorded(seen: Seen, sensors: str) -> dict[str, Any]:
    """Return the cycles of some sensors and the truth at each."""
    origin = seen.walk.settings.origin
    family = PaperFamily(
        sensors,
        {"cmm": SELECTORS["cmm"]()},
        origin=origin,
        rig=seen.walk.rig,
        declination_rad=declination_rad(origin, START_NS),
    )
    for measurement in _sensed(seen.measurements):
        family.step(measurement)
    truth_m = seen.walk.at(np.array([cycle.t_ns for cycle in family.cycles], np.int64)).p_m
    return {"cycles": [_numbers(cycle) for cycle in family.cycles], "truth_m": truth_m.tolist()}


def read_recording(held: dict[str, Any]) -> Recording:
    """Return one of `record_case`'s."""
    cycles = [_cycle(numbers) for numbers in held["cycles"]]
    return Recording(held["dataset"], held["seed"], held["sensors"], cycles, np.array(held["truth_m"], np.float64))


def refilter(
    recording: Recording,
    selector: MotionSelector,
    settings: FusionSettings,
    var_scale: float = 1.0,
    innovation: InnovationReading = "metres",
) -> Figures:
    """Filter a recording and return its figures.

    Args:
        recording: Unchanged by it.
        selector: Chooses the motion model; newly built.
        settings: Q and the rotation's R.
        var_scale: What the position's R is multiplied by.
        innovation: What the selector is given.

    Returns:
        Means of the filter error (m and rad), ATE and the RMS change of the horizontal error from one update to the next
        (`step_m`, m: what is seen as trembling), and the share of the updates that P0R0 predicted.
    """
    filter_ = CycleFilter(selector, settings, innovation)
    p_m, errors_m, errors_rad, at_rest = [], [], [], 0
    for cycle in recording.cycles:
        seen = filter_.step(cycle if var_scale == 1.0 else _scaled(cycle, var_scale))
        p_m.append(_position(filter_))
        if seen is not None:
            errors_m.append(hypot(*seen.position_m))
            errors_rad.append(hypot(*seen.rotation_rad))
            at_rest += seen.motion_model == "P0R0"
    ate_m, step_m = _against_truth(recording, np.array(p_m))
    return {
        "filter_error_m": float(np.mean(errors_m)),
        "filter_error_rad": float(np.mean(errors_rad)),
        "ate_m": ate_m,
        "step_m": step_m,
        "p0r0_share": at_rest / len(errors_m),
    }


def _against_truth(recording: Recording, p_m: Vector) -> tuple[float, float]:
    t_ns: NDArray[np.int64] = np.array([cycle.t_ns for cycle in recording.cycles], np.int64)
    settled = t_ns - START_NS >= SETTLING_S * 1e9
    error = (p_m - recording.truth_m)[settled, :2]
    steps = np.diff(error, axis=0)
    return float(np.sqrt(np.mean(np.sum(error**2, axis=1)))), float(np.sqrt(np.mean(np.sum(steps**2, axis=1))))


def _position(filter_: CycleFilter) -> Vector3:
    if filter_.filter is None:
        raise RuntimeError("a filter has taken a cycle without starting")
    return filter_.filter.position_m


def _sensed(measurements: Iterable[Measurement]) -> Iterable[Measurement]:
    return (measurement for measurement in measurements if not isinstance(measurement, TruePose))


def _scaled(cycle: Cycle, var_scale: float) -> Cycle:
    x, y, z = cycle.var_P_m2
    var_P_m2 = (x * var_scale, y * var_scale, z * var_scale)
    return Cycle(cycle.t_ns, cycle.m_P, var_P_m2, cycle.m_R, cycle.turned_rad, cycle.widened_m2, cycle.moved_to)


def _numbers(cycle: Cycle) -> list[Any]:
    moved = list(cycle.moved_to) if cycle.moved_to is not None else None
    return [cycle.t_ns, *cycle.m_P, *cycle.var_P_m2, *cycle.m_R, cycle.turned_rad, cycle.widened_m2, moved]


def _cycle(numbers: list[Any]) -> Cycle:
    t_ns, px, py, pz, vx, vy, vz, roll, pitch, yaw, turned_rad, widened_m2, moved = numbers
    moved_to = (moved[0], moved[1], moved[2]) if moved is not None else None
    return Cycle(t_ns, (px, py, pz), (vx, vy, vz), (roll, pitch, yaw), turned_rad, widened_m2, moved_to)
