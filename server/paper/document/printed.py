"""What the paper prints, to stand beside what we measure: its two tables of filter errors and the figures of its text."""

from dataclasses import dataclass

TITLE = "Sensor fusion of camera, GPS and IMU using fuzzy adaptive multiple motion models"
AUTHORS = "Bostanci, Bostanci, Kanwal and Clark"
LINK = "https://arxiv.org/abs/1512.02766"

#: "the positional accuracy has been reduced to about 1 metres when the GPS is used with other sensors, where [...] only for this
#: sensor was found as 2.5 metres"
FUSED_M, GPS_M = 1.0, 2.5
DRIFT_DEG_MIN = 0.5


@dataclass(frozen=True)
class Errors:
    """A row of a table: mean and standard deviation of the filter error in metres, under CMM and under FAMM."""

    cmm_m: float
    cmm_std_m: float
    famm_m: float
    famm_std_m: float

    @property
    def change_percent(self) -> float:
        """What FAMM changed."""
        return 100.0 * (self.famm_m / self.cmm_m - 1.0)


#: Tables "GPS and IMU filter errors" and "GPS, camera and IMU filter errors", by dataset and sensors.
FILTER_ERRORS: dict[tuple[int, str], Errors] = {
    (1, "gps-imu"): Errors(1.106497, 0.638612, 1.087659, 0.633043),
    (2, "gps-imu"): Errors(0.884078, 0.554315, 0.903469, 0.563023),
    (3, "gps-imu"): Errors(0.372074, 0.247346, 0.154518, 0.232001),
    (4, "gps-imu"): Errors(0.872035, 0.573797, 0.871161, 0.569474),
    (5, "gps-imu"): Errors(0.497994, 0.430623, 0.511027, 0.447664),
    (1, "camera-gps-imu"): Errors(1.234321, 0.885747, 1.168871, 0.732295),
    (2, "camera-gps-imu"): Errors(0.953222, 0.576215, 0.937526, 0.581637),
    (3, "camera-gps-imu"): Errors(0.155107, 0.230386, 0.343855, 0.240241),
    (4, "camera-gps-imu"): Errors(0.894683, 0.563316, 0.897089, 0.569789),
    (5, "camera-gps-imu"): Errors(0.543074, 0.442076, 0.498571, 0.384069),
}
