"""Measurements that no sensor should send, each with what is to be made of it; helpers of the tests beside this file."""

from dataclasses import replace
from math import inf, nan

import numpy as np

from tracker.measurements import (
    CompassHeading,
    GpsFix,
    GpsVelocity,
    ImuSample,
    MagSample,
    Measurement,
    Outcome,
    Sighting,
    Standpoint,
    VisualMotion,
    VisualTracks,
)

S = 1_000_000_000
ZERO = (0.0, 0.0, 0.0)
NOT_FINITE, GATE, WEAK = Outcome.REJECTED_NOT_FINITE, Outcome.REJECTED_GATE, Outcome.REJECTED_WEAK
Case = tuple[Measurement, Outcome]


def sane(t_ns: int) -> dict[str, Measurement]:
    """Return a measurement of every kind that nothing is wrong with."""
    cov = (4.0, 0.1, 0.0, 0.1, 4.0, 0.0, 0.0, 0.0, 9.0)
    return {
        "imu": ImuSample(t_ns, t_ns, (0.01, 0.02, 0.03), (0.1, 0.2, 9.8)),
        "fix": GpsFix(t_ns, t_ns, 37.9366, 27.3447, 88.0, cov),
        "velocity": GpsVelocity(t_ns, t_ns, (0.5, 0.5, 0.0)),
        "field": MagSample(t_ns, t_ns, (2e-5, 1e-5, -3e-5)),
        "compass": CompassHeading(t_ns, t_ns, 0.3),
        "vision": VisualMotion(t_ns, t_ns, 9, t_ns - S // 4, np.eye(3), (0.0, 0.6, 0.8), 80, 9.0, True, features()),
        "sighting": Sighting(t_ns, t_ns, (10.0, 5.0, 2.0), (0.0, 0.0, 1.0), 0.01),
        "standpoint": Standpoint(t_ns, t_ns, (1.0, 2.0, 1.65), 0.2),
    }


def features(count: int = 20) -> VisualTracks:
    """Return features that nothing is wrong with."""
    rays = np.linspace(-0.5, 0.5, 4 * count, dtype=np.float32).reshape(count, 4)
    return VisualTracks(np.arange(count), rays)


def refused(t_ns: int) -> list[Case]:
    """Return what is to be refused whatever the state, with the outcome."""
    good = sane(t_ns)
    cases = [(replace(one, t_ns=t), GATE) for one in good.values() for t in (t_ns + 3 * S, 10**25, 10**400)]
    return [
        *cases,
        *_of_inertial(good["imu"]),  # type: ignore[arg-type]
        *_of_receiver(good["fix"], good["velocity"]),  # type: ignore[arg-type]
        *_of_compass(good["field"], good["compass"]),  # type: ignore[arg-type]
        *_of_vision(good["vision"]),  # type: ignore[arg-type]
        *_of_people(good["sighting"], good["standpoint"]),  # type: ignore[arg-type]
    ]


def out_of_place(last: Measurement) -> list[Case]:
    """Return what is to be refused because of what came before, `last` the last of it: repeated, out of time, out of reach."""
    t_ns, stale = last.t_recv_ns, Outcome.REJECTED_STALE
    good, old = sane(t_ns), sane(-(10**30))
    fix = good["fix"]
    assert isinstance(fix, GpsFix)
    return [
        (last, stale),
        *((one, stale) for one in old.values()),
        (ImuSample(t_ns + 3600 * S, t_ns + 3600 * S, ZERO, ZERO), GATE),
        (GpsVelocity(10**30, 10**30, ZERO), GATE),
        (replace(fix, lat_deg=fix.lat_deg + 0.05), GATE),
        (replace(fix, lat_deg=-fix.lat_deg, t_ns=t_ns + 1), GATE),
        (replace(fix, lat_deg=0.0, lon_deg=0.0, t_ns=t_ns + 2), GATE),
        (Standpoint(t_ns, t_ns, (1e5, 0.0, 0.0), 0.1), GATE),
    ]


def _of_inertial(imu: ImuSample) -> list[Case]:
    return [
        (replace(imu, gyro_rad_s=(nan, 0.0, 0.0)), NOT_FINITE),
        (replace(imu, gyro_rad_s=(0.0, -inf, nan)), NOT_FINITE),
        (replace(imu, accel_m_s2=(0.0, 0.0, inf)), NOT_FINITE),
        (replace(imu, gyro_rad_s=(0.0, 1e6, 0.0)), GATE),
        (replace(imu, accel_m_s2=(1e308, 1e308, 0.0)), GATE),
    ]


def _of_receiver(fix: GpsFix, velocity: GpsVelocity) -> list[Case]:
    def cov(*diagonal: float, north_east: float = 0.0, east_north: float = 0.0) -> GpsFix:
        east, north, up = diagonal
        return replace(fix, cov_enu_m2=(east, east_north, 0.0, north_east, north, 0.0, 0.0, 0.0, up))

    return [
        (replace(fix, valid=False), WEAK),
        (replace(fix, lat_deg=nan), NOT_FINITE),
        (replace(fix, h_ellipsoid_m=-inf), NOT_FINITE),
        (replace(fix, lat_deg=500.0), GATE),
        (replace(fix, lon_deg=1e30), GATE),
        (replace(fix, h_ellipsoid_m=1e30), GATE),
        (cov(nan, 4.0, 9.0), NOT_FINITE),
        (cov(4.0, 4.0, inf), NOT_FINITE),
        (cov(-4.0, 4.0, 9.0), GATE),
        (cov(4.0, 0.0, 9.0), GATE),
        (cov(4.0, 4.0, 9.0, north_east=3.0), GATE),
        (cov(4.0, 4.0, 9.0, north_east=5.0, east_north=5.0), GATE),
        (cov(4.0, 1e30, 9.0), WEAK),
        (replace(fix, cov_enu_m2=(4.0, 4.0, 9.0)), GATE),
        (replace(velocity, v_enu_m_s=(0.0, nan, 0.0)), NOT_FINITE),
        (replace(velocity, v_enu_m_s=(1e30, 0.0, 0.0)), GATE),
    ]


def _of_compass(field: MagSample, compass: CompassHeading) -> list[Case]:
    return [
        (replace(field, field_body_t=ZERO), GATE),
        (replace(field, field_body_t=(1e-200, 0.0, 1e-200)), GATE),
        (replace(field, field_body_t=(1e30, 0.0, 0.0)), GATE),
        (replace(field, field_body_t=(nan, 0.0, 0.0)), NOT_FINITE),
        (replace(compass, yaw_rad=inf), NOT_FINITE),
        (replace(compass, yaw_rad=1e30), GATE),
    ]


def _no_features() -> list[VisualTracks]:
    """Return too many, the same one twice, rays of others, one that is not finite, and one behind the camera."""
    good, behind = features(), features()
    behind.xy[3, 0] = 1e30
    broken = features()
    broken.xy_key[0, 1] = nan
    twice = replace(good, ids=np.zeros(len(good.ids), np.int64))
    return [
        features(2000),
        twice,
        replace(good, ids=good.ids[1:]),
        replace(good, rays=good.rays[:, :3]),
        broken,
        behind,
    ]


def _of_vision(vision: VisualMotion) -> list[Case]:
    mirror = np.diag([1.0, 1.0, -1.0])
    return [
        (replace(vision, R_key_cam=np.full((3, 3), nan)), NOT_FINITE),
        (replace(vision, R_key_cam=1e300 * np.eye(3)), GATE),
        (replace(vision, R_key_cam=1.1 * np.eye(3)), GATE),
        (replace(vision, R_key_cam=mirror), GATE),
        (replace(vision, R_key_cam=np.zeros((3, 3))), GATE),
        (replace(vision, R_key_cam=np.eye(2)), GATE),
        (replace(vision, direction_key=(0.0, 0.0, 2.0)), GATE),
        (replace(vision, direction_key=(nan, 0.0, 1.0)), NOT_FINITE),
        (replace(vision, parallax_px=nan), NOT_FINITE),
        (replace(vision, parallax_px=-1.0), GATE),
        (replace(vision, t_key_ns=vision.t_ns), GATE),
        *((replace(vision, tracks=tracks), GATE) for tracks in _no_features()),
        (replace(vision, t_key_ns=10**400), GATE),
    ]


def _of_people(sighting: Sighting, standpoint: Standpoint) -> list[Case]:
    return [
        (replace(sighting, ray_cam=ZERO), GATE),
        (replace(sighting, ray_cam=(2.0, 0.0, 0.0)), GATE),
        (replace(sighting, ray_cam=(nan, 0.0, 0.0)), NOT_FINITE),
        (replace(sighting, point_site_m=(1e300, 1e300, 0.0)), GATE),
        (replace(sighting, sigma_rad=0.0), GATE),
        (replace(sighting, sigma_rad=-0.01), GATE),
        (replace(sighting, sigma_rad=1e300), GATE),
        (replace(sighting, sigma_rad=nan), NOT_FINITE),
        (replace(standpoint, p_site_m=(0.0, inf, 0.0)), NOT_FINITE),
        (replace(standpoint, p_site_m=(1e30, 0.0, 0.0)), GATE),
        (replace(standpoint, sigma_m=0.0), GATE),
        (replace(standpoint, sigma_m=1e-200), GATE),
        (replace(standpoint, sigma_m=1e200), GATE),
    ]
