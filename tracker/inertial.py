"""Velocity and position by integration (m_imu, eqs. 4 and 5): the specific force turned to ENU, gravity removed, integrated twice.

The paper integrates within four samples (16 ms), which gives micrometres; its conclusion says that the IMU carries the position
from one GPS fix to the next, and that is what is done here: displacements are read between any two times of the last seconds.
Its v(0) is what a fix or the receiver's own velocity says.
"""

from collections import deque
from dataclasses import dataclass, replace
from math import cos, sin

from tracker.calibration import MeanSample
from tracker.geometry import exp, multiply, rotate, slerp
from tracker.measurements import Vector3, Wxyz
from tracker.pace import Pace, share_of

#: How far back displacements can be read: longer than the latest GPS fix and the oldest keyframe.
HISTORY_S = 2.5
#: After this long without a known velocity the integral can only have drifted: with this time constant it gives way to the
#: walker's pace.
TRUSTED_S = 2.0
LEAK_S = 1.0
#: Velocities that come faster than this share their say: each has noise of its own.
VELOCITY_S = 0.5
#: Share that a second's displacement between two fixes has in the velocity: their noise makes it three times as coarse as the
#: integral of a second; and the longest time between two that say anything of a walker's velocity.
DISPLACEMENT_SHARE = 0.35
LONGEST_DISPLACEMENT_S = 3.0
#: A prediction holds the velocity at most this long, then stands still.
LONGEST_PREDICTION_S = 1.0


@dataclass(frozen=True, slots=True)
class InertialState:
    """The integral at one time. `p_m` is a displacement: only differences of it mean something."""

    t_ns: int
    wxyz_level_body: Wxyz
    p_m: Vector3
    v_m_s: Vector3
    gyro_rad_s: Vector3
    gained_level_m_s: tuple[float, float]
    """Horizontal velocity gained since the start, in the level frame: only differences of it mean something."""


class InertialPath:
    """The recent path of the rig by dead reckoning, in site axes."""

    def __init__(self, gravity_m_s2: float) -> None:
        self._gravity = gravity_m_s2
        self._states: deque[InertialState] = deque()
        self._known_ns: int | None = None
        """When the velocity was last known from outside."""
        self._yaw_offset_rad: float | None = None
        self._yaw_offset = (1.0, 0.0)
        self._pace = Pace()

    @property
    def newest(self) -> InertialState | None:
        """The integral up to the last sample."""
        return self._states[-1] if self._states else None

    def step(self, mean: MeanSample, wxyz_level_body: Wxyz, yaw_offset_rad: float | None) -> None:
        """Integrate one mean sample twice (eqs. 4 and 5).

        While north is unknown its force has no direction, and the velocity is only held.
        """
        self._pace.step(mean.accel_m_s2, wxyz_level_body, mean.dt_s)
        last = self.newest
        if last is None:
            zero = (0.0, 0.0, 0.0)
            self._states.append(InertialState(mean.t_ns, wxyz_level_body, zero, zero, mean.gyro_rad_s, (0.0, 0.0)))
            return
        if yaw_offset_rad != self._yaw_offset_rad:
            self._yaw_offset_rad = yaw_offset_rad
            self._yaw_offset = (cos(yaw_offset_rad or 0.0), sin(yaw_offset_rad or 0.0))
        dt, (vx, vy, vz), (px, py, pz), (gx, gy) = mean.dt_s, last.v_m_s, last.p_m, last.gained_level_m_s
        fx, fy, fz = rotate(wxyz_level_body, mean.accel_m_s2)
        ax = ay = az = 0.0
        if yaw_offset_rad is not None:
            c, s = self._yaw_offset
            ax, ay, az = c * fx - s * fy, s * fx + c * fy, fz - self._gravity
        half = 0.5 * dt * dt
        p = (px + vx * dt + ax * half, py + vy * dt + ay * half, pz + vz * dt + az * half)
        v = (vx + ax * dt, vy + ay * dt, vz + az * dt)
        if self._known_ns is None or mean.t_ns - self._known_ns > TRUSTED_S * 1e9:
            v = _mix(v, self._expected(), share_of(dt, LEAK_S))
        gained = (gx + fx * dt, gy + fy * dt)
        self._states.append(InertialState(mean.t_ns, wxyz_level_body, p, v, mean.gyro_rad_s, gained))
        while mean.t_ns - self._states[0].t_ns > HISTORY_S * 1e9:
            self._states.popleft()

    def _expected(self) -> Vector3:
        return self._pace.velocity_m_s(self._yaw_offset) if self._yaw_offset_rad is not None else (0.0, 0.0, 0.0)

    def correct_velocity(self, t_ns: int, v_site_m_s: Vector3) -> None:
        """Take a velocity known at t_ns, now or in the past: what was integrated since then moves on with it."""
        then = self.at(t_ns)
        if then is None:
            return
        since_s = (t_ns - self._known_ns) * 1e-9 if self._known_ns is not None else TRUSTED_S
        if since_s > 0.0:
            share = share_of(since_s, VELOCITY_S)
            dx, dy, dz = (share * (new - old) for new, old in zip(v_site_m_s, then.v_m_s, strict=True))
            self._shift_velocity(t_ns, (dx, dy, dz), v_site_m_s)

    def correct_by_displacement(self, from_ns: int, to_ns: int, moved_m: Vector3, from_path_m: Vector3) -> None:
        """Take how far two fixes lie apart; `from_path_m` is where the path was at the first of them."""
        then, dt_s = self.at(to_ns), (to_ns - from_ns) * 1e-9
        if then is None or not 0.0 < dt_s < LONGEST_DISPLACEMENT_S:
            return
        rate = DISPLACEMENT_SHARE * min(1.0, dt_s) / dt_s
        dx, dy, dz = (rate * (m - (p - f)) for m, p, f in zip(moved_m, then.p_m, from_path_m, strict=True))
        vx, vy, vz = then.v_m_s
        self._shift_velocity(to_ns, (dx, dy, dz), (vx + dx, vy + dy, vz + dz))

    def _shift_velocity(self, t_ns: int, by_m_s: Vector3, v_site_m_s: Vector3) -> None:
        """Add to the velocity from t_ns on; `v_site_m_s` is what it is known to have been then."""
        dx, dy, dz = by_m_s
        states = self._states
        for index in range(len(states) - 1, -1, -1):
            state = states[index]
            if state.t_ns < t_ns and index < len(states) - 1:
                break
            dt = max(0.0, (state.t_ns - t_ns) * 1e-9)
            (px, py, pz), (vx, vy, vz) = state.p_m, state.v_m_s
            p, v = (px + dx * dt, py + dy * dt, pz + dz * dt), (vx + dx, vy + dy, vz + dz)
            states[index] = replace(state, p_m=p, v_m_s=v)
        self._known_ns = t_ns
        if self._yaw_offset_rad is not None:
            self._pace.learn(v_site_m_s, self._yaw_offset)

    def at(self, t_ns: int) -> InertialState | None:
        """Return the state at a time: interpolated inside the history, held at its start, carried on after its end."""
        states = self._states
        if not states:
            return None
        last = states[-1]
        if t_ns >= last.t_ns:
            return _carry_on(last, min((t_ns - last.t_ns) * 1e-9, LONGEST_PREDICTION_S), t_ns)
        later = last
        for index in range(len(states) - 2, -1, -1):
            state = states[index]
            if state.t_ns <= t_ns:
                return _between(state, later, t_ns)
            later = state
        return states[0]

    def displacement_m(self, from_ns: int, to_ns: int) -> Vector3:
        """Return how far the rig moved between two times, in site axes; a longer past than the history counts as its start."""
        a, b = self.at(from_ns), self.at(to_ns)
        if a is None or b is None:
            return (0.0, 0.0, 0.0)
        return (b.p_m[0] - a.p_m[0], b.p_m[1] - a.p_m[1], b.p_m[2] - a.p_m[2])


def _carry_on(state: InertialState, dt_s: float, t_ns: int) -> InertialState:
    (px, py, pz), (vx, vy, vz), (gx, gy, gz) = state.p_m, state.v_m_s, state.gyro_rad_s
    # beyond the next few samples a turning head is as likely to stop as to go on
    turn_s = min(dt_s, 0.1)
    q = multiply(state.wxyz_level_body, exp((gx * turn_s, gy * turn_s, gz * turn_s)))
    p = (px + vx * dt_s, py + vy * dt_s, pz + vz * dt_s)
    return InertialState(t_ns, q, p, state.v_m_s, state.gyro_rad_s, state.gained_level_m_s)


def _between(a: InertialState, b: InertialState, t_ns: int) -> InertialState:
    f = (t_ns - a.t_ns) / (b.t_ns - a.t_ns)
    q = slerp(a.wxyz_level_body, b.wxyz_level_body, f)
    (ax, ay), (bx, by) = a.gained_level_m_s, b.gained_level_m_s
    gained = (ax + f * (bx - ax), ay + f * (by - ay))
    return InertialState(t_ns, q, _mix(a.p_m, b.p_m, f), _mix(a.v_m_s, b.v_m_s, f), a.gyro_rad_s, gained)


def _mix(a: Vector3, b: Vector3, f: float) -> Vector3:
    return (a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2]))
