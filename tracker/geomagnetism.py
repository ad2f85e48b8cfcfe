"""The Earth's magnetic field by the World Magnetic Model: what turns a compass's north into true north; nothing else."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, radians, sin

from pygeomag import GeoMag

from tracker.estimator import Origin
from tracker.measurements import Vector3

#: First year of each five-year model that pygeomag carries, oldest first, with its coefficients.
_MODELS = (
    (2010.0, "wmm/WMM_2010.COF"),
    (2015.0, "wmm/WMM_2015v2.COF"),
    (2020.0, "wmm/WMM_2020.COF"),
    (2025.0, "wmm/WMM_2025.COF"),
)
_MODEL_LIFE_YEARS = 5.0

_JULIAN_YEAR_NS = 365.25 * 86_400 * 1e9


@dataclass(frozen=True, slots=True)
class MagneticField:
    """The field at one place and time."""

    declination_rad: float
    """Magnetic north east of true north (clockwise) is positive: +0.095 at Ephesus in 2026."""
    inclination_rad: float
    """Dip below the horizon, positive in the northern hemisphere."""
    strength_t: float

    @property
    def enu_t(self) -> Vector3:
        """(east, north, up) in tesla."""
        horizontal_t = self.strength_t * cos(self.inclination_rad)
        return (
            horizontal_t * sin(self.declination_rad),
            horizontal_t * cos(self.declination_rad),
            -self.strength_t * sin(self.inclination_rad),
        )


def magnetic_field(lat_deg: float, lon_deg: float, h_ellipsoid_m: float, t_ns: int) -> MagneticField:
    """Return the field where and when it is asked for, to about 0.4° of declination (the model's own claim).

    A stamp outside the models' years (a clock that was never set, a log with made-up stamps) takes the nearest year that
    a model covers: the declination drifts by a tenth of a degree a year, so that this is better than no correction.

    Args:
        lat_deg: Geodetic, -90 to 90.
        lon_deg: -180 to 180.
        h_ellipsoid_m: Matters little: the field falls by 0.05 % a kilometre.
        t_ns: Nanoseconds since 1970, UTC.
    """
    year = min(max(1970.0 + t_ns / _JULIAN_YEAR_NS, _MODELS[0][0]), _MODELS[-1][0] + _MODEL_LIFE_YEARS)
    coefficients = next(file for first_year, file in reversed(_MODELS) if year >= first_year)
    result = _model(coefficients).calculate(lat_deg, lon_deg, h_ellipsoid_m / 1000.0, year)
    return MagneticField(radians(result.d), radians(result.i), result.f * 1e-9)


def declination_rad(origin: Origin, t_ns: int) -> float:
    """Return how far magnetic north lies east (clockwise) of true north at the origin."""
    return magnetic_field(origin.lat_deg, origin.lon_deg, origin.h_ellipsoid_m, t_ns).declination_rad


@lru_cache(maxsize=len(_MODELS))
def _model(coefficients: str) -> GeoMag:
    return GeoMag(coefficients_file=coefficients)
