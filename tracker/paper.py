"""The paper's tracker: measurements m_P and m_R of three sensors into the 12-state filter, four times a second.

`SensorPose` turns sensors into measurements, `CycleFilter` filters them, and this answers for any time between two cycles.

Reference:
    Bostanci et al., Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models, arXiv 1512.02766.
"""

from copy import deepcopy
from dataclasses import dataclass, field
from math import pi, sqrt

import numpy as np

from tracker.cycle import Cycle, CycleFilter, InnovationReading
from tracker.estimator import Innovation, Origin, Pose, Snapshot
from tracker.fusion import FusionSettings
from tracker.fuzzy import FuzzySettings
from tracker.geometry import conjugate, multiply, normalise, wxyz_from_rpy, wxyz_from_yaw
from tracker.inertial import InertialState
from tracker.measurements import Matrix, Measurement, Outcome
from tracker.motion import MotionSelector
from tracker.readings import SensorSettings
from tracker.rig import Rig
from tracker.sensor_pose import SensorPose


@dataclass(frozen=True)
class PaperSettings:
    """What the paper leaves open, and which of its readings are taken."""

    sensors: SensorSettings = field(default_factory=SensorSettings)
    fusion: FusionSettings = field(default_factory=FusionSettings)
    fuzzy: FuzzySettings = field(default_factory=FuzzySettings)
    innovation: InnovationReading = "metres"
    """What the controller is given: metres (and radians), or nis: divided by what the filter expected of it."""
    tilt_sigma_rad: float = 0.017
    """What Madgwick's filter is good for; the filter's own R only holds its noise."""
    heading_sigma_rad: float = 0.09
    """What Madgwick's filter and the start heading are good for; the filter's own R only holds their noise."""


class PaperEstimator:
    """GPS-IMU or camera-GPS-IMU, with a constant or a fuzzy motion model: the paper's four columns, and their rivals."""

    def __init__(
        self,
        name: str,
        selector: MotionSelector,
        *,
        origin: Origin,
        rig: Rig,
        declination_rad: float,
        uses_camera: bool,
        settings: PaperSettings | None = None,
        sensors: SensorPose | None = None,
    ) -> None:
        """`sensors` are a family's (`tracker/family.py`), which steps them for all its members; None for its own."""
        self._name = name
        self._uses_camera = uses_camera
        self._settings = settings or PaperSettings()
        self._sensors = sensors or SensorPose(self._settings.sensors, origin, rig, declination_rad, uses_camera)
        self._fusion = CycleFilter(selector, self._settings.fusion, self._settings.innovation)
        self._yaw_offset_rad: float | None = None
        """Where north was in the last cycle."""
        self._innovations: list[Innovation] = []

    @property
    def name(self) -> str:
        """For instance `camera-gps-imu/famm`."""
        return self._name

    @property
    def uses_camera(self) -> bool:
        """Whether it wants `VisualMotion`."""
        return self._uses_camera

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement in order of arrival."""
        outcome = self._sensors.step(measurement)
        cycle = self._sensors.take()
        if cycle is not None:
            self.filter(cycle)
        return outcome

    def filter(self, cycle: Cycle) -> None:
        """Take what the sensors have just made."""
        self._yaw_offset_rad = self._sensors.yaw_offset_rad
        innovation = self._fusion.step(cycle)
        if innovation is not None:
            self._innovations.append(innovation)

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at t_ns: the last filtered one, moved by the inertial path between its cycle and t_ns."""
        path = self._sensors.path
        return self.carried(t_ns, path.at(t_ns), path.at(self._fusion.t_ns))

    def carried(self, t_ns: int, then: InertialState | None, cycle: InertialState | None) -> Pose | None:
        """Return the pose at t_ns, where the inertial path is at that time and at the last cycle's known."""
        filter_ = self._fusion.filter
        if filter_ is None or then is None or cycle is None:
            return None
        x, y, z = (p + a - b for p, a, b in zip(filter_.position_m, then.p_m, cycle.p_m, strict=True))
        turned = multiply(conjugate(cycle.wxyz_level_body), then.wxyz_level_body)
        q = multiply(wxyz_from_rpy(filter_.rpy_rad), turned)
        yaw_rad = self._sensors.yaw_offset_rad
        if yaw_rad is not None and yaw_rad != self._yaw_offset_rad:
            q = multiply(wxyz_from_yaw(yaw_rad - (self._yaw_offset_rad or 0.0)), q)
        covariance = self._covariance(t_ns, filter_.var_value)
        return Pose(t_ns, (x, y, z), normalise(q), then.v_m_s, covariance, str(self._fusion.model), yaw_rad is not None)

    def _covariance(self, t_ns: int, var_value: list[float]) -> Matrix:
        """What a reader should believe. The filter takes GPS errors for white, but they last for minutes, and so does the
        error of the start heading: what averaging cannot remove is added back."""
        fix, settings = self._sensors.fix, self._settings
        if fix is None:
            raise RuntimeError("a filter has started without a fix")
        doubt = self._sensors.doubt_m2(t_ns)
        heading = settings.heading_sigma_rad if self._sensors.yaw_offset_rad is not None else pi / sqrt(3.0)
        rotation = (settings.tilt_sigma_rad**2, settings.tilt_sigma_rad**2, heading**2)
        position = (v + f + doubt for v, f in zip(var_value[:3], fix.var_m2, strict=True))
        return np.diag([*position, *(r + v for r, v in zip(rotation, var_value[3:], strict=True))])

    def state_covariance(self) -> Matrix | None:
        """Return the filter's own Sigma, (12, 12), in the paper's order; None before its start."""
        return self._fusion.filter.covariance() if self._fusion.filter is not None else None

    def innovations(self) -> list[Innovation]:
        """Return the updates since the last call and forget them."""
        innovations, self._innovations = self._innovations, []
        return innovations

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return deepcopy((self._sensors, self._fusion, self._yaw_offset_rad, self._innovations))

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._sensors, self._fusion, self._yaw_offset_rad, self._innovations = deepcopy(snapshot)
