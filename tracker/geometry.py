"""Rotations: unit quaternions (wxyz, Hamilton) and matrices, in plain floats; nothing else.

Three- and four-vectors are tuples: at 250 Hz a numpy call on so few numbers costs twenty times the arithmetic.
"""

from math import acos, asin, atan2, copysign, cos, hypot, pi, sin, sqrt

import numpy as np

from tracker.measurements import Matrix, Vector3, Wxyz

IDENTITY: Wxyz = (1.0, 0.0, 0.0, 0.0)


def multiply(a: Wxyz, b: Wxyz) -> Wxyz:
    """Return the rotation that does b first, then a: `wxyz_x_z = multiply(wxyz_x_y, wxyz_y_z)`."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def conjugate(q: Wxyz) -> Wxyz:
    """Return the inverse rotation of a unit quaternion."""
    return (q[0], -q[1], -q[2], -q[3])


def normalise(q: Wxyz) -> Wxyz:
    """Return q at unit length; ValueError where it has none."""
    norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    if not 1e-12 < norm < 1e12:
        raise ValueError(f"expected a quaternion of length about 1, got {q}")
    return (q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm)


def rotate(wxyz_a_b: Wxyz, v_b: Vector3) -> Vector3:
    """Return v_a: the vector's coordinates in a."""
    w, x, y, z = wxyz_a_b
    vx, vy, vz = v_b
    tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def exp(rotation_rad: Vector3) -> Wxyz:
    """Return the quaternion of a rotation vector (axis times angle)."""
    x, y, z = rotation_rad
    angle = sqrt(x * x + y * y + z * z)
    # sin(angle / 2) / angle, by its series where the quotient would lose digits
    scale = sin(0.5 * angle) / angle if angle > 1e-4 else 0.5 - angle * angle / 48.0
    return (cos(0.5 * angle), x * scale, y * scale, z * scale)


def log(q: Wxyz) -> Vector3:
    """Return the rotation vector of a unit quaternion, of the shorter way round (angle at most pi)."""
    w, x, y, z = q if q[0] >= 0.0 else (-q[0], -q[1], -q[2], -q[3])
    sine = sqrt(x * x + y * y + z * z)
    scale = 2.0 * atan2(sine, w) / sine if sine > 1e-7 else 2.0 / w
    return (x * scale, y * scale, z * scale)


def slerp(a: Wxyz, b: Wxyz, fraction: float) -> Wxyz:
    """Return the rotation a fraction of the way from a to b along the shorter arc."""
    x, y, z = log(multiply(conjugate(a), b))
    return normalise(multiply(a, exp((x * fraction, y * fraction, z * fraction))))


def angle_between_rad(a: Wxyz, b: Wxyz) -> float:
    """Return the angle of the rotation between two attitudes, 0 to pi; q and -q are one attitude."""
    cosine = abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])
    return 2.0 * acos(min(1.0, cosine))


def matrix_from_wxyz(wxyz_a_b: Wxyz) -> Matrix:
    """Return R_a_b, (3, 3)."""
    w, x, y, z = wxyz_a_b
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def wxyz_from_matrix(R_a_b: Matrix) -> Wxyz:
    """Return the quaternion of a (3, 3) rotation matrix, by its largest component (Shepperd's method)."""
    m = R_a_b
    trace = float(m[0, 0] + m[1, 1] + m[2, 2])
    squares = (trace, float(m[0, 0]), float(m[1, 1]), float(m[2, 2]))
    largest = squares.index(max(squares))
    if largest == 0:
        q = (1.0 + trace, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1])
    elif largest == 1:
        q = (m[2, 1] - m[1, 2], 1.0 + m[0, 0] - m[1, 1] - m[2, 2], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0])
    elif largest == 2:
        q = (m[0, 2] - m[2, 0], m[0, 1] + m[1, 0], 1.0 - m[0, 0] + m[1, 1] - m[2, 2], m[1, 2] + m[2, 1])
    else:
        q = (m[1, 0] - m[0, 1], m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], 1.0 - m[0, 0] - m[1, 1] + m[2, 2])
    return normalise((float(q[0]), float(q[1]), float(q[2]), float(q[3])))


def transform(wxyz_a_b: Wxyz, p_a_b: Vector3) -> Matrix:
    """Return T_a_b, (4, 4), from b's attitude and b's origin in a."""
    T_a_b = np.eye(4)
    T_a_b[:3, :3] = matrix_from_wxyz(wxyz_a_b)
    T_a_b[:3, 3] = p_a_b
    return T_a_b


def inverse(T_a_b: Matrix) -> Matrix:
    """Return T_b_a of a rigid (4, 4) transform."""
    T_b_a = np.eye(4)
    T_b_a[:3, :3] = T_a_b[:3, :3].T
    T_b_a[:3, 3] = -T_a_b[:3, :3].T @ T_a_b[:3, 3]
    return T_b_a


def wrap_rad(angle_rad: float) -> float:
    """Return the same direction in [-pi, pi)."""
    return (angle_rad + pi) % (2.0 * pi) - pi


def yaw_of(wxyz_site_body: Wxyz) -> float:
    """Return the direction of body x over the ground, counter-clockwise from east."""
    x, y, _ = rotate(wxyz_site_body, (1.0, 0.0, 0.0))
    return atan2(y, x)


def wxyz_from_yaw(yaw_rad: float) -> Wxyz:
    """Return the level attitude that faces yaw_rad."""
    return (cos(0.5 * yaw_rad), 0.0, 0.0, sin(0.5 * yaw_rad))


def wxyz_level_from_gravity(accel_m_s2: Vector3) -> Wxyz:
    """Return the attitude of zero yaw that turns a specific force at rest to straight up.

    Raises:
        ValueError: The specific force is zero.
    """
    x, y, z = accel_m_s2
    if hypot(x, y, z) < 1e-6:
        raise ValueError("expected a specific force at rest near 9.81 m/s2, got zero")
    roll, pitch = atan2(y, z), atan2(-x, hypot(y, z))
    wxyz_pitch = (cos(0.5 * pitch), 0.0, sin(0.5 * pitch), 0.0)
    return multiply(wxyz_pitch, (cos(0.5 * roll), sin(0.5 * roll), 0.0, 0.0))


def wxyz_from_rpy(rpy_rad: Vector3) -> Wxyz:
    """Return the attitude of roll, pitch and yaw: R = Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, sr), (cp, sp), (cy, sy) = ((cos(0.5 * angle), sin(0.5 * angle)) for angle in rpy_rad)
    return multiply(multiply((cy, 0.0, 0.0, sy), (cp, 0.0, sp, 0.0)), (cr, sr, 0.0, 0.0))


def rpy_from_wxyz(wxyz: Wxyz) -> Vector3:
    """Return roll, pitch in [-pi/2, pi/2] and yaw, radians: R = Rz(yaw) Ry(pitch) Rx(roll).

    Looking straight up or down only the sum or difference of roll and yaw is determined, and roll is given as 0.
    """
    w, x, y, z = wxyz
    sine_pitch = 2.0 * (w * y - x * z)
    if abs(sine_pitch) > 1.0 - 1e-12:
        return 0.0, copysign(0.5 * pi, sine_pitch), wrap_rad(2.0 * atan2(z, w))
    roll = atan2(2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
    yaw = atan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z))
    return roll, asin(sine_pitch), yaw
