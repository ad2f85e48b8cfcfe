"""Measurements that nothing can be made of, whatever the state is: not finite, out of this world, or against their own rules."""

from math import hypot, isfinite, pi

import numpy as np

from tracker.fixes import FASTEST_M_S
from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Matrix,
    Measurement,
    Outcome,
    Sighting,
    Standpoint,
    VisualMotion,
    VisualTracks,
)

#: A stamp that is ahead of its arrival by more than this is a clock that leapt.
_FASTEST_CLOCK_NS = 2_000_000_000
#: What a head can do, and then some.
_FASTEST_TURN_RAD_S, _LARGEST_FORCE_M_S2 = 50.0, 400.0
#: Nobody walks above this, m above the ellipsoid, nor stands this far from the site's origin.
_HIGHEST_M, _FARTHEST_M = 20_000.0, 1e6
#: A front end follows a few hundred features, and a lens that sees a ray further aside than this has no plane before it.
_MOST_FEATURES, _WIDEST_RAY = 1000, 20.0
#: Who is no surer than this has told nothing.
_LEAST_SURE_M, _LEAST_SURE_RAD = 1_000.0, 1.0
#: The Earth's field is 25 to 65 microtesla; a magnet beside the sensor shows more, a dead sensor less.
_WEAKEST_T, _STRONGEST_T = 1e-7, 1e-2
#: What people point at and where they say that they stand is never better than this.
_LEAST_SIGMA_RAD, _LEAST_SIGMA_M = 1e-5, 1e-4
#: A rotation and a direction are that to this.
_UNIT = 1e-3


def refusal(measurement: Measurement) -> Outcome | None:
    """Return why a measurement cannot be used; None where it can."""
    if measurement.t_ns > measurement.t_recv_ns + _FASTEST_CLOCK_NS:
        return Outcome.REJECTED_GATE
    match measurement:
        case ImuSample():
            return _of_imu(measurement)
        case GpsFix():
            return _of_fix(measurement)
        case GpsVelocity():
            return _judged(measurement.v_enu_m_s, hypot(*measurement.v_enu_m_s) <= FASTEST_M_S)
        case MagSample():
            return _judged(measurement.field_body_t, _WEAKEST_T <= hypot(*measurement.field_body_t) <= _STRONGEST_T)
        case CompassHeading():
            return _judged((measurement.yaw_rad,), abs(measurement.yaw_rad) <= 4.0 * pi)
        case VisualMotion():
            return _of_vision(measurement)
        case Sighting():
            return _of_sighting(measurement)
        case Standpoint():
            is_sure = _LEAST_SIGMA_M <= measurement.sigma_m <= _LEAST_SURE_M
            numbers = (*measurement.p_site_m, measurement.sigma_m)
            return _judged(numbers, is_sure and hypot(*measurement.p_site_m) <= _FARTHEST_M)
    return None


def _judged(numbers: tuple[float, ...], is_sane: bool) -> Outcome | None:
    if not all(map(isfinite, numbers)):
        return Outcome.REJECTED_NOT_FINITE
    return None if is_sane else Outcome.REJECTED_GATE


def _of_imu(sample: ImuSample) -> Outcome | None:
    turn_rad_s, force_m_s2 = hypot(*sample.gyro_rad_s), hypot(*sample.accel_m_s2)
    if turn_rad_s <= _FASTEST_TURN_RAD_S and force_m_s2 <= _LARGEST_FORCE_M_S2:
        return None
    return _judged((*sample.gyro_rad_s, *sample.accel_m_s2), is_sane=False)


def _of_fix(fix: GpsFix) -> Outcome | None:
    if not fix.valid:
        return Outcome.REJECTED_WEAK
    is_place = abs(fix.lat_deg) <= 90.0 and abs(fix.lon_deg) <= 360.0 and abs(fix.h_ellipsoid_m) <= _HIGHEST_M
    refused = _judged((fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m, *fix.cov_enu_m2), is_place)
    if refused is not None or not any(fix.cov_enu_m2):
        return refused  # all zero: the receiver states none
    if len(fix.cov_enu_m2) != 9 or not _is_covariance(np.array(fix.cov_enu_m2).reshape(3, 3)):
        return Outcome.REJECTED_GATE
    return Outcome.REJECTED_WEAK if max(fix.cov_enu_m2) > _LEAST_SURE_M**2 else None


def _is_covariance(cov: Matrix) -> bool:
    diagonal = np.diag(cov)
    if np.any(diagonal <= 0.0):
        return False
    scale = np.sqrt(diagonal)
    # written with few digits, equal off-diagonals may differ a little, and a full correlation be a little more than one
    correlation = cov / np.outer(scale, scale)
    return bool(np.allclose(correlation, correlation.T, atol=1e-3) and np.abs(correlation).max() <= 1.0 + 1e-3)


def _of_sighting(seen: Sighting) -> Outcome | None:
    is_near, is_ray = hypot(*seen.point_site_m) <= _FARTHEST_M, abs(hypot(*seen.ray_cam) - 1.0) <= _UNIT
    numbers = (*seen.point_site_m, *seen.ray_cam, seen.sigma_rad)
    return _judged(numbers, is_near and is_ray and _LEAST_SIGMA_RAD <= seen.sigma_rad <= _LEAST_SURE_RAD)


def _of_vision(motion: VisualMotion) -> Outcome | None:
    R, length = motion.R_key_cam, hypot(*motion.direction_key)
    if R.shape != (3, 3) or motion.t_key_ns >= motion.t_ns:
        return Outcome.REJECTED_GATE
    refused = _judged((*R.ravel().tolist(), *motion.direction_key, motion.parallax_px), motion.parallax_px >= 0.0)
    if refused is not None:
        return refused
    is_rotation = np.abs(R).max() <= 2.0 and np.abs(R @ R.T - np.eye(3)).max() <= _UNIT and np.linalg.det(R) > 0.0
    is_direction = length == 0.0 or abs(length - 1.0) <= _UNIT
    are_features = motion.tracks is None or _are_features(motion.tracks)
    return None if is_rotation and is_direction and are_features else Outcome.REJECTED_GATE


def _are_features(tracks: VisualTracks) -> bool:
    count = len(tracks.ids)
    if tracks.rays.shape != (count, 4) or count > _MOST_FEATURES or len(np.unique(tracks.ids)) < count:
        return False
    return bool(np.all(np.abs(tracks.rays) < _WIDEST_RAY))
