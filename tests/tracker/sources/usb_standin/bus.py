"""Devices on a USB bus that is not there: the real Phidget22 library sees them, attaches them and reads their reports.

`Bus` loads the stand-in for libusb (`libusb.c`) and must do so before the first call of Phidget22 in this process. Layouts of
reports were read in the public source of libphidget22 and agree with what the library then says (`test_phidget.py`).
"""

import ctypes
import struct
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import TypeAlias

Vector3: TypeAlias = tuple[float, float, float]

SOURCE = Path(__file__).with_name("libusb.c")
_FLAGS = ("-shared", "-fPIC", "-O2", "-Wall", "-Wextra", "-Werror", "-Wl,-soname,libusb-1.0.so.0")

#: The product number and version of a device, as in its USB descriptor.
GPS_1040 = (0x79, 0x0101)
SPATIAL_1042 = (0x33, 0x0300)
SPATIAL_1044 = (0x33, 0x0400)
SPATIAL_1056 = (0x33, 0x0100)

_COUNTS_PER_G = 1024.0
_COUNTS_PER_DEG_S = 1.0 / 0.07
_COUNTS_PER_GAUSS = 330.0
#: Acceleration and rate are those of the sensors with the wide range, the magnetic field is there: for two samples.
_DIGITAL, _MAGNETIC = 0x0F, 0x30
#: What a report of 64 bytes can carry after its length.
_NMEA_BYTES = 63


def build(folder: Path) -> Path:
    """Compile the stand-in with gcc and return the library; FileNotFoundError where there is no gcc."""
    library = folder / "libusb-1.0.so.0"
    subprocess.run(["gcc", *_FLAGS, "-o", library, SOURCE, "-lpthread"], check=True, capture_output=True, timeout=60)
    return library


class Bus:
    """The bus; devices are numbers on it, and what is pushed to one that is not plugged in is lost, as on a real one."""

    def __init__(self, library: Path) -> None:
        # Global, so that libphidget22, which asks for a library of this SONAME, is given this one.
        self._library = ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
        self._devices: list[int] = []

    def add(self, kind: tuple[int, int], serial: int) -> int:
        """Add a device, plugged in, and return its number."""
        number = int(self._library.standin_add(*kind, str(serial).encode()))
        if number < 0:
            raise ValueError("the stand-in has no room for more devices")
        if kind == SPATIAL_1056:
            self.answer(number, CALIBRATION_1056_ASKED, calibration_1056())
        self.plug(number, True)
        self._devices.append(number)
        return number

    def close(self) -> None:
        """Pull out all devices that were added here."""
        for number in self._devices:
            self.plug(number, False)

    def plug(self, number: int, plugged: bool) -> None:
        """Plug a device in, as anew, or pull it out."""
        self._library.standin_plug(number, int(plugged))

    def push(self, number: int, report: bytes) -> bool:
        """Queue a report; False where the device is not plugged in, or the library does not fetch its reports."""
        return bool(self._library.standin_push(number, report, len(report)))

    def waiting(self, number: int) -> int:
        """Return how many reports the library has not fetched."""
        return int(self._library.standin_waiting(number))

    def listened_to(self, number: int) -> bool:
        """Return whether the library has opened a device and waits for its reports."""
        return bool(self._library.standin_listened_to(number))

    def answer(self, number: int, first_byte: int, report: bytes) -> None:
        """Let a device answer each report to it that begins with `first_byte`."""
        self._library.standin_answer(number, first_byte, report, len(report))


def nmea(body: str) -> bytes:
    """Return a sentence with its checksum and end of line; `body` is what stands between `$` and `*`."""
    checksum = 0
    for character in body.encode("ascii"):
        checksum ^= character
    return f"${body}*{checksum:02X}\r\n".encode("ascii")


def nmea_reports(sentences: bytes) -> list[bytes]:
    """Return the reports in which a GPS 1040 sends these bytes: a length, then as many of them."""
    parts = [sentences[i : i + _NMEA_BYTES] for i in range(0, len(sentences), _NMEA_BYTES)]
    return [bytes([len(part)]) + part for part in parts]


def spatial_report(
    t_ms: int, accel_g: Vector3, gyro_deg_s: Vector3, field_gauss: Vector3 | None, kind: tuple[int, int] = SPATIAL_1042
) -> bytes:
    """Return the report of one sample of a 1042, 1044 or 1056, in the device's own axes and signs.

    Args:
        t_ms: The device's clock, of which the report carries 16 bits.
        accel_g: As the library says it; the wide range has 1/1024 g a step.
        gyro_deg_s: As the library says it, 0.07 deg/s a step.
        field_gauss: None where the magnetometer has nothing to say, which the library shows as 1e300.
        kind: Which device.
    """
    if kind == SPATIAL_1056:
        return _report_1056(t_ms, accel_g, gyro_deg_s, field_gauss)
    values = [round(value * _COUNTS_PER_G) for value in accel_g]
    values += [round(value * _COUNTS_PER_DEG_S) for value in gyro_deg_s]
    values += [round(value * _COUNTS_PER_GAUSS) for value in field_gauss or (0.0, 0.0, 0.0)]
    flags = _DIGITAL | (_MAGNETIC if field_gauss is not None else 0)
    return struct.pack(">BBH9h", 1, flags, t_ms & 0xFFFF, *(max(-32768, min(value, 32767)) for value in values))


#: A 1056 says raw voltages: counts of 1/19859 V, and the calibration to read them with, when it is asked (report 0x01).
CALIBRATION_1056_ASKED = 0x01
_MIDDLE, _GYRO_MIDDLE = 0x7FFF, 24427
_COUNTS_PER_G_1056, _COUNTS_PER_DEG_S_1056, _COUNTS_PER_GAUSS_1056 = 4369.0, 49.6477, 4964


def calibration_1056() -> bytes:
    """Return the calibration of a 1056 without faults: gains of 1, offsets and cross-talk of 0."""
    axis = bytes([0x80, 0x08, 0x00, 0x80, 0x00, 0x80, 0x80])  # two gains of 12 bits about 0.8, an offset, two factors
    gyro_axis = bytes([0x80, 0x08, 0x00, 0x00, 0x00, 0x80, 0x80])
    compass_axis = struct.pack(">hH", 0, _COUNTS_PER_GAUSS_1056)
    return bytes([0x80]) + 3 * axis + 3 * gyro_axis + bytes(6) + 3 * compass_axis


def _report_1056(t_ms: int, accel_g: Vector3, gyro_deg_s: Vector3, field_gauss: Vector3 | None) -> bytes:
    """The raw axes of its chips: y of the accelerometer, x and z of the gyroscope and the compass are mirrored."""
    accel = [_MIDDLE + sign * value * _COUNTS_PER_G_1056 for sign, value in zip((1, -1, 1), accel_g, strict=True)]
    gyro = [
        _GYRO_MIDDLE + sign * value * _COUNTS_PER_DEG_S_1056
        for sign, value in zip((-1, 1, -1), gyro_deg_s, strict=True)
    ]
    field = [_MIDDLE - value * _COUNTS_PER_GAUSS_1056 for value in field_gauss or (0.0, 0.0, 0.0)]
    flags = 9 | (0x80 if field_gauss is not None else 0)
    return struct.pack(">BBH9H", 0, flags, t_ms & 0xFFFF, *_rounded([*accel, *gyro, *field]))


def _rounded(values: Sequence[float]) -> list[int]:
    return [max(0, min(round(value), 0xFFFF)) for value in values]
