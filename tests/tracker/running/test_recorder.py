"""A recording: the same poses again, whatever is cut off; and a disk that is full costs the recording alone."""

import errno
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from threading import Event
from time import monotonic, monotonic_ns, sleep
from typing import Any

import pytest

from tests.tracker.running.walking import UTC_NS, Noted, S, drive, live_stream, new_core, rig, rows_of
from tracker.errors import InputError
from tracker.estimators import ESTIMATORS
from tracker.evaluate import make_pipeline
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, ImuSample, Measurement
from tracker.running.recorder import Recorder
from tracker.simulate import AGORA_ORIGIN, START_NS

ABOUT = {"estimator": "camera-gps-imu/precise", "rig": "# nothing is known of this rig\n"}


def _record(path: Path, measurements: Iterable[Measurement], **options: Any) -> Recorder:
    recorder = Recorder(path, rig(), t_start_ns=START_NS, utc_start_ns=UTC_NS, about=ABOUT, **options)
    for measurement in measurements:
        while recorder.state.waiting > 50:  # a walk would take its time
            sleep(0.001)
        recorder.put(measurement)
    return recorder


@pytest.mark.parametrize("name", [name for name in ESTIMATORS if name != "truth"])
def test_a_replay_of_a_recording_gives_the_same_poses_bit_for_bit(name: str, tmp_path: Path) -> None:
    """What vision made of the pictures comes from the recording, at the moment at which it came live: no picture is decoded."""
    noted = Noted()
    noted.core = core = new_core(name, noted)
    drive(core, live_stream(9.0))
    _record(tmp_path / "walk.mcap", noted.fed).close()
    log = Log.open(tmp_path / "walk.mcap")
    assert log.info.date_ns == UTC_NS
    assert log.info.utc_offset_s == (UTC_NS - START_NS) * 1e-9
    assert log.metadata["agora"]["rig"] == ABOUT["rig"]
    again = rows_of(make_pipeline(name, log, AGORA_ORIGIN), log.messages())
    assert not log.skipped
    assert again == noted.rows
    assert sum(1 for one in again if one) > 250


def test_pictures_are_looked_at_anew_where_that_is_asked_for(tmp_path: Path) -> None:
    """Then what was recorded of them counts for nothing."""
    noted = Noted()
    noted.core = core = new_core("camera-gps-imu/precise", noted)
    drive(core, live_stream(3.0))
    _record(tmp_path / "walk.mcap", noted.fed).close()
    log = Log.open(tmp_path / "walk.mcap")
    pipeline = make_pipeline("camera-gps-imu/precise", log, AGORA_ORIGIN, look_again=True)
    for measurement in log.messages():
        pipeline.step(measurement)
    assert pipeline.front_end is not None
    assert pipeline.rejected["weak"] == log.info.counts["frames"]  # these pictures do not decode
    assert make_pipeline("camera-gps-imu/precise", log, AGORA_ORIGIN).front_end is None


_WRITE_FOR_EVER = """
import sys
from pathlib import Path
from time import monotonic_ns, sleep
from tests.tracker.running.walking import PICTURE, rig
from tracker.measurements import Frame, ImuSample
from tracker.running.recorder import Recorder
recorder = Recorder(Path(sys.argv[1]), rig(), t_start_ns=monotonic_ns(), utc_start_ns=0, about={})
index = 0
while True:
    t_ns = monotonic_ns()
    recorder.put(ImuSample(t_ns, t_ns, (0.1, 0.2, 0.001 * index), (0.0, 0.0, 9.8)))
    index += 1
    if index % 20 == 0:
        recorder.put(Frame(t_ns, t_ns, index, PICTURE))
    print(t_ns, flush=True)
    sleep(0.004)
"""


def test_a_kill_loses_at_most_the_last_second(tmp_path: Path) -> None:
    """SIGKILL in the middle: no index, no farewell, and all that is older than a second can be replayed."""
    path = tmp_path / "killed.mcap"
    with subprocess.Popen(
        [sys.executable, "-c", _WRITE_FOR_EVER, str(path)], stdout=subprocess.PIPE, text=True
    ) as rig_:
        try:
            assert rig_.stdout is not None
            t_ns = first_ns = int(rig_.stdout.readline())
            told = 1
            while t_ns < first_ns + 2 * S or told < 500:  # a machine with other work takes longer for as many
                t_ns, told = int(rig_.stdout.readline()), told + 1
            rig_.send_signal(signal.SIGKILL)
            t_last_ns = max([t_ns, *(int(line) for line in rig_.stdout)])
        finally:
            rig_.kill()
    log = Log.open(path)
    samples = [m.t_ns for m in log.messages() if isinstance(m, ImuSample)]
    assert log.info.truncated
    assert samples[0] == first_ns
    assert samples[-1] > t_last_ns - S
    assert len(samples) > 250


class _FullDisk(LogWriter):
    """A log on a disk that has room for the beginning only."""

    room = 3

    def flush(self) -> None:
        """Say what the kernel says."""
        super().flush()
        self.room -= 1
        if self.room == 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_full_disk_ends_the_recording_with_a_warning_and_nothing_else(tmp_path: Path) -> None:
    """Putting goes on without an error; what came before can be read."""
    measurements = live_stream(5.0)
    recorder = _record(tmp_path / "full.mcap", measurements[:500], open_log=_FullDisk)
    deadline = monotonic() + 10.0
    while recorder.state.is_recording and monotonic() < deadline:
        sleep(0.01)
    for measurement in measurements[500:]:
        recorder.put(measurement)
    state = recorder.state
    recorder.close()
    assert not state.is_recording
    assert state.warning is not None
    assert "No space left on device" in state.warning
    assert "tracking goes on" in state.warning
    assert Log.open(tmp_path / "full.mcap").info.counts["imu"] > 100


def test_a_disk_that_is_full_already_is_said_at_once() -> None:
    """By the kernel itself."""
    with pytest.raises(InputError, match=r"cannot be written|is there already"):
        _record(Path("/dev/full"), ())


def test_a_recording_overwrites_nothing(tmp_path: Path) -> None:
    """A walk cannot be walked twice."""
    (tmp_path / "walk.mcap").write_bytes(b"precious")
    with pytest.raises(InputError, match="is there already"):
        _record(tmp_path / "walk.mcap", ())


class _SlowDisk(LogWriter):
    """A log on a disk that hangs until it is let go."""

    go = Event()

    def write(self, measurement: Measurement) -> None:
        """Hang, and write."""
        self.go.wait()
        super().write(measurement)


def test_a_slow_disk_never_delays_who_records_and_says_what_is_missing(tmp_path: Path) -> None:
    """Sixty pictures may wait, and a minute of everything else."""
    picture = next(m for m in live_stream(3.0) if isinstance(m, Frame))
    recorder = _record(tmp_path / "slow.mcap", (), open_log=_SlowDisk)
    t_ns = monotonic_ns()
    recorder.put(ImuSample(t_ns, t_ns, (0.0, 0.0, 0.0), (0.0, 0.0, 9.8)))
    sleep(0.2)  # the recorder has taken the sample, and hangs
    for index in range(100):
        recorder.put(Frame(t_ns + index, t_ns + index, index, picture.picture))
    assert recorder.state.lost == 40
    assert "too slow" in str(recorder.state.warning)
    _SlowDisk.go.set()
    recorder.close()
    assert Log.open(tmp_path / "slow.mcap").info.counts["frames"] == 60
