"""Scenes with the real Phidget22 library and a USB bus that is not there; `test_phidget.py` runs them in a process of their own.

By hand: `USB_STANDIN=LIBRARY pytest --noconftest tests/tracker/sources/phidget_scenes.py -k NAME`, with LIBRARY as built by
`tests.tracker.sources.usb_standin.bus.build`.
"""

import ctypes
import logging
import os
import time
from collections.abc import Iterator
from itertools import pairwise
from math import radians
from pathlib import Path
from threading import Event, current_thread
from time import monotonic_ns

import numpy as np
import pytest

from tests.tracker.sources.listening import Listening
from tests.tracker.sources.usb_standin.bus import (
    SPATIAL_1042,
    SPATIAL_1044,
    SPATIAL_1056,
    Bus,
    spatial_report,
)
from tests.tracker.sources.usb_standin.numbered import (
    G_M_S2,
    LEVEL,
    NUMBERS,
    STILL,
    Rig,
    consecutive,
    epochs,
    imu,
    mag,
    numbers,
)
from tests.tracker.sources.usb_standin.run import measurements
from tests.tracker.sources.usb_standin.walker import GEOID_M, Walker
from tracker.errors import SourceLost
from tracker.measurements import GpsFix, ImuSample
from tracker.sources.phidget_gps import PhidgetGpsSource
from tracker.sources.phidget_library import load_libusb
from tracker.sources.phidget_spatial import PhidgetSpatialSource

#: How long real time is tried; a minute with USB_STANDIN_SECONDS=60.
SECONDS = float(os.environ.get("USB_STANDIN_SECONDS", "3"))


@pytest.fixture
def bus() -> Iterator[Bus]:
    bus = Bus(Path(os.environ["USB_STANDIN"]))
    yield bus
    bus.close()


@pytest.fixture
def rig(bus: Bus) -> Rig:
    return Rig(bus)


class LateClock:
    """A clock for whose answer one waits on a machine that has no time: a handler that asks it runs late."""

    def __init__(self) -> None:
        self.has_time = Event()
        self.has_time.set()

    def __call__(self) -> int:
        assert self.has_time.wait(20.0)
        return monotonic_ns()


# Units, axes, gaps


@pytest.mark.parametrize("kind", [SPATIAL_1042, SPATIAL_1044, SPATIAL_1056])
@pytest.mark.parametrize("R_body_imu", [None, np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])])
def test_units_axes_and_gaps_of_each_spatial(bus: Bus, kind: tuple[int, int], R_body_imu: np.ndarray | None) -> None:
    """g, deg/s and gauss become m/s², rad/s and tesla in body axes; level and at rest is (0, 0, +9.81); gaps are counted."""
    device = bus.add(kind, 2002)
    source = PhidgetSpatialSource(R_body_imu=R_body_imu)
    said = (
        (LEVEL, STILL, (0.2, -0.1, 0.4)),
        ((0.25, -0.5, 0.75), (10.0, 20.0, -30.0), None),
    )
    with Listening(source) as listening:
        t_ms = 0
        while len(imu(listening)) < 50:
            accel_g, gyro_deg_s, field_gauss = said[t_ms // 4 % 2]
            bus.push(device, spatial_report(t_ms, accel_g, gyro_deg_s, field_gauss, kind))
            t_ms += 4
            time.sleep(0.004)
    status = source.status()
    R = np.eye(3) if R_body_imu is None else R_body_imu
    # the first is the mean of all that came before the interval was set
    found = {(tuple(np.round(s.accel_m_s2, 1)), tuple(np.round(s.gyro_rad_s, 2))) for s in imu(listening)[1:]}
    level = tuple(np.round(R @ (0.0, 0.0, G_M_S2), 1)), (0.0, 0.0, 0.0)
    turning = (
        tuple(np.round(R @ (-0.25 * G_M_S2, -0.5 * G_M_S2, 0.75 * G_M_S2), 1)),
        tuple(np.round(R @ (radians(10.0), -radians(20.0), radians(30.0)), 2)),
    )
    assert found == {level, turning}
    fields = np.array([sample.field_body_t for sample in mag(listening)])
    assert np.allclose(fields, R @ (0.2e-4, 0.1e-4, -0.4e-4), atol=2e-7)
    assert abs(len(fields) - len(imu(listening)) / 2) <= 1
    assert status.counts["mag_gaps"] + status.counts["mag"] == status.counts["imu"] == len(imu(listening))
    assert status.facts["interval_ms"] == 4
    assert status.facts["model"] == {SPATIAL_1042: "1042", SPATIAL_1044: "1044", SPATIAL_1056: "1056"}[kind]


def test_an_epoch_is_one_fix_and_one_velocity_of_one_moment(rig: Rig) -> None:
    """MSL and geoid make the ellipsoidal height, km/h and course a velocity; covariance comes of HDOP 1.1 and VDOP 1.8."""
    with rig.listen(PhidgetGpsSource()) as listening:
        rig.live_until(lambda: len(listening.velocities) > 9)
    fixes, velocities = listening.fixes, listening.velocities
    assert [fix.t_ns for fix in fixes] == [velocity.t_ns for velocity in velocities]
    assert all(fix.h_ellipsoid_m == pytest.approx(80.0 + GEOID_M) for fix in fixes)
    assert all(velocity.v_enu_m_s == pytest.approx((3.0, 4.0, 0.0), abs=2e-3) for velocity in velocities)
    assert fixes[0].cov_enu_m2 == pytest.approx(
        ((3.5 * 1.1) ** 2 / 2, 0, 0, 0, (3.5 * 1.1) ** 2 / 2, 0, 0, 0, (3.5 * 1.8) ** 2)
    )
    assert consecutive(epochs(fixes))
    assert {round((b.t_ns - a.t_ns) / 1e7) for a, b in pairwise(fixes[1:])} == {10}


# Nothing is lost


def test_a_minute_at_250_hz_beside_a_receiver_loses_nothing(rig: Rig) -> None:
    """Sixty seconds of both devices' time, as fast as the library takes it: 15000 samples and 600 epochs, each once, in order."""
    spatial, gps = PhidgetSpatialSource(), PhidgetGpsSource()
    with rig.listen(spatial) as samples, rig.listen(gps) as places:
        rig.live_until(lambda: imu(samples) and places.fixes)
        first_tick = rig.tick
        while rig.tick < first_tick + 15_000:
            if (
                len(samples.found) >= 2 * (len(rig.samples_said) - 100)
                and len(places.fixes) >= len(rig.epochs_said) - 20
            ):
                rig.say()
            else:
                time.sleep(0.0002)
        rig.live_until(lambda: numbers(imu(samples)[-1:]) == [rig.samples_said[-1] % NUMBERS])
        rig.live(0.1)
        counts = spatial.status().counts.keys() | gps.status().counts.keys()
    minute = numbers(imu(samples))[-(rig.tick - first_tick) :]
    assert len(minute) > 15_000
    assert consecutive(minute, NUMBERS)
    assert len(places.fixes) >= 600
    assert consecutive(epochs(places.fixes))
    assert counts == {"attached", "imu", "mag", "fixes", "velocities"}


def test_in_real_time_nothing_is_lost_and_samples_have_the_devices_times(rig: Rig) -> None:
    """4 ms apart to a hundredth of a millisecond once the clock is known, however unevenly they come; never after receipt."""
    with rig.listen(PhidgetSpatialSource()) as samples, rig.listen(PhidgetGpsSource()) as places:
        rig.live_until(lambda: imu(samples) and places.fixes)
        rig.live(SECONDS)
        samples.wait(lambda: numbers(imu(samples)[-1:]) == [rig.samples_said[-1] % NUMBERS])
        places.wait(lambda: epochs(places.fixes[-1:]) == [rig.epochs_said[-1]])
    found = imu(samples)
    assert len(found) > 250 * SECONDS - 10
    assert consecutive(numbers(found[5:]), NUMBERS)
    assert len(places.fixes) > 10 * SECONDS - 2
    assert consecutive(epochs(places.fixes))
    assert all(sample.t_ns <= sample.t_recv_ns for sample in found)
    steps_ms = np.diff([sample.t_ns for sample in found[-500:]]) / 1e6
    assert np.median(np.abs(steps_ms - 4.0)) < 0.01


# Pulled out and put back


def test_the_spatial_pulled_out_and_put_back_while_the_receiver_goes_on(rig: Rig) -> None:
    """The receiver loses no epoch; the status says what happened; samples go on by themselves, at 4 ms and in their own time."""
    spatial, gps = PhidgetSpatialSource(), PhidgetGpsSource()
    with rig.listen(spatial) as samples, rig.listen(gps) as places:
        rig.live_until(lambda: imu(samples) and places.fixes)
        rig.live(1.0)
        rig.bus.plug(rig.spatial, False)
        rig.live_until(lambda: not spatial.status().attached)
        away = spatial.status()
        rig.live(0.3)
        before = len(imu(samples))
        rig.bus.plug(rig.spatial, True)
        rig.tick = rig.tick // 25 * 25
        rig.ticks_ahead = -rig.tick  # its clock begins at zero
        rig.live_until(lambda: spatial.status().attached)
        rig.live(1.0)
        back = spatial.status()
        assert gps.status().counts == {"attached": 1, "fixes": len(places.fixes), "velocities": len(places.velocities)}
    assert "PhidgetSpatial" in away.detail
    assert "put it back" in away.detail
    assert (back.counts["attached"], back.counts["detached"], back.facts["interval_ms"]) == (2, 1, 4)
    assert set(np.diff(epochs(places.fixes))) <= {0, 1}
    after = imu(samples)[before + 1 :]
    assert len(after) > 200
    assert consecutive(numbers(after), NUMBERS)
    assert np.median([sample.t_recv_ns - sample.t_ns for sample in after]) < 50e6
    assert all(a.t_ns < b.t_ns for a, b in pairwise(imu(samples)[3:]))


def test_the_receiver_pulled_out_and_put_back_while_the_spatial_goes_on(rig: Rig) -> None:
    """The Spatial loses no sample; fixes go on by themselves."""
    spatial, gps = PhidgetSpatialSource(), PhidgetGpsSource()
    with rig.listen(spatial) as samples, rig.listen(gps) as places:
        rig.live_until(lambda: imu(samples) and places.fixes)
        rig.live(0.5)
        rig.bus.plug(rig.gps, False)
        rig.live_until(lambda: not gps.status().attached)
        away, before = gps.status(), len(places.fixes)
        rig.live(0.3)
        rig.bus.plug(rig.gps, True)
        rig.live_until(lambda: len(places.fixes) > before + 5)
        assert spatial.status().counts.keys() == {"attached", "imu", "mag"}
        assert (gps.status().counts["attached"], gps.status().counts["detached"]) == (2, 1)
    assert "PhidgetGPS" in away.detail
    assert consecutive(numbers(imu(samples)[5:]), NUMBERS)
    assert consecutive(epochs(places.fixes[before:]))


def test_a_clock_that_restarts_while_attached_is_followed(rig: Rig) -> None:
    """The library shows it as a leap forward; the samples' times stay those at which they were taken."""
    source = PhidgetSpatialSource()
    with rig.listen(source) as listening:
        rig.live_until(lambda: imu(listening))
        rig.live(1.0)
        rig.ticks_ahead = -rig.tick
        rig.live(1.0)
        assert source.status().facts["clock_resets"] == 1
    samples = imu(listening)
    assert all(a.t_ns < b.t_ns <= b.t_recv_ns for a, b in pairwise(samples[3:]))
    assert np.median([sample.t_recv_ns - sample.t_ns for sample in samples[-100:]]) < 50e6
    assert consecutive(numbers(samples[5:]), NUMBERS)


def test_a_device_is_chosen_by_its_serial_number(bus: Bus) -> None:
    first, second = bus.add(SPATIAL_1042, 11), bus.add(SPATIAL_1044, 22)
    source = PhidgetSpatialSource(22)
    with Listening(source) as listening:
        t_ms = 0
        while len(imu(listening)) < 5:
            bus.push(first, spatial_report(t_ms, (0.0, 0.0, -1.0), STILL, None))
            bus.push(second, spatial_report(t_ms, LEVEL, STILL, None))
            t_ms += 4
            time.sleep(0.004)
        assert source.status().detail.endswith("serial number 22")
    assert {sample.accel_m_s2 for sample in imu(listening)} == {(0.0, 0.0, G_M_S2)}


def test_a_missing_device_is_said_with_the_remedy_and_found_when_it_is_there(rig: Rig) -> None:
    """A source that has ended can be run again; it is lost as long as there is no device of its number."""
    source = PhidgetSpatialSource(3003, attach_s=0.3)
    for _ in range(2):
        with pytest.raises(SourceLost, match="No PhidgetSpatial 3003 was found: plug it in"):
            source.run(lambda measurement: None, Event())
        assert source.status().detail.startswith("No PhidgetSpatial 3003 was found")
    rig.spatial = rig.bus.add(SPATIAL_1042, 3003)
    with rig.listen(source) as listening:
        rig.live_until(lambda: len(imu(listening)) > 50)


# What goes wrong


def test_an_exception_in_a_handler_is_counted_told_and_logged_once(rig: Rig, caplog: pytest.LogCaptureFixture) -> None:
    """Here the clock fails at every tenth call by the library's threads; what else comes, comes."""
    calls = 0

    def clock_ns() -> int:
        nonlocal calls
        calls += current_thread().name.startswith("Dummy")
        if calls % 10 == 9:
            calls += 1
            raise RuntimeError("no time")
        return monotonic_ns()

    source = PhidgetSpatialSource(clock_ns=clock_ns)
    with caplog.at_level(logging.WARNING), rig.listen(source) as listening:
        rig.live_until(lambda: source.status().counts.get("handler_errors", 0) > 5)
        assert source.status().facts["last_handler_error"] == "RuntimeError: no time"
    assert len(imu(listening)) > 20
    assert len(caplog.records) == 1
    assert "no time" in caplog.text


def test_sentences_with_wrong_checksums_are_refused_and_the_others_arrive(rig: Rig) -> None:
    """Of every fifth epoch a digit of RMC has changed on the way, and there is no such epoch."""

    def damage(sentences: bytes, epoch: int) -> bytes:
        return sentences.replace(b"$GPRMC,1", b"$GPRMC,2") if epoch % 5 == 0 else sentences

    rig.damage = damage
    source = PhidgetGpsSource()
    with rig.listen(source) as listening:
        rig.live_until(lambda: len(listening.fixes) > 12)
    found = epochs(listening.fixes)
    assert found == [epoch for epoch in range(found[0], found[-1] + 1) if epoch % 5]


def test_a_receiver_that_stands_is_no_outage(rig: Rig) -> None:
    """Its position does not change, the library says nothing of it, and there are fixes all the same, at the receiver's rate."""
    rig.stands = True
    source = PhidgetGpsSource()
    with rig.listen(source) as listening:
        rig.live_until(lambda: listening.fixes)
        first = rig.epochs_said[-1]
        rig.live(1.5)
        status = source.status()
    assert abs(len(listening.fixes) - (rig.epochs_said[-1] - first)) <= 2
    assert {(fix.lat_deg, fix.valid) for fix in listening.fixes} == {(37.0, True)}
    assert status.facts["fix"] == "autonomous"


def test_without_sky_the_receiver_says_no_fix_and_is_heard_all_the_same(rig: Rig) -> None:
    """A fix that is not valid at once and then each second, no velocity, and fixes again with the sky."""
    source = PhidgetGpsSource()
    with rig.listen(source) as listening:
        rig.live_until(lambda: listening.velocities)
        rig.has_sky = False
        rig.live_until(lambda: sum(not fix.valid for fix in listening.fixes) > 2)
        status, velocities = source.status(), len(listening.velocities)
        rig.has_sky = True
        rig.live_until(lambda: len(listening.velocities) > velocities + 3)
        assert source.status().facts["fix"] == "autonomous"
    assert status.attached
    assert status.facts["fix"] == "no fix"
    assert status.facts["silent_s"] < 3.0  # type: ignore[operator]
    assert status.counts["no_fix"] >= 3
    assert "detached" not in status.counts


def test_a_day_that_ends_ends_no_walk(rig: Rig) -> None:
    """Over midnight, UTC, fixes stay 0.1 s apart."""
    rig.utc_ms = 24 * 3600 * 1000 - 1500
    source = PhidgetGpsSource()
    with rig.listen(source) as listening:
        rig.live_until(lambda: listening.fixes and rig.tick > 750)
        assert source.status().facts["clock_resets"] == 0
    steps_ms = np.diff([fix.t_ns for fix in listening.fixes[1:]]) / 1e6
    assert len(steps_ms) > 20
    assert np.median(np.abs(steps_ms - 100.0)) < 0.1
    assert steps_ms.max() < 1000.0


def test_saturation_and_a_full_queue_are_told(rig: Rig) -> None:
    """A saturated sensor gives an error for the sample; events that the library dropped are counted as it says them."""
    clock_ns = LateClock()
    source = PhidgetSpatialSource(clock_ns=clock_ns)
    with rig.listen(source) as listening:
        rig.live_until(lambda: len(imu(listening)) > 10)
        rig.bus.push(rig.spatial, spatial_report(4 * rig.tick, (9.0, 0.0, 1.0), STILL, None))
        rig.tick += 1
        rig.live_until(lambda: "error_saturation" in source.status().counts)
        clock_ns.has_time.clear()  # or the library's thread might be faster than what fills its queue
        for _ in range(5000):
            rig.say()
        clock_ns.has_time.set()
        rig.live_until(lambda: "error_dispatch" in source.status().counts)
        before = len(imu(listening))
        rig.live_until(lambda: len(imu(listening)) > before + 50)
        assert "queue is full" in str(source.status().facts["last_error"])


# libusb


def test_where_the_system_has_no_libusb_that_of_pypi_is_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is loaded globally and has the name that libphidget22 asks for."""
    load, loaded = ctypes.CDLL, []

    def cdll(name: str, mode: int = ctypes.DEFAULT_MODE) -> ctypes.CDLL:
        if name == "libusb-1.0.so.0":
            raise OSError("libusb-1.0.so.0: cannot open shared object file")
        loaded.append((Path(name).name, mode))
        return load(name, mode)

    monkeypatch.setattr(ctypes, "CDLL", cdll)
    assert load_libusb() == "libusb-package"
    assert loaded == [("libusb-1.0.so", ctypes.RTLD_GLOBAL)]


# A walk


def test_a_walk_that_is_played_is_the_walk(bus: Bus) -> None:
    """What the sources say of a simulated walk is what was simulated, but for the steps of the devices' numbers."""
    said = [m for m in measurements("simulate:3:4") if isinstance(m, ImuSample | GpsFix)]
    walker = Walker(bus, measurements("simulate:3:4"))
    walker.start()
    try:
        with Listening(PhidgetSpatialSource()) as samples, Listening(PhidgetGpsSource()) as places:
            samples.wait(walker.ended.is_set)
            samples.wait(lambda: len({fix.lat_deg for fix in places.fixes}) == 4)
        with pytest.raises(ValueError, match="cannot 'fly'"):
            walker.do("fly")
    finally:
        walker.close()
    walked = np.array([(*m.gyro_rad_s, *m.accel_m_s2) for m in said if isinstance(m, ImuSample)])
    found = np.array([(*m.gyro_rad_s, *m.accel_m_s2) for m in imu(samples)])
    begins = min(
        range(len(found) - len(walked) + 1), key=lambda i: float(np.abs(found[i : i + 50] - walked[:50]).sum())
    )
    assert np.abs(found[begins : begins + len(walked)] - walked).max(axis=0) == pytest.approx(0.0, abs=2e-3)
    places_said = [(m.lat_deg, m.lon_deg, m.h_ellipsoid_m) for m in said if isinstance(m, GpsFix)]
    places_found = list(dict.fromkeys((m.lat_deg, m.lon_deg, m.h_ellipsoid_m) for m in places.fixes))
    assert np.array(places_found) == pytest.approx(np.array(places_said), abs=2e-3)
    assert np.array(places_found)[:, :2] == pytest.approx(np.array(places_said)[:, :2], abs=1e-8)
