"""Geodetic coordinates to ECEF (the paper's eqs. 2 and 3) and to the site's ENU frame; gravity, and how the Earth turns.

ECEF never leaves this file: rotating or filtering ECEF coordinates turns metres into kilometres of lever arm.
"""

from math import atan2, cos, hypot, radians, sin, sqrt

import numpy as np

from tracker.estimator import Origin
from tracker.measurements import Matrix, Vector3

#: Equatorial radius, m, and squared eccentricity of WGS84; the paper prints 6,378,137 m and 6.69437999e-3.
WGS84_A_M = 6_378_137.0
WGS84_E2 = 6.694_379_990_14e-3
#: The Earth's rate of turning, WGS84.
EARTH_RAD_S = 7.292_115e-5


def prime_vertical_radius_m(lat_rad: float) -> float:
    """Return N of the paper's eq. 3."""
    return WGS84_A_M / sqrt(1.0 - WGS84_E2 * sin(lat_rad) ** 2)


def ecef_from_geodetic(lat_deg: float, lon_deg: float, h_ellipsoid_m: float) -> Vector3:
    """Return (x, y, z) in metres, the paper's eq. 2. The height is above the ellipsoid, not above the sea."""
    lat, lon = radians(lat_deg), radians(lon_deg)
    N = prime_vertical_radius_m(lat)
    return (
        (N + h_ellipsoid_m) * cos(lat) * cos(lon),
        (N + h_ellipsoid_m) * cos(lat) * sin(lon),
        ((1.0 - WGS84_E2) * N + h_ellipsoid_m) * sin(lat),
    )


def geodetic_from_ecef(p_ecef_m: Vector3) -> tuple[float, float, float]:
    """Return latitude and longitude in degrees and ellipsoidal height in metres.

    Fixed-point iteration on the latitude (Bowring's start); below a tenth of a millimetre within 10 km of the surface.
    """
    x, y, z = p_ecef_m
    b_m = WGS84_A_M * sqrt(1.0 - WGS84_E2)
    p = hypot(x, y)
    reduced = atan2(z * WGS84_A_M, p * b_m)
    second_e2 = WGS84_E2 / (1.0 - WGS84_E2)
    for _ in range(3):
        lat = atan2(z + second_e2 * b_m * sin(reduced) ** 3, p - WGS84_E2 * WGS84_A_M * cos(reduced) ** 3)
        reduced = atan2(b_m * sin(lat), WGS84_A_M * cos(lat))
    # this form of the height is good at the poles too, where p / cos(lat) is not
    h_m = p * cos(lat) + z * sin(lat) - WGS84_A_M * sqrt(1.0 - WGS84_E2 * sin(lat) ** 2)
    return float(np.degrees(lat)), float(np.degrees(atan2(y, x))), h_m


class SiteFrame:
    """ENU about an origin: x east, y north, z up (REP 103)."""

    def __init__(self, origin: Origin) -> None:
        self.origin = origin
        lat, lon = radians(origin.lat_deg), radians(origin.lon_deg)
        self._p_ecef_site_m = np.array(ecef_from_geodetic(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m))
        self.R_site_ecef: Matrix = np.array(
            [
                [-sin(lon), cos(lon), 0.0],
                [-sin(lat) * cos(lon), -sin(lat) * sin(lon), cos(lat)],
                [cos(lat) * cos(lon), cos(lat) * sin(lon), sin(lat)],
            ]
        )

    def site_from_geodetic(self, lat_deg: float, lon_deg: float, h_ellipsoid_m: float) -> Vector3:
        """Return (east, north, up) in metres."""
        return self.site_from_ecef(ecef_from_geodetic(lat_deg, lon_deg, h_ellipsoid_m))

    def site_from_ecef(self, p_ecef_m: Vector3) -> Vector3:
        """Return (east, north, up) in metres of a point in ECEF."""
        east, north, up = self.R_site_ecef @ (np.array(p_ecef_m) - self._p_ecef_site_m)
        return float(east), float(north), float(up)

    def geodetic_from_site(self, p_site_m: Vector3) -> tuple[float, float, float]:
        """Return latitude and longitude in degrees and ellipsoidal height in metres."""
        x, y, z = self._p_ecef_site_m + self.R_site_ecef.T @ np.array(p_site_m)
        return geodetic_from_ecef((float(x), float(y), float(z)))

    def T_from(self, other: Origin) -> Matrix:
        """Return T_site_map, (4, 4), of an ENU frame `map` laid at another origin."""
        there = SiteFrame(other)
        T_site_map = np.eye(4)
        T_site_map[:3, :3] = self.R_site_ecef @ there.R_site_ecef.T
        T_site_map[:3, 3] = self.R_site_ecef @ (there._p_ecef_site_m - self._p_ecef_site_m)
        return T_site_map


def gravity_m_s2(lat_deg: float, h_ellipsoid_m: float) -> float:
    """Return normal gravity: Somigliana's formula with the free-air gradient (WGS84, NIMA TR8350.2 eq. 4-1)."""
    sine2 = sin(radians(lat_deg)) ** 2
    surface = 9.7803253359 * (1.0 + 0.00193185265241 * sine2) / sqrt(1.0 - WGS84_E2 * sine2)
    return surface - 3.086e-6 * h_ellipsoid_m


def earth_rate_rad_s(lat_deg: float) -> Vector3:
    """Return how the Earth turns, site axes: a gyroscope feels it, a sixth of a degree in 40 s, wherever the rig faces."""
    lat = radians(lat_deg)
    return (0.0, EARTH_RAD_S * cos(lat), EARTH_RAD_S * sin(lat))
