"""Velocity and position by integration: the specific force turned to ENU, gravity removed, integrated twice.

The paper integrates within four samples (16 ms), which gives micrometres; its conclusion says that the IMU carries the position
from one GPS fix to the next, and that is what is done here: displacements are read between any two times of the last seconds.
"""

from collections import deque
from dataclasses import dataclass
from math import exp as exponential

from tracker.calibration import MeanSample
from tracker.geometry import exp, multiply, rotate, slerp, wxyz_from_yaw
from tracker.measurements import Vector3, Wxyz

#: How far back displacements can be read: longer than the latest GPS fix and the oldest keyframe.
HISTORY_S = 2.5
#: After this long without a reset the velocity can only have drifted, and is let go of with this time constant.
TRUSTED_S = 2.0
LEAK_S = 1.0
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


class InertialPath:
    """The recent path of the rig by dead reckoning, in site axes."""

    def __init__(self, gravity_m_s2: float) -> None:
        self._gravity = gravity_m_s2
        self._states: deque[InertialState] = deque()
        self._reset_ns: int | None = None

    @property
    def newest(self) -> InertialState | None:
        """The integral up to the last sample."""
        return self._states[-1] if self._states else None

    def step(self, mean: MeanSample, wxyz_level_body: Wxyz, yaw_offset_rad: float | None) -> None:
        """Integrate one mean sample; while north is unknown its force has no direction, and the velocity is only held."""
        last = self.newest
        if last is None:
            zero = (0.0, 0.0, 0.0)
            self._states.append(InertialState(mean.t_ns, wxyz_level_body, zero, zero, mean.gyro_rad_s))
            return
        dt, (vx, vy, vz), (px, py, pz) = mean.dt_s, last.v_m_s, last.p_m
        ax = ay = az = 0.0
        if yaw_offset_rad is not None:
            q = multiply(wxyz_from_yaw(yaw_offset_rad), wxyz_level_body)
            ax, ay, az = rotate(q, mean.accel_m_s2)
            az -= self._gravity
        half = 0.5 * dt * dt
        p = (px + vx * dt + ax * half, py + vy * dt + ay * half, pz + vz * dt + az * half)
        keep = 1.0
        if self._reset_ns is None or mean.t_ns - self._reset_ns > TRUSTED_S * 1e9:
            keep = exponential(-dt / LEAK_S)
        v = ((vx + ax * dt) * keep, (vy + ay * dt) * keep, (vz + az * dt) * keep)
        self._states.append(InertialState(mean.t_ns, wxyz_level_body, p, v, mean.gyro_rad_s))
        while mean.t_ns - self._states[0].t_ns > HISTORY_S * 1e9:
            self._states.popleft()

    def reset_velocity(self, v_site_m_s: Vector3) -> None:
        """Replace the velocity: a fix has just corrected it."""
        last = self._states[-1]
        self._states[-1] = InertialState(last.t_ns, last.wxyz_level_body, last.p_m, v_site_m_s, last.gyro_rad_s)
        self._reset_ns = last.t_ns

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
    return InertialState(t_ns, q, p, state.v_m_s, state.gyro_rad_s)


def _between(a: InertialState, b: InertialState, t_ns: int) -> InertialState:
    f = (t_ns - a.t_ns) / (b.t_ns - a.t_ns)
    q = slerp(a.wxyz_level_body, b.wxyz_level_body, f)
    return InertialState(t_ns, q, _mix(a.p_m, b.p_m, f), _mix(a.v_m_s, b.v_m_s, f), a.gyro_rad_s)


def _mix(a: Vector3, b: Vector3, f: float) -> Vector3:
    return (a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2]))
