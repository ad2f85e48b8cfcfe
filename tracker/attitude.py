"""Attitude from gyroscope and accelerometer: the filter of Madgwick's 2010 report, in plain floats.

S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010, section 3 (IMU form).
"""

from math import sqrt

from tracker.geometry import exp, multiply, normalise, wxyz_level_from_gravity
from tracker.measurements import Vector3, Wxyz

#: rad/s: gyro error that the gradient step can undo; the report's value for its 6-axis experiment.
MADGWICK_BETA = 0.033
#: The first sample gives the tilt to a few degrees, and the gain above would need seconds to mend it: it begins larger and
#: comes down to its value in this time (as x-io's own implementation of the filter does).
START_BETA = 0.1
START_S = 1.0


class Madgwick:
    """Attitude of the body against a level frame whose yaw is wherever it was at the start.

    The angular rate is integrated with the exponential map instead of the report's first-order step, so that a phone's
    16 Hz samples integrate as exactly as a Phidget's 250 Hz; the correction is the report's.
    """

    def __init__(self, beta: float = MADGWICK_BETA) -> None:
        self._beta = beta
        self._age_s = 0.0
        self.wxyz_level_body: Wxyz | None = None
        """None until the first specific force has given the tilt; yaw starts at 0."""

    def update(self, gyro_rad_s: Vector3, accel_m_s2: Vector3, dt_s: float) -> Wxyz:
        """Advance by dt_s and return the attitude.

        Args:
            gyro_rad_s: Mean rate over the step, bias removed.
            accel_m_s2: Specific force; at rest and level (0, 0, +9.81). Its offset must not have been subtracted: it
                contains gravity, which is what levels the filter.
            dt_s: Step, >= 0.
        """
        q = self.wxyz_level_body
        if q is None:
            q = wxyz_level_from_gravity(accel_m_s2)
        else:
            gx, gy, gz = gyro_rad_s
            q = multiply(q, exp((gx * dt_s, gy * dt_s, gz * dt_s)))
            self._age_s += dt_s
            q = self._descend(q, accel_m_s2, dt_s)
        self.wxyz_level_body = q
        return q

    def _descend(self, q: Wxyz, accel_m_s2: Vector3, dt_s: float) -> Wxyz:
        """One step of length beta dt down the gradient of |R^T up - a|², eqs. 25, 26, 33 of the report."""
        ax, ay, az = accel_m_s2
        norm = sqrt(ax * ax + ay * ay + az * az)
        if norm < 1e-6:
            return q
        w, x, y, z = q
        f1 = 2.0 * (x * z - w * y) - ax / norm
        f2 = 2.0 * (w * x + y * z) - ay / norm
        f3 = 1.0 - 2.0 * (x * x + y * y) - az / norm
        dw = -y * f1 + x * f2
        dx = z * f1 + w * f2 - 2.0 * x * f3
        dy = -w * f1 + z * f2 - 2.0 * y * f3
        dz = x * f1 + y * f2
        length = sqrt(dw * dw + dx * dx + dy * dy + dz * dz)
        if length < 1e-9:
            return q
        beta = self._beta
        if self._age_s < START_S:
            beta += (START_BETA - beta) * (1.0 - self._age_s / START_S)
        step = beta * dt_s / length
        return normalise((w - step * dw, x - step * dx, y - step * dy, z - step * dz))
