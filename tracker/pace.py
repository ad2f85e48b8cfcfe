"""How a person walks on when nothing says where they are: at the pace and in the direction they had, turning as they turn.

Doubly integrated force is worth two seconds; a receiver behind a wall may be silent for thirty. The paper says nothing of it.
"""

from math import exp, hypot, sqrt

from tracker.measurements import Vector3, Wxyz

#: A glance aside is over sooner than this, a corner is not.
FACING_S = 1.5
#: The length of the specific force is watched over this long ...
GAIT_S = 0.6
#: ... and spreads wider than this while walking, m/s2: steps show 0.6 to 3, a standing person 0.1 to 0.2.
GAIT_STD_M_S2 = 0.4
#: Slower than this the direction of a velocity is noise.
WALKING_M_S = 0.5
#: Share of a new velocity in what is remembered.
SHARE = 0.3


class Pace:
    """Learns speed and direction against the facing while velocities are known, and gives them back."""

    def __init__(self) -> None:
        self._facing_level: tuple[float, float] | None = None
        """Low-passed direction of body x, in the level frame."""
        self._norm_m_s2 = self._variance = 0.0
        self._speed_m_s = 0.0
        self._aside: tuple[float, float] = (1.0, 0.0)
        """Mean direction of travel against the facing, as (cos, sin) times its steadiness."""

    def step(self, accel_m_s2: Vector3, wxyz_level_body: Wxyz, dt_s: float) -> None:
        """Watch the gait and the facing."""
        w, x, y, z = wxyz_level_body
        forward = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z))
        ax, ay, az = accel_m_s2
        norm = sqrt(ax * ax + ay * ay + az * az)
        if self._facing_level is None:
            self._facing_level, self._norm_m_s2 = forward, norm
            return
        share = dt_s / (FACING_S + dt_s)
        fx, fy = self._facing_level
        self._facing_level = (fx + share * (forward[0] - fx), fy + share * (forward[1] - fy))
        share = dt_s / (GAIT_S + dt_s)
        off = norm - self._norm_m_s2
        self._norm_m_s2 += share * off
        self._variance += share * (off * off - self._variance)

    @property
    def is_walking(self) -> bool:
        """Whether the force shows steps."""
        return self._variance > GAIT_STD_M_S2 * GAIT_STD_M_S2

    def learn(self, v_site_m_s: Vector3, yaw_offset: tuple[float, float]) -> None:
        """Take a known velocity; `yaw_offset` is (cos, sin) of the turn from the level frame to site."""
        vx, vy, _ = v_site_m_s
        speed = hypot(vx, vy)
        facing = self._facing_site(yaw_offset)
        if speed < WALKING_M_S or facing is None:
            return
        fx, fy = facing
        ahead, left = (vx * fx + vy * fy) / speed, (vy * fx - vx * fy) / speed
        share = SHARE if self._speed_m_s else 1.0
        self._speed_m_s += share * (speed - self._speed_m_s)
        self._aside = (
            self._aside[0] + share * (ahead - self._aside[0]),
            self._aside[1] + share * (left - self._aside[1]),
        )

    def velocity_m_s(self, yaw_offset: tuple[float, float]) -> Vector3:
        """Return the velocity that is to be expected of the walker now, in site; zero while they stand."""
        facing = self._facing_site(yaw_offset)
        steadiness = hypot(*self._aside)
        if not self.is_walking or facing is None or steadiness < 1e-3:
            return (0.0, 0.0, 0.0)
        (fx, fy), (ahead, left) = facing, self._aside
        scale = self._speed_m_s / steadiness
        return (scale * (ahead * fx - left * fy), scale * (ahead * fy + left * fx), 0.0)

    def _facing_site(self, yaw_offset: tuple[float, float]) -> tuple[float, float] | None:
        if self._facing_level is None:
            return None
        (fx, fy), (c, s) = self._facing_level, yaw_offset
        length = hypot(fx, fy)
        return ((c * fx - s * fy) / length, (s * fx + c * fy) / length) if length > 0.1 else None


def share_of(dt_s: float, time_constant_s: float) -> float:
    """Return how much of a new value a first-order low-pass takes in over dt_s."""
    return 1.0 - exp(-dt_s / time_constant_s)
