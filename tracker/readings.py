"""How the paper is read where its text is silent, ambiguous or literally wrong: one settings object."""

from dataclasses import dataclass
from math import inf
from typing import Literal, TypeAlias

from tracker.measurements import Vector3

#: How "m_P = Tr x m_gps + m_imu" is read. `keyframe_local`: the fix, and the camera's displacement since the keyframe nearest
#: to it. `literal_enu`, `literal_ecef`: the matrix times the fix as it stands, about the site's origin or the Earth's centre.
PositionReading: TypeAlias = Literal["keyframe_local", "literal_enu", "literal_ecef"]
#: How m_imu is read. `sane`: turned to the site's axes, gravity removed, integrated since the last fix. `literal`: four samples in
#: the rig's own axes, their mean at rest subtracted.
InertialReading: TypeAlias = Literal["sane", "literal"]


@dataclass(frozen=True)
class SensorSettings:
    """What the paper leaves open of its sensors."""

    cycle_s: float = 0.25
    """Its camera's four keyframes a second."""
    m_P: PositionReading = "keyframe_local"
    """keyframe_local: the fix, and the camera's displacement since; literal_enu, literal_ecef: Tr times the fix, about the site's
    origin or the Earth's centre."""
    m_imu: InertialReading = "sane"
    """sane: turned to the site, gravity removed, integrated since the fix; literal: four samples, their mean at rest subtracted."""
    calibration: bool = True
    """Subtract the gyroscope's mean over the rest at the start of a walk: the paper's 5000 samples."""
    mean_samples: int = 4
    """Inertial samples that are averaged: the paper's four."""
    gps_var_m2: Vector3 = (2.12**2, 2.12**2, 4.0**2)
    """For a receiver that states none: 2.5 m CEP."""
    gps_floor_m: float = 1.0
    """A receiver that states less is not believed."""
    anchor_s: float = 10.0
    """How long a fix is remembered where the camera's path carries it on: its white error averages out, its drift does not."""
    anchor_imu: bool = False
    """Let the IMU's path carry them where there is no camera (not in the paper; to tell what of a gain is the camera's own)."""
    camera_north: bool = True
    """Correct the start heading by the angle that the camera finds between its travel and the path (not in the paper)."""
    fastest_walk_m_s: float = 2.0
    """A camera's step is never longer than this speed makes it."""
    outage_speed_m_s: float = 0.5
    """An old fix is off by this much more for every second of its age."""
    velocity_held_s: float = 3.0
    """A receiver that has told no velocity for this long tells none: its fixes' displacements are used."""

    def __post_init__(self) -> None:
        require_positive(
            cycle_s=self.cycle_s,
            mean_samples=self.mean_samples,
            gps_var_m2=min(self.gps_var_m2),
            gps_floor_m=self.gps_floor_m,
            anchor_s=self.anchor_s,
            fastest_walk_m_s=self.fastest_walk_m_s,
            outage_speed_m_s=self.outage_speed_m_s,
            velocity_held_s=self.velocity_held_s,
        )


def require_positive(**values: float) -> None:
    """Raise ValueError for the first value that is not a finite number above zero."""
    for name, value in values.items():
        if not 0.0 < value < inf:
            raise ValueError(f"{name} must be a number above zero, not {value}")
