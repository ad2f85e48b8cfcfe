"""What `--gps`, `--imu` and `--camera` name, as sources. Device libraries are imported only where they are asked for."""

from collections.abc import Callable
from pathlib import Path

from tracker.errors import InputError
from tracker.log import Log
from tracker.rig import Rig
from tracker.rig_file import RigFile
from tracker.sources.played import Played
from tracker.sources.source import Source

GPS_HELP = "phidget[:SERIAL], serial:DEVICE[:BAUD], gpsd[:HOST:PORT], log:FILE or none."
IMU_HELP = "phidget[:SERIAL], log:FILE or none."
CAMERA_HELP = "A number or /dev/video0, rtsp://…, a video file, log:FILE or none."
_LOG = "log:"


class RigSources:
    """Makes the sources of one rig; what is played from one recording is played together."""

    def __init__(self, rig_file: RigFile) -> None:
        self._rig_file = rig_file
        self._played: dict[str, Played] = {}

    def make(self, *, gps: str, imu: str, camera: str) -> list[Source]:
        """Return the sources that are named.

        Raises:
            InputError: A word names nothing, or a file cannot be read.
        """
        makers = (("gps", gps, self._gps), ("imu", imu, self._imu), ("camera", camera, self._camera))
        return [self._source(sensor, spec, maker) for sensor, spec, maker in makers if spec != "none"]

    def rig(self) -> Rig:
        """Return the rig: the file's, or a recording's own where one is played and nothing was calibrated here."""
        if self._rig_file != RigFile() or not self._played:
            return self._rig_file.rig()
        return next(iter(self._played.values())).log.rig

    def _source(self, sensor: str, spec: str, maker: Callable[[str], Source]) -> Source:
        return self._recorded(spec).source(sensor) if spec.startswith(_LOG) else maker(spec)

    def _recorded(self, spec: str) -> Played:
        path = spec.removeprefix(_LOG)
        if path not in self._played:
            self._played[path] = Played(Log.open(Path(path).expanduser()))
        return self._played[path]

    def _gps(self, spec: str) -> Source:
        if spec.partition(":")[0] == "phidget":
            from tracker.sources.phidget_gps import PhidgetGpsSource

            return PhidgetGpsSource(_serial(spec, "--gps", GPS_HELP))
        from tracker.sources.nmea_source import nmea_source

        return nmea_source(spec)

    def _imu(self, spec: str) -> Source:
        if spec.partition(":")[0] == "phidget":
            from tracker.sources.phidget_spatial import PhidgetSpatialSource

            R_body_imu = self._rig_file.rig().T_body_imu[:3, :3]
            return PhidgetSpatialSource(_serial(spec, "--imu", IMU_HELP), R_body_imu)
        raise InputError(f"--imu {spec!r} names nothing: give {IMU_HELP}")

    def _camera(self, spec: str) -> Source:
        from tracker.sources.camera import camera_source
        from tracker.sources.camera_mode import CameraSettings

        lens = self._rig_file.camera
        # a lens was calibrated at one size of the picture, and other sizes may be cut from another part of the sensor
        settings = CameraSettings() if lens is None else CameraSettings(lens.width_px, lens.height_px)
        return camera_source(spec, settings)


def _serial(spec: str, option: str, usage: str) -> int | None:
    """Return the serial number after the colon."""
    _, colon, text = spec.partition(":")
    if not colon:
        return None
    if not (text.isascii() and text.isdigit() and len(text) < 10):
        raise InputError(f"{option} {spec!r} has no serial number after its colon: give {usage}")
    return int(text)
