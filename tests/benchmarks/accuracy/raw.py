"""The receiver alone: each fix held until the next has arrived."""

from collections.abc import Sequence

import numpy as np

from tracker.estimator import NO_MOTION_MODEL, Origin, Pose
from tracker.geodesy import SiteFrame
from tracker.geometry import IDENTITY
from tracker.measurements import GpsFix, Measurement
from tracker.rig import Rig


def held_fixes(measurements: Sequence[Measurement], origin: Origin, rig: Rig, ticks_ns: Sequence[int]) -> list[Pose]:
    """Return the newest fix that had arrived at each tick, level and facing east; nothing before the first."""
    fixes = [m for m in measurements if isinstance(m, GpsFix) and m.valid]
    site, arrived = SiteFrame(origin), np.array([fix.t_recv_ns for fix in fixes])
    poses = []
    for fix in fixes:
        cov = np.zeros((6, 6))
        cov[:3, :3], cov[3:, 3:] = np.reshape(fix.cov_enu_m2, (3, 3)), np.pi**2 * np.eye(3)
        p = site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m)
        poses.append((p, cov))
    newest = np.searchsorted(arrived, np.array(ticks_ns), side="right") - 1
    return [
        Pose(t_ns, poses[i][0], IDENTITY, (0.0, 0.0, 0.0), poses[i][1], NO_MOTION_MODEL, False)
        for t_ns, i in zip(ticks_ns, newest.tolist(), strict=True)
        if i >= 0
    ]
