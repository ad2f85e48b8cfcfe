"""The serial ports that this machine has: file and name. Opens none."""

from dataclasses import dataclass

from serial.tools.list_ports import comports


@dataclass(frozen=True, slots=True)
class SerialDevice:
    """One port at which a receiver may be."""

    path: str
    name: str
    """What is plugged in, as it names itself; empty where it does not."""
    is_usb: bool
    """A port on the board is there whether something is plugged in or not."""


def serial_devices() -> tuple[SerialDevice, ...]:
    """Return the ports, by path."""
    ports = sorted(comports(), key=lambda port: port.device)
    names = ((p, p.product or p.description) for p in ports)
    return tuple(SerialDevice(p.device, "" if name in (None, "n/a") else name, p.vid is not None) for p, name in names)
