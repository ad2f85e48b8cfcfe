"""How a stored picture must be turned to stand upright: a phone held upright stores its pictures on their side."""

from math import atan2, hypot, pi

from tracker.estimator import Snapshot
from tracker.measurements import ImuSample, Matrix
from tracker.rig import Rig

#: Share of a new sample in the running mean of gravity: half a second at 250 Hz.
_SHARE = 0.01
#: A turn is changed only when the picture leans this far off it: a head tilted by 45 degrees must not make it flutter.
_HOLD_RAD = 60.0 * pi / 180.0
#: Looking up or down, with less of gravity than this in the picture's plane, nothing is upright.
_LEAST = 0.4


class Upright:
    """Follows gravity in the picture's plane, in quarter turns."""

    def __init__(self, rig: Rig) -> None:
        self._R_cam_body: Matrix = rig.T_body_cam[:3, :3].T
        self._up_body: tuple[float, float, float] | None = None
        self.quarter_turns = 0
        """Clockwise turns of 90 degrees, 0 to 3, that make the stored picture upright."""

    def step(self, sample: ImuSample) -> None:
        """Take a specific force: on average it points up."""
        ax, ay, az = sample.accel_m_s2
        norm = hypot(ax, ay, az)
        if not 1.0 < norm < 100.0:
            return
        first = self._up_body is None
        x, y, z = self._up_body or (ax / norm, ay / norm, az / norm)
        keep = 1.0 - _SHARE
        up_body = (keep * x + _SHARE * ax / norm, keep * y + _SHARE * ay / norm, keep * z + _SHARE * az / norm)
        self._up_body = up_body
        self._turn(up_body, 0.0 if first else _HOLD_RAD)

    def _turn(self, up_body: tuple[float, float, float], hold_rad: float) -> None:
        right, down, _ = self._R_cam_body @ up_body
        if hypot(right, down) < _LEAST:
            return
        # clockwise turns take the picture's up (right, down) to (0, -1)
        wanted_rad = -pi / 2 - atan2(down, right)
        off_rad = (wanted_rad - self.quarter_turns * pi / 2 + pi) % (2.0 * pi) - pi
        if abs(off_rad) > hold_rad:
            self.quarter_turns = round(wanted_rad / (pi / 2)) % 4

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return self._up_body, self.quarter_turns

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._up_body, self.quarter_turns = snapshot
