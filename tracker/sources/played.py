"""A recorded walk that stands in for live sensors: each sensor's measurements at the pace and with the delays of the recording."""

from dataclasses import replace
from threading import Event, Lock
from time import monotonic_ns
from types import MappingProxyType

from tracker.errors import InputError, SourceLost
from tracker.log import Log
from tracker.measurements import Frame, GpsFix, GpsVelocity, ImuSample, MagSample, Measurement
from tracker.sources.source import Put, SourceStatus

#: What each sensor of a rig says. (A phone's own heading is no sensor of a rig's.)
SENSORS: dict[str, tuple[type, ...]] = {
    "gps": (GpsFix, GpsVelocity),
    "imu": (ImuSample, MagSample),
    "camera": (Frame,),
}


class Played:
    """One recording, begun once for all the sensors that are played from it: so they stay together."""

    def __init__(self, log: Log, *, looping: bool = False) -> None:
        """`looping` begins again at the end, as one walk that goes on; the rig then leaps to where the recording began."""
        self.log, self.looping = log, looping
        self._lock = Lock()
        self._begun_ns: int | None = None

    def source(self, sensor: str) -> "PlayedSource":
        """Return one sensor: `gps`, `imu` or `camera`.

        Raises:
            InputError: The recording has none.
        """
        counted = {"gps": "gps", "imu": "imu", "camera": "frames"}[sensor]
        if not self.log.info.counts[counted]:
            raise InputError(f"{self.log.path} has no {sensor} to play: name another recording, or `none`.")
        return PlayedSource(self, sensor)

    def begin(self) -> int:
        """Return when the recording began to be played, local clock: when anybody asked first."""
        with self._lock:
            if self._begun_ns is None:
                self._begun_ns = monotonic_ns()
            return self._begun_ns


class PlayedSource:
    """One sensor of a recording. Fulfils `Source`."""

    def __init__(self, played: Played, sensor: str) -> None:
        self._played, self._sensor = played, sensor
        self._attached = False
        self._count = 0

    @property
    def name(self) -> str:
        """The sensor."""
        return self._sensor

    def status(self) -> SourceStatus:
        """Return how it is."""
        detail = f"played from {self._played.log.name}" if self._attached else f"{self._played.log.name} is not playing"
        return SourceStatus(self._attached, detail, MappingProxyType({"played": self._count}))

    def run(self, put: Put, stop: Event) -> None:
        """Play from where the recording is by now."""
        info = self._played.log.info
        lap_ns = info.t_end_ns - info.t_start_ns + 50_000_000
        begun_ns = self._played.begin()
        lap = (monotonic_ns() - begun_ns) // lap_ns if self._played.looping else 0
        self._attached = True
        try:
            while True:
                self._play(put, stop, begun_ns + lap * lap_ns - info.t_start_ns)
                if stop.is_set():
                    return
                if not self._played.looping:
                    raise SourceLost(f"the recording {self._played.log.name} has ended")
                lap += 1
        finally:
            self._attached = False

    def _play(self, put: Put, stop: Event, shift_ns: int) -> None:
        """Play to the end; `shift_ns` is the local clock minus the recording's."""
        kinds, is_camera = SENSORS[self._sensor], self._sensor == "camera"
        start_ns = max(self._played.log.info.t_start_ns, monotonic_ns() - shift_ns)
        for measurement in self._played.log.messages(start_ns=start_ns, camera=is_camera, truth=False):
            if not isinstance(measurement, kinds):
                continue
            wait_s = (measurement.t_recv_ns + shift_ns - monotonic_ns()) * 1e-9
            if stop.wait(wait_s) if wait_s > 0.0 else stop.is_set():
                return
            put(_shifted(measurement, shift_ns))
            self._count += 1


def _shifted(measurement: Measurement, shift_ns: int) -> Measurement:
    t_recv_ns = max(monotonic_ns(), measurement.t_recv_ns + shift_ns)
    return replace(measurement, t_ns=measurement.t_ns + shift_ns, t_recv_ns=t_recv_ns)
