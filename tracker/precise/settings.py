"""Noise and habits that the precise filter believes in."""

from dataclasses import dataclass, fields
from math import pi

from tracker.measurements import Vector3
from tracker.readings import require_positive


@dataclass(frozen=True)
class PreciseSettings:
    """What the filter takes for granted of sensors, receivers and walkers."""

    lag_s: float = 0.5
    """The filter runs this far behind the newest sample, so that what arrives late still comes in its turn."""
    gyro_noise_rad_s_sqrt_hz: float = 2.5e-4
    """White noise density; a few times the sensor's own, for scale and misalignment errors."""
    accel_noise_m_s2_sqrt_hz: float = 8e-3
    """White noise density of the accelerometer."""
    gyro_scale: float = 0.002
    """What is left of errors of scale and axes, as a share of each turn: what a fast head turn adds to the doubt of attitude."""
    accel_scale: float = 0.005
    """Error of scale and axes, as a share of each change of velocity, gravity's included."""
    gyro_axes: float = 0.005
    """Standard deviation of the scales and leans of the gyroscope's axes, before anything was measured."""
    gyro_bias_walk_rad_s2_sqrt_hz: float = 5e-5
    """How fast the bias wanders."""
    accel_bias_walk_m_s3_sqrt_hz: float = 2.5e-4
    """How fast the bias wanders."""
    gyro_bias_rad_s: float = 0.006
    """Standard deviation before anything was measured."""
    accel_bias_m_s2: float = 0.06
    """Standard deviation before anything was measured."""
    tilt_rad: float = 0.05
    """Of the first specific force, from a rig that may be moving."""
    gps_error_s: tuple[float, float, float] = (15.0, 90.0, 600.0)
    """Correlation times of a receiver's error. It is not known in advance which is true: three share the variance."""
    gps_error_share: tuple[float, float, float] = (0.28, 0.33, 0.33)
    """Shares of the stated variance; what is left over is white."""
    gps_inflation: float = 1.5
    """By how much stated variances are taken larger: receivers flatter themselves."""
    fresh_s: float = 60.0
    """What has come to be doubted of the place is corrected in full for about this long,"""
    settled_share: float = 0.5
    """and later by this share of what a fix makes likely: the square stands stiller, and hardly less near."""
    gps_sigma_m: Vector3 = (2.12, 2.12, 4.0)
    """For a receiver that states none."""
    gps_floor_m: float = 0.3
    """A receiver that states less is not believed."""
    gps_velocity_sigma_m_s: float = 0.1
    """White noise of a horizontal velocity; half as much again of the vertical one."""
    gps_velocity_aside: float = 5.0
    """Near a wall, where its fixes have leapt aside, it is so many times as large."""
    gate_nis: float = 9.0
    """Per dimension: what lies further out counts for less and less,"""
    reject_nis: float = 40.0
    """and beyond this for nothing."""
    velocity_nis: float = 2.5
    """`gate_nis` of a receiver's velocity: most of these err little, and some by many times as much."""
    insist: int = 5
    """So many refused fixes in a row are believed."""
    stride_sigma_m_s: float = 0.6
    """Of the speed that steps tell, four times a second, before anything was learned of the walker; and upwards."""
    still_sigma_m_s: float = 0.03
    """A head that stands sways by this much."""
    still_rate_sigma_rad_s: float = 0.012
    """... and turns by this much."""
    magnetic_deviation_rad: float = 0.25
    """Iron near the rig and in it turns the compass by this much,"""
    magnetic_deviation_s: float = 60.0
    """and for so long."""
    magnetic_every_s: float = 0.5
    """How often a magnetometer is asked, once one heading is left."""
    magnetic_sigma_rad: float = 0.05
    """White noise of its direction."""
    eye_height_sigma_m: float = 0.1
    """How well the height of the eyes above the ground is known,"""
    eye_height_repeats: float = 8.0
    """and how many times it says the same in a quarter of a second each: its error does not average out."""
    feature_px: float = 0.5
    """Error of a feature in a picture, at best."""
    feature_nis: float = 3.0
    """Per dimension: a feature that is further off slid along an outline, or moves by itself."""
    feature_pictures: int = 16
    """A feature is followed over so many held pictures at most, and then has told what it can."""
    blend_s: float = 3.0
    """A correction moves what is shown with this time constant: a temple that jumps is worse than one that is off;"""
    blend_walking_s: float = 1.2
    """with this one for who walks, and sees no temple jump by centimetres,"""
    blend_turn_s: float = 0.6
    """and with this one it turns what is shown."""
    hypotheses: int = 8
    """So many headings are tried where motion must tell north."""
    converged_rad: float = 5.0 * pi / 180.0
    """Heading is called known when its standard deviation is below this."""
    heading_known_rad: float = 0.3
    """The page is told that north is known when it is known this well."""

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            value = getattr(self, name)
            require_positive(**{name: min(value) if isinstance(value, tuple) else value})
        if self.settled_share > 1.0:
            raise ValueError(f"settled_share is more than the whole: {self.settled_share:g}")
        if sum(self.gps_error_share) > 1.0:
            raise ValueError(f"the shares of gps_error_share are more than the whole: {sum(self.gps_error_share):g}")
