"""The estimator `truth`: ground truth passed through, to prove everything that comes after a tracker."""

from collections import deque
from math import isfinite, pi

import numpy as np

from tracker.estimator import NO_MOTION_MODEL, Innovation, Pose, Snapshot
from tracker.geometry import multiply, normalise, slerp, wxyz_from_matrix
from tracker.measurements import Matrix, Measurement, Outcome, TruePose, Vector3

#: Poses kept: two seconds and more of any truth up to 400 Hz.
_KEPT = 1024
#: A prediction beyond the newest truth goes on with its velocity at most this long.
_LONGEST_PREDICTION_S = 1.0


class TruthEstimator:
    """Interpolates ground truth: lerp of the position, slerp of the attitude."""

    name = "truth"
    uses_camera = False

    def __init__(self, T_site_map: Matrix) -> None:
        """`T_site_map`, (4, 4): the log's map frame in site."""
        self._R_site_map = T_site_map[:3, :3]
        self._p_site_map_m = T_site_map[:3, 3]
        self._wxyz_site_map = wxyz_from_matrix(self._R_site_map)
        self._poses: deque[TruePose] = deque(maxlen=_KEPT)

    def step(self, measurement: Measurement) -> Outcome:
        """Take ground truth; everything else is ignored."""
        if not isinstance(measurement, TruePose):
            return Outcome.IGNORED
        if not measurement.position_known:
            return Outcome.REJECTED_WEAK
        if not all(map(isfinite, (*measurement.p_map_body_m, *measurement.wxyz_map_body))):
            return Outcome.REJECTED_NOT_FINITE
        if self._poses and measurement.t_ns <= self._poses[-1].t_ns:
            return Outcome.REJECTED_STALE
        self._poses.append(measurement)
        return Outcome.USED

    def predict(self, t_ns: int) -> Pose | None:
        """Return the true pose at t_ns; None before the first."""
        if not self._poses:
            return None
        a, b = self._around(t_ns)
        if a is b or t_ns >= b.t_ns:
            dt_s = min(max(0.0, (t_ns - b.t_ns) * 1e-9), _LONGEST_PREDICTION_S)
            v = b.v_map_m_s or _slope(a, b)
            p = (b.p_map_body_m[0] + v[0] * dt_s, b.p_map_body_m[1] + v[1] * dt_s, b.p_map_body_m[2] + v[2] * dt_s)
            return self._pose(t_ns, p, b, b.wxyz_map_body, v)
        f = max(0.0, (t_ns - a.t_ns) / (b.t_ns - a.t_ns))
        (ax, ay, az), (bx, by, bz) = a.p_map_body_m, b.p_map_body_m
        p = (ax + f * (bx - ax), ay + f * (by - ay), az + f * (bz - az))
        return self._pose(t_ns, p, a, slerp(a.wxyz_map_body, b.wxyz_map_body, f), _slope(a, b))

    def _around(self, t_ns: int) -> tuple[TruePose, TruePose]:
        """Return the two poses on either side of t_ns, or the last two (or one twice) where t_ns lies beyond."""
        poses = self._poses
        for index in range(len(poses) - 2, -1, -1):
            if poses[index].t_ns <= t_ns or index == 0:
                return poses[index], poses[index + 1]
        return poses[-1], poses[-1]

    def _pose(self, t_ns: int, p_map_m: Vector3, truth: TruePose, wxyz_map: tuple[float, ...], v: Vector3) -> Pose:
        x, y, z = (float(value) for value in self._R_site_map @ p_map_m + self._p_site_map_m)
        vx, vy, vz = (float(value) for value in self._R_site_map @ v)
        w, i, j, k = wxyz_map
        known = (truth.tilt_known, truth.tilt_known, truth.heading_known)
        rotation = (1e-12 if is_known else pi**2 / 3.0 for is_known in known)
        position = (truth.sigma_h_m**2 + 1e-12, truth.sigma_h_m**2 + 1e-12, 1e-12 if truth.height_known else 1e4)
        q = normalise(multiply(self._wxyz_site_map, (w, i, j, k)))
        cov = np.diag([*position, *rotation])
        return Pose(t_ns, (x, y, z), q, (vx, vy, vz), cov, NO_MOTION_MODEL, truth.heading_known)

    def innovations(self) -> list[Innovation]:
        """Return nothing: truth is not filtered."""
        return []

    def snapshot(self) -> Snapshot:
        """Return the whole state."""
        return tuple(self._poses)

    def restore(self, snapshot: Snapshot) -> None:
        """Become what the snapshot was taken of."""
        self._poses = deque(snapshot, maxlen=_KEPT)


def _slope(a: TruePose, b: TruePose) -> Vector3:
    if a is b:
        return (0.0, 0.0, 0.0)
    dt_s = (b.t_ns - a.t_ns) * 1e-9
    (ax, ay, az), (bx, by, bz) = a.p_map_body_m, b.p_map_body_m
    return ((bx - ax) / dt_s, (by - ay) / dt_s, (bz - az) / dt_s)
