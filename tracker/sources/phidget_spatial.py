"""Phidget Spatial (1042, 1044, 1056 and their kin) as a source of inertial samples and of the magnetic field.

Measured on Phidget22 1.26 with USB reports of a 1042, a 1044 and a 1056: an interval of 256 ms after every attachment and 4 ms at
the least, stamps in milliseconds of the device that begin anew at every attachment, a magnetic field of 1e300 where there is
none (the 1056 every second while it calibrates itself, the 1044 at every other sample), no event but an error where a sensor is
saturated, and units of g, degrees per second and gauss.

Not measured, but told by those who have devices (ros-drivers/phidgets_drivers, issues 16, 193 and 196): lying level with its
components up, a Spatial says +1 g along z, and its axes, as gyroscope and magnetometer have them, are x forward, y right, z
down. So the specific force in these axes is minus what it says.
"""

from collections.abc import Callable, Iterator, Mapping
from math import radians
from time import monotonic_ns
from typing import Any, TypeAlias

import numpy as np
from Phidget22.Devices.Spatial import Spatial

from tracker.device_clock import DeviceClock
from tracker.measurements import ImuSample, MagSample, Matrix, Measurement, Vector3
from tracker.sources.phidget import ATTACH_S, PhidgetSource

#: The interval asked for: 250 samples a second.
INTERVAL_MS = 4
#: What a g is by definition, m/s².
_G_M_S2 = 9.80665
_GAUSS_T = 1e-4
_MS_NS = 1_000_000
#: The library's number for what it does not know is 1e300.
_UNKNOWN = 1e299
#: From the axes of a Spatial (x forward, y right, z down) to ours of an inertial unit (x forward, y left, z up).
R_IMU_PHIDGET: Matrix = np.diag([1.0, -1.0, -1.0])
_ROTATION = 1e-6

_Said: TypeAlias = tuple[int, float, list[float], list[float], list[float]]
"""When it was here, the device's stamp in ms, g, deg/s, gauss."""
_Rows: TypeAlias = tuple[Vector3, Vector3, Vector3]


class PhidgetSpatialSource(PhidgetSource[_Said]):
    """A `Source` of `ImuSample` and `MagSample` in body axes."""

    _KIND = "PhidgetSpatial"

    def __init__(
        self,
        serial: int | None = None,
        R_body_imu: Matrix | None = None,
        *,
        attach_s: float = ATTACH_S,
        clock_ns: Callable[[], int] = monotonic_ns,
    ) -> None:
        """Prepare; nothing is opened before `run`.

        Args:
            serial: Serial number of the device; None for any.
            R_body_imu: (3, 3) how it is mounted; None where its components are up and its x is forward.
            attach_s: How long it may take to attach at the start.
            clock_ns: The local clock.

        Raises:
            ValueError: `R_body_imu` is no rotation.
        """
        super().__init__("imu", serial, attach_s=attach_s, clock_ns=clock_ns)
        R_body_imu = np.eye(3) if R_body_imu is None else R_body_imu
        if R_body_imu.shape != (3, 3) or not np.allclose(R_body_imu @ R_body_imu.T, np.eye(3), atol=_ROTATION):
            raise ValueError("R_body_imu must be a (3, 3) rotation")
        R_body_phidget = R_body_imu @ R_IMU_PHIDGET
        self._gyro_rows = _rows(radians(1.0) * R_body_phidget)
        self._accel_rows = _rows(-_G_M_S2 * R_body_phidget)
        self._field_rows = _rows(_GAUSS_T * R_body_phidget)
        self._clock = DeviceClock()

    def _create(self) -> Spatial:
        channel = Spatial()
        channel.setOnSpatialDataHandler(self._guarded(self._on_data))
        return channel

    def _prepare(self, channel: Any) -> Mapping[str, object]:
        least_ms = channel.getMinDataInterval()
        channel.setDataInterval(max(INTERVAL_MS, least_ms))
        return {"interval_ms": channel.getDataInterval(), "least_interval_ms": least_ms}

    def _restart(self) -> None:
        self._clock.reset()

    def _on_data(
        self, _channel: Any, accel_g: list[float], gyro_deg_s: list[float], field_gauss: list[float], t_ms: float
    ) -> None:
        t_recv_ns = self._clock_ns()
        self._receive((t_recv_ns, t_ms, accel_g, gyro_deg_s, field_gauss), t_recv_ns)

    def _measure(self, said: _Said) -> Iterator[Measurement]:
        t_recv_ns, t_ms, accel_g, gyro_deg_s, field_gauss = said
        if not _known((t_ms,)):
            self._count("no_time")
            return
        t_ns = self._clock.local_ns(round(t_ms * _MS_NS), t_recv_ns)
        if _known(accel_g) and _known(gyro_deg_s):
            self._count("imu")
            gyro_rad_s, accel_m_s2 = _turned(self._gyro_rows, gyro_deg_s), _turned(self._accel_rows, accel_g)
            yield ImuSample(t_ns, t_recv_ns, gyro_rad_s, accel_m_s2)
        else:
            self._count("imu_gaps")
        if _known(field_gauss):
            self._count("mag")
            yield MagSample(t_ns, t_recv_ns, _turned(self._field_rows, field_gauss))
        else:
            self._count("mag_gaps")

    def _facts(self) -> Mapping[str, object]:
        return {
            "clock_offset_ns": self._clock.offset_ns,
            "clock_drift_ppm": round(self._clock.drift_ppm, 2),
            "clock_resets": self._clock.resets,
        }


def _rows(matrix: Matrix) -> _Rows:
    a, b, c = (tuple(float(value) for value in row) for row in matrix)
    return (a[0], a[1], a[2]), (b[0], b[1], b[2]), (c[0], c[1], c[2])


def _turned(rows: _Rows, values: list[float]) -> Vector3:
    x, y, z = values
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = rows
    return ax * x + ay * y + az * z, bx * x + by * y + bz * z, cx * x + cy * y + cz * z


def _known(values: list[float] | tuple[float, ...]) -> bool:
    """Whether the library knows all of these; NaN is not known either."""
    return all(-_UNKNOWN < value < _UNKNOWN for value in values)
