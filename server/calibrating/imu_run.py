"""`agora calibrate imu`: an inertial unit that lies still."""

from collections.abc import Sequence
from typing import Literal

import numpy as np

from server.calibrating.feed import Feed, Progress
from server.calibrating.result import Result, today
from server.plots.rest import rest_pictures
from server.plots.style import Picture
from tracker.calibrate.rest import RestFit, fit_rest, fit_sides, longest_rest
from tracker.geodesy import gravity_m_s2
from tracker.measurements import ImuSample, Matrix, Vector3
from tracker.rig_sheets import ImuSheet

#: Where no receiver says where the rig is: gravity at 45 degrees and sea level, right to a quarter of a percent anywhere.
_USUAL_GRAVITY_M_S2 = 9.80665

Which = Literal["all", "longest", "sides"]
"""The whole recording is one rest; its longest rest; rests on several sides."""


def calibrate_imu(feed: Feed, which: Which, progress: Progress) -> Result:
    """Return what a rest tells of the inertial unit.

    Raises:
        InputError: The rig moved, or the rest is too short; with the remedy.
    """
    samples: Sequence[ImuSample] = [
        measurement for measurement in feed.measurements(progress) if isinstance(measurement, ImuSample)
    ]
    fix = feed.first_fix()
    gravity = _USUAL_GRAVITY_M_S2 if fix is None else gravity_m_s2(fix.lat_deg, fix.h_ellipsoid_m)
    R_body_imu = feed.rig.T_body_imu[:3, :3]
    if which == "longest":
        samples = longest_rest(samples)
    fit = fit_sides(samples, R_body_imu, gravity) if which == "sides" else fit_rest(samples, R_body_imu, gravity)
    return _result(fit, samples, feed, gravity)


def _result(fit: RestFit, samples: Sequence[ImuSample], feed: Feed, gravity: float) -> Result:
    device, serial = feed.device("imu")
    sheet = ImuSheet(
        date=today(),
        device=device,
        serial=serial,
        gyro_bias_rad_s=_vector(fit.gyro_bias_rad_s),
        accel_bias_m_s2=_vector(fit.accel_bias_m_s2),
        accel_scale=_vector(fit.accel_scale),
        gyro_noise_rad_s_sqrt_hz=_vector(fit.gyro_noise_rad_s_sqrt_hz),
        accel_noise_m_s2_sqrt_hz=_vector(fit.accel_noise_m_s2_sqrt_hz),
        gyro_bias_sigma_rad_s=_vector(fit.gyro_bias_sigma_rad_s),
        duration_s=round(fit.duration_s, 3),
        attitudes=fit.attitudes,
    )
    drift = float(np.degrees(np.linalg.norm(fit.gyro_bias_rad_s))) * 60.0
    left = float(np.degrees(np.linalg.norm(fit.gyro_bias_sigma_rad_s))) * 60.0
    found = [
        f"The gyroscope's bias is {_triple(np.degrees(fit.gyro_bias_rad_s), 3)} degrees/s, "
        f"±{np.degrees(fit.gyro_bias_sigma_rad_s.max()):.4f}: {drift:.1f} degrees a minute, of which {left:.2f} are left.",
        f"Its noise is {_triple(np.degrees(fit.gyro_noise_rad_s_sqrt_hz), 4)} degrees/s/√Hz, the accelerometer's "
        f"{_triple(fit.accel_noise_m_s2_sqrt_hz * 1e3, 2)} mm/s²/√Hz, at {fit.rate_hz:.0f} Hz over {fit.duration_s:.0f} s.",
    ]
    if fit.attitudes > 1:
        found.append(
            f"From {fit.attitudes} attitudes: the accelerometer's bias is {_triple(fit.accel_bias_m_s2, 3)} m/s², "
            f"its scale is put right by {_triple(100.0 * (fit.accel_scale - 1.0), 2)} %."
        )
    else:
        found.append(
            f"At rest the accelerometer says {fit.norm_m_s2:.3f} m/s², gravity is {gravity:.3f} here: its scale is put right by "
            f"{100.0 * (fit.accel_scale[0] - 1.0):+.2f} %. One rest cannot tell its bias apart: `--sides` does."
        )
    numbers = {
        "gyro_bias_rad_s": fit.gyro_bias_rad_s.tolist(),
        "gyro_bias_sigma_rad_s": fit.gyro_bias_sigma_rad_s.tolist(),
        "gyro_noise_rad_s_sqrt_hz": fit.gyro_noise_rad_s_sqrt_hz.tolist(),
        "accel_noise_m_s2_sqrt_hz": fit.accel_noise_m_s2_sqrt_hz.tolist(),
        "accel_bias_m_s2": fit.accel_bias_m_s2.tolist(),
        "accel_scale": fit.accel_scale.tolist(),
        "duration_s": fit.duration_s,
        "rate_hz": fit.rate_hz,
        "attitudes": fit.attitudes,
    }

    def pictures() -> Sequence[Picture]:
        return rest_pictures(fit, samples, feed.rig.T_body_imu[:3, :3])

    return Result("inertial unit", {"imu": sheet}, found, (), numbers, pictures)


def _vector(values: Matrix) -> Vector3:
    x, y, z = (float(value) for value in values)
    return (x, y, z)


def _triple(values: Matrix, digits: int) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in values)
