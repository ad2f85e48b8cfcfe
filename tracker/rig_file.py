"""The rig file: what `agora calibrate` has found out about one rig, as one TOML file that people can read."""

import os
import tomllib
from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from tracker.errors import InputError
from tracker.measurements import Frame, ImuSample, MagSample, Matrix, Measurement, Vector3
from tracker.rig import Rig
from tracker.rig_sheets import CameraMountSheet, CameraSheet, GpsMountSheet, ImuMountSheet, ImuSheet, MagSheet
from tracker.sheet import Rows, read_sheet, sheet_lines

DEFAULT_PLACE = Path("~/.config/agora/rig.toml")
_LARGEST_BYTES = 1_000_000
_REMEDY = "mend it by hand, or make it anew with `agora calibrate {}`"
#: How far a hand-written rotation may be from one; it is made one when it is read.
_SLOPPY_ROTATION = 2e-3
_EXACT_ROTATION = 1e-9

_SHEETS: dict[str, tuple[type[Any], str]] = {
    "camera": (CameraSheet, "camera"),
    "camera_mount": (CameraMountSheet, "rig"),
    "imu_mount": (ImuMountSheet, "imu"),
    "gps_mount": (GpsMountSheet, "imu"),
    "imu": (ImuSheet, "imu"),
    "mag": (MagSheet, "mag"),
}
"""Tables of the file: what each is read as, and the command that makes it."""


@dataclass(frozen=True)
class RigFile:
    """All that is known of a rig; None where nothing was calibrated, and then nothing is corrected."""

    camera: CameraSheet | None = None
    camera_mount: CameraMountSheet | None = None
    imu_mount: ImuMountSheet | None = None
    gps_mount: GpsMountSheet | None = None
    imu: ImuSheet | None = None
    mag: MagSheet | None = None

    def rig(self) -> Rig:
        """Return the extrinsics and the camera; what is not known is as on an uncalibrated rig."""
        rig = Rig()
        return Rig(
            rig.T_body_imu if self.imu_mount is None else np.array(self.imu_mount.T_body_imu),
            rig.T_body_gps if self.gps_mount is None else np.array(self.gps_mount.T_body_gps),
            rig.T_body_cam if self.camera_mount is None else np.array(self.camera_mount.T_body_cam),
            None if self.camera is None else self.camera.camera,
        )

    def correct(self, measurement: Measurement) -> Measurement:
        """Return a measurement as the calibration makes it; the very same where there is nothing to correct.

        Samples are in body axes, as sources give them. A picture's time goes over to the inertial unit's clock, but never past
        its arrival.
        """
        match measurement:
            case ImuSample() if self._imu_terms is not None:
                gyro_bias, accel_matrix, accel_bias = self._imu_terms
                gx, gy, gz = measurement.gyro_rad_s
                return replace(
                    measurement,
                    gyro_rad_s=(gx - gyro_bias[0], gy - gyro_bias[1], gz - gyro_bias[2]),
                    accel_m_s2=_affine(accel_matrix, measurement.accel_m_s2, accel_bias),
                )
            case MagSample() if self._mag_terms is not None:
                return replace(
                    measurement, field_body_t=_affine(self._mag_terms[0], measurement.field_body_t, self._mag_terms[1])
                )
            case Frame() if self._shift_ns:
                return replace(measurement, t_ns=min(measurement.t_ns + self._shift_ns, measurement.t_recv_ns))
            case _:
                return measurement

    @cached_property
    def _imu_terms(self) -> tuple[Vector3, Rows, Vector3] | None:
        """Gyroscope's bias, accelerometer's matrix and bias, all in body axes."""
        if self.imu is None:
            return None
        R = self._R_body_imu
        matrix = R @ np.diag(self.imu.accel_scale) @ R.T
        return _vector(R @ self.imu.gyro_bias_rad_s), _rows(matrix), _vector(R @ self.imu.accel_bias_m_s2)

    @cached_property
    def _mag_terms(self) -> tuple[Rows, Vector3] | None:
        if self.mag is None:
            return None
        R = self._R_body_imu
        return _rows(R @ np.array(self.mag.soft_iron) @ R.T), _vector(R @ self.mag.hard_iron_t)

    @cached_property
    def _shift_ns(self) -> int:
        return 0 if self.camera_mount is None else round(self.camera_mount.time_offset_s * 1e9)

    @property
    def _R_body_imu(self) -> Matrix:
        return self.rig().T_body_imu[:3, :3]


def _affine(matrix: Rows, v: Vector3, offset: Vector3) -> Vector3:
    """Return matrix @ (v - offset)."""
    x, y, z = v[0] - offset[0], v[1] - offset[1], v[2] - offset[2]
    (a, b, c), (d, e, f), (g, h, i) = matrix
    return (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z)


def _vector(values: Matrix) -> Vector3:
    x, y, z = values.tolist()
    return (x, y, z)


def _rows(matrix: Matrix) -> Rows:
    return tuple(tuple(row) for row in matrix.tolist())


# -- reading and writing ----------------------------------------------------------------------------------------------


def find_rig_file(path: Path | None) -> RigFile:
    """Return the rig file that was asked for, else the one in its usual place, else that of a rig of which nothing is known.

    Raises:
        InputError: As `read_rig_file`; also where the file that was asked for is not there.
    """
    place = DEFAULT_PLACE.expanduser() if path is None else path
    return RigFile() if path is None and not place.exists() else read_rig_file(place)


def read_rig_file(path: Path) -> RigFile:
    """Read a rig file.

    Raises:
        InputError: It cannot be read, is no TOML, or holds what no rig has; one sentence with file, key and remedy.
    """
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST_BYTES + 1)
    except OSError as error:
        raise InputError(
            f"The rig file {path} cannot be read ({error.strerror}): name another with --rig, or make one with `agora calibrate`."
        ) from error
    if len(data) > _LARGEST_BYTES:
        raise InputError(
            f"{path} is larger than {_LARGEST_BYTES // 1_000_000} MB, so it is no rig file: name another with --rig."
        )
    try:
        tables = tomllib.loads(data.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path} is no TOML ({error}): {_REMEDY.format('...')}.") from error
    for name in tables:
        if name not in _SHEETS:
            raise InputError(
                f"{path} has the unknown table {name!r}, expected {', '.join(_SHEETS)}: {_REMEDY.format('...')}."
            )
    return RigFile(**{name: _read(path, name, table) for name, table in tables.items()})


def _read(path: Path, name: str, table: object) -> Any:
    kind, command = _SHEETS[name]
    where, remedy = f"{path} [{name}]", _REMEDY.format(command)
    sheet = read_sheet(kind, table, where, remedy)
    for field in fields(sheet):
        if field.name.startswith("T_"):
            sheet = replace(sheet, **{field.name: _rigid(getattr(sheet, field.name), f"{where} {field.name}", remedy)})
    if name == "mag" and np.linalg.det(np.array(sheet.soft_iron)) <= 1e-6:
        raise InputError(f"{where} soft_iron turns space inside out or flat: {remedy}.")
    return sheet


def _rigid(rows: Rows, where: str, remedy: str) -> Rows:
    """Return a rigid transform; a rotation that was typed with few digits becomes the nearest one."""
    T = np.array(rows)
    R = T[:3, :3]
    off = float(np.abs(R @ R.T - np.eye(3)).max())
    if off > _SLOPPY_ROTATION or np.linalg.det(R) < 0.0 or rows[3] != (0.0, 0.0, 0.0, 1.0):
        raise InputError(f"{where} is no rotation and translation (its last row is 0, 0, 0, 1): {remedy}.")
    if off <= _EXACT_ROTATION:
        return rows
    u, _, vt = np.linalg.svd(R)
    T[:3, :3] = u @ vt
    return _rows(T)


def write_rig_file(path: Path, rig_file: RigFile) -> None:
    """Write a rig file in one go: whoever reads meanwhile finds the old or the new one. Folders are made.

    Raises:
        InputError: The place cannot be written to.
    """
    lines = [
        "# What is known of this rig. `agora calibrate camera|rig|imu|mag` writes a table each and keeps the others."
    ]
    for name in _SHEETS:
        sheet = getattr(rig_file, name)
        if sheet is not None:
            lines += ["", *sheet_lines(name, sheet)]
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            with part.open("w", encoding="utf-8") as file:
                file.write("\n".join(lines) + "\n")
                file.flush()
                os.fsync(file.fileno())  # else a power cut may leave the new name on an empty file
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(
            f"The rig file {path} cannot be written ({error.strerror}): name another place with --rig."
        ) from error
