"""Geodesy against PROJ, round trips, and the site's own figures."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyproj import Transformer

from tracker.estimator import Origin
from tracker.geodesy import SiteFrame, earth_rate_rad_s, ecef_from_geodetic, geodetic_from_ecef, gravity_m_s2

EPHESUS = Origin(37.9366, 27.3447, 88.4)
PROJ = Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)

latitudes, longitudes, heights = st.floats(-90.0, 90.0), st.floats(-180.0, 180.0), st.floats(-500.0, 9000.0)


@given(latitudes, longitudes, heights)
def test_equation_2_agrees_with_proj(lat_deg: float, lon_deg: float, h_m: float) -> None:
    assert np.allclose(ecef_from_geodetic(lat_deg, lon_deg, h_m), PROJ.transform(lon_deg, lat_deg, h_m), atol=1e-6)


@given(latitudes, longitudes, heights)
def test_ecef_and_back(lat_deg: float, lon_deg: float, h_m: float) -> None:
    p_ecef_m = ecef_from_geodetic(lat_deg, lon_deg, h_m)
    assert np.allclose(ecef_from_geodetic(*geodetic_from_ecef(p_ecef_m)), p_ecef_m, atol=1e-4)


@given(st.tuples(*[st.floats(-500.0, 500.0)] * 3))
def test_site_and_back(p_site_m: tuple[float, float, float]) -> None:
    site = SiteFrame(EPHESUS)
    assert np.allclose(site.site_from_geodetic(*site.geodetic_from_site(p_site_m)), p_site_m, atol=1e-4)


def test_a_degree_at_ephesus_has_the_published_length() -> None:
    """The data sheet's figures: one degree of longitude is 87 908.0 m, one of latitude 110 995.3 m."""
    site = SiteFrame(Origin(EPHESUS.lat_deg, EPHESUS.lon_deg, 0.0))
    east, _, _ = site.site_from_geodetic(EPHESUS.lat_deg, EPHESUS.lon_deg + 0.001, 0.0)
    _, north, _ = site.site_from_geodetic(EPHESUS.lat_deg + 0.001, EPHESUS.lon_deg, 0.0)
    assert east == pytest.approx(87.908, abs=0.001)
    assert north == pytest.approx(110.9953, abs=0.002)


def test_a_map_laid_elsewhere_is_carried_over() -> None:
    there = Origin(37.9380, 27.3430, 95.0)
    p_map_m = np.array([12.0, -30.0, 2.0, 1.0])
    geodetic = SiteFrame(there).geodetic_from_site((12.0, -30.0, 2.0))
    expected = SiteFrame(EPHESUS).site_from_geodetic(*geodetic)
    assert np.allclose((SiteFrame(EPHESUS).T_from(there) @ p_map_m)[:3], expected, atol=1e-4)


def test_gravity() -> None:
    assert gravity_m_s2(0.0, 0.0) == pytest.approx(9.7803, abs=1e-4)
    assert gravity_m_s2(90.0, 0.0) == pytest.approx(9.8322, abs=1e-4)
    assert gravity_m_s2(37.94, 88.0) == pytest.approx(9.8001, abs=5e-4)


@pytest.mark.parametrize(
    ("lat_deg", "turns"), [(90.0, (0.0, 0.0, 1.0)), (0.0, (0.0, 1.0, 0.0)), (-90.0, (0.0, 0.0, -1.0))]
)
def test_the_earth_turns_once_in_a_sidereal_day(lat_deg: float, turns: tuple[float, float, float]) -> None:
    assert np.array(earth_rate_rad_s(lat_deg)) * 86_164.1 / (2.0 * np.pi) == pytest.approx(turns, abs=1e-5)
