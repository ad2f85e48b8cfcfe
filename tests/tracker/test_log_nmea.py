"""A receiver's own sentences in a log."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from tests.tracker.sources.receivers import MS, SECOND, Moment, burst, walk
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import GpsFix, GpsVelocity, ImuSample
from tracker.rig import Rig

T0 = 1_000 * SECOND
NO_COV = (0.0,) * 9


def write(path: Path, moments: list[Moment], style: str = "u-blox", *, with_fixes: bool = False) -> Path:
    """Write a log of IMU samples and a receiver's sentences, each 60 ms and more late; and a driver's fixes that are elsewhere."""
    with LogWriter(path, Rig(), t_start_ns=T0) as writer:
        for number, moment in enumerate(moments):
            t_ns = T0 + number * SECOND
            writer.write(ImuSample(t_ns, t_ns, (0.0,) * 3, (0.0, 0.0, 9.81)))
            if with_fixes:
                writer.write(GpsFix(t_ns, t_ns + MS, 1.0, 2.0, 3.0, NO_COV))
                writer.write(GpsVelocity(t_ns, t_ns + MS, (9.0, 9.0, 0.0)))
            for place, line in enumerate(burst(style, moment).splitlines(keepends=True)):
                text = line.decode() if number % 2 else line.decode().strip()
                writer.write_sentence(t_ns + (60 + 10 * place + number * 7 % 11) * MS, text)
    return path


def test_sentences_are_the_source_where_there_are_any(tmp_path: Path) -> None:
    """Every fix and velocity, evenly in time; the driver's own are left alone; counts and the first fix are theirs."""
    log = Log.open(write(tmp_path / "walk.mcap", walk(30), with_fixes=True))
    found = list(log.messages())
    fixes = [m for m in found if isinstance(m, GpsFix)]
    assert len(fixes) == len([m for m in found if isinstance(m, GpsVelocity)]) == 30
    assert [fix.lat_deg for fix in fixes] == pytest.approx([moment.lat_deg for moment in walk(30)])
    assert all(abs(b.t_ns - a.t_ns - SECOND) < 12 * MS for a, b in pairwise(fixes))
    assert all(fix.t_ns <= fix.t_recv_ns for fix in fixes)
    assert all(a.t_recv_ns <= b.t_recv_ns for a, b in pairwise(found))
    assert (log.info.counts["gps"], log.info.counts["gps_velocity"]) == (30, 30)
    assert log.info.first_fix is not None
    assert log.info.first_fix.lat_deg == fixes[0].lat_deg
    assert not log.skipped


def test_without_positions_the_drivers_fixes_count(tmp_path: Path) -> None:
    """Satellites alone are no source."""
    path = tmp_path / "walk.mcap"
    with LogWriter(path, Rig(), t_start_ns=T0) as writer:
        writer.write(GpsFix(T0, T0, 1.0, 2.0, 3.0, NO_COV))
        for line in Moment(5.0).gsv().splitlines():
            writer.write_sentence(T0, line.decode())
    log = Log.open(path)
    assert [m.lat_deg for m in log.messages() if isinstance(m, GpsFix)] == [1.0]
    assert log.info.counts["gps"] == 1


def test_reading_from_the_middle_is_the_end_of_reading_all(tmp_path: Path) -> None:
    """Clock, learned order and all: a seek sees the same numbers."""
    log = Log.open(write(tmp_path / "walk.mcap", walk(30)))
    start_ns = T0 + 12 * SECOND + 70 * MS
    assert list(log.messages(start_ns=start_ns)) == [m for m in log.messages() if m.t_recv_ns >= start_ns]


def test_a_log_of_sentences_alone_is_a_walk_and_damage_is_counted(tmp_path: Path) -> None:
    """No IMU, no `/gps/fix`; a line whose checksum is wrong, one that was cut off and one in another alphabet."""
    path = tmp_path / "walk.mcap"
    with LogWriter(path, Rig(), t_start_ns=T0) as writer:
        for number, moment in enumerate(walk(4)):
            for text in (moment.gga().decode(), moment.rmc().decode().replace("A", "B", 1), "$GPGGA,1", "καλημέρα"):
                writer.write_sentence(T0 + number * SECOND, text)
    log = Log.open(path)
    assert [m.valid for m in log.messages() if isinstance(m, GpsFix)] == [True] * 4
    assert log.skipped == {"nmea_checksum": 4, "nmea_cut": 4, "nmea_noise": 4}


def test_another_library_reads_the_sentences(tmp_path: Path) -> None:
    """As nmea_msgs/msg/Sentence."""
    path, lines = write(tmp_path / "walk.mcap", walk(1), "RTK"), []
    with path.open("rb") as file:
        reader: Any = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, _, message in reader.iter_decoded_messages():
            if channel.topic == "/gps/nmea":
                assert schema.name == "nmea_msgs/msg/Sentence"
                lines.append(message.sentence)
    assert lines == burst("RTK", walk(1)[0]).decode().splitlines()
