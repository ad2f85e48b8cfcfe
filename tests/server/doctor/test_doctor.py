"""`agora doctor` with nothing plugged in, with Phidgets that are not there, a receiver at a pseudo-terminal, a video file."""

import json
import shutil
import subprocess
import sys
from io import StringIO
from pathlib import Path
from threading import Event, Thread
from typing import Any

import cv2
import numpy as np
import pytest
from rich.console import Console

from server.doctor.facts import SensorFacts
from server.doctor.listening import Wanted, listen
from server.doctor.looking import asked, browser_here, gpsd_here, has_screen, machine_facts, rig_file_facts, room_in
from server.doctor.page import page
from server.doctor.verdict import State, Verdict
from server.options import SITE, WEB, site_with
from tests.server.serving import serving
from tests.tracker.sources.gpsd_daemon import free_port
from tests.tracker.sources.receivers import burst, walk
from tests.tracker.sources.test_nmea_source import Receiver
from tracker.errors import InputError, SourceLost
from tracker.measurements import GpsFix, Measurement
from tracker.sources.nmea_source import nmea_source
from tracker.sources.source import Put, Source, SourceStatus

ROOT = Path(__file__).parents[3]
AGORA = str(Path(sys.executable).with_name("agora"))
RATE_HZ = 15


def write_video(path: Path) -> Path:
    """Write two seconds of gray noise."""
    video = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), RATE_HZ, (320, 240))
    rng = np.random.default_rng(0)
    for _ in range(2 * RATE_HZ):
        video.write(rng.integers(0, 255, (240, 320, 3), np.uint8))
    video.release()
    return path


def told(command: list[str], *codes: int) -> dict[str, dict[str, Any]]:
    """Return what the doctor says, by name and part, where it ends with one of these codes."""
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=60, check=False)
    assert done.returncode in codes, done.stdout + done.stderr
    said = json.loads(done.stdout)
    assert said["ok"] == (done.returncode == 0)
    return {f"{check['name']} {check['part']}".strip(): check for check in said["checks"]}


@pytest.mark.slow
def test_with_nothing_plugged_in_every_sensor_has_its_remedy_and_the_code_is_1() -> None:
    absent = ["--gps", "serial:/dev/nowhere", "--imu", "phidget:1", "--camera", "/dev/video77", "--rig", "nowhere.toml"]
    checks = told([AGORA, "doctor", "--json", "--port", "0", "--no-browser", *absent], 1)
    for name, words in (
        ("GPS receiver", "There is no /dev/nowhere: plug the receiver in"),
        ("inertial unit", "No PhidgetSpatial 1 was found: plug it in"),
        ("camera", "There is no /dev/video77: plug the camera in"),
        ("rig file", "nowhere.toml cannot be read"),
    ):
        assert checks[name]["state"] == "amiss"
        assert words in checks[name]["sentence"]


def test_where_nothing_is_asked_for_nothing_is_amiss(tmp_path: Path) -> None:
    none = ["--gps", "none", "--imu", "none", "--camera", "none", "--port", "0", "--no-browser"]
    done = subprocess.run(
        [AGORA, "doctor", *none], capture_output=True, text=True, cwd=tmp_path, timeout=60, check=False
    )
    built = (WEB / "ar.html").is_file() and any((SITE / "built").glob("*.glb"))
    assert done.returncode == (0 if built else 1), done.stdout + done.stderr
    assert "All that was asked for is well." in done.stdout if built else "make setup" in done.stdout


@pytest.mark.slow
def test_with_two_phidgets_and_a_camera_all_is_found_and_measured(tmp_path: Path) -> None:
    """By the real Phidget22 library, on a bus that is not there. How fast they are is not asked: the machine may be busy."""
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    video = write_video(tmp_path / "noise.avi")
    stand_in = [
        sys.executable,
        "-m",
        "tests.tracker.sources.usb_standin.run",
        "simulate:3:60",
        "--",
        "agora",
        "doctor",
        "--json",
    ]
    checks = told([*stand_in, "--camera", str(video), "--port", "0", "--no-browser", "--seconds", "2"], 0, 1)
    assert "PhidgetGPS" in checks["Phidgets"]["sentence"]
    assert "PhidgetSpatial" in checks["Phidgets"]["sentence"]
    for name in (
        "GPS receiver",
        "GPS receiver fix",
        "inertial unit",
        "inertial unit gravity",
        "camera",
        "camera picture",
    ):
        assert checks[name]["state"] == "well", checks[name]
    assert checks["inertial unit rate"]["facts"]["count"] > 100
    assert checks["inertial unit clock"]["facts"]["clock_offset_ns"] != 0
    assert checks["GPS receiver fix"]["facts"]["satellites_used"] > 3
    assert (checks["camera mode"]["facts"]["width_px"], checks["camera mode"]["facts"]["height_px"]) == (320, 240)


def test_a_receiver_at_a_serial_port_is_listened_to() -> None:
    receiver, gone = Receiver(), Event()

    def speak() -> None:
        for moment in walk(1000):
            receiver.say(burst("u-blox", moment))
            if gone.wait(0.1):
                return

    speaker = Thread(target=speak, daemon=True)
    speaker.start()
    wanted = Wanted("gps", "serial", lambda: nmea_source(f"serial:{receiver.path}:9600"))
    (facts,) = listen([wanted], 1.0, lambda seconds: None)
    gone.set()
    speaker.join()
    receiver.leave()
    assert facts.trouble is None
    assert facts.valid_fixes == facts.streams["GpsFix"].count > 3
    assert facts.status is not None
    assert len(facts.status.facts["satellites"]) == 7  # type: ignore[arg-type]
    assert facts.utc_offset_s is not None


class Acted:
    """A source that does what a test says."""

    name = "gps"

    def __init__(self, *acts: Exception | Measurement) -> None:
        self._acts = list(acts)

    def status(self) -> SourceStatus:
        return SourceStatus(True, "an actor")

    def run(self, put: Put, stop: Event) -> None:
        while self._acts:
            act = self._acts.pop(0)
            if isinstance(act, Exception):
                raise act
            put(act)
        stop.wait()


def heard(source: Source, *, is_there: bool = False) -> SensorFacts:
    (facts,) = listen([Wanted("gps", "actor", lambda: source, is_there)], 0.2, lambda seconds: None)
    return facts


FIX = GpsFix(1, 2, 38.0, 27.0, 50.0, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0))


def test_a_device_that_was_seen_is_tried_again_and_one_that_was_not_is_given_up() -> None:
    assert heard(Acted(SourceLost("Not yet."), FIX)).trouble == "Not yet."
    seen = heard(Acted(SourceLost("Not yet."), FIX), is_there=True)
    assert (seen.trouble, seen.valid_fixes) == (None, 1)


def test_a_device_that_goes_away_while_it_is_listened_to_is_in_trouble() -> None:
    assert heard(Acted(FIX, SourceLost("Pulled out.")), is_there=True).trouble == "Pulled out."


def test_a_word_that_names_nothing_hides_no_other_sensor() -> None:
    def make() -> Source:
        raise InputError("That names nothing.")

    good = Acted(FIX)
    facts = listen([Wanted("imu", "banana", make), Wanted("gps", "actor", lambda: good)], 0.2, lambda seconds: None)
    assert (facts[0].trouble, facts[1].valid_fixes) == ("That names nothing.", 1)


def test_the_servers_own_page_is_asked_for_and_a_taken_port_is_noticed(tmp_path: Path) -> None:
    with serving(tmp_path) as server:
        facts = machine_facts(site_with(SITE, None), WEB, port=server.port, record=tmp_path / "new", browser=False)
        assert str(server.port) in (facts.port_trouble or "")
        assert facts.page_trouble is None or not facts.pages_built
        assert facts.records
    assert "does not answer" in (asked(f"http://127.0.0.1:{free_port()}/ar") or "")


def test_browsers_screens_and_folders(tmp_path: Path) -> None:
    assert browser_here(lambda name: None, {}, "linux") is None
    assert browser_here(lambda name: name if name == "firefox" else None, {}, "linux") == "firefox"
    assert browser_here(lambda name: None, {"BROWSER": "mine"}, "linux") == "mine"
    assert browser_here(lambda name: None, {}, "darwin") is not None
    assert has_screen({"WAYLAND_DISPLAY": "wayland-0"}, "linux")
    assert not has_screen({}, "linux")
    assert room_in(tmp_path / "a" / "b")[1:] == (shutil.disk_usage(tmp_path).free, None)
    (tmp_path / "file").touch()
    assert "Nothing can be written" in (room_in(tmp_path / "file")[2] or "")


def test_a_rig_file_that_was_named_must_be_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert rig_file_facts(None).trouble is None
    assert rig_file_facts(None).rig_file is None
    assert rig_file_facts(tmp_path / "rig.toml").trouble is not None


def test_a_machine_without_gpsd_has_none() -> None:
    assert gpsd_here(free_port()) is None


def printed(*states: State) -> str:
    console = Console(width=100, file=StringIO(), record=True)
    verdicts = [Verdict("Sensors", "camera", state, "It is as it is.", part="rate") for state in states]
    console.print(page(verdicts, "agora walk --camera 0"))
    return console.export_text()


def test_the_page_says_what_to_do_last() -> None:
    assert "All that was asked for is well. Go: agora walk --camera 0" in printed(State.WELL, State.ABSENT)
    assert "1 thing would make it better (!). Go: agora walk" in printed(State.WELL, State.ADVICE)
    amiss = printed(State.AMISS, State.AMISS, State.ADVICE)
    assert "2 things are amiss (✗): mend that and look again. 1 thing would" in amiss
    assert "Go:" not in amiss
