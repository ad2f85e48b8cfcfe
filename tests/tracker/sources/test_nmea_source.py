"""NMEA receivers at a serial port and behind a real gpsd: every valid fix arrives, every corrupt sentence is counted."""

import os
import pty
import socket
import termios
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event, Thread

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.tracker.sources.gpsd_daemon import free_port, need_gpsd, playing
from tests.tracker.sources.listening import Listening
from tests.tracker.sources.nmea_count import count, is_passed, places_deg
from tests.tracker.sources.receivers import STYLES, Moment, burst, ubx, walk
from tracker.errors import InputError, SourceLost
from tracker.sources.nmea_source import nmea_source
from tracker.sources.serial_port import SerialStream

END = Moment(80_000.0, lat_deg=-89.5).gga() + Moment(80_001.0, lat_deg=-89.4).gga()
"""Said last, so that a test knows when everything has arrived: a place of its own, and the next epoch, which ends that one."""


def corrupted(style: str) -> bytes:
    """Return a walk in which every fifth epoch has a wrong digit, is cut off or is drowned in noise."""
    parts = []
    for number, moment in enumerate(walk(30)):
        data = burst(style, moment)
        match number % 15:
            case 4:
                data = data.replace(b"38.500,M", b"38.501,M")
            case 9:
                data = data[: len(data) // 2] + b"\r\n"
            case 14:
                data = b"\xb5\x62\x01\x07\x00\xff" + data
        parts.append(data)
    return b"".join(parts)


class Receiver:
    """The far end of a pseudo-terminal, whose near end is a serial port."""

    def __init__(self) -> None:
        self._master, slave = pty.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        self._slave = slave

    @property
    def baud(self) -> int:
        """The rate to which the port is set, as termios numbers it."""
        speed: int = termios.tcgetattr(self._master)[5]
        return speed

    def say(self, data: bytes) -> None:
        """Send bytes; waits until there is room."""
        while data:
            data = data[os.write(self._master, data[:1024]) :]

    def leave(self) -> None:
        """Be pulled out."""
        for end in (self._slave, self._master):
            if end >= 0:
                os.close(end)
        self._slave = self._master = -1


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    it = Receiver()
    yield it
    it.leave()


@contextmanager
def speaking(receiver: Receiver, data: bytes) -> Iterator[None]:
    """Say `data` from another thread."""
    thread = Thread(target=receiver.say, args=(data,), daemon=True)
    thread.start()
    yield
    thread.join(10.0)


def only(expected: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return those places that are expected: RMC says where a corrupt GGA would have been."""
    return np.array([place for place in places if np.abs(expected - place).max(axis=1).min() < 1e-10]).reshape(-1, 2)


def check_port(receiver: Receiver, data: bytes) -> None:
    """Hear a log through the port: what is counted by hand is what arrives and what is counted."""
    source = nmea_source(f"serial:{receiver.path}:9600")
    with Listening(source) as heard:
        heard.wait(lambda: source.status().attached)  # what is said before is thrown away as it should be: it is old
        with speaking(receiver, data + END):
            heard.wait(lambda: any(fix.lat_deg == -89.5 for fix in heard.fixes))
        heard.stop()
    expected = count(data)
    assert is_passed(only(expected.places_deg, places_deg(heard.found)), expected.places_deg)
    counts = source.status().counts
    assert counts.get("checksum", 0) + counts.get("cut", 0) + counts.get("too_long", 0) == expected.corrupt
    assert heard.error is None


@pytest.mark.parametrize("style", STYLES)
def test_a_port_gives_every_fix_and_counts_every_corrupt_sentence(receiver: Receiver, style: str) -> None:
    check_port(receiver, corrupted(style))


def test_a_port_hears_real_receivers(receiver: Receiver, shared: Path) -> None:
    """Seven of them, each from a log, without its remarks."""
    for path in sorted((shared / "data/nmea").glob("*.log")):
        check_port(receiver, b"".join(line for line in path.read_bytes().splitlines(True) if not line.startswith(b"#")))


def test_the_rate_is_found_out(receiver: Receiver) -> None:
    """A receiver at 38400 baud is noise at 9600; once its rate is set, nothing that it says is lost."""
    source, stop = nmea_source(f"serial:{receiver.path}"), Event()

    def speak() -> None:
        number = 0
        while not stop.is_set():
            data = burst("RTK", Moment(float(number), lat_deg=number * 1e-3))
            receiver.say(data if receiver.baud == termios.B38400 else bytes(byte ^ 0x5A | 0x80 for byte in data))
            number += 1
            stop.wait(0.05)

    thread = Thread(target=speak, daemon=True)
    thread.start()
    with Listening(source) as heard:
        heard.wait(lambda: len(heard.fixes) > 5)
        heard.wait(lambda: source.status().attached)
        assert source.status().detail == f"{receiver.path} at 38400 baud"
    stop.set()
    thread.join()
    assert not source.status().attached
    steps_deg = np.diff(places_deg(heard.found)[:, 0])
    assert np.allclose(steps_deg, 1e-3)


def test_a_receiver_that_is_pulled_out_is_lost_and_found_again() -> None:
    """The message says what to do, and the same source may run again."""
    receiver = Receiver()
    source = nmea_source(f"serial:{receiver.path}:9600")
    with Listening(source) as heard:
        heard.wait(lambda: source.status().attached)
        receiver.say(burst("RTK", Moment(1.0)) + burst("RTK", Moment(2.0)))
        heard.wait(lambda: len(heard.fixes) > 1)
        receiver.leave()
        heard.join()
    assert isinstance(heard.error, SourceLost)
    assert "plug the receiver in again" in str(heard.error)
    assert source.status().detail == str(heard.error)
    assert not source.status().attached


def test_a_receiver_that_falls_silent_is_lost(receiver: Receiver, monkeypatch: pytest.MonkeyPatch) -> None:
    """Noise is silence too; the message says where to look."""
    monkeypatch.setattr("tracker.sources.nmea_source._SILENCE_NS", 300_000_000)
    with Listening(nmea_source(f"serial:{receiver.path}:9600")) as heard:
        while not isinstance(heard.error, SourceLost):
            receiver.say(b"\xff\x00noise\r\n")
            time.sleep(0.01)
    assert "check the receiver's power" in str(heard.error)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (FileNotFoundError(2, "no such file"), "plug the receiver in"),
        (PermissionError(13, "permission denied"), "usermod -aG dialout"),
        (BlockingIOError(11, "could not exclusively lock port"), "in use by another program"),
        (OSError(25, "not a typewriter"), "no serial port"),
    ],
)
def test_a_port_that_cannot_be_opened_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch, error: OSError, words: str
) -> None:
    def refuse(*_arguments: object, **_options: object) -> None:
        raise error

    monkeypatch.setattr("tracker.sources.serial_port.Serial", refuse)
    with pytest.raises(SourceLost, match=words):
        SerialStream("/dev/ttyUSB0").open(Event())


def test_a_port_in_use_is_left_alone(receiver: Receiver) -> None:
    """By the lock that serial programs take."""
    first, second = SerialStream(receiver.path, 9600), SerialStream(receiver.path, 9600)
    first.open(Event())
    with pytest.raises(SourceLost, match="another program"):
        second.open(Event())
    first.close()


@pytest.mark.parametrize(
    ("words", "path", "detail"),
    [
        ("/dev/ttyUSB0", "/dev/ttyUSB0", "/dev/ttyUSB0"),
        ("/dev/ttyUSB0:9600", "/dev/ttyUSB0", "/dev/ttyUSB0 at 9600 baud"),
        ("/dev/serial/by-path/pci-0:1", "/dev/serial/by-path/pci-0:1", "/dev/serial/by-path/pci-0:1"),
    ],
)
def test_ports_are_named(words: str, path: str, detail: str) -> None:
    assert path in SerialStream.named(words).detail
    assert SerialStream.named(words).detail == detail


@pytest.mark.parametrize("spec", ["serial", "serial:", "gpsd:localhost:port", "gpsd::0", "usb", ""])
def test_what_names_no_receiver_is_refused(spec: str) -> None:
    with pytest.raises(InputError):
        nmea_source(spec)


def check_gpsd(log: Path) -> None:
    """Hear a log that gpsd plays over and over: one whole pass of it, in order, is among what arrives, and nothing else is."""
    expected = count(log.read_bytes()).places_deg
    with playing(log) as port:
        source = nmea_source(f"gpsd:127.0.0.1:{port}")
        with Listening(source) as heard:
            heard.wait(lambda: sum(fix.valid for fix in heard.fixes) >= 2 * len(expected) + 10)
    places = places_deg(heard.found)
    assert is_passed(only(expected, places), expected)
    assert len(heard.velocities) > len(expected)
    assert source.status().counts.get("checksum", 0) == 0  # gpsd refuses those itself


@pytest.mark.parametrize("style", ["u-blox", "SiRF", "RTK"])
def test_gpsd_hands_on_every_fix(tmp_path: Path, style: str) -> None:
    """And nothing of what is corrupt."""
    need_gpsd()
    log = tmp_path / "receiver.log"
    log.write_bytes(corrupted(style))
    check_gpsd(log)


def test_gpsd_hands_on_a_binary_receivers_own_view(tmp_path: Path) -> None:
    """To 1e-7 degrees, with the receiver's own height above the ellipsoid, errors and velocity."""
    need_gpsd()
    log, moments = tmp_path / "receiver.ubx", walk(40)
    log.write_bytes(b"".join(ubx(moment) for moment in moments))
    with playing(log) as port, Listening(nmea_source(f"gpsd:127.0.0.1:{port}")) as heard:
        heard.wait(lambda: len(heard.fixes) > 100)
    expected = np.array([(moment.lat_deg, moment.lon_deg) for moment in moments])
    away_deg = np.abs(places_deg(heard.found)[:, None] - expected).max(axis=2)
    assert away_deg.min(axis=1).max() < 1e-7
    assert set(away_deg.argmin(axis=1)) == set(range(40))
    fix, velocity = heard.fixes[-1], heard.velocities[-1]
    assert fix.h_ellipsoid_m == pytest.approx(86.7, abs=0.3)
    assert fix.cov_enu_m2[::4] == pytest.approx((1.125, 1.125, 6.25), rel=1e-3)
    assert velocity.v_enu_m_s == pytest.approx((0.99, 0.99, 0.0), abs=0.01)


@pytest.mark.slow
def test_gpsd_hears_real_receivers(shared: Path) -> None:
    """Seven of them, each from a log."""
    need_gpsd()
    for path in sorted((shared / "data/nmea").glob("*.log")):
        check_gpsd(path)


def answering(lines: bytes) -> tuple[int, Thread]:
    """Return a port at which somebody says `lines` to the first who comes, and hangs up."""
    server = socket.create_server(("127.0.0.1", 0))

    def answer() -> None:
        with server, server.accept()[0] as connection:
            connection.recv(1000)
            connection.sendall(lines)

    thread = Thread(target=answer, daemon=True)
    thread.start()
    return int(server.getsockname()[1]), thread


VERSION = b'{"class":"VERSION","release":"3.25","proto_major":3,"proto_minor":15}\r\n'


def test_gpsds_own_lines_are_no_noise() -> None:
    """Its notices tell of receivers; TPV and SKY are passed over, and so is what is no JSON."""
    moment = Moment(5.0)
    devices = b'{"class":"DEVICES","devices":[{"class":"DEVICE","path":"/dev/ttyUSB0","driver":"NMEA0183"},7]}\r\n'
    other = b'{"class":"TPV","mode":3}\r\n{"class":"DEVICE",\r\n{"class":"DEVICE","path":4}\r\n'
    port, thread = answering(VERSION + devices + moment.gga() + other + moment.rmc())
    source = nmea_source(f"gpsd:127.0.0.1:{port}")
    with Listening(source) as heard:
        heard.join()
    thread.join()
    assert isinstance(heard.error, SourceLost)
    assert "ended the connection" in str(heard.error)
    assert len(heard.fixes) == len(heard.velocities) == 1
    assert source.status().counts == {"sentences": 2, "fixes": 1, "velocities": 1}


@pytest.mark.parametrize("lines", [b"SSH-2.0-OpenSSH\r\n", b"x" * 100_000])
def test_somebody_else_at_gpsds_port(lines: bytes) -> None:
    port, thread = answering(lines)
    with Listening(nmea_source(f"gpsd:127.0.0.1:{port}")) as heard:
        heard.join()
    thread.join()
    assert "is no gpsd" in str(heard.error)


def test_no_gpsd_says_how_to_start_it() -> None:
    with Listening(nmea_source(f"gpsd:127.0.0.1:{free_port()}")) as heard:
        heard.join()
    assert isinstance(heard.error, SourceLost)
    assert "systemctl start gpsd" in str(heard.error)
