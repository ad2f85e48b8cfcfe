"""`agora walk`, `track` and `record` as a user runs them, a recording in place of the sensors."""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from server.status_screen import as_json, screen
from server.walking import recording_in, rig_url
from tests.server.command import agora_here
from tests.server.serving import serving, text_of, token, until, viewer
from tests.walks import write_walk
from tracker.errors import InputError
from tracker.log import Log
from tracker.running.health import Health, SensorState
from tracker.running.recorder import RecorderState
from tracker.running.walk import WalkState

AGORA = Path(sys.executable).with_name("agora")


@pytest.fixture(scope="module")
def sensors(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The options for a rig with every sensor, a minute long."""
    log = f"log:{write_walk(tmp_path_factory.mktemp('logs') / 'wall.mcap', 60.0, pictures=True)}"
    return ["--gps", log, "--imu", log, "--camera", log]


@contextmanager
def running(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    """Run a command, and end it as ctrl-C does."""
    with subprocess.Popen([AGORA, *arguments], stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGINT)
            assert process.wait(30.0) == 0


def lines(process: subprocess.Popen[str]) -> Iterator[dict[str, object]]:
    """Yield what it says in JSON."""
    assert process.stdout is not None
    yield from (json.loads(line) for line in process.stdout if line.startswith("{"))


def test_track_pushes_to_a_server_elsewhere_and_says_how_it_is(sensors: list[str], tmp_path: Path) -> None:
    with serving(tmp_path) as server:
        to = f"ws://127.0.0.1:{server.port}"
        with running(
            "track", "--to", to, "--token", token("rig", "rig-7"), "--session", "rig-7", *sensors, "--json"
        ) as process:
            told = next(line for line in lines(process) if line["connected"] and line["pose"])
            assert told["estimator"] == "camera-gps-imu/precise"
            assert set(told["sensors"]) == {"gps", "imu", "camera"}  # type: ignore[call-overload]
            with viewer(server, "rig-7") as watching:
                session = text_of(watching, "hello")["session"]
                assert session["kind"] == "live"
                until(lambda: not text_of(watching, "state")["session"]["health"]["imu"]["trouble"])


def test_record_records_without_tracking(sensors: list[str], tmp_path: Path) -> None:
    """No motion of the camera is worked out; a replay does that, with time for every picture."""
    out = tmp_path / "later" / "walk.mcap"
    with running("record", str(out), *sensors, "--json") as process:
        next(line for line in lines(process) if line["sensors"]["camera"]["count"] > 10)  # type: ignore[index]
    log = Log.open(out)
    assert not log.info.truncated
    assert log.info.counts["motions"] == 0
    assert all(log.info.counts[name] > 0 for name in ("imu", "mag", "gps", "frames"))
    assert log.metadata["agora"]["gps"].startswith("log:")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["walk", "--imu", "none", "--gps", "none", "--camera", "none", "--port", "0"], "no IMU"),
        (["record", "x.mcap", "--imu", "banana"], "phidget"),
        (["record", "x.mcap", "--imu", "phidget:seven"], "serial number"),
        (["record", "x.mcap", "--gps", "banana"], "gpsd"),
        (["record", "x.mcap", "--gps", "log:nowhere.mcap"], "no file nowhere.mcap"),
        (["record", "x.mcap", "--rig", "nowhere.toml"], "nowhere.toml"),
        (["track", "--to", "ftp://server", "--token", "t"], "wss://HOST"),
    ],
)
def test_what_cannot_be_is_one_sentence_and_exit_code_2(
    arguments: list[str], word: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = agora_here(*arguments)
    assert done.returncode == 2, done.stderr
    assert word in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "x.mcap").exists()


def test_addresses_of_servers() -> None:
    assert rig_url("wss://walks.example", "walk") == "wss://walks.example/ws/rig/walk"
    assert rig_url("https://walks.example:8443/agora/", "a.b") == "wss://walks.example:8443/agora/ws/rig/a.b"
    for url, session in (
        ("walks.example", "a"),
        ("wss://", "a"),
        ("wss://h:x", "a"),
        ("wss://h", "a b"),
        ("wss://h", ""),
    ):
        with pytest.raises(InputError, match=r"address|named"):
            rig_url(url, session)


def test_recordings_are_named_after_their_time(tmp_path: Path) -> None:
    assert recording_in(tmp_path).parent == tmp_path
    assert recording_in(tmp_path).suffix == ".mcap"


def state(sensor: SensorState, warning: str | None) -> WalkState:
    """Return a walk with one sensor."""
    health = {"gps": Health(sensor, 0.0, "The GPS receiver is gone: plug it in.", 12)}
    recorder = RecorderState(Path("walk.mcap"), 1_500_000, 0, 0, warning, is_recording=warning is None)
    return WalkState(0, None, 0.0, 0.0, 0.4, 1.2, 3.0, health, {"imu": 3}, {}, {}, recorder)


def test_the_screen_says_what_is_amiss() -> None:
    console = Console(width=140, record=True, file=StringIO())
    console.print(
        screen(state(SensorState.LOST, "The disk is full."), estimator="gps-imu/precise", connected=False, url=None)
    )
    text = console.export_text()
    for words in (
        "plug it in",
        "The server is away",
        "The disk is full",
        "no pose yet",
        "Lost, since fusion was behind",
    ):
        assert words in text
    turned_away = state(SensorState.STREAMING, None)
    console.print(screen(turned_away, estimator="e", connected=False, url=None, refused="The server refused this rig."))
    assert "The server refused this rig. Tracking goes on." in console.export_text()
    console.print(screen(state(SensorState.STREAMING, None), estimator="", connected=None, url="http://h/"))
    text = console.export_text()
    assert "Nothing is tracked" in text
    assert "walk.mcap: 1.5 MB" in text


def test_the_screen_as_json_is_json() -> None:
    told = json.loads(json.dumps(as_json(state(SensorState.LOST, None), estimator="e", connected=None)))
    assert (told["sensors"]["gps"]["state"], told["lost"], told["pose"]) == ("lost", {"imu": 3}, None)
