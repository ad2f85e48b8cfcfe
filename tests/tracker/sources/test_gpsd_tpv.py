"""gpsd's own view as sentences."""

from math import sqrt
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.measurements import GpsFix, GpsVelocity
from tracker.sources.gpsd_tpv import sentences
from tracker.sources.nmea import NmeaReader

TPV: dict[str, Any] = {
    "class": "TPV", "mode": 3, "time": "2026-08-28T12:00:59.950Z", "lat": -37.936612345, "lon": -127.344712345,
    "altHAE": 86.5, "altMSL": 48.0, "geoidSep": 29.012, "eph": 1.5, "epv": 2.5, "speed": 1.4, "track": 90.0,
}  # fmt: skip


def read(tpv: dict[str, Any]) -> list[GpsFix | GpsVelocity]:
    reader = NmeaReader()
    found = reader.feed(sentences(tpv, {"hdop": 0.9, "uSat": 11}), 10**9) + reader.close(10**9)
    assert not set(reader.counts) - {"sentences", "fixes", "no_fix", "velocities"}
    return found


def test_nothing_is_rounded_away() -> None:
    """Place, the receiver's own height, its errors, speed and course."""
    fix, velocity = read(TPV)
    assert isinstance(fix, GpsFix)
    assert (fix.lat_deg, fix.lon_deg) == pytest.approx((-37.936612345, -127.344712345), abs=2e-10)
    assert fix.h_ellipsoid_m == pytest.approx(86.5)
    assert [sqrt(fix.cov_enu_m2[at]) for at in (0, 4, 8)] == pytest.approx(
        [1.5 / sqrt(2), 1.5 / sqrt(2), 2.5], rel=1e-3
    )
    assert isinstance(velocity, GpsVelocity)
    assert velocity.v_enu_m_s == pytest.approx((1.4, 0.0, 0.0), abs=1e-4)


@pytest.mark.parametrize(
    ("status", "sigma_m", "valid"), [(3, 0.02, True), (5, 14.0, True), (7, 0.0, False), (8, 0.0, False)]
)
def test_the_kind_of_fix(status: int, sigma_m: float, valid: bool) -> None:
    """RTK, dead reckoning, surveyed in, simulated."""
    fix = read({name: value for name, value in TPV.items() if name != "eph"} | {"status": status})[0]
    assert isinstance(fix, GpsFix)
    assert fix.valid == valid
    assert not valid or sqrt(fix.cov_enu_m2[0]) == pytest.approx(sigma_m, rel=0.7)


def test_without_a_fix_there_is_none() -> None:
    assert [m.valid for m in read(TPV | {"mode": 1}) if isinstance(m, GpsFix)] == [False]
    assert [m.valid for m in read(TPV | {"lat": None}) if isinstance(m, GpsFix)] == [False]
    assert not read({"class": "TPV", "mode": 0})


def test_a_height_that_was_not_measured_is_not_told() -> None:
    """Two dimensions."""
    fix = read(TPV | {"mode": 2})[0]
    assert isinstance(fix, GpsFix)
    assert fix.cov_enu_m2[8] > 1000.0


_VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.lists(st.integers(), max_size=2)
)


@given(changed=st.dictionaries(st.sampled_from([*TPV, "status"]), _VALUES, max_size=6), sky=st.dictionaries(
    st.sampled_from(["hdop", "uSat"]), _VALUES))  # fmt: skip
def test_any_json_gives_sentences_that_can_be_read(changed: dict[str, Any], sky: dict[str, Any]) -> None:
    """Or none; nothing is raised."""
    reader = NmeaReader()
    reader.feed(sentences(TPV | changed, sky), 10**9)
    reader.close(10**9)
    assert not reader.counts["cut"] + reader.counts["checksum"] + reader.counts["not_text"] + reader.counts["noise"]
