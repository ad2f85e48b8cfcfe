"""A log of NMEA counted by a few lines that share nothing with the reader: positions by GGA, lines by their checksums."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracker.measurements import GpsFix, Measurement


@dataclass(frozen=True)
class Counted:
    """What a log holds."""

    places_deg: NDArray[np.float64]
    """(N, 2) latitude and longitude of every valid GGA."""
    invalid: int
    corrupt: int


def count(data: bytes) -> Counted:
    """Count."""
    places, invalid, corrupt = [], 0, 0
    for line in re.findall(rb"\$[^$\r\n]*", data):
        body, _, stated = line[1:].partition(b"*")
        value = 0
        for byte in body:
            value ^= byte
        if stated[:2].upper() != f"{value:02X}".encode():
            corrupt += 1
        elif body[2:5] == b"GGA":
            fields = body.decode().split(",")
            if fields[6] == "0":
                invalid += 1
            else:
                places.append((degrees(*fields[2:4]), degrees(*fields[4:6])))
    return Counted(np.array(places).reshape(-1, 2), invalid, corrupt)


def places_deg(found: Sequence[Measurement]) -> NDArray[np.float64]:
    """Return the places of valid fixes, (N, 2)."""
    fixes = [m for m in found if isinstance(m, GpsFix) and m.valid]
    return np.array([(fix.lat_deg, fix.lon_deg) for fix in fixes]).reshape(-1, 2)


def is_passed(places: NDArray[np.float64], expected: NDArray[np.float64]) -> bool:
    """Return whether all expected places are among others, in order and with none between them, to 10 um."""
    starts = range(len(places) - len(expected) + 1)
    return any(np.allclose(places[i : i + len(expected)], expected, rtol=0.0, atol=1e-10) for i in starts)


def degrees(text: str, side: str) -> float:
    """Return the degrees of `ddmm.mmmm` or `dddmm.mmmm`."""
    whole = float(text) // 100
    value = whole + (float(text) - whole * 100) / 60
    return -value if side in "SW" else value
