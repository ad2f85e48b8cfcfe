"""A compass: the mean turn from a heading to what the field says, and which fields are the Earth's."""

from math import cos, pi, sin

import pytest

from tracker.geomagnetism import MagneticField
from tracker.geometry import wrap_rad, wxyz_from_yaw
from tracker.measurements import MagSample, Vector3
from tracker.precise.compass import Compass

LEVEL = (1.0, 0.0, 0.0, 0.0)
EARTH = MagneticField(declination_rad=0.1, inclination_rad=0.9, strength_t=47e-6)


def _sample(field: Vector3) -> MagSample:
    return MagSample(0, 0, field)


def _field(yaw_rad: float, strength_t: float = EARTH.strength_t, dip_rad: float = EARTH.inclination_rad) -> MagSample:
    """What a level rig that faces yaw_rad measures."""
    north_rad = pi / 2 - EARTH.declination_rad - yaw_rad
    flat = strength_t * cos(dip_rad)
    return _sample((flat * cos(north_rad), flat * sin(north_rad), -strength_t * sin(dip_rad)))


@pytest.mark.parametrize("yaw_rad", [-3.1, -1.0, 0.0, 2.0])
def test_it_tells_the_heading_whatever_the_filter_takes_for_it(yaw_rad: float) -> None:
    compass, taken_rad = Compass(EARTH.declination_rad, EARTH), 0.7
    assert compass.yaw_rad(LEVEL) is None
    for _ in range(5):
        compass.field(_field(yaw_rad), wxyz_from_yaw(taken_rad))
    found_rad = compass.yaw_rad(wxyz_from_yaw(taken_rad))
    assert found_rad is not None
    assert wrap_rad(found_rad - yaw_rad) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("sample", "trusted"),
    [
        (_field(0.3), True),
        (_field(0.3, strength_t=1.3 * EARTH.strength_t), False),
        (_field(0.3, dip_rad=EARTH.inclination_rad - 0.2), False),
        (_sample((0.0, 0.0, -EARTH.strength_t)), False),
    ],
)
def test_only_the_earth_s_field_is_trusted(sample: MagSample, trusted: bool) -> None:
    compass = Compass(EARTH.declination_rad, EARTH)
    compass.field(_field(0.3), LEVEL)
    compass.field(sample, LEVEL)
    assert compass.is_trusted is trusted


def test_a_field_straight_up_tells_nothing_even_where_every_field_is_believed() -> None:
    compass = Compass(0.0)
    compass.field(_sample((2e-5, 0.0, -4e-5)), LEVEL)
    assert compass.is_trusted
    compass.field(_sample((0.0, 0.0, -4e-5)), LEVEL)
    assert not compass.is_trusted
