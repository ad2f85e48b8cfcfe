"""What each sensor says of the state: residual and Jacobian, for `ErrorState.correct`.

Every function returns the residual (measured minus predicted, (m,)) and the blocks of H, by columns of the error state.
"""

from math import atan2, hypot

import numpy as np

from tracker.geometry import conjugate, log, rotate, wrap_rad, wxyz_from_matrix
from tracker.measurements import Matrix, Vector3
from tracker.precise.error_model import BG, GPS_ERROR, MAGNETIC, SIZE, THETA, P, V, skew
from tracker.precise.error_state import ErrorState
from tracker.precise.update import Observation

_I3 = np.eye(3)


def gps_position(state: ErrorState, p_site_m: Vector3, sigma_m: Vector3, lever_body_m: Vector3) -> Observation:
    """A fix of the antenna: the position, and the receiver's error in units of its stated sigma."""
    lever = np.array(rotate(state.nav.wxyz_site_body, lever_body_m))
    scale = np.diag(sigma_m)
    error = state.gps_error
    residual = np.array(p_site_m) - state.nav.p_m - lever - scale @ (error[0:3] + error[3:6] + error[6:9])
    return residual, [(P, _I3), (THETA, -skew(lever)), (GPS_ERROR, np.hstack([scale, scale, scale]))]


def gps_velocity(state: ErrorState, v_site_m_s: Vector3, gyro_rad_s: Vector3, lever_body_m: Vector3) -> Observation:
    """A velocity of the antenna; `gyro_rad_s` with its bias."""
    wx, wy, wz = (g - b for g, b in zip(gyro_rad_s, state.biases.gyro_rad_s, strict=True))
    lx, ly, lz = lever_body_m
    turning = rotate(state.nav.wxyz_site_body, (wy * lz - wz * ly, wz * lx - wx * lz, wx * ly - wy * lx))
    residual = np.array(v_site_m_s) - state.nav.v_m_s - turning
    return residual, [(V, _I3), (THETA, -skew(turning)), (BG, state.R_site_body @ skew(lever_body_m))]


def velocity(state: ErrorState, v_site_m_s: Vector3) -> Observation:
    """A velocity of the body: zero while it stands."""
    return np.array(v_site_m_s) - state.nav.v_m_s, [(V, _I3)]


def turn_rate(state: ErrorState, gyro_rad_s: Vector3) -> Observation:
    """A mean gyro reading of a body that does not turn but with the Earth: its bias."""
    earth = rotate(conjugate(state.nav.wxyz_site_body), state.earth_rad_s)
    return np.array(gyro_rad_s) - earth - state.biases.gyro_rad_s, [(BG, _I3)]


def height(state: ErrorState, z_site_m: float) -> Observation:
    """A height above the site's datum."""
    return np.array([z_site_m - state.nav.p_m[2]]), [(P, np.array([[0.0, 0.0, 1.0]]))]


def position(state: ErrorState, p_site_m: Vector3) -> Observation:
    """A place that somebody knows."""
    return np.array(p_site_m) - state.nav.p_m, [(P, _I3)]


def magnetic_yaw(state: ErrorState, field_body_t: Vector3, declination_rad: float) -> Observation:
    """The direction of the field's horizontal part beside magnetic north, turned by the local deviation."""
    x, y, z = rotate(state.nav.wxyz_site_body, field_body_t)
    by_tilt = -z / (x * x + y * y)
    off_rad = wrap_rad(np.pi / 2 - declination_rad - atan2(y, x) - state.magnetic_rad)
    return np.array([off_rad]), [
        (THETA, np.array([[by_tilt * x, by_tilt * y, 1.0]])),
        (slice(MAGNETIC, MAGNETIC + 1), np.array([[1.0]])),
    ]


def turn(state: ErrorState, held: int, R_held_now: Matrix) -> Observation:
    """A turn of the body, (3, 3), since a held pose."""
    R_site_now = state.clones[held].R_site_body @ R_held_now
    off_rad = log(wxyz_from_matrix(R_site_now @ state.R_site_body.T))
    at = SIZE + 6 * held + 3
    return np.array(off_rad), [(THETA, _I3), (slice(at, at + 3), -_I3)]


def bearing(state: ErrorState, landmark_site_m: Vector3, direction_body: Vector3, lever_body_m: Vector3) -> Observation:
    """A direction to a known point, seen from the camera at `lever_body_m`; two angles across the line of sight."""
    lever = np.array(rotate(state.nav.wxyz_site_body, lever_body_m))
    to = np.array(landmark_site_m) - state.nav.p_m - lever
    distance_m = float(np.linalg.norm(to))
    sight = to / distance_m
    seen = np.array(rotate(state.nav.wxyz_site_body, direction_body))
    across = tangents(sight)
    # seen_true = Exp(dtheta) seen, and sight moves against the position
    by_position = across @ (_I3 - np.outer(sight, sight)) / distance_m
    return across @ (sight - seen), [
        (P, by_position),
        (THETA, -across @ skew(seen) - by_position @ skew(lever)),
    ]


def tangents(direction: Matrix) -> Matrix:
    """Return (2, 3): two unit vectors across a unit vector."""
    x, y, z = (float(value) for value in direction)
    flat = hypot(x, y)
    if flat < 1e-6:
        return np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    first = np.array([-y / flat, x / flat, 0.0])
    return np.array([first, [-z * x / flat, -z * y / flat, flat]])
