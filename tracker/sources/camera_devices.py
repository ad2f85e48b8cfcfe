"""The cameras that Linux knows: number, name, serial number. Reads /sys, opens no camera."""

from dataclasses import dataclass
from pathlib import Path

_SYSFS = Path("/sys/class/video4linux")


@dataclass(frozen=True, slots=True)
class CameraDevice:
    """One `/dev/videoN` that gives pictures."""

    number: int
    name: str
    serial: str
    """Empty where it has none."""

    @property
    def path(self) -> str:
        """The device's file."""
        return f"/dev/video{self.number}"


def camera_devices(sysfs: Path = _SYSFS) -> tuple[CameraDevice, ...]:
    """Return the cameras, by number. A webcam's second node, which carries its metadata, is left out."""
    if not sysfs.is_dir():
        return ()
    numbers = sorted(int(node.name[5:]) for node in sysfs.glob("video*") if node.name[5:].isdecimal())
    return tuple(device for number in numbers if (device := camera_device(number, sysfs)) is not None)


def camera_device(number: int, sysfs: Path = _SYSFS) -> CameraDevice | None:
    """Return one camera, or None where there is none of that number or it gives no pictures."""
    node = sysfs / f"video{number}"
    name, index = _line(node / "name"), _line(node / "index")
    if not name or index not in ("", "0"):
        return None
    # the USB interface is `device`, the device with its serial number the folder above it
    return CameraDevice(number, name, _line((node / "device").resolve().parent / "serial"))


def _line(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""
