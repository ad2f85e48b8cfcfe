"""Where the sun stands at a date and an hour, today and in antiquity; numbers in, numbers out. `web/src/sun.ts` is its twin.

The sun as it was at this hour in an ancient year has today's season (the sun's longitude from the equinox) and today's true
solar time, under the obliquity of that year. Left out: that the year's uneven pace has moved through the seasons since (under
0.4 degrees of declination for a given day of the calendar, none for a given season), parallax (0.002 degrees), the difference
between the clocks of astronomy and ours (0.001 degrees), and nutation but for its largest term.

Reference: Jean Meeus, Astronomical Algorithms, 2nd edition, 1998, chapters 12, 13, 16, 22 and 25.
"""

from math import asin, atan2, cos, degrees, fmod, pi, radians, sin, tan
from typing import NamedTuple

UNIX_J2000_S = 946_728_000.0
"""2000-01-01 12:00 UTC."""
CENTURY_S = 36_525.0 * 86_400.0


class Sun(NamedTuple):
    """Where it is seen, refraction of the air included."""

    azimuth_rad: float
    """Clockwise from true north, [0, 2 pi)."""
    elevation_rad: float


def sun_at(t_unix_s: float, lat_deg: float, lon_deg: float, year: float | None = None) -> Sun:
    """Return the sun at a time and a place, within 0.02 degrees for 1950 to 2050.

    Args:
        t_unix_s: Seconds since 1970, UTC.
        lat_deg: North of the equator.
        lon_deg: East of Greenwich.
        year: Under the sky of that year, at the same season and true solar time; None for the time's own.
    """
    centuries = (t_unix_s - UNIX_J2000_S) / CENTURY_S
    longitude = _longitude_rad(centuries)
    obliquity = _obliquity_rad(centuries)
    ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude))
    hour_angle = radians(_sidereal_deg(t_unix_s) + lon_deg) - ascension
    tilt = obliquity if year is None else _obliquity_rad((year - 2000.0) / 100.0)
    declination = asin(sin(tilt) * sin(longitude))
    lat = radians(lat_deg)
    azimuth = atan2(sin(hour_angle), cos(hour_angle) * sin(lat) - tan(declination) * cos(lat)) + pi
    elevation = asin(sin(lat) * sin(declination) + cos(lat) * cos(declination) * cos(hour_angle))
    return Sun(azimuth % (2.0 * pi), elevation + _refraction_rad(elevation))


def direction(sun: Sun) -> tuple[float, float, float]:
    """Return the unit vector towards the sun, site frame."""
    flat = cos(sun.elevation_rad)
    return flat * sin(sun.azimuth_rad), flat * cos(sun.azimuth_rad), sin(sun.elevation_rad)


def _longitude_rad(t: float) -> float:
    """The sun's apparent longitude from the equinox of date, `t` Julian centuries from 2000 (Meeus, chapter 25)."""
    mean = 280.46646 + 36_000.76983 * t + 0.0003032 * t * t
    anomaly = radians(357.52911 + 35_999.05029 * t - 0.0001537 * t * t)
    centre = (
        (1.914602 - 0.004817 * t - 0.000014 * t * t) * sin(anomaly)
        + (0.019993 - 0.000101 * t) * sin(2.0 * anomaly)
        + 0.000289 * sin(3.0 * anomaly)
    )
    return radians(mean + centre - 0.00569 - 0.00478 * sin(_node_rad(t)))


def _obliquity_rad(t: float) -> float:
    """The tilt of the Earth's axis, with the largest term of its nutation (Meeus, chapter 22)."""
    mean = 23.4392911 - 0.0130041667 * t - 1.64e-7 * t * t + 5.036e-7 * t * t * t
    return radians(mean + 0.00256 * cos(_node_rad(t)))


def _node_rad(t: float) -> float:
    """The Moon's ascending node."""
    return radians(125.04 - 1934.136 * t)


def _sidereal_deg(t_unix_s: float) -> float:
    """Sidereal time at Greenwich (Meeus, chapter 12)."""
    days = (t_unix_s - UNIX_J2000_S) / 86_400.0
    return fmod(280.46061837 + 360.98564736629 * days, 360.0)


def _refraction_rad(elevation_rad: float) -> float:
    """How much the air lifts the sun (Saemundsson; Meeus, chapter 16); nothing where it is well below the horizon."""
    h = degrees(elevation_rad)
    return radians(1.02 / tan(radians(h + 10.3 / (h + 5.11))) / 60.0) if h > -1.0 else 0.0
