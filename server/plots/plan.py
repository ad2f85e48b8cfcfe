"""A site's plan under a path: what stands there, as outlines about the log's origin."""

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from assets.site import Monument, Site
from server.plots.trace import Array
from tracker.estimator import Origin
from tracker.geodesy import SiteFrame

Plan: TypeAlias = tuple[Array, ...]
"""Outlines of what stands above the ground, each (corners, 2): east and north in metres."""

#: A walk further from a site than this was not made there.
_NEAR_M = 1000.0
#: What one walks on would hide, as one grey field, what one walks around.
_GROUND = frozenset({"court", "paving", "steps", "terrace"})


def plan_of(site: Site, origin: Origin) -> Plan:
    """Return a site's footprints about an origin; none where the site lies somewhere else."""
    e, n, _ = SiteFrame(origin).site_from_geodetic(site.origin.lat_deg, site.origin.lon_deg, site.origin.h_ellipsoid_m)
    if np.hypot(e, n) > _NEAR_M:
        return ()
    outlines = (np.array(monument.footprint.corners_en_m, float) for monument in _standing(site))
    return tuple(outline + np.array([e, n]) for outline in outlines)


def _standing(site: Site) -> Iterator[Monument]:
    return (monument for monument in site.monuments if monument.kind not in _GROUND)


def draw_plan(axes: Axes, plan: Plan) -> None:
    """Draw the outlines faintly, without changing what the axes show."""
    for outline in plan:
        axes.add_patch(
            Polygon(outline, closed=True, facecolor="#efe9dd", edgecolor="#d3c9b6", linewidth=0.6, zorder=0.5)
        )
