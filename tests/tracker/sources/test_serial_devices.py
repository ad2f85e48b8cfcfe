"""The serial ports of a machine, as pyserial lists them."""

from dataclasses import dataclass

import pytest

from tracker.sources import serial_devices as module
from tracker.sources.serial_devices import SerialDevice, serial_devices


@dataclass
class Port:
    """What pyserial says of a port."""

    device: str
    product: str | None = None
    description: str | None = "n/a"
    vid: int | None = None


def test_ports_come_by_path_with_the_names_of_what_is_plugged_in(monkeypatch: pytest.MonkeyPatch) -> None:
    ports = [
        Port("/dev/ttyUSB0", "u-blox 7", "u-blox 7 - GPS", 0x1546),
        Port("/dev/ttyACM1", None, "modem", 7),
        Port("/dev/ttyS0"),
    ]
    monkeypatch.setattr(module, "comports", lambda: ports)
    assert serial_devices() == (
        SerialDevice("/dev/ttyACM1", "modem", True),
        SerialDevice("/dev/ttyS0", "", False),
        SerialDevice("/dev/ttyUSB0", "u-blox 7", True),
    )
