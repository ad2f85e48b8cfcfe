"""Where the sun stands, and the site as it sees it."""

import numpy as np

from assets.axes import Array

SUN_AZIMUTH_RAD, SUN_ELEVATION_RAD = np.radians(212.0), np.radians(62.0)
"""An hour after noon in spring."""
SUN_UNIX_S = 1_777_115_280
"""When it stands there at Ephesus, within a degree: 25 April 2026, 11:08 UTC."""
SHADE_RADIUS_M, SHADE_CENTRE_M = 200.0, (-40.0, 0.0, 0.0)
"""The square of the site that shadows are drawn of."""


def sun_direction() -> tuple[float, float, float]:
    """Return the unit vector towards the sun, site frame."""
    flat = np.cos(SUN_ELEVATION_RAD)
    east, north = flat * np.sin(SUN_AZIMUTH_RAD), flat * np.cos(SUN_AZIMUTH_RAD)
    return float(east), float(north), float(np.sin(SUN_ELEVATION_RAD))


def sun_projection() -> Array:
    """Return the (4, 4) map from the site frame to the clip space of the shadows' picture."""
    towards = np.array(sun_direction())
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(towards, right), -towards]) / SHADE_RADIUS_M
    T = np.eye(4)
    T[:3, :3] = axes
    T[:3, 3] = -axes @ SHADE_CENTRE_M
    return T
