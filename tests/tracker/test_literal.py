"""The paper's equations to the letter, and by how much they break."""

from dataclasses import replace
from math import hypot, radians

import numpy as np
import pytest

from tracker.calibration import MeanSample
from tracker.geodesy import SiteFrame
from tracker.literal import FourSampleIntegral, m_P_ecef, m_P_enu
from tracker.measurements import GpsFix, Matrix, Measurement, Vector3, VisualMotion
from tracker.readings import InertialReading, PositionReading, SensorSettings
from tracker.sensor_pose import SensorPose
from tracker.simulate import AGORA_ORIGIN, Walk, WalkSettings, default_rig, simulate
from tracker.transformation import tr_from_euler

SITE = SiteFrame(AGORA_ORIGIN)
FIX_M = (30.0, -20.0, 1.5)
NOTHING = (0.0, 0.0, 0.0)


def _off_m(found: Vector3, wanted: Vector3) -> float:
    return hypot(*(a - b for a, b in zip(found, wanted, strict=True)))


def test_a_camera_that_has_not_moved_leaves_the_fix() -> None:
    assert m_P_enu(np.eye(4), FIX_M, (0.1, 0.2, 0.3)) == pytest.approx((30.1, -19.8, 1.8))
    assert m_P_ecef(np.eye(4), FIX_M, NOTHING, SITE) == pytest.approx(FIX_M, abs=1e-6)


def test_a_step_is_taken_in_the_axes_it_is_written_in() -> None:
    Tr = tr_from_euler(0.0, 0.0, 0.0, (1.0, 2.0, 3.0))
    assert m_P_enu(Tr, FIX_M, NOTHING) == pytest.approx((31.0, -18.0, 4.5))
    assert _off_m(m_P_ecef(Tr, FIX_M, NOTHING, SITE), FIX_M) == pytest.approx(hypot(1.0, 2.0, 3.0), abs=1e-6)


def test_a_tenth_of_a_degree_is_eleven_kilometres() -> None:
    """About the Earth's centre; about the site's origin, 36 m away, it is six centimetres."""
    Tr = tr_from_euler(0.0, radians(0.1), 0.0, NOTHING)
    assert 8_000.0 < _off_m(m_P_ecef(Tr, FIX_M, NOTHING, SITE), FIX_M) < 11_200.0
    assert _off_m(m_P_enu(Tr, FIX_M, NOTHING), FIX_M) == pytest.approx(radians(0.1) * hypot(30.0, 1.5), rel=0.01)


def test_four_samples_integrate_to_micrometres() -> None:
    """1 m/s2 over 16 ms is 128 micrometres; what was there at rest, gravity too, is subtracted."""
    integral, rest = FourSampleIntegral(), (0.1, 0.2, 9.8)
    for index in range(100):
        integral.step(MeanSample(index, 0.016, NOTHING, rest), calibrating=True)
    assert integral.offset_m_s2 == pytest.approx(rest)
    assert hypot(*integral.m_imu_m) < 1e-12
    integral.step(MeanSample(101, 0.016, NOTHING, (1.1, 0.2, 9.8)), calibrating=False)
    assert integral.m_imu_m == pytest.approx((128e-6, 0.0, 0.0))


def _cycles(settings: SensorSettings, measurements: list[Measurement]) -> tuple[Matrix, Matrix]:
    """Return stamps in seconds and m_P, from the time on when a camera tells of motions."""
    sensors, found = SensorPose(settings, AGORA_ORIGIN, default_rig(), 0.1, uses_camera=True), []
    for measurement in measurements:
        sensors.step(measurement)
        cycle = sensors.take()
        if cycle is not None:
            found.append((cycle.t_ns * 1e-9, *cycle.m_P))
    rows = np.array(found)
    return rows[:, 0], rows[:, 1:]


@pytest.fixture(scope="module")
def walk() -> list[Measurement]:
    """A walk with a camera that turns by a degree a picture and shows no parallax."""
    measurements = list(simulate(Walk(WalkSettings(seed=6, duration_s=24.0), default_rig())))
    start_ns = measurements[0].t_ns
    R = tr_from_euler(0.0, radians(1.0), 0.0, NOTHING)[:3, :3]
    motions: list[Measurement] = [
        VisualMotion(t, t + 1, index, t - 250_000_000, R, NOTHING, 100, 0.0, is_keyframe=False)
        for index, t in enumerate(range(start_ns + 15_000_000_000, start_ns + 23_000_000_000, 250_000_000))
    ]
    return sorted([*measurements, *motions], key=lambda m: m.t_recv_ns)


@pytest.mark.parametrize(
    ("m_P", "m_imu", "at_least_m", "at_most_m"),
    [
        ("keyframe_local", "sane", 0.0, 12.0),
        ("keyframe_local", "literal", 0.0, 12.0),
        ("literal_enu", "sane", 0.0, 12.0),
        ("literal_ecef", "sane", 80_000.0, 120_000.0),
        ("literal_ecef", "literal", 80_000.0, 120_000.0),
    ],
)
def test_readings_go_astray_as_far_as_they_must(
    walk: list[Measurement], m_P: PositionReading, m_imu: InertialReading, at_least_m: float, at_most_m: float
) -> None:
    """The largest distance of m_P from the fixes' path: a degree about the Earth's centre is about a hundred kilometres."""
    _, positions_m = _cycles(replace(SensorSettings(), m_P=m_P, m_imu=m_imu), walk)
    fixes_m = np.array(
        [SITE.site_from_geodetic(f.lat_deg, f.lon_deg, f.h_ellipsoid_m) for f in walk if isinstance(f, GpsFix)]
    )
    off_m = np.linalg.norm(positions_m[:, None, :] - fixes_m[None, :, :], axis=2).min(axis=1).max()
    assert at_least_m <= off_m <= at_most_m


def test_the_literal_imu_holds_the_fix_between_two(walk: list[Measurement]) -> None:
    """Micrometres: m_P stays where the last fix was. The sane reading moves on with the walker."""
    before: list[Measurement] = [m for m in walk if not isinstance(m, VisualMotion)]
    _, literal = _cycles(replace(SensorSettings(), m_imu="literal"), before)
    _, sane = _cycles(SensorSettings(), before)
    steps_literal, steps_sane = (np.linalg.norm(np.diff(p, axis=0), axis=1) for p in (literal, sane))
    assert np.count_nonzero(steps_literal < 0.001) > 0.7 * len(steps_literal)
    assert np.count_nonzero(steps_sane < 0.001) < 0.4 * len(steps_sane)
