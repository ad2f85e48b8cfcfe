"""One NMEA sentence as a value in SI units; `pynmeagps` reads the fields.

Whatever a sentence holds, only `MalformedInput` leaves this file.
"""

from dataclasses import dataclass
from datetime import date, time
from math import isfinite, radians
from typing import Any, TypeAlias

from pynmeagps import NMEAReader
from pynmeagps.nmeahelpers import calc_checksum

from tracker.errors import MalformedInput

_KNOT_M_S = 1852.0 / 3600.0
_KM_H_M_S = 1.0 / 3.6
_NS = 1_000_000_000
#: Sentences of which only the time is read: it tells one epoch from the next.
_TIMED = frozenset({"GNS", "GLL", "ZDA", "GBS", "GRS"})
#: Modes of RMC and VTG, as the quality that GGA would state.
_QUALITY_OF_MODE = {"A": 1, "D": 2, "P": 3, "R": 4, "F": 5, "E": 6, "M": 7, "S": 8, "N": 0, "": 1}
#: Constellations by talker and by the system number of NMEA 4.1.
_SYSTEMS = {
    "GP": "GPS",
    "GL": "GLONASS",
    "GA": "Galileo",
    "GB": "BeiDou",
    "BD": "BeiDou",
    "GQ": "QZSS",
    "QZ": "QZSS",
    "GI": "NavIC",
}
_SYSTEM_NUMBERS = {"1": "GPS", "2": "GLONASS", "3": "Galileo", "4": "BeiDou", "5": "QZSS", "6": "NavIC"}


@dataclass(frozen=True, slots=True)
class Gga:
    """Position, quality and height."""

    time_of_day_ns: int | None
    lat_deg: float | None
    lon_deg: float | None
    quality: int
    """0 none, 1 autonomous, 2 differential, 3 PPS, 4 RTK fixed, 5 RTK float, 6 estimated, 7 manual, 8 simulated."""
    satellites_used: int | None
    hdop: float | None
    h_msl_m: float | None
    geoid_separation_m: float | None


@dataclass(frozen=True, slots=True)
class Rmc:
    """Position, speed, course and date."""

    time_of_day_ns: int | None
    date: date | None
    lat_deg: float | None
    lon_deg: float | None
    quality: int
    """As of GGA; 0 where the receiver warns of it."""
    speed_m_s: float | None
    heading_rad: float | None
    """Of the motion, clockwise from true north."""


@dataclass(frozen=True, slots=True)
class Vtg:
    """Speed and course."""

    quality: int
    speed_m_s: float | None
    heading_rad: float | None


@dataclass(frozen=True, slots=True)
class Gst:
    """The receiver's own standard deviations."""

    time_of_day_ns: int | None
    sigma_east_m: float | None
    sigma_north_m: float | None
    sigma_up_m: float | None


@dataclass(frozen=True, slots=True)
class Gsa:
    """Satellites that the position was made from, and dilutions of precision."""

    system: str | None
    """None where the sentence does not say: satellites of several systems, told apart by their numbers."""
    used: tuple[int, ...]
    dimensions: int | None
    """1 no position, 2 height held, 3."""
    hdop: float | None
    vdop: float | None


@dataclass(frozen=True, slots=True)
class InView:
    """One satellite as GSV lists it."""

    number: int
    elevation_rad: float | None
    azimuth_rad: float | None
    snr_db_hz: float | None
    """None while it is not tracked."""


@dataclass(frozen=True, slots=True)
class Gsv:
    """A part of the list of satellites in view of one system, in one of its signals."""

    system: str | None
    signal: str
    part: int
    parts: int
    satellites: tuple[InView, ...]


@dataclass(frozen=True, slots=True)
class Timed:
    """Another sentence that says the time."""

    time_of_day_ns: int | None


Sentence: TypeAlias = Gga | Rmc | Vtg | Gst | Gsa | Gsv | Timed


def parse(content: str) -> Sentence | None:
    """Return the sentence whose text between `$` and `*` this is; None for a kind that nobody needs here.

    Raises:
        MalformedInput: The checksum was right and yet it is no sentence of its kind.
    """
    identifier = content.partition(",")[0]
    kind = identifier[2:]
    if len(identifier) != 5 or identifier.startswith("P") or (kind not in _READERS and kind not in _TIMED):
        return None
    try:
        fields: Any = NMEAReader.parse(f"${content}*{calc_checksum(content)}".encode("ascii"))
        if kind in _TIMED:
            return Timed(_time_of_day(fields))
        sentence: Sentence = _READERS[kind](fields)
        return sentence
    except MalformedInput:
        raise
    except Exception as error:  # whatever hostile text makes the parser raise
        raise MalformedInput(f"This is no {identifier} sentence: {content[:100]}") from error


def _gga(fields: Any) -> Gga:
    lat_deg, lon_deg = _place(fields)
    quality = _number(fields, "quality", 0, 9)
    used = _number(fields, "numSV", 0, 999)
    return Gga(
        _time_of_day(fields),
        lat_deg,
        lon_deg,
        int(quality or 0),
        None if used is None else int(used),
        _number(fields, "HDOP", 0.0, 1e4),
        _number(fields, "alt", -12_000.0, 1e8),
        _number(fields, "sep", -200.0, 200.0),
    )


def _rmc(fields: Any) -> Rmc:
    lat_deg, lon_deg = _place(fields)
    day = getattr(fields, "date", "")
    return Rmc(
        _time_of_day(fields),
        day if isinstance(day, date) else None,
        lat_deg,
        lon_deg,
        _quality_of_mode(fields) if getattr(fields, "status", "") == "A" else 0,
        _scaled(_number(fields, "spd", 0.0, 1e5), _KNOT_M_S),
        _angle(fields, "cog"),
    )


def _vtg(fields: Any) -> Vtg:
    speed_m_s = _scaled(_number(fields, "sogn", 0.0, 1e5), _KNOT_M_S)
    if speed_m_s is None:
        speed_m_s = _scaled(_number(fields, "sogk", 0.0, 1e5), _KM_H_M_S)
    return Vtg(_quality_of_mode(fields), speed_m_s, _angle(fields, "cogt"))


def _gst(fields: Any) -> Gst:
    east_m, north_m, up_m = (_number(fields, name, 0.0, 1e9) for name in ("stdLong", "stdLat", "stdAlt"))
    return Gst(_time_of_day(fields), east_m, north_m, up_m)


def _gsa(fields: Any) -> Gsa:
    numbers = (_number(fields, f"svid_{index:02d}", 0, 9999) for index in range(1, 13))
    dimensions = _number(fields, "navMode", 1, 3)
    system = _SYSTEM_NUMBERS.get(str(getattr(fields, "systemId", "")), _SYSTEMS.get(fields.talker))
    return Gsa(
        system,
        tuple(int(number) for number in numbers if number),
        None if dimensions is None else int(dimensions),
        _number(fields, "HDOP", 0.0, 1e4),
        _number(fields, "VDOP", 0.0, 1e4),
    )


def _gsv(fields: Any) -> Gsv:
    parts, part = _number(fields, "numMsg", 1, 99), _number(fields, "msgNum", 1, 99)
    if parts is None or part is None or part > parts:
        raise MalformedInput("A GSV sentence says which part of how many it is.")
    found = []
    for index in range(1, 5):
        number = _number(fields, f"svid_{index:02d}", 0, 9999)
        if number:
            elevation_rad, azimuth_rad = _angle(fields, f"elv_{index:02d}"), _angle(fields, f"az_{index:02d}")
            snr_db_hz = _number(fields, f"cno_{index:02d}", 0.0, 999.0)
            found.append(InView(int(number), elevation_rad, azimuth_rad, snr_db_hz))
    signal = str(getattr(fields, "signalID", ""))[:1]
    return Gsv(_SYSTEMS.get(fields.talker), signal, int(part), int(parts), tuple(found))


_READERS: dict[str, Any] = {"GGA": _gga, "RMC": _rmc, "VTG": _vtg, "GST": _gst, "GSA": _gsa, "GSV": _gsv}


def _number(fields: Any, name: str, least: float, most: float) -> float | None:
    """Return a field; None where it is empty or the sentence ends before it."""
    value = getattr(fields, name, "")
    if value == "":
        return None
    number = float(value)
    if not (isfinite(number) and least <= number <= most):
        raise MalformedInput(f"{name} is {value}, outside {least} to {most}.")
    return number


def _scaled(value: float | None, unit: float) -> float | None:
    return None if value is None else value * unit


def _angle(fields: Any, name: str) -> float | None:
    degrees = _number(fields, name, -360.0, 360.0)
    return None if degrees is None else radians(degrees)


def _place(fields: Any) -> tuple[float | None, float | None]:
    return _number(fields, "lat", -90.0, 90.0), _number(fields, "lon", -180.0, 180.0)


def _time_of_day(fields: Any) -> int | None:
    value = getattr(fields, "time", "")
    if not isinstance(value, time):
        return None
    return ((value.hour * 60 + value.minute) * 60 + value.second) * _NS + value.microsecond * 1000


def _quality_of_mode(fields: Any) -> int:
    return _QUALITY_OF_MODE.get(str(getattr(fields, "posMode", "")), 0)
