"""The interface that every estimator shares: feed measurements, read poses.

An estimator is sans-I/O: no clock, thread, file or log inside; one owner; the same measurements in the same order give the same
poses, bit for bit. Position is ENU about an origin that the composition root passes in.
"""

from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from tracker.measurements import Matrix, Measurement, Outcome, Vector3, Wxyz

NO_MOTION_MODEL = "-"
"""Said of a pose whose estimator has none."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Where the rig is and looks at `t_ns`, with its covariance."""

    t_ns: int
    p_site_m: Vector3
    wxyz_site_body: Wxyz
    v_site_m_s: Vector3
    cov: Matrix
    """(6, 6): position in site (m²), then rotation vector in site (rad²)."""
    motion_model: str
    """`P0R0` … `P2R2`, or `NO_MOTION_MODEL`."""
    heading_known: bool
    """False until something (magnetometer, compass, course, truth) has given north."""


@dataclass(frozen=True, slots=True)
class Innovation:
    """What one filter update saw: the paper's filter error, before the update."""

    t_ns: int
    position_m: Vector3
    rotation_rad: Vector3
    """Wrapped to [-pi, pi); roll, pitch, yaw as the paper's R."""
    motion_model: str
    """The model that made the prediction."""


Snapshot: TypeAlias = Any
"""An estimator's whole state; opaque, immutable, only given back to `restore` of an estimator built alike."""


class Estimator(Protocol):
    """What the runner, the evaluator and the server know of an estimator."""

    @property
    def name(self) -> str:
        """For instance `camera-gps-imu/famm`."""
        ...

    @property
    def uses_camera(self) -> bool:
        """Whether it wants `VisualMotion`; if not, no picture is decoded for it."""
        ...

    def step(self, measurement: Measurement) -> Outcome:
        """Take one measurement, in order of arrival (`t_recv_ns`)."""
        ...

    def predict(self, t_ns: int) -> Pose | None:
        """Return the pose at `t_ns` from what has been stepped so far; None before initialisation.

        Pure: calling it changes nothing. `t_ns` may lie up to a second in the past (a picture is shown with the pose of
        its own capture) or in the future.
        """
        ...

    def innovations(self) -> list[Innovation]:
        """Return the filter updates since the last call, oldest first, and forget them."""
        ...

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        ...

    def restore(self, snapshot: Snapshot) -> None:
        """Become what `snapshot` was taken of: what follows is bit-identical."""
        ...


@dataclass(frozen=True)
class Origin:
    """Where an ENU frame is laid."""

    lat_deg: float
    lon_deg: float
    h_ellipsoid_m: float
