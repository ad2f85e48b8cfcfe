"""North from a receiver's motion, with a path that feels what it sees."""

from math import cos, pi, sin

import pytest

from tracker.calibration import MeanSample
from tracker.course import CourseOverGround
from tracker.geometry import wrap_rad, wxyz_from_yaw
from tracker.heading import StartHeading
from tracker.inertial import InertialPath
from tracker.measurements import GpsVelocity

G, S = 9.81, 1_000_000_000


def _second(path: InertialPath, second: int, accel_level: tuple[float, float], level_yaw: float) -> None:
    """Feel a constant force for a second, as a body that is turned in the level frame does."""
    ax, ay = accel_level
    c, s = cos(level_yaw), sin(level_yaw)
    for index in range(1, 51):
        mean = MeanSample(second * S + index * S // 50, 0.02, (0.0,) * 3, (c * ax + s * ay, c * ay - s * ax, G))
        path.step(mean, wxyz_from_yaw(level_yaw), None)


def test_velocities_find_north_for_a_rig_that_looks_aside() -> None:
    """A walker whose rig looks 100 degrees off the path and keeps turning: the gains know."""
    path, heading, course = InertialPath(G), StartHeading(0.0), CourseOverGround()
    north, v = 1.1, (0.0, 0.0)
    for second in range(60):
        site = (1.5 * cos(2.0 * second), 1.5 * sin(2.0 * second))
        level = (site[0] * cos(north) + site[1] * sin(north), site[1] * cos(north) - site[0] * sin(north))
        _second(path, second, level, level_yaw=0.3 * second)
        v = (v[0] + site[0], v[1] + site[1])
        t_ns = (second + 1) * S
        course.velocity(GpsVelocity(t_ns, t_ns, (*v, 0.0)), path, heading)
    assert heading.yaw_offset_rad is not None
    assert wrap_rad(heading.yaw_offset_rad - north) == pytest.approx(0.0, abs=0.03)
    assert heading.is_final


def test_fixes_give_a_course() -> None:
    """Ten of them a second are thinned to one; six seconds of walking north while looking ahead."""
    path, heading, course = InertialPath(G), StartHeading(0.0), CourseOverGround()
    for second in range(8):
        _second(path, second, (0.0, 0.0), level_yaw=0.4)
        for tenth in range(1, 11):
            t_ns = second * S + tenth * S // 10
            course.fix(t_ns, (0.0, 1.3e-9 * t_ns, 0.0), path, heading)
    assert heading.yaw_offset_rad == pytest.approx(pi / 2 - 0.4, abs=1e-6)
