"""The sun's place against the almanac, and `tests/golden/sun.json`, which `sun.test.ts` reads too.

Run as a program, this file writes it anew.
"""

import json
from datetime import UTC, datetime
from math import cos, degrees, radians, sin
from pathlib import Path
from typing import Any

import pytest

from assets.solar import direction, sun_at

GOLDEN_PATH = Path(__file__).parents[1] / "golden" / "sun.json"
EPHESUS = (37.9366, 27.3447)
YEAR = 150


def unix_s(text: str) -> float:
    """Return seconds since 1970 of a time UTC."""
    return datetime.fromisoformat(text).replace(tzinfo=UTC).timestamp()


def golden() -> dict[str, Any]:
    """Return what the file must hold: times and places, and where the sun is, today and in AD 150; degrees."""
    hours = ("2026-01-15T06:10", "2026-03-20T10:20", "2026-06-21T03:20", "2026-06-21T11:10", "2026-09-05T16:00")
    cases = [(unix_s(hour), *EPHESUS) for hour in (*hours, "2026-12-21T22:00", "1999-08-11T11:30")]
    cases += [(unix_s("2026-04-25T02:00"), -33.87, 151.21), (unix_s("2030-11-02T18:30"), 64.15, -21.94)]
    return {
        "note": f"The sun by assets/solar.py, and under the sky of AD {YEAR}; tests/assets/test_solar.py makes this file.",
        "year": YEAR,
        "cases": [_case(*case) for case in cases],
    }


def _case(t_unix_s: float, lat_deg: float, lon_deg: float) -> dict[str, Any]:
    now, then = (sun_at(t_unix_s, lat_deg, lon_deg, year) for year in (None, YEAR))
    return {
        "t_unix_s": t_unix_s,
        "lat_deg": lat_deg,
        "lon_deg": lon_deg,
        "now_deg": [round(degrees(angle), 7) for angle in now],
        "then_deg": [round(degrees(angle), 7) for angle in then],
    }


def test_the_sun_stands_where_an_almanac_has_it() -> None:
    # Reda and Andreas, Solar Position Algorithm, NREL/TP-560-34302, 2008, table A5.1: zenith 50.11162, azimuth 194.34024
    sun = sun_at(unix_s("2003-10-17T19:30:30"), 39.742476, -105.1786)
    assert degrees(sun.azimuth_rad) == pytest.approx(194.34024, abs=0.02)
    assert 90.0 - degrees(sun.elevation_rad) == pytest.approx(50.11162, abs=0.02)
    # Meeus, example 25.a: 1992-10-13 0h TD, declination -7.78507; on that parallel the sun passes through the zenith
    noons = [sun_at(unix_s("1992-10-13T00:00:00"), -7.78507, lon) for lon in range(150, 200)]
    assert 90.0 - degrees(max(noon.elevation_rad for noon in noons)) < 0.51


def test_the_highest_sun_of_midsummer_is_the_obliquitys() -> None:
    lat_deg, lon_deg = EPHESUS
    day_s = unix_s("2026-06-21T00:00:00")
    highest = [
        max(degrees(sun_at(day_s + 60.0 * minute, lat_deg, lon_deg, year).elevation_rad) for minute in range(1440))
        for year in (None, YEAR)
    ]
    assert highest[0] == pytest.approx(90.0 - lat_deg + 23.436, abs=0.01)
    assert highest[1] == pytest.approx(90.0 - lat_deg + 23.68, abs=0.01)


def test_antiquity_changes_nothing_at_the_equinox() -> None:
    t = unix_s("2026-03-20T14:46:00")
    now, then = (sun_at(t, *EPHESUS, year) for year in (None, YEAR))
    assert degrees(abs(now.elevation_rad - then.elevation_rad)) < 0.002
    assert degrees(abs(now.azimuth_rad - then.azimuth_rad)) < 0.002


def test_the_direction_is_east_north_up() -> None:
    sun = sun_at(unix_s("2026-06-21T05:00:00"), *EPHESUS)
    east, north, up = direction(sun)
    assert east > 0.8
    assert east**2 + north**2 + up**2 == pytest.approx(1.0)
    assert up == pytest.approx(sin(sun.elevation_rad))
    assert north == pytest.approx(cos(sun.azimuth_rad) * cos(sun.elevation_rad))
    assert radians(20.0) < sun.elevation_rad < radians(30.0)


def test_the_golden_file_is_what_this_says() -> None:
    kept, fresh = json.loads(GOLDEN_PATH.read_text(encoding="utf-8")), golden()
    assert kept["year"] == fresh["year"]
    for ours, theirs in zip(kept["cases"], fresh["cases"], strict=True):
        for name, value in theirs.items():
            assert ours[name] == pytest.approx(value, abs=1e-6), name


if __name__ == "__main__":
    fresh = golden()
    lines = ",\n ".join(json.dumps(case) for case in fresh["cases"])
    head = f'"note": {json.dumps(fresh["note"])}, "year": {fresh["year"]}'
    GOLDEN_PATH.write_text(f'{{{head}, "cases": [\n {lines}\n]}}\n', encoding="utf-8")
