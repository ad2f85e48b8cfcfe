"""The satellites in view, out of GSV and GSA sentences."""

from dataclasses import dataclass
from typing import TypeAlias

from tracker.sources.nmea_sentence import Gsa, Gsv, InView

#: A list that was not renewed for so long is no longer what is in view.
_KEPT_NS = 15_000_000_000
#: Numbers by which NMEA 0183 tells systems apart where a sentence does not name one.
_RANGES = (
    (1, 32, "GPS"),
    (33, 64, "SBAS"),
    (65, 99, "GLONASS"),
    (120, 158, "SBAS"),
    (193, 200, "QZSS"),
    (201, 264, "BeiDou"),
    (301, 336, "Galileo"),
    (401, 463, "BeiDou"),
)

_Name: TypeAlias = tuple[str, int]


@dataclass(frozen=True, slots=True)
class Satellite:
    """One satellite in view."""

    system: str
    number: int
    elevation_rad: float | None
    azimuth_rad: float | None
    """Clockwise from true north."""
    snr_db_hz: float | None
    """Of its strongest signal; None while it is not tracked."""
    used: bool
    """Whether the last complete epoch's position was made from it too."""


class Sky:
    """What the receiver sees. A list counts when its last part is here."""

    def __init__(self) -> None:
        self._parts: dict[tuple[str | None, str], list[Gsv]] = {}
        self._lists: dict[tuple[str | None, str], tuple[int, tuple[InView, ...]]] = {}
        self._used: set[_Name] = set()
        self._named: set[_Name] | None = None

    def take_view(self, gsv: Gsv, t_ns: int) -> None:
        """Take a part of a list; one whose predecessor was lost makes no list."""
        parts = self._parts.setdefault((gsv.system, gsv.signal), [])
        if gsv.part == 1:
            parts.clear()
        if len(parts) != gsv.part - 1:
            parts.clear()
            return
        parts.append(gsv)
        if gsv.part == gsv.parts:
            listed = tuple(satellite for part in parts for satellite in part.satellites)
            self._lists[gsv.system, gsv.signal] = (t_ns, listed)

    def take_used(self, gsa: Gsa) -> None:
        """Take satellites that this epoch's position was made from; one sentence names at most twelve."""
        self._named = (self._named or set()) | {_name(gsa.system, number) for number in gsa.used}

    def end_epoch(self) -> None:
        """Make what the epoch's sentences named what is used, where they named any or none."""
        if self._named is not None:
            self._used, self._named = self._named, None

    def satellites(self, t_ns: int) -> tuple[Satellite, ...]:
        """Return the satellites in view now, by system and number."""
        found: dict[_Name, Satellite] = {}
        for (system, _), (at_ns, listed) in self._lists.items():
            for seen in listed if t_ns - at_ns <= _KEPT_NS else ():
                name = _name(system, seen.number)
                known = found.get(name)
                if known is None or (seen.snr_db_hz or 0.0) > (known.snr_db_hz or 0.0):
                    place = (seen.elevation_rad, seen.azimuth_rad)
                    found[name] = Satellite(*name, *place, seen.snr_db_hz, name in self._used)
        return tuple(found[name] for name in sorted(found))


def _name(system: str | None, number: int) -> _Name:
    """Return system and number: receivers list SBAS as GPS, and may leave the system to be told by the number."""
    if system is None or (system == "GPS" and number > 32):
        named = next((name for least, most, name in _RANGES if least <= number <= most), "unknown")
        return named, number
    return system, number
