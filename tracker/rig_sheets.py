"""The tables of a rig file: what each calibration says, with its date, its device and how good it is.

Calibrations of the inertial unit and the magnetometer are in the unit's own axes (`imu`), so that they outlive a change of its
mount. Lengths are metres, angles radians; `T_body_x` maps x coordinates to body coordinates.
"""

import datetime
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args

from tracker.measurements import Vector3
from tracker.rig import CameraModel, DistortionModel
from tracker.sheet import Kind, Rows

METHODS = ("board", "pan")


@dataclass(frozen=True, kw_only=True)
class CameraSheet:
    """The camera's lens."""

    date: Annotated[datetime.date, Kind("when it was found")]
    device: Annotated[str, Kind("of the camera, as it names itself")] = ""
    serial: Annotated[str, Kind("of the camera, as it names itself")] = ""
    method: Annotated[
        Literal["board", "pan"], Kind("a printed board; a pan tells the focal length alone", words=METHODS)
    ]
    width_px: Annotated[int, Kind("of the pictures that it was found in", 1, 20_000)]
    height_px: Annotated[int, Kind("likewise", 1, 20_000)]
    fx_px: Annotated[float, Kind("focal length across", 1.0, 1e6)]
    fy_px: Annotated[float, Kind("focal length down", 1.0, 1e6)]
    cx_px: Annotated[float, Kind("where the optical axis is; 0 is the centre of the leftmost pixel", -1e5, 1e5)]
    cy_px: Annotated[float, Kind("likewise, downwards", -1e5, 1e5)]
    distortion_model: Annotated[DistortionModel, Kind("which formula", words=get_args(DistortionModel))]
    distortion: Annotated[tuple[float, ...], Kind("OpenCV's coefficients, in its order", -1e4, 1e4, (-1,))]
    rms_px: Annotated[float, Kind("quality: error of a corner seen again, root mean square", 0.0, 1e3)]
    focal_sigma_px: Annotated[float, Kind("quality: standard error of the focal length", 0.0, 1e6)]
    views: Annotated[int, Kind("quality: how many pictures it rests on", 0, 1_000_000)]
    coverage: Annotated[float, Kind("quality: share of the picture's area in which the board was seen", 0.0, 1.0)]

    @classmethod
    def of(cls, camera: CameraModel, **others: Any) -> "CameraSheet":
        """Return a sheet for a camera; `others` are the remaining fields."""
        return cls(
            width_px=camera.width_px,
            height_px=camera.height_px,
            fx_px=camera.fx_px,
            fy_px=camera.fy_px,
            cx_px=camera.cx_px,
            cy_px=camera.cy_px,
            distortion_model=camera.distortion_model,
            distortion=camera.distortion,
            **others,
        )

    @property
    def camera(self) -> CameraModel:
        """The lens as the tracker takes it."""
        return CameraModel(
            self.width_px,
            self.height_px,
            self.fx_px,
            self.fy_px,
            self.cx_px,
            self.cy_px,
            self.distortion_model,
            self.distortion,
        )


@dataclass(frozen=True, kw_only=True)
class CameraMountSheet:
    """How the camera sits on the rig, and how its clock runs beside the inertial unit's."""

    date: Annotated[datetime.date, Kind("when it was found")]
    device: Annotated[str, Kind("of the camera, as it names itself")] = ""
    serial: Annotated[str, Kind("of the camera, as it names itself")] = ""
    T_body_cam: Annotated[Rows, Kind("camera to body; its translation is measured by hand", -100.0, 100.0, (4, 4))]
    time_offset_s: Annotated[
        float, Kind("added to a picture's time: the inertial unit's time of the same moment", -2.0, 2.0)
    ]
    rotation_sigma_rad: Annotated[
        float, Kind("quality: standard error of the rotation, about its worst axis", 0.0, 10.0)
    ]
    time_sigma_s: Annotated[float, Kind("quality: standard error of the time offset", 0.0, 10.0)]
    residual_px: Annotated[
        float, Kind("quality: what of the pictures' turning the gyroscope does not explain, median", 0.0, 1e3)
    ]


@dataclass(frozen=True, kw_only=True)
class ImuMountSheet:
    """How the inertial unit sits on the rig: measured by hand."""

    T_body_imu: Annotated[Rows, Kind("inertial unit to body; its rotation counts", -100.0, 100.0, (4, 4))]


@dataclass(frozen=True, kw_only=True)
class GpsMountSheet:
    """Where the antenna sits on the rig: measured by hand."""

    T_body_gps: Annotated[Rows, Kind("antenna to body; its translation counts", -100.0, 100.0, (4, 4))]


@dataclass(frozen=True, kw_only=True)
class ImuSheet:
    """The inertial unit, from a rest. Axes are its own."""

    date: Annotated[datetime.date, Kind("when it was found")]
    device: Annotated[str, Kind("of the inertial unit, as it names itself")] = ""
    serial: Annotated[str, Kind("of the inertial unit, as it names itself")] = ""
    gyro_bias_rad_s: Annotated[Vector3, Kind("what the gyroscope says at rest: taken off", -0.5, 0.5, (3,))]
    accel_bias_m_s2: Annotated[Vector3, Kind("taken off; one rest cannot tell it: zero", -5.0, 5.0, (3,))]
    accel_scale: Annotated[
        Vector3, Kind("multiplied after that, so that a rest shows gravity's length", 0.8, 1.25, (3,))
    ]
    gyro_noise_rad_s_sqrt_hz: Annotated[Vector3, Kind("quality: white noise of the gyroscope", 0.0, 1.0, (3,))]
    accel_noise_m_s2_sqrt_hz: Annotated[Vector3, Kind("quality: white noise of the accelerometer", 0.0, 10.0, (3,))]
    gyro_bias_sigma_rad_s: Annotated[Vector3, Kind("quality: standard error of the gyroscope's bias", 0.0, 1.0, (3,))]
    duration_s: Annotated[float, Kind("quality: length of the rest", 0.0, 1e6)]
    attitudes: Annotated[
        int, Kind("quality: in how many attitudes it rested; six tell the accelerometer's bias", 1, 1000)
    ]


@dataclass(frozen=True, kw_only=True)
class MagSheet:
    """The magnetometer, from a turn through all directions. Axes are the inertial unit's."""

    date: Annotated[datetime.date, Kind("when it was found")]
    device: Annotated[str, Kind("of the magnetometer, as it names itself")] = ""
    serial: Annotated[str, Kind("of the magnetometer, as it names itself")] = ""
    hard_iron_t: Annotated[Vector3, Kind("field of the rig itself, tesla: taken off", -1e-2, 1e-2, (3,))]
    soft_iron: Annotated[Rows, Kind("multiplied after that: makes a sphere of the ellipsoid", -10.0, 10.0, (3, 3))]
    strength_t: Annotated[float, Kind("quality: field after that, mean", 1e-6, 1e-2)]
    residual: Annotated[float, Kind("quality: spread of the field's strength after that, as a share of it", 0.0, 1.0)]
    coverage: Annotated[float, Kind("quality: share of all directions that were seen", 0.0, 1.0)]
    place: Annotated[str, Kind("where: its field by the World Magnetic Model sets the scale")] = ""
