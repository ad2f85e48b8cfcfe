"""NMEA receivers: what they say becomes fixes and velocities, in any pieces, and everything else is counted."""

from dataclasses import replace
from itertools import pairwise
from math import degrees, sqrt
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.sources.nmea_count import count, places_deg
from tests.tracker.sources.receivers import MS, SECOND, STYLES, Moment, burst, sentence, walk
from tracker.measurements import GpsFix, GpsVelocity
from tracker.sources.nmea import NmeaReader

T0 = 5_000 * SECOND


def read(data: bytes) -> tuple[list[GpsFix], list[GpsVelocity], NmeaReader]:
    """Return what a whole stream gives, all of it received at once."""
    reader = NmeaReader()
    found = reader.feed(data, T0) + reader.close(T0)
    fixes = [m for m in found if isinstance(m, GpsFix)]
    return fixes, [m for m in found if isinstance(m, GpsVelocity)], reader


def one(moment: Moment, *extra: bytes) -> GpsFix:
    """Return the only fix of a moment."""
    (fix,), _, _ = read(moment.gga() + b"".join(extra))
    return fix


@pytest.mark.parametrize("style", STYLES)
def test_every_epoch_of_every_kind_of_receiver(style: str) -> None:
    """Position, height above the ellipsoid and velocity of every moment, from any order of sentences."""
    moments = walk(20)
    fixes, velocities, reader = read(b"".join(burst(style, moment) for moment in moments))
    assert len(fixes) == len(velocities) == 20
    for moment, fix in zip(moments, fixes, strict=True):
        assert fix.valid
        assert (fix.lat_deg, fix.lon_deg) == pytest.approx((moment.lat_deg, moment.lon_deg), abs=2e-9)
        assert fix.h_ellipsoid_m == pytest.approx((moment.h_msl_m or 0.0) + 38.5, abs=1e-3)
    for velocity in velocities:
        assert velocity.v_enu_m_s == pytest.approx((1.4 / sqrt(2), 1.4 / sqrt(2), 0.0), abs=1e-3)
    assert set(reader.counts) == {"sentences", "fixes", "velocities"}


@pytest.mark.parametrize("talker", ["GP", "GN", "GL", "GA", "GB", "BD", "GQ", "GI"])
def test_any_talker(talker: str) -> None:
    moment = Moment(1000.0)
    fixes, velocities, _ = read(moment.gga(talker) + moment.rmc(talker))
    assert len(fixes) == len(velocities) == 1


@pytest.mark.parametrize(("style", "last"), [("u-blox", "gst"), ("SiRF", "rmc"), ("modem", "rmc"), ("no RMC", "vtg")])
def test_an_epoch_is_given_out_with_its_last_needed_sentence(style: str, last: str) -> None:
    """Learned from the first epoch, which waits for the second; a lost sentence costs one epoch's wait and no more."""
    reader, given = NmeaReader(), {}
    for number, moment in enumerate(walk(8)):
        for place, kind in enumerate(STYLES[style]):
            if (number, kind) == (5, last):
                continue
            t_ns = T0 + number * SECOND + place * 20 * MS
            for measurement in reader.feed(getattr(moment, kind)(), t_ns):
                given[type(measurement).__name__, round((measurement.t_ns - T0) / SECOND)] = measurement.t_recv_ns
    at = STYLES[style].index(last) * 20 * MS
    due = {0: T0 + SECOND, 5: T0 + 6 * SECOND}
    for number in range(8):
        expected = due.get(number, T0 + number * SECOND + at)
        assert abs(given["GpsFix", number] - expected) <= 60 * MS  # the next epoch's first sentence with a time


def test_times_are_even_however_late_the_bytes_come() -> None:
    """Up to 0.1 s of delay on top of the receiver's own: spaced by a second within 5 ms after half a minute."""
    reader, rng, t_ns = NmeaReader(), np.random.default_rng(3), []
    for number, moment in enumerate(walk(90)):
        t_recv_ns = T0 + number * SECOND + int(rng.exponential(20 * MS)) % (100 * MS)
        t_ns += [m.t_ns for m in reader.feed(burst("RTK", moment), t_recv_ns) if isinstance(m, GpsFix)]
    steps = np.diff(t_ns[30:])
    assert np.abs(steps - SECOND).max() < 5 * MS


def test_midnight_and_dates_that_are_wrong() -> None:
    """The day ends while walking, and the date says 2007: a second stays a second."""
    reader, t_ns = NmeaReader(), []
    for number, moment in enumerate(walk(10, start_s=86_395.0)):
        data = burst("RTK", replace(moment, date="080407"))
        t_ns += [m.t_ns for m in reader.feed(data, T0 + number * SECOND) if isinstance(m, GpsFix)]
    assert len(t_ns) == 10
    assert {b - a for a, b in pairwise(t_ns[1:])} == {SECOND}
    assert reader.facts(T0)["clock_resets"] == 0
    assert str(reader.facts(T0)["utc"]).startswith("2007-04-08T00:00:04")


@pytest.mark.parametrize("quality", [0, 7, 8])
def test_what_was_not_measured_is_no_fix(quality: int) -> None:
    """None, typed in, simulated."""
    fixes, velocities, reader = read(burst("RTK", Moment(5.0, quality=quality)))
    assert [fix.valid for fix in fixes] == [False]
    assert not velocities
    assert reader.counts["no_fix"] == 1


def test_a_warning_in_rmc_makes_it_no_fix() -> None:
    moment = Moment(5.0)
    fixes, velocities, _ = read(moment.gga() + replace(moment, quality=0).rmc())
    assert [fix.valid for fix in fixes] == [False]
    assert not velocities


def test_better_kinds_of_fix_are_believed_more() -> None:
    """Estimated, autonomous, differential, float, fixed; and by dilution."""
    sigmas = [sqrt(one(Moment(5.0, quality=quality)).cov_enu_m2[0]) for quality in (6, 1, 2, 5, 4)]
    assert sigmas == sorted(sigmas, reverse=True)
    assert sigmas[0] > 10.0
    assert 1.5 < sigmas[1] < 4.0
    assert sigmas[-1] < 0.05
    wide, usual = one(Moment(5.0, hdop=4.0)).cov_enu_m2, one(Moment(5.0, hdop=1.0)).cov_enu_m2
    assert wide[0] == pytest.approx(16.0 * usual[0])
    assert usual[8] > usual[0]


def test_the_receivers_own_deviations_count_for_more() -> None:
    """Of the same epoch, and for epochs after it that have none."""
    moment = Moment(5.0)
    assert one(moment, moment.gst()).cov_enu_m2 == pytest.approx((6.25, 0, 0, 0, 2.25, 0, 0, 0, 16.0))
    later = replace(moment, utc_s=6.0)
    fixes, _, _ = read(moment.gga() + moment.gst() + later.gga())
    assert fixes[1].cov_enu_m2 == fixes[0].cov_enu_m2
    best = one(moment, moment.gst(sigma_m=(0.001, 0.001, 0.001)))
    assert best.cov_enu_m2[0] >= 0.2  # nobody is that good on his own


def test_heights_without_a_geoid_admit_it() -> None:
    """Told by the receiver once, it is kept; told by the user, it stands in; told by nobody, the variance says so."""
    unknown = Moment(5.0, separation_m=None)
    fix = one(unknown)
    assert (fix.h_ellipsoid_m, fix.cov_enu_m2[8] > 900.0) == (48.0, True)
    fixes, _, _ = read(Moment(4.0).gga() + unknown.gga())
    assert [fix.h_ellipsoid_m for fix in fixes] == [86.5, 86.5]
    reader = NmeaReader(geoid_separation_m=40.0)
    reader.feed(unknown.gga(), T0)
    (known,) = reader.close(T0)
    assert isinstance(known, GpsFix)
    assert (known.h_ellipsoid_m, known.cov_enu_m2[8] < 100.0) == (88.0, True)


def test_a_position_without_height_still_counts() -> None:
    """From RMC alone: the height is the last one, or nothing is known of it."""
    moment = Moment(5.0)
    (alone,), velocities, _ = read(moment.rmc())
    assert alone.valid
    assert alone.cov_enu_m2[8] > 1e5
    assert len(velocities) == 1
    fixes, _, _ = read(moment.gga() + replace(moment, utc_s=6.0).rmc())
    assert fixes[1].h_ellipsoid_m == 86.5
    assert fixes[1].cov_enu_m2[8] > 1000.0


def test_who_stands_has_no_course() -> None:
    """Slow and without a course is standing; fast and without a course is not known."""
    still = Moment(5.0, speed_m_s=0.1, heading_deg=None)
    _, velocities, _ = read(still.rmc() + replace(still, utc_s=6.0, speed_m_s=3.0).rmc())
    assert [velocity.v_enu_m_s for velocity in velocities] == [(0.0, 0.0, 0.0)]


def test_satellites_in_view() -> None:
    """All of both systems, with where they stand, how strong they are and whether they are used; SBAS by its number."""
    _, _, reader = read(burst("u-blox", Moment(5.0)) + burst("u-blox", Moment(6.0)))
    seen = {(s.system, s.number): s for s in reader.satellites(T0)}
    assert set(seen) == {
        ("GPS", 5), ("GPS", 13), ("GPS", 20), ("GPS", 29), ("SBAS", 46), ("GLONASS", 68), ("GLONASS", 83)
    }  # fmt: skip
    assert {name for name, s in seen.items() if s.used} == {("GPS", 5), ("GPS", 13), ("GPS", 20), ("GLONASS", 68)}
    thirteen = seen["GPS", 13]
    assert (degrees(thirteen.elevation_rad or 0), degrees(thirteen.azimuth_rad or 0)) == pytest.approx((58.0, 198.0))
    assert (thirteen.snr_db_hz, seen["GPS", 29].snr_db_hz) == (44.0, None)
    assert not reader.satellites(T0 + 60 * SECOND)
    listed = reader.facts(T0)["satellites"]
    assert isinstance(listed, list)
    assert len(listed) == 7


def test_every_corrupt_sentence_is_counted() -> None:
    """By reason; none of it disturbs its neighbours."""
    good, gga = Moment(5.0).gga() + Moment(5.0).rmc(), Moment(6.0).gga()
    damaged = {
        "checksum": gga.replace(b"09,0.9", b"08,0.9"),
        "cut": gga[:30] + b"\r\n" + gga[:50],
        "too_long": b"$GPGGA," + b"1" * 600 + b"\r\n",
        "not_text": sentence("GPGGA,\x01\x02"),
        "noise": b"\xb5\x62\x01\x07 binary\r\n",
        "unreadable": sentence("GPGGA,1,2,3,x,y,z,z,z") + sentence("GPGSV,1,2,3,4,5,6,7") + sentence("GPRMC,1,A,9999.0,N,0.1,E"),
        "unknown": sentence("PUBX,00,1") + sentence("GPTXT,01,01,02,hello") + sentence("GPXXX") + sentence(""),
    }  # fmt: skip
    fixes, _, reader = read(good + b"".join(damaged.values()) + good)
    assert {reason: reader.counts[reason] for reason in damaged} == {
        "checksum": 1, "cut": 2, "too_long": 1, "not_text": 1, "noise": 1, "unreadable": 3, "unknown": 4
    }  # fmt: skip
    assert reader.counts["repeated"] == 2
    assert [fix.valid for fix in fixes] == [True]


_PIECES = st.one_of(
    st.binary(max_size=40),
    st.sampled_from([b"$", b"\r\n", b"*", b"$GPGGA,", b"$$", b"$" + b"A" * 600]),
    st.builds(
        lambda style, s, quality: burst(style, Moment(s, quality=quality)),
        st.sampled_from(list(STYLES)),
        st.integers(0, 90_000).map(float),
        st.integers(0, 9),
    ),
    st.lists(st.sampled_from("0123456789.,-NSEWAVMTK*$eEinfa_ \x00é"), max_size=60).map(
        lambda letters: sentence("GP" + "GGA," + "".join(letters))
    ),
    st.builds(
        lambda kind, fields: sentence(f"GN{kind}," + ",".join(fields)),
        st.sampled_from(["GGA", "RMC", "VTG", "GSA", "GSV", "GST", "ZDA", "GNS"]),
        st.lists(st.text("0123456789.-NSEWAVnaif", max_size=10), max_size=24),
    ),
)


@given(
    pieces=st.lists(_PIECES, max_size=12), cuts=st.lists(st.integers(0, 5000), max_size=8), byte_by_byte=st.booleans()
)
def test_any_bytes_in_any_pieces(pieces: list[bytes], cuts: list[int], byte_by_byte: bool) -> None:
    """The same measurements and counts, whole or in pieces; nothing is raised; what is given is sound."""
    data = b"".join(pieces)
    whole, split = NmeaReader(), NmeaReader()
    expected = whole.feed(data, T0) + whole.close(T0)
    places = sorted({*(range(len(data)) if byte_by_byte else ()), *(min(cut, len(data)) for cut in cuts), 0, len(data)})
    found = [m for start, end in pairwise(places) for m in split.feed(data[start:end], T0)] + split.close(T0)
    assert repr(found) == repr(expected)
    assert split.counts == whole.counts
    assert split.satellites(T0) == whole.satellites(T0)
    assert whole.facts(T0) == split.facts(T0)
    for m in expected:
        numbers = m.v_enu_m_s if isinstance(m, GpsVelocity) else (m.lat_deg, m.lon_deg, m.h_ellipsoid_m, *m.cov_enu_m2)
        assert np.all(np.isfinite(numbers)) or (isinstance(m, GpsFix) and not m.valid)
        assert m.t_ns <= m.t_recv_ns


def test_real_receivers(shared: Path) -> None:
    """Every valid position of seven receivers arrives, with a velocity, and every corrupt line is counted."""
    for path in sorted((shared / "data/nmea").glob("*.log")):
        data = b"".join(line for line in path.read_bytes().splitlines(True) if not line.startswith(b"#"))
        expected = count(data)
        fixes, velocities, reader = read(data)
        np.testing.assert_allclose(places_deg(fixes), expected.places_deg, rtol=0.0, atol=1e-10, err_msg=path.name)
        assert len(velocities) == len(expected.places_deg), path.name
        assert sum(reader.counts[reason] for reason in ("cut", "checksum", "too_long")) == expected.corrupt, path.name
        assert reader.counts["unreadable"] == 0, path.name
