"""gpsd's own view of a position (TPV) as the sentences that the receiver would have said, with nothing rounded away.

For receivers that speak a binary protocol. gpsd writes NMEA for these too, but to a ten-thousandth of a minute (0.18 m), without
the receiver's error estimates, and with a geoid of its own, so that heights are off by metres (seen with gpsd 3.22 and NAV-PVT).

Reference:
    gpsd_json(5): https://gpsd.gitlab.io/gpsd/gpsd_json.html
"""

from collections.abc import Mapping
from datetime import datetime
from functools import reduce
from math import sqrt
from operator import xor
from typing import Any

#: TPV's status as GGA's quality and RMC's mode; 1, an ordinary fix, is left out. 6 is dead reckoning helped by satellites.
_QUALITIES = {2: (2, "D"), 3: (4, "R"), 4: (5, "F"), 5: (6, "E"), 6: (6, "E"), 7: (7, "M"), 8: (8, "S"), 9: (3, "P")}
_FIX = 2
"""Of TPV's modes: 2 in two dimensions, 3 in three."""
_KNOT_M_S = 1852.0 / 3600.0


def sentences(tpv: Mapping[str, Any], sky: Mapping[str, Any]) -> bytes:
    """Return GGA, RMC and, where the errors are told, GST; nothing where TPV tells no time.

    Args:
        tpv: The TPV object, whatever it holds.
        sky: The last SKY object, for its dilutions.
    """
    try:
        utc = datetime.fromisoformat(str(tpv.get("time")).replace("Z", "+00:00"))
    except ValueError:
        return b""
    time, place, height = f"{utc:%H%M%S}.{utc.microsecond // 1000:03d}", _place(tpv), _height(tpv)
    status = tpv.get("status")
    quality, mode = _QUALITIES.get(status, (1, "A")) if isinstance(status, int) else (1, "A")
    is_fix = place != ",,," and (_number(tpv, "mode") or 0.0) >= _FIX
    used, hdop = _text(_number(sky, "uSat"), ".0f"), _text(_number(sky, "hdop"), ".2f")
    speed_m_s, course = _number(tpv, "speed"), _text(_number(tpv, "track"), ".3f")
    knots = _text(None if speed_m_s is None else speed_m_s / _KNOT_M_S, ".4f")
    found = [
        f"GNGGA,{time},{place},{quality if is_fix else 0},{used},{hdop},{height},,",
        f"GNRMC,{time},{'A' if is_fix else 'V'},{place},{knots},{course},{utc:%d%m%y},,,{mode if is_fix else 'N'}",
    ]
    deviations = _deviations(tpv)
    if is_fix and deviations:
        found.append(f"GNGST,{time},,,,,{deviations}")
    return b"".join(_whole(content) for content in found)


def _whole(content: str) -> bytes:
    data = content.encode("ascii")
    return b"$%s*%02X\r\n" % (data, reduce(xor, data, 0))


def _number(fields: Mapping[str, Any], name: str) -> float | None:
    value = fields.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e9:
        return None
    return float(value)


def _text(value: float | None, form: str) -> str:
    return "" if value is None else format(value, form)


def _place(tpv: Mapping[str, Any]) -> str:
    lat_deg, lon_deg = _number(tpv, "lat"), _number(tpv, "lon")
    if lat_deg is None or lon_deg is None or abs(lat_deg) > 90.0 or abs(lon_deg) > 180.0:
        return ",,,"
    return f"{_minutes(lat_deg, 2)},{'S' if lat_deg < 0 else 'N'},{_minutes(lon_deg, 3)},{'W' if lon_deg < 0 else 'E'}"


def _minutes(degrees: float, digits: int) -> str:
    """Return `ddmm.mmmmmmmm`, to 20 um."""
    whole, rest = divmod(round(abs(degrees) * 60e8), 60 * 10**8)
    return f"{whole:0{digits}d}{rest // 10**8:02d}.{rest % 10**8:08d}"


def _height(tpv: Mapping[str, Any]) -> str:
    """Return height above the sea and the geoid's separation, which add up to the receiver's height above the ellipsoid."""
    h_ellipsoid_m, separation_m, h_msl_m = (_number(tpv, name) for name in ("altHAE", "geoidSep", "altMSL"))
    if (_number(tpv, "mode") or 0.0) <= _FIX:
        return ",,,"
    if h_ellipsoid_m is not None:
        separation_m = separation_m or 0.0
        return f"{h_ellipsoid_m - separation_m:.4f},M,{separation_m:.4f},M"
    return ",,," if h_msl_m is None else f"{h_msl_m:.4f},M,{_text(separation_m, '.4f')},M"


def _deviations(tpv: Mapping[str, Any]) -> str:
    """Return north, east and up, one sigma. `eph` is the receiver's own estimate, of both axes together."""
    both_m, up_m = _number(tpv, "eph"), _number(tpv, "epv")
    if both_m is None or both_m <= 0.0:
        return ""
    each_m = both_m / sqrt(2.0)
    return f"{each_m:.4f},{each_m:.4f},{_text(up_m, '.4f')}"
