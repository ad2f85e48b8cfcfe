"""How high the eyes are on the State Agora, asked in its own frame and in another."""

from copy import deepcopy
from dataclasses import replace
from math import inf

import numpy as np
import pytest

from assets.axes import agora_from_site
from assets.site import load_site
from server.cli import SITE
from server.standing import distance_m, eye_heights, origin_of
from tracker.estimator import Origin
from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix

AGORA = replace(load_site(SITE), eye_height_m=1.7)


@pytest.mark.parametrize(("uv_m", "ground_m"), [((-20.0, -30.0), 0.0), ((-20.0, 10.0), 0.9)])
def test_one_eye_height_above_the_square_and_above_the_floor_of_the_basilica(
    uv_m: tuple[float, float], ground_m: float
) -> None:
    east_m, north_m = np.array(uv_m) @ agora_from_site(AGORA.azimuth_rad)
    assert eye_heights(AGORA)(east_m, north_m) == pytest.approx(1.7 + ground_m, abs=0.01)


def test_nobody_stands_where_there_is_no_ground() -> None:
    assert eye_heights(AGORA)(5000.0, 0.0) == inf


def test_in_another_frame_it_is_the_same_place() -> None:
    """A log's own frame, 300 m away, 20 m lower and turned by seconds of arc."""
    site = origin_of(AGORA)
    elsewhere = Origin(site.lat_deg + 0.002, site.lon_deg - 0.0025, site.h_ellipsoid_m - 20.0)
    here, there = eye_heights(AGORA), eye_heights(AGORA, elsewhere)
    for east_m, north_m in ((0.0, 0.0), (-20.0, -30.0), (-109.0, 53.0)):
        p_site = np.array([east_m, north_m, here(east_m, north_m), 1.0])
        p_there = SiteFrame(elsewhere).T_from(site) @ p_site
        assert there(*p_there[:2].tolist()) == pytest.approx(p_there[2], abs=0.005)


def test_distances_over_the_ground() -> None:
    """A few metres as the site's own frame has them, and the far side of the Earth as an atlas has it."""
    site = origin_of(AGORA)
    near = GpsFix(0, 0, site.lat_deg + 0.001, site.lon_deg + 0.001, site.h_ellipsoid_m, (), valid=True)
    assert distance_m(near, site) == pytest.approx(141.6, abs=1.0)
    christchurch = replace(near, lat_deg=-43.5, lon_deg=172.6)
    assert distance_m(christchurch, site) == pytest.approx(17.05e6, rel=0.005)


def test_copies_of_an_estimator_share_it() -> None:
    eyes_z_m = eye_heights(AGORA)
    assert deepcopy(eyes_z_m) is eyes_z_m
