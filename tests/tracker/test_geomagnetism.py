"""The World Magnetic Model, against ahrs's own reading of it."""

from datetime import UTC, date, datetime

import numpy as np
import pytest
from ahrs.utils import WMM

from tracker.estimator import Origin
from tracker.geomagnetism import declination_rad, magnetic_field

#: State Agora, Ankara, Colchester, and somewhere south.
PLACES = [(37.9366, 27.3447), (39.93, 32.86), (51.89, 0.90), (-43.5, 172.6)]
T_NS = int(datetime(2026, 11, 22, tzinfo=UTC).timestamp() * 1e9)


@pytest.mark.parametrize(("lat_deg", "lon_deg"), PLACES)
def test_agrees_with_ahrs(lat_deg: float, lon_deg: float) -> None:
    """To a fiftieth of a degree and 20 nT, far within what the model itself is good for."""
    ours = magnetic_field(lat_deg, lon_deg, 0.0, T_NS)
    theirs = WMM(date(2026, 11, 22), latitude=lat_deg, longitude=lon_deg, height=0.0)
    assert np.degrees(ours.declination_rad) == pytest.approx(theirs.D, abs=0.02)
    assert np.degrees(ours.inclination_rad) == pytest.approx(theirs.I, abs=0.02)
    assert ours.strength_t * 1e9 == pytest.approx(theirs.F, abs=20.0)
    east, north, up = ours.enu_t
    assert (east * 1e9, north * 1e9, -up * 1e9) == pytest.approx((theirs.Y, theirs.X, theirs.Z), abs=20.0)


def test_a_clock_that_was_never_set_is_as_good_as_the_nearest_year() -> None:
    """1970 and 2100 take the first and last year of the models; none ends in an exception."""
    origin = Origin(37.9366, 27.3447, 88.4)
    now = declination_rad(origin, T_NS)
    for year in (1970, 2100):
        t_ns = int(datetime(year, 1, 1, tzinfo=UTC).timestamp() * 1e9)
        assert declination_rad(origin, t_ns) == pytest.approx(now, abs=np.radians(2.0))
