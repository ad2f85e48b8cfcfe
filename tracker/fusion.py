"""The paper's 12-state Kalman filter: x = (P, V, R, Omega), eq. 6, with F of eq. 7 and its velocity coefficients.

F, H and a diagonal Q and R couple each of the six values (position, then roll, pitch, yaw) only with its own rate, so the
12-state filter is exactly six filters of two states. They are computed as such, in plain floats: a sixth of the time of
12 x 12 matrices, and the same numbers (tested against the full matrices).
"""

from dataclasses import dataclass, field

import numpy as np

from tracker.fuzzy import MotionModel
from tracker.geometry import wrap_rad
from tracker.measurements import Matrix, Vector3
from tracker.readings import require_positive


@dataclass(frozen=True)
class FusionSettings:
    """Noise of the filter. The paper gives none; these are our defaults."""

    accel_noise_m_s2: float = 3.0
    """Process noise of V: white acceleration (discrete white-noise acceleration model). Footfalls and tight turns are as large.
    The sweep keeps it (docs/paper.md, "Sensitivity"): with less both errors grow, with 4.5 and more FAMM loses cells to CMM."""
    angular_accel_noise_rad_s2: float = 1.0
    """Process noise of Omega: white angular acceleration."""
    rotation_sigma_rad: float = 0.0044
    """Noise of m_R from one cycle to the next, a quarter of a degree. The slow error of the IMU filter, some degrees, is no
    noise that a Kalman filter can average: calling it that only makes the picture lag behind a turning head."""
    rate_sigma: float = 1.0
    """Start of V and Omega, m/s and rad/s."""

    def __post_init__(self) -> None:
        require_positive(
            accel_noise_m_s2=self.accel_noise_m_s2,
            angular_accel_noise_rad_s2=self.angular_accel_noise_rad_s2,
            rotation_sigma_rad=self.rotation_sigma_rad,
            rate_sigma=self.rate_sigma,
        )


@dataclass
class FusionFilter:
    """Predict, measure, update. Values 0 to 2 are P in metres (site), 3 to 5 are R: roll, pitch, yaw in radians."""

    settings: FusionSettings
    value: list[float]
    rate: list[float] = field(default_factory=lambda: [0.0] * 6)
    var_value: list[float] = field(default_factory=lambda: [0.0] * 6)
    covar: list[float] = field(default_factory=lambda: [0.0] * 6)
    var_rate: list[float] = field(default_factory=lambda: [0.0] * 6)

    @classmethod
    def start(
        cls, settings: FusionSettings, position_m: Vector3, rotation_rad: Vector3, position_var_m2: Vector3
    ) -> "FusionFilter":
        """Return a filter at its first measurement: P0 is R for P and R, and 1 for the rates."""
        filter_ = cls(settings, [*position_m, *rotation_rad])
        filter_.var_value = [*position_var_m2, *[settings.rotation_sigma_rad**2] * 3]
        filter_.var_rate = [settings.rate_sigma**2] * 6
        return filter_

    def predict(self, dt_s: float, model: MotionModel) -> None:
        """Apply F with the model's coefficients: value += c rate dt (eqs. 11 and 12).

        With c = 0 the coupling is gone from F: the rate is kept, and what is learnt of the value teaches nothing of it. Its
        own process noise stays, else a velocity could never be learnt again.
        """
        for axis in range(6):
            c = model.i if axis < 3 else model.j
            noise = self.settings.accel_noise_m_s2 if axis < 3 else self.settings.angular_accel_noise_rad_s2
            q, h = noise * noise, c * dt_s
            self.value[axis] += h * self.rate[axis]
            self.var_value[axis] += h * (2.0 * self.covar[axis] + h * self.var_rate[axis]) + 0.25 * q * dt_s**4
            self.covar[axis] += h * self.var_rate[axis] + (0.5 * q * dt_s**3 if c else 0.0)
            self.var_rate[axis] += q * dt_s * dt_s
        for axis in (3, 4, 5):
            self.value[axis] = wrap_rad(self.value[axis])

    def widen(self, position_var_m2: float) -> None:
        """Doubt the position: after an outage it may be off by more than the measurements that were carried over it said."""
        for axis in range(3):
            self.var_value[axis] += position_var_m2

    def move_to(self, position_m: Vector3) -> None:
        """Take a position as it is: five fixes in a row have said that the old one was wrong."""
        self.value[:3] = position_m

    def turn(self, yaw_rad: float) -> None:
        """Turn about the vertical: north has become known, or better known."""
        self.value[5] = wrap_rad(self.value[5] + yaw_rad)

    def innovation(self, position_m: Vector3, rotation_rad: Vector3) -> tuple[Vector3, Vector3]:
        """Return y = z - H x, eq. 10, in its two parts; angles by the shorter way round."""
        return innovation(self.value, position_m, rotation_rad)

    def update(self, y_p_m: Vector3, y_r_rad: Vector3, position_var_m2: Vector3) -> None:
        """Take an innovation in, eq. 9."""
        rotation_var = self.settings.rotation_sigma_rad**2
        for axis in range(3):
            self._update_axis(axis, y_p_m[axis], position_var_m2[axis])
            self._update_axis(axis + 3, y_r_rad[axis], rotation_var)
            self.value[axis + 3] = wrap_rad(self.value[axis + 3])

    def _update_axis(self, axis: int, y: float, r: float) -> None:
        vv, vr = self.var_value[axis], self.covar[axis]
        s = vv + r
        self.value[axis] += vv / s * y
        self.rate[axis] += vr / s * y
        # the same as (I - K H) P, written so that it cannot turn negative
        self.var_value[axis] = vv * r / s
        self.covar[axis] = vr * r / s
        self.var_rate[axis] -= vr * vr / s

    @property
    def position_m(self) -> Vector3:
        """P in the site frame."""
        return (self.value[0], self.value[1], self.value[2])

    @property
    def velocity_m_s(self) -> Vector3:
        """V in the site frame."""
        return (self.rate[0], self.rate[1], self.rate[2])

    @property
    def rpy_rad(self) -> Vector3:
        """R: roll, pitch, yaw."""
        return (self.value[3], self.value[4], self.value[5])

    def state(self) -> Matrix:
        """Return x, (12,), of eq. 6: (P, V, R, Omega)."""
        return np.array([*self.value[:3], *self.rate[:3], *self.value[3:], *self.rate[3:]])

    def covariance(self) -> Matrix:
        """Return Sigma, (12, 12), in the paper's order."""
        sigma = np.zeros((12, 12))
        for axis in range(6):
            v = axis if axis < 3 else axis + 3
            sigma[v, v] = self.var_value[axis]
            sigma[v, v + 3] = sigma[v + 3, v] = self.covar[axis]
            sigma[v + 3, v + 3] = self.var_rate[axis]
        return sigma


def transition(dt_s: float, model: MotionModel) -> Matrix:
    """Return F, (12, 12), of eq. 7, its velocity terms multiplied by the model's coefficients (eqs. 11 and 12)."""
    F = np.eye(12)
    for axis in range(3):
        F[axis, axis + 3] = model.i * dt_s
        F[axis + 6, axis + 9] = model.j * dt_s
    return F


def innovation(value: list[float], position_m: Vector3, rotation_rad: Vector3) -> tuple[Vector3, Vector3]:
    """Return z - H x for the six values of H x, eq. 10, in its two parts; angles by the shorter way round."""
    x, y, z, roll, pitch, yaw = value
    y_r = (wrap_rad(rotation_rad[0] - roll), wrap_rad(rotation_rad[1] - pitch), wrap_rad(rotation_rad[2] - yaw))
    return (position_m[0] - x, position_m[1] - y, position_m[2] - z), y_r
