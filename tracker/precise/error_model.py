"""The error of the filter: its layout, what a step makes of it, and what it is at the start.

The error is (dp, dv, dtheta, dbg, dba, e, m, G, clones): position, velocity and rotation vector in site axes, biases in body axes,
nine states of the receiver's error (unit variance; three correlation times for each axis), the magnetic deviation, the scales and
leans of the gyroscope's axes (row by row), and for every held picture its position and rotation. dtheta is on the left:
R_true = Exp(dtheta) R.

Reference:
    Sola, Quaternion kinematics for the error-state Kalman filter, 2017, chapter 7 (global angular error).
"""

import numpy as np

from tracker.measurements import Matrix, Vector3
from tracker.precise.settings import PreciseSettings

P, V, THETA, BG, BA = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), slice(12, 15)
#: The receiver's error: first the three axes of the shortest correlation time.
GPS_ERROR = slice(15, 24)
MAGNETIC = 24
#: States that forget: the receiver's error and the magnetic deviation.
FORGETTING = slice(15, 25)
#: A walk round a square turns one way: half a percent of a hundred quarter turns is more than the receiver can correct. And a head
#: that looks to the side and back tilts by the lean of the axes.
GYRO_AXES = slice(25, 34)
SIZE = 34


class ProcessNoise:
    """What a step adds to the diagonal, and what it leaves of states that forget."""

    def __init__(self, settings: PreciseSettings) -> None:
        self.velocity = settings.accel_noise_m_s2_sqrt_hz**2
        self._rates = np.zeros(SIZE)
        self._rates[V] = self.velocity
        self._rates[THETA] = settings.gyro_noise_rad_s_sqrt_hz**2
        self._rates[BG] = settings.gyro_bias_walk_rad_s2_sqrt_hz**2
        self._rates[BA] = settings.accel_bias_walk_m_s3_sqrt_hz**2
        self._times_s = np.array([*np.repeat(settings.gps_error_s, 3), settings.magnetic_deviation_s])
        self._steady = np.array([*np.repeat(settings.gps_error_share, 3), settings.magnetic_deviation_rad**2])
        self._dt_s = 0.0
        self._kept = np.ones(10)

    def kept(self, dt_s: float) -> Matrix:
        """(10,) factors of the receiver's error and the magnetic deviation."""
        if dt_s != self._dt_s:
            self._dt_s, self._kept = dt_s, np.exp(-dt_s / self._times_s)
        return self._kept

    @property
    def receiver(self) -> Matrix:
        """(2, 9): variances that the receiver's errors come to, in units of its stated variance, and how long they last, s."""
        return np.array([self._steady[:9], self._times_s[:9]])

    @receiver.setter
    def receiver(self, shares_and_times: Matrix) -> None:
        shares, times_s = shares_and_times
        self._steady = np.array([*shares, self._steady[9]])
        self._times_s = np.array([*times_s, self._times_s[9]])
        self._dt_s = 0.0

    def added(self, dt_s: float) -> Matrix:
        """(34,) variances."""
        added = self._rates * dt_s
        added[P] = self.velocity * dt_s**3 / 3.0
        added[FORGETTING] = self._steady * (1.0 - self.kept(dt_s) ** 2)
        return added


def start_covariance(settings: PreciseSettings, position_m: Vector3, velocity_m_s: float, yaw_rad: float) -> Matrix:
    """Return the (34, 34) covariance of a start: standard deviations of position, velocity and yaw as given."""
    sigma = np.zeros(SIZE)
    sigma[P], sigma[V] = position_m, velocity_m_s
    sigma[THETA] = (settings.tilt_rad, settings.tilt_rad, yaw_rad)
    sigma[BG], sigma[BA] = settings.gyro_bias_rad_s, settings.accel_bias_m_s2
    sigma[GPS_ERROR] = np.sqrt(np.repeat(settings.gps_error_share, 3))
    sigma[MAGNETIC] = settings.magnetic_deviation_rad
    sigma[GYRO_AXES] = settings.gyro_axes
    return np.diag(sigma**2)


def inertial_transition(dt_s: float, R_site_body: Matrix, gained_m_s: Matrix) -> Matrix:
    """Return Phi, (15, 15), of a step.

    Args:
        dt_s: Its length.
        R_site_body: (3, 3), the mean attitude.
        gained_m_s: (3,) integral of the specific force over the step, in site.
    """
    cross = skew(gained_m_s)
    Phi = np.eye(15)
    Phi[0, 3] = Phi[1, 4] = Phi[2, 5] = dt_s
    Phi[P, THETA] = -0.5 * dt_s * cross
    Phi[V, THETA] = -cross
    turned = R_site_body * dt_s
    Phi[THETA, BG] = -turned
    Phi[V, BG] = 0.5 * cross @ turned
    Phi[P, BG] = (dt_s / 6.0) * cross @ turned
    Phi[V, BA] = -turned
    Phi[P, BA] = -0.5 * dt_s * turned
    return Phi


def skew(v: Matrix | Vector3) -> Matrix:
    """Return [v]x, (3, 3)."""
    x, y, z = (float(value) for value in v)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def skews(v: Matrix) -> Matrix:
    """Return [v]x of many vectors, (..., 3), as (..., 3, 3)."""
    cross = np.zeros((*v.shape[:-1], 3, 3))
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return np.asarray(cross - np.swapaxes(cross, -1, -2))
