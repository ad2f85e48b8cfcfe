"""How high a visitor's eyes are who stands somewhere on a site: assets and tracker joined for the estimators that ask."""

from math import asin, cos, inf, radians, sin, sqrt

from assets.footholds import Footholds
from assets.site import Site
from assets.walkable import walkable
from tracker.estimator import Origin
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix
from tracker.precise.ground import EyeHeight

#: A walk that begins further than this from a site was recorded elsewhere.
FAR_M = 3_000.0
#: Mean radius (IUGG).
EARTH_RADIUS_M = 6_371_000.0


def origin_of(site: Site) -> Origin:
    """Return where a site's own frame is laid."""
    return Origin(site.origin.lat_deg, site.origin.lon_deg, site.origin.h_ellipsoid_m)


def distance_m(fix: GpsFix, origin: Origin) -> float:
    """Return how far over the ground a fix is from an origin, by the haversine of a round Earth: within half a per cent."""
    there, here = radians(fix.lat_deg), radians(origin.lat_deg)
    across = cos(there) * cos(here) * sin(radians(fix.lon_deg - origin.lon_deg) / 2.0) ** 2
    return 2.0 * EARTH_RADIUS_M * asin(sqrt(min(1.0, sin((there - here) / 2.0) ** 2 + across)))


def eye_heights(site: Site, origin: Origin | None = None) -> EyeHeight:
    """Return the height of the eyes above what one stands on today, infinite where nobody can stand.

    Args:
        site: Whose walkable surface, and how high the eyes are above it.
        origin: Where the frame of the question is laid; None for the site's own.
    """
    footholds, eye_height_m = Footholds.of(walkable(site), "today"), site.eye_height_m
    T_asked_site = SiteFrame(origin or origin_of(site)).T_from(origin_of(site))
    (r00, r01, _, e0), (r10, r11, _, n0), (r20, r21, r22, up0) = T_asked_site[:3].tolist()

    # a function, not a method: estimators are copied at every checkpoint, and functions are shared
    def eyes_z_m(east_m: float, north_m: float) -> float:
        e, n = east_m - e0, north_m - n0  # what is left out is the height by the frames' tilt: millimetres
        x, y = r00 * e + r10 * n, r01 * e + r11 * n
        ground_m = footholds.height_m(x, y)
        return inf if ground_m is None else up0 + r20 * x + r21 * y + r22 * (ground_m + eye_height_m)

    return eyes_z_m
