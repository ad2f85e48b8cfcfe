"""The Phidgets that are plugged in: as the library sees them, and as the USB does. Opens no channel."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from time import sleep
from typing import Any

from Phidget22.Devices.Manager import Manager
from Phidget22.PhidgetException import PhidgetException

from tracker.errors import InputError
from tracker.sources.phidget_library import load_libusb

_USB = Path("/sys/bus/usb/devices")
#: Phidgets Inc.
_VENDOR = "06c2"
#: The library looks at the bus several times a second.
_LOOK_S = 1.0


@dataclass(frozen=True, slots=True)
class PhidgetDevice:
    """One device."""

    name: str
    serial: int


def phidget_devices(look_s: float = _LOOK_S, *, wait: Callable[[float], None] = sleep) -> tuple[PhidgetDevice, ...]:
    """Return the devices that the library may open, by serial number; takes `look_s`.

    Raises:
        InputError: The library cannot be loaded on this machine.
    """
    libusb = load_libusb()
    found: dict[int, str] = {}
    lock = Lock()

    def attached(_manager: Any, channel: Any) -> None:
        """Note the device of a channel: each has several."""
        with lock, suppress(PhidgetException):
            found[channel.getDeviceSerialNumber()] = channel.getDeviceName()

    try:
        manager = Manager()
        manager.setOnAttachHandler(attached)
        manager.open()
    except OSError as error:
        raise InputError(f"The Phidget22 library cannot be loaded here (libusb from {libusb}): {error}") from error
    except PhidgetException as error:
        raise InputError(f"The Phidget22 library does not start: {error.description}") from error
    try:
        wait(look_s)
    finally:
        with suppress(PhidgetException):
            manager.close()
    with lock:
        return tuple(PhidgetDevice(name, serial) for serial, name in sorted(found.items()))


def phidgets_on_usb(usb: Path = _USB) -> int:
    """Return how many Phidgets are on the USB, whether anybody may open them or not. Reads /sys."""
    return sum(1 for file in usb.glob("*/idVendor") if _line(file) == _VENDOR)


def _line(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii", errors="replace").strip()
    except OSError:
        return ""
