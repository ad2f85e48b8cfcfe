"""A walk written to disk while it is walked, on a thread of its own: the estimator never waits for a disk.

What is written is what the estimator was fed, in that order, so that a replay gives the same poses, bit for bit. All that is
older than a second is on the disk, whatever happens then. A disk that is full ends the recording, and nothing else.
"""

import logging
import shutil
import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Condition, Thread
from time import monotonic

import numpy as np

from tracker import ros_messages as ros
from tracker.errors import InputError, MalformedInput
from tracker.log import RECORDING, rig_of
from tracker.log_writer import LogWriter, rig_messages
from tracker.measurements import Frame, Measurement
from tracker.rig import Rig

_logger = logging.getLogger(__name__)

#: How often all that was written is brought to the disk.
_FLUSH_S = 0.5
#: The recording ends while there is room for its index and for everybody else, bytes.
_LEAST_FREE = 64 * 1024 * 1024
#: What may wait for a slow disk: measurements (a minute of them), and pictures, which are large.
_MOST_WAITING, _MOST_PICTURES = 20_000, 60


@dataclass(frozen=True, slots=True)
class RecorderState:
    """How the recording is."""

    path: Path
    bytes: int
    """Size of the file."""
    waiting: int
    """Measurements and pictures that the disk has not taken yet."""
    lost: int
    """Measurements and pictures that a slow disk left no place for."""
    warning: str | None
    """Why nothing is recorded any more, or what is missing from it; one sentence."""
    is_recording: bool

    def as_json(self) -> dict[str, object]:
        """Return it as JSON values."""
        return {
            "file": self.path.name,
            "bytes": self.bytes,
            "lost": self.lost,
            "warning": self.warning,
            "recording": self.is_recording,
        }


def recorded(rig: Rig) -> Rig:
    """Return the rig that a recording's frames are of: samples are in body axes already, so its inertial unit's are those."""
    T_body_imu = np.eye(4)
    T_body_imu[:3, 3] = rig.T_body_imu[:3, 3]
    return replace(rig, T_body_imu=T_body_imu)


def as_read(rig: Rig) -> Rig:
    """Return a rig as the recording of it will be read: a rotation on its way through a quaternion changes in its last bits."""
    messages = {topic: ros.decode(ros.encode(m), m.__msgtype__) for topic, m in rig_messages(rig, 0).items()}
    camera = messages.get("/camera/camera_info")
    return rig_of(ros.transforms(messages["/tf_static"]), None if camera is None else ros.camera_model(camera))


class Recorder:
    """Writes one file until it is closed or the disk is full."""

    def __init__(
        self,
        path: Path,
        rig: Rig,
        *,
        t_start_ns: int,
        utc_start_ns: int,
        about: Mapping[str, str],
        open_log: Callable[..., LogWriter] = LogWriter,
    ) -> None:
        """Begin a recording.

        Args:
            path: Must not exist.
            rig: See `recorded`.
            t_start_ns: The local clock now; not after the first measurement.
            utc_start_ns: Nanoseconds since 1970, UTC, at the same time.
            about: What else is worth knowing: the rig's file, the estimator, the program's version.
            open_log: Makes the writer.

        Raises:
            InputError: The file cannot be written.
        """
        self.path = path
        metadata = {RECORDING: {"utc_start_ns": str(utc_start_ns), **about}}
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.exists():
                raise InputError(f"{path} is there already: name another file, a recording overwrites nothing.")
            self._writer = open_log(path, rig, t_start_ns=t_start_ns, metadata=metadata)
            self._writer.flush()
        except OSError as error:
            raise InputError(f"{path} cannot be written ({error.strerror}): name another place.") from error
        self._changed = Condition()
        self._waiting: list[Measurement] = []
        self._pictures = self._lost = self._bytes = 0
        self._warning: str | None = None
        self._closed = False
        self._thread = Thread(target=self._run, name="recorder", daemon=True)
        self._thread.start()

    @property
    def state(self) -> RecorderState:
        """How it is now; from any thread."""
        return RecorderState(self.path, self._bytes, len(self._waiting), self._lost, self._sentence(), self._is_running)

    def put(self, measurement: Measurement) -> None:
        """Take what the estimator was fed; never waits. Called by one thread."""
        if not self._is_running:
            return
        is_picture = isinstance(measurement, Frame)
        with self._changed:
            if len(self._waiting) >= _MOST_WAITING or (is_picture and self._pictures >= _MOST_PICTURES):
                self._lost += 1
                return
            self._pictures += is_picture
            self._waiting.append(measurement)

    def close(self) -> None:
        """Write what waits, and the index, and end. May be called twice."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._thread.join()

    @property
    def _is_running(self) -> bool:
        return self._warning is None and not self._closed

    def _sentence(self) -> str | None:
        if self._warning is None and self._lost:
            return f"The disk is too slow: {self._lost} measurements are missing from {self.path.name}."
        return self._warning

    # -- the thread ---------------------------------------------------------------------------------------------------

    def _run(self) -> None:
        try:
            while self._write_waiting():
                pass
            self._writer.close()
            self._bytes = self.path.stat().st_size
        except OSError as error:
            self._end(f"The recording has stopped, since {self.path} cannot be written ({error.strerror})")
        except Exception as error:
            _logger.exception("the recorder failed")
            self._end(f"The recording has stopped, since it failed ({type(error).__name__}: {error})")

    def _write_waiting(self) -> bool:
        """Write for half a second and bring it to the disk; False at the end."""
        until_s = monotonic() + _FLUSH_S
        goes_on = True
        while goes_on and monotonic() < until_s:
            with self._changed:
                self._changed.wait_for(lambda: self._closed, 0.05)
                waiting, self._waiting, self._pictures = self._waiting, [], 0
                goes_on = not self._closed
            for measurement in waiting:
                self._write(measurement)
        self._writer.flush()
        self._bytes = self.path.stat().st_size
        if shutil.disk_usage(self.path.parent).free < _LEAST_FREE:
            self._writer.close()
            self._end(f"The recording has stopped, since the disk of {self.path} is full")
            return False
        return goes_on

    def _write(self, measurement: Measurement) -> None:
        try:
            self._writer.write(measurement)
        except (MalformedInput, ValueError, TypeError, OverflowError, struct.error) as error:
            self._lost += 1  # a picture that does not encode, a stamp that ROS cannot write
            _logger.debug("not recorded: %s", error)

    def _end(self, what: str) -> None:
        """Say why it ends. What was written is kept: a file without an index reads, too."""
        self._warning = f"{what}: what came before is kept, and tracking goes on."
        _logger.warning("%s", self._warning)
        with self._changed:
            self._waiting.clear()
        try:
            self._writer.close()
        except Exception:
            _logger.debug("the file was closed without its index")
