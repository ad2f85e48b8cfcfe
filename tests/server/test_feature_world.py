"""The site as a world for studies: its walks are those of `agora simulate`, and its corners lie on the site."""

from pathlib import Path

import numpy as np
import pytest

from assets.site import Site, load_site
from assets.terrain import build_terrain
from server.feature_world import dataset_walk, walk_on, world_of
from server.site_tour import tour_of
from tests.ci.machine import has_open_gl, is_root
from tracker.choreography import DATASET_DURATION_S
from tracker.simulate import EYE_HEIGHT_M, WalkSettings

SITE = Path(__file__).parents[2] / "assets" / "state_agora"


@pytest.fixture(scope="module")
def site() -> Site:
    return load_site(SITE)


@pytest.mark.parametrize("dataset", DATASET_DURATION_S)
def test_a_dataset_s_walk_is_on_the_site_and_as_long(site: Site, dataset: int) -> None:
    walk = dataset_walk(site, dataset, 7)
    assert (walk.settings.dataset, walk.settings.seed) == (dataset, 7)
    assert walk.settings.duration_s == DATASET_DURATION_S[dataset]
    assert walk.settings.tour == tour_of(site)
    assert walk.settings.origin.lat_deg == site.origin.lat_deg


def test_a_walker_stands_on_the_ground(site: Site) -> None:
    walk = walk_on(site, WalkSettings(duration_s=30.0, tour=tour_of(site), dataset=2))
    p_m = walk.at(walk.stamps(1.0)).p_m
    ground_m = build_terrain(site).ground_z_m(p_m[:, 0], p_m[:, 1])
    # the rig bobs with the gait
    assert p_m[:, 2] - ground_m == pytest.approx(EYE_HEIGHT_M, abs=0.1)


def test_corners_of_the_site_lie_about_who_looks(site: Site, tmp_path: Path) -> None:
    """On the ground or over it, near and far, on all sides; and they are kept under the name of what was drawn."""
    if not has_open_gl() and not is_root():
        pytest.skip("not root")
    walk = dataset_walk(site, 3, 1)
    p_m = walk.T_site_cam(walk.frame_times()[0][0])[:3, 3]
    with world_of(site, tmp_path) as world:
        corners = world.corners(p_m)
        key = world.key
    assert [len(list(folder.iterdir())) for folder in tmp_path.iterdir() if folder.name == key] == [1]
    assert len(corners.p_site_m) > 1000
    away_m = corners.p_site_m - p_m
    distance_m = np.linalg.norm(away_m, axis=1)
    assert distance_m.min() < 6.0
    assert distance_m.max() > 200.0
    bearing = np.arctan2(away_m[:, 1], away_m[:, 0])
    assert (np.histogram(bearing, 8, (-np.pi, np.pi))[0] > 50).all()
    near = distance_m < 30.0
    ground_m = build_terrain(site).ground_z_m(corners.p_site_m[near, 0], corners.p_site_m[near, 1])
    assert np.mean(corners.p_site_m[near, 2] - ground_m > -0.1) > 0.98
