"""The paper's m_P and m_imu to the letter. They break, and are here to show by how much; the defaults are in `sensor_pose`.

Reference:
    Bostanci et al., Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models, arXiv 1512.02766,
    eq. 8 (m_P), eqs. 4 and 5 (v and x of the IMU), and the table of calibration offsets.
"""

import numpy as np

from tracker.calibration import REST_SAMPLES, MeanSample
from tracker.geodesy import SiteFrame, ecef_from_geodetic
from tracker.measurements import Matrix, Vector3


def m_P_enu(Tr: Matrix, m_gps_m: Vector3, m_imu_m: Vector3) -> Vector3:
    """Return Tr x m_gps + m_imu (eq. 8) with m_gps in the site's ENU frame: a head that turns swings the walker about its origin.

    Args:
        Tr: (4, 4), of eq. 1.
        m_gps_m: The fix, site.
        m_imu_m: The IMU's offset, m.
    """
    return _sum((Tr @ np.array([*m_gps_m, 1.0]))[:3], m_imu_m)


def m_P_ecef(Tr: Matrix, m_gps_m: Vector3, m_imu_m: Vector3, site: SiteFrame) -> Vector3:
    """Return Tr x m_gps + m_imu (eq. 8) with m_gps in ECEF, as eqs. 2 and 3 give it, brought to site.

    A tenth of a degree of camera rotation turns the walker about the Earth's centre, 11 km away.
    """
    p_ecef_m = ecef_from_geodetic(*site.geodetic_from_site(m_gps_m))
    x, y, z = (Tr @ np.array([*p_ecef_m, 1.0]))[:3].tolist()
    return _sum(np.array(site.site_from_ecef((x + m_imu_m[0], y + m_imu_m[1], z + m_imu_m[2]))), (0.0, 0.0, 0.0))


class FourSampleIntegral:
    """m_imu to the letter (eqs. 4 and 5): four samples integrated twice from v(0) = 0, in the rig's own axes: micrometres.

    The accelerometer's mean at rest, gravity and the table's tilt in it, is subtracted as the paper's table of offsets has it.
    """

    def __init__(self) -> None:
        self.offset_m_s2: Vector3 = (0.0, 0.0, 0.0)
        """The table's accelerometer row: the mean over the first 5000 samples, or as many as the rest lasted."""
        self.m_imu_m: Vector3 = (0.0, 0.0, 0.0)
        self._sum = (0.0, 0.0, 0.0)
        self._count = 0

    def step(self, mean: MeanSample, calibrating: bool) -> None:
        """Take the mean of four samples; while the rig is calibrated at rest they are averaged into the offsets."""
        ax, ay, az = mean.accel_m_s2
        if self._count == 0 or (calibrating and self._count < REST_SAMPLES // 4):
            sx, sy, sz = self._sum
            self._sum, self._count = (sx + ax, sy + ay, sz + az), self._count + 1
            self.offset_m_s2 = (self._sum[0] / self._count, self._sum[1] / self._count, self._sum[2] / self._count)
        ox, oy, oz = self.offset_m_s2
        half = 0.5 * mean.dt_s * mean.dt_s
        self.m_imu_m = ((ax - ox) * half, (ay - oy) * half, (az - oz) * half)


def _sum(a: Matrix, b: Vector3) -> Vector3:
    return (float(a[0]) + b[0], float(a[1]) + b[1], float(a[2]) + b[2])
