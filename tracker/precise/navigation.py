"""The strapdown integral: attitude, velocity and position carried on by one inertial sample after another, in plain floats."""

from dataclasses import dataclass
from typing import NamedTuple

from tracker.geometry import conjugate, exp, multiply, normalise, rotate
from tracker.measurements import ImuSample, Vector3, Wxyz


class Navigation(NamedTuple):
    """Where the body is, site axes."""

    t_ns: int
    p_m: Vector3
    v_m_s: Vector3
    wxyz_site_body: Wxyz


_NONE: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Biases:
    """What the inertial sensors say too much, body axes."""

    gyro_rad_s: Vector3 = (0.0, 0.0, 0.0)
    accel_m_s2: Vector3 = (0.0, 0.0, 0.0)
    gyro_axes: tuple[Vector3, Vector3, Vector3] = (_NONE, _NONE, _NONE)
    """(3, 3): the share of a rate about the axis of the column that the axis of the row says too much."""


def advance(
    nav: Navigation, t_ns: int, gyro_rad_s: Vector3, accel_m_s2: Vector3, biases: Biases, gravity_m_s2: float
) -> Navigation:
    """Return the state at t_ns, the rates being what they are from nav.t_ns on.

    Specific force is turned by the attitude in the middle of the step, which is exact to the second order.
    """
    dt = (t_ns - nav.t_ns) * 1e-9
    (gx, gy, gz), (bx, by, bz) = gyro_rad_s, biases.gyro_rad_s
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = biases.gyro_axes
    rx, ry, rz = (gx - bx) * dt, (gy - by) * dt, (gz - bz) * dt
    wx, wy = rx - xx * rx - xy * ry - xz * rz, ry - yx * rx - yy * ry - yz * rz
    wz = rz - zx * rx - zy * ry - zz * rz
    middle = multiply(nav.wxyz_site_body, exp((0.5 * wx, 0.5 * wy, 0.5 * wz)))
    (ax, ay, az), (cx, cy, cz) = accel_m_s2, biases.accel_m_s2
    fx, fy, fz = rotate(middle, (ax - cx, ay - cy, az - cz))
    fz -= gravity_m_s2
    (px, py, pz), (vx, vy, vz), half = nav.p_m, nav.v_m_s, 0.5 * dt * dt
    return Navigation(
        t_ns,
        (px + vx * dt + fx * half, py + vy * dt + fy * half, pz + vz * dt + fz * half),
        (vx + fx * dt, vy + fy * dt, vz + fz * dt),
        normalise(multiply(nav.wxyz_site_body, exp((wx, wy, wz)))),
    )


def mean(a: Vector3, b: Vector3) -> Vector3:
    """Return what a rate was between two samples of it."""
    return (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]))


def sample_between(a: ImuSample, b: ImuSample, t_ns: int) -> ImuSample:
    """Return the sample that would have been taken at a time between two."""
    f = (t_ns - a.t_ns) / (b.t_ns - a.t_ns)
    (ax, ay, az), (bx, by, bz) = a.gyro_rad_s, b.gyro_rad_s
    (cx, cy, cz), (dx, dy, dz) = a.accel_m_s2, b.accel_m_s2
    gyro = (ax + f * (bx - ax), ay + f * (by - ay), az + f * (bz - az))
    return ImuSample(t_ns, t_ns, gyro, (cx + f * (dx - cx), cy + f * (dy - cy), cz + f * (dz - cz)))


def carried(start: Navigation, free_start: Navigation, free_end: Navigation, gravity_m_s2: float) -> Navigation:
    """Return `start`, carried on by the motion between two states of an integral that runs free.

    The motion is taken in the body's axes at its start, gravity removed (preintegration), so that it does not matter where the
    free integral has drifted to.

    Reference:
        Forster et al., On-manifold preintegration for real-time visual-inertial odometry, 2017, eq. 33.
    """
    dt = (free_end.t_ns - free_start.t_ns) * 1e-9
    back = conjugate(free_start.wxyz_site_body)
    turn = multiply(start.wxyz_site_body, back)
    (ax, ay, az), (bx, by, bz) = free_start.v_m_s, free_end.v_m_s
    (px, py, pz), (qx, qy, qz) = free_start.p_m, free_end.p_m
    fall = gravity_m_s2 * dt
    dvx, dvy, dvz = rotate(turn, (bx - ax, by - ay, bz - az + fall))
    dpx, dpy, dpz = rotate(turn, (qx - px - ax * dt, qy - py - ay * dt, qz - pz - az * dt + 0.5 * fall * dt))
    (sx, sy, sz), (ux, uy, uz) = start.p_m, start.v_m_s
    return Navigation(
        free_end.t_ns,
        (sx + ux * dt + dpx, sy + uy * dt + dpy, sz + uz * dt + dpz - 0.5 * fall * dt),
        (ux + dvx, uy + dvy, uz + dvz - fall),
        normalise(multiply(turn, free_end.wxyz_site_body)),
    )
