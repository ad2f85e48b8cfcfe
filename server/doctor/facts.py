"""What was found on a rig and its machine: values that the verdicts are made of."""

from dataclasses import dataclass, field
from pathlib import Path

from tracker.rig_file import RigFile
from tracker.sources.camera_devices import CameraDevice
from tracker.sources.phidget_devices import PhidgetDevice
from tracker.sources.serial_devices import SerialDevice
from tracker.sources.source import SourceStatus


@dataclass(frozen=True, slots=True)
class Stream:
    """Measurements of one kind while a sensor was listened to."""

    count: int = 0
    rate_hz: float = 0.0
    """Between the first and the last."""
    longest_pause_s: float = 0.0
    delay_s: float = 0.0
    """From what was measured to its arrival, median."""


@dataclass(frozen=True, slots=True)
class PictureFacts:
    """The newest picture, and how large pictures are."""

    width_px: int
    height_px: int
    brightness: float
    """Mean gray, 0 to 255."""
    mean_bytes: float


@dataclass(frozen=True, slots=True)
class SensorFacts:
    """One sensor that was asked for, after it was listened to."""

    sensor: str
    """`gps`, `imu` or `camera`."""
    spec: str
    """As it was named on the command line."""
    status: SourceStatus | None = None
    """What its source said of itself, the last time it was attached; else at the end."""
    trouble: str | None = None
    """Why it cannot be used, is not there, or went away."""
    streams: dict[str, Stream] = field(default_factory=dict)
    """By the name of what is measured: `ImuSample`, `MagSample`, `GpsFix`, `GpsVelocity`, `Frame`."""
    valid_fixes: int = 0
    specific_force_m_s2: float | None = None
    """Mean length of what the accelerometer says."""
    picture: PictureFacts | None = None
    utc_offset_s: float | None = None
    """How far this machine's time of day is ahead of the receiver's."""


@dataclass(frozen=True, slots=True)
class FoundDevices:
    """What is plugged in, whether it was asked for or not."""

    phidgets: tuple[PhidgetDevice, ...] = ()
    phidgets_on_usb: int = 0
    """Whether anybody may open them or not."""
    phidget_trouble: str | None = None
    """Why the library cannot look."""
    serial_ports: tuple[SerialDevice, ...] = ()
    gpsd: str | None = None
    """What it says of its receivers; None where there is none on this machine."""
    cameras: tuple[CameraDevice, ...] = ()

    def has_phidget(self, word: str) -> bool:
        """Return whether there is a Phidget with a word in its name."""
        return any(word in device.name for device in self.phidgets)


@dataclass(frozen=True, slots=True)
class RigFileFacts:
    """The calibration."""

    path: Path
    was_named: bool
    """Whether somebody gave it on the command line."""
    rig_file: RigFile | None = None
    """None where it is not there or cannot be read."""
    trouble: str | None = None


@dataclass(frozen=True, slots=True)
class MachineFacts:
    """The machine that the rig is plugged into."""

    port: int
    port_trouble: str | None
    browser: str | None
    """The program that would open the page."""
    has_screen: bool
    wants_browser: bool
    pages_built: bool
    models_built: bool
    page_trouble: str | None
    """Why the server's own page did not come; None where it did."""
    folder: Path
    """Where recordings would go."""
    folder_trouble: str | None
    free_bytes: int
    records: bool
    """Whether a recording was asked for."""
