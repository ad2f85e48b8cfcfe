"""Stamps that rise and numbers that are numbers: what a log's reader and a live rig ask of every measurement before all else."""

from math import isfinite

import numpy as np

from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Measurement,
    Retraction,
    Sighting,
    Standpoint,
    TruePose,
    VisualMotion,
)

#: A stamp may lie this much later than its message's arrival: two clocks, not a jump.
_CLOCK_TOLERANCE_NS = 1_000_000_000


class Soundness:
    """The last stamp of each kind. Measurements come in order of arrival; those of one kind are of one sensor."""

    def __init__(self) -> None:
        self._last_ns: dict[type, int] = {}
        self._lateness_ns: dict[type, int] = {}

    def fault(self, measurement: Measurement) -> str | None:
        """Return in a word why a measurement is to be left out; None where it is sound, and its stamp is then the last."""
        fault = self._fault(measurement)
        if fault is None:
            self._last_ns[type(measurement)] = measurement.t_ns
        return fault

    def _fault(self, measurement: Measurement) -> str | None:
        if not _is_finite(measurement):
            return "not_finite"
        kind, late_ns = type(measurement), measurement.t_ns - measurement.t_recv_ns
        usual_ns = self._lateness_ns.setdefault(kind, max(0, late_ns))
        if late_ns > usual_ns + _CLOCK_TOLERANCE_NS:
            return "stamp_after_arrival"
        if isinstance(measurement, Sighting | Standpoint | Retraction):
            return None  # people point at one picture twice, and at an older one after a newer
        last_ns = self._last_ns.get(kind)
        if last_ns is not None and measurement.t_ns <= last_ns:
            return "duplicate_stamp" if measurement.t_ns == last_ns else "stamp_went_back"
        return None


def _is_finite(measurement: Measurement) -> bool:
    match measurement:
        case ImuSample():
            return all(map(isfinite, (*measurement.gyro_rad_s, *measurement.accel_m_s2)))
        case MagSample():
            return all(map(isfinite, measurement.field_body_t))
        case GpsVelocity():
            return all(map(isfinite, measurement.v_enu_m_s))
        case CompassHeading():
            return isfinite(measurement.yaw_rad)
        case GpsFix():
            place = (measurement.lat_deg, measurement.lon_deg, measurement.h_ellipsoid_m)
            return not measurement.valid or all(map(isfinite, place))
        case TruePose():
            return all(map(isfinite, (*measurement.p_map_body_m, *measurement.wxyz_map_body)))
        case VisualMotion():
            tracks = measurement.tracks
            rays = () if tracks is None else (tracks.rays,)
            arrays = (measurement.R_key_cam, measurement.direction_key, measurement.parallax_px, *rays)
            return all(bool(np.all(np.isfinite(array))) for array in arrays)
        case Sighting():
            return all(map(isfinite, (*measurement.point_site_m, *measurement.ray_cam, measurement.sigma_rad)))
        case Standpoint():
            return all(map(isfinite, (*measurement.p_site_m, measurement.sigma_m)))
        case _:
            return True
