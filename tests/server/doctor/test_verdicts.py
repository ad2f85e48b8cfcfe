"""The doctor's judgement: facts in, verdicts out; every trouble has its remedy, and nothing that is well is called amiss."""

from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

import pytest

from server.doctor.facts import FoundDevices, MachineFacts, PictureFacts, RigFileFacts, SensorFacts, Stream
from server.doctor.machine_verdicts import bytes_per_s, machine_verdicts
from server.doctor.rig_verdicts import calibration_verdicts, found_verdicts
from server.doctor.sensor_verdicts import sensor_verdicts
from server.doctor.verdict import State, Verdict, all_is_well
from tracker.rig_file import RigFile
from tracker.rig_sheets import CameraMountSheet, CameraSheet, ImuSheet
from tracker.simulate import default_rig
from tracker.sources.camera_devices import CameraDevice
from tracker.sources.phidget_devices import PhidgetDevice
from tracker.sources.serial_devices import SerialDevice
from tracker.sources.source import SourceStatus

NOTHING = FoundDevices()
TODAY = date(2026, 11, 28)
SPATIAL = "PhidgetSpatial 3/3/3, serial number 302934"


def lens(**changes: Any) -> CameraSheet:
    """Return a lens as found by a board today."""
    camera = default_rig().camera
    assert camera is not None
    found: dict[str, Any] = {"rms_px": 0.3, "focal_sigma_px": 1.0, "views": 20, "coverage": 0.8}
    return replace(CameraSheet.of(camera, date=TODAY, method="board", **found), **changes)


def mount(**changes: Any) -> CameraMountSheet:
    """Return how a camera sits, as found by a pan today."""
    T_body_cam = tuple(tuple(row) for row in default_rig().T_body_cam.tolist())
    quality: dict[str, Any] = {"rotation_sigma_rad": 0.001, "time_sigma_s": 0.001, "residual_px": 0.5}
    return replace(CameraMountSheet(date=TODAY, T_body_cam=T_body_cam, time_offset_s=-0.02, **quality), **changes)


def rest(**changes: Any) -> ImuSheet:
    """Return a unit's offsets, as found by a rest today."""
    zero = (0.0, 0.0, 0.0)
    sheet = ImuSheet(
        date=TODAY, device=SPATIAL, gyro_bias_rad_s=zero, accel_bias_m_s2=zero, accel_scale=(1.0, 1.0, 1.0),
        gyro_noise_rad_s_sqrt_hz=zero, accel_noise_m_s2_sqrt_hz=zero, gyro_bias_sigma_rad_s=zero,
        duration_s=30.0, attitudes=1,
    )  # fmt: skip
    return replace(sheet, **changes)


def gps(**said: Any) -> SensorFacts:
    """Return a receiver that is well."""
    facts = {"fix": "autonomous", "hdop": 0.9, "satellites_used": 9, "satellites": [{}] * 12, "clock_drift_ppm": 3.0}
    status = SourceStatus(True, "/dev/ttyUSB0 at 9600 baud", {}, {**facts, **said})
    streams = {"GpsFix": Stream(6, 1.0, 1.0, 0.15), "GpsVelocity": Stream(6, 1.0, 1.0, 0.15)}
    return SensorFacts("gps", "serial:/dev/ttyUSB0", status, None, streams, valid_fixes=6, utc_offset_s=0.6)


def imu(**said: Any) -> SensorFacts:
    """Return an inertial unit that is well."""
    status = SourceStatus(True, SPATIAL, {}, {"clock_offset_ns": 5, "clock_drift_ppm": 12.0, "clock_resets": 0, **said})
    streams = {"ImuSample": Stream(1250, 250.0, 0.008, 0.002), "MagSample": Stream(125, 25.0, 0.05, 0.002)}
    return SensorFacts("imu", "phidget", status, None, streams, specific_force_m_s2=9.81)


def camera(**said: Any) -> SensorFacts:
    """Return a camera that is well."""
    facts = {"device": "C920", "serial": "A1", "codec": "MJPG", "rate_hz": 30.0, "exposure_s": None, "stamps": "driver"}
    status = SourceStatus(True, "/dev/video0", {}, {**facts, **said})
    streams = {"Frame": Stream(150, 30.0, 0.04, 0.035)}
    return SensorFacts("camera", "0", status, None, streams, picture=PictureFacts(640, 480, 120.0, 60e3))


def machine(**changes: Any) -> MachineFacts:
    """Return a machine that is well."""
    facts = MachineFacts(8470, None, "chromium", True, True, True, True, None, Path("/data"), None, 10**12, False)
    return replace(facts, **changes)


def one(verdicts: list[Verdict], part: str) -> Verdict:
    """Return the verdict on a part, or on what has that name."""
    return next(verdict for verdict in verdicts if (verdict.part or verdict.name) == part)


def test_a_rig_that_is_well_is_green_in_every_line() -> None:
    rig_file = RigFile(camera=lens(serial="A1"), camera_mount=mount(), imu=rest())
    sensors = [gps(), imu(), camera()]
    verdicts = [verdict for facts in sensors for verdict in sensor_verdicts(facts, NOTHING, rig_file)]
    verdicts += machine_verdicts(machine(), sensors)
    assert {verdict.state for verdict in verdicts} == {State.WELL}
    assert all_is_well(verdicts)
    by_name = {v.name: v for v in calibration_verdicts(RigFileFacts(Path("r"), True, rig_file), sensors, TODAY)}
    assert by_name.pop("magnetometer").state is State.ADVICE
    assert {verdict.state for verdict in by_name.values()} == {State.WELL}
    assert "9 satellites used of 12 in view" in one(verdicts, "fix").sentence


@pytest.mark.parametrize(
    ("facts", "part", "state", "words"),
    [
        (replace(gps(), valid_fixes=0), "fix", State.AMISS, "12 satellites in view: it needs open sky"),
        (gps(hdop=9.0), "fix", State.ADVICE, "more of the sky"),
        (replace(gps(), streams={"GpsFix": Stream(2, 0.2, 5.0)}), "rate", State.AMISS, "one a second"),
        (replace(gps(), streams={"GpsFix": Stream(6, 1.0, 1.0)}), "rate", State.ADVICE, "RMC or VTG"),
        (replace(gps(), utc_offset_s=-3600.0), "clock", State.ADVICE, "60 minutes behind"),
        (gps(clock_resets=2), "clock", State.AMISS, "leaps"),
        (replace(imu(), streams={"ImuSample": Stream(20, 4.0, 0.25)}), "rate", State.AMISS, "not through a hub"),
        (replace(imu(), streams={"ImuSample": Stream(1200, 240.0, 0.3)}), "rate", State.ADVICE, "300 ms apart"),
        (replace(imu(), streams={"ImuSample": Stream(1250, 250.0)}), "compass", State.ADVICE, "walk ten steps"),
        (replace(imu(), specific_force_m_s2=11.0), "gravity", State.ADVICE, "agora calibrate imu"),
        (imu(clock_resets=1), "clock", State.AMISS, "leaps"),
        (replace(camera(), picture=None), "mode", State.AMISS, "do not decode"),
        (replace(camera(), streams={"Frame": Stream(20, 4.0)}), "rate", State.AMISS, "make light"),
        (replace(camera(), streams={"Frame": Stream(75, 15.0)}), "rate", State.ADVICE, "15.0 pictures a second of the 30"),
        (replace(camera(), picture=PictureFacts(640, 480, 2.0, 9e3)), "picture", State.AMISS, "uncover the lens"),
        (replace(camera(), picture=PictureFacts(640, 480, 253.0, 9e3)), "picture", State.AMISS, "shade the lens"),
        (camera(stamps="read"), "clock", State.ADVICE, "agora calibrate rig"),
    ],
)  # fmt: skip
def test_each_trouble_of_a_sensor_has_its_remedy(facts: SensorFacts, part: str, state: State, words: str) -> None:
    verdict = one(sensor_verdicts(facts, NOTHING, None), part)
    assert verdict.state is state
    assert words in verdict.sentence


def test_a_sensor_that_is_not_there_is_told_with_what_is() -> None:
    facts = SensorFacts("gps", "phidget", trouble="No PhidgetGPS was found: plug it in.")
    ports = (SerialDevice("/dev/ttyS0", "", False), SerialDevice("/dev/ttyUSB0", "u-blox 7", True))
    found = FoundDevices(serial_ports=ports, gpsd="gpsd at 127.0.0.1:2947: no receiver")
    (verdict,) = sensor_verdicts(facts, found, None)
    assert verdict.state is State.AMISS
    assert verdict.sentence == (
        "No PhidgetGPS was found: plug it in. Or take what is plugged in: --gps serial:/dev/ttyUSB0 or --gps gpsd."
    )
    (silent,) = sensor_verdicts(SensorFacts("imu", "phidget", SourceStatus(True, SPATIAL)), found, None)
    assert "says nothing: check its plug" in silent.sentence


def test_a_sensor_that_went_away_is_amiss_whatever_it_said_before() -> None:
    verdict = sensor_verdicts(replace(imu(), trouble="It was pulled out."), NOTHING, None)[0]
    assert (verdict.state, "pulled out" in verdict.sentence) == (State.AMISS, True)


def test_a_lens_of_another_shape_does_not_do_and_one_of_another_size_does() -> None:
    wide = RigFile(camera=lens(width_px=1280, height_px=720))
    large = RigFile(camera=lens(width_px=1280, height_px=960))
    assert one(sensor_verdicts(camera(), NOTHING, wide), "mode").state is State.AMISS
    assert one(sensor_verdicts(camera(), NOTHING, large), "mode").state is State.WELL


def test_a_camera_without_times_does_where_its_delay_was_measured() -> None:
    assert (
        one(sensor_verdicts(camera(stamps="read"), NOTHING, RigFile(camera_mount=mount())), "clock").state is State.WELL
    )


@pytest.mark.parametrize(
    ("sheet", "state", "words"),
    [
        (lens(serial="B2"), State.AMISS, "C920, A1"),
        (lens(date=date(2025, 1, 1)), State.ADVICE, "696 days old: run `agora calibrate camera`"),
        (lens(date=date(2026, 11, 27)), State.WELL, "yesterday"),
        (None, State.ADVICE, "run `agora calibrate camera`"),
    ],
)
def test_a_calibration_is_judged_by_its_age_and_its_device(sheet: CameraSheet | None, state: State, words: str) -> None:
    facts = RigFileFacts(Path("rig.toml"), False, RigFile(camera=sheet))
    verdict = one(calibration_verdicts(facts, [camera()], TODAY), "lens")
    assert verdict.state is state
    assert words in verdict.sentence


def test_another_inertial_unit_than_the_calibrated_one_is_noticed() -> None:
    facts = RigFileFacts(Path("rig.toml"), False, RigFile(imu=rest(device="PhidgetSpatial 3/3/3, serial number 1")))
    assert one(calibration_verdicts(facts, [imu()], TODAY), "inertial unit").state is State.AMISS


def test_a_rig_file_that_is_not_there_is_advice_and_one_that_does_not_read_is_amiss() -> None:
    (none,) = calibration_verdicts(RigFileFacts(Path("rig.toml"), False), [camera()], TODAY)
    assert none.state is State.ADVICE
    assert "`agora calibrate camera`, `agora calibrate rig`" in none.sentence
    assert "imu" not in none.sentence
    (broken,) = calibration_verdicts(RigFileFacts(Path("r"), True, trouble="r is no TOML."), [], TODAY)
    assert broken.state is State.AMISS


def test_what_is_played_from_a_recording_is_not_asked_for_a_calibration() -> None:
    played = replace(camera(), spec="log:walk.mcap")
    (verdict,) = calibration_verdicts(RigFileFacts(Path("r"), False), [played], TODAY)
    assert verdict.state is State.ABSENT


@pytest.mark.parametrize(
    ("changes", "name", "state", "words"),
    [
        ({"port_trouble": "Port 8470 is taken."}, "port", State.AMISS, "taken"),
        ({"pages_built": False, "models_built": False}, "pages", State.AMISS, "pages and the models are not built"),
        ({"page_trouble": "No answer."}, "pages", State.AMISS, "No answer"),
        ({"browser": None}, "browser", State.AMISS, "--no-browser"),
        ({"browser": None, "wants_browser": False}, "browser", State.ABSENT, "None was asked for"),
        ({"has_screen": False}, "browser", State.AMISS, "ssh -L 8470:127.0.0.1:8470"),
        ({"free_bytes": 10**9, "records": True}, "disk", State.AMISS, "9 minutes"),
        ({"free_bytes": 10**9}, "disk", State.ADVICE, "make room"),
        ({"folder_trouble": "Not there.", "records": True}, "disk", State.AMISS, "Not there"),
        ({"folder_trouble": "Not there."}, "disk", State.ABSENT, "Not there"),
    ],
)
def test_each_trouble_of_the_machine_has_its_remedy(
    changes: dict[str, Any], name: str, state: State, words: str
) -> None:
    verdict = one(machine_verdicts(machine(**changes), [camera()]), name)
    assert verdict.state is state
    assert words in verdict.sentence


def test_a_recording_grows_with_its_pictures() -> None:
    assert bytes_per_s([imu()]) < 1e5
    assert bytes_per_s([camera()]) == pytest.approx(30 * 60e3, rel=0.1)
    assert bytes_per_s([SensorFacts("camera", "0")]) > 1e6


def test_what_is_plugged_in_is_listed() -> None:
    found = FoundDevices((PhidgetDevice("PhidgetGPS", 7),), 1, None, (), None, (CameraDevice(2, "C920", ""),))
    verdicts = found_verdicts(found, ["phidget"])
    assert one(verdicts, "Phidgets").sentence == "PhidgetGPS, serial number 7."
    assert one(verdicts, "cameras").sentence == "/dev/video2 (C920)."
    assert one(verdicts, "gpsd").state is State.ABSENT


def test_a_phidget_that_nobody_may_open_is_told_with_the_rule_that_lets_them() -> None:
    verdicts = found_verdicts(FoundDevices(phidgets_on_usb=2), ["phidget:7"])
    assert one(verdicts, "Phidgets").state is State.AMISS
    assert "99-libphidget22.rules" in one(verdicts, "Phidgets").sentence
    assert all_is_well(found_verdicts(FoundDevices(phidgets_on_usb=2), ["gpsd"]))
    assert not all_is_well(found_verdicts(FoundDevices(phidget_trouble="No libusb."), ["phidget"]))
