"""Another site is another folder: this one loads, builds and tracks with no code changed."""

from heapq import merge
from pathlib import Path

import numpy as np
import pytest

from assets.footholds import Footholds
from assets.gltf import Scene
from assets.occluders import occluders
from assets.roman import build_roman
from assets.site import Site, load_site
from assets.terrain import build_terrain
from assets.today import build_today
from assets.walkable import walkable
from server.site_facts import site_facts
from server.site_tour import tour_of
from tracker.estimator import Origin
from tracker.evaluate import run
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.rig import Rig
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate

FOLDER = Path(__file__).parent
SECONDS, STILL_S = 10.0, 3.0


@pytest.fixture(scope="module")
def field() -> Site:
    return load_site(FOLDER)


@pytest.fixture(scope="module")
def ruins(field: Site) -> Scene:
    return build_today(field, lambda share: None)


@pytest.mark.parametrize("level", [0, 1, 2])
def test_it_is_built_at_every_level(field: Site, level: int) -> None:
    names = {node.name for node in build_roman(field, lambda share: None, level=level).nodes}
    assert {"ground", "field", "temple", "altar"} <= names
    assert not any("basilica" in name or "memmius" in name for name in names)


def test_its_ruins_stand_and_hide(field: Site, ruins: Scene) -> None:
    assert {"ground", "temple", "altar"} <= {node.name for node in ruins.nodes}
    assert {"ground", "temple"} <= {node.name for node in occluders(field, ruins).nodes}


def test_it_is_walked_on(field: Site) -> None:
    ways, terrain = walkable(field), build_terrain(field)
    for east, north in field.ways[0]:
        assert Footholds.of(ways, "today").height_m(east, north) == pytest.approx(
            terrain.ground_z_m(east, north), abs=1e-3
        )
    assert Footholds.of(ways, "roman").height_m(0.0, 0.0) is None  # the cella


def test_a_page_can_show_it(field: Site) -> None:
    facts = site_facts(field, FOLDER / "built")
    assert facts["models"] == {}
    assert [m["id"] for m in facts["monuments"]] == ["field", "temple", "altar"]
    assert facts["tour"][0]["texts"]["tr"].startswith("Bu tapınak")


def test_a_visitor_is_tracked_there(field: Site, tmp_path: Path) -> None:
    origin = Origin(field.origin.lat_deg, field.origin.lon_deg, field.origin.h_ellipsoid_m)
    rig = default_rig()
    settings = WalkSettings(
        seed=4, duration_s=SECONDS, still_s=STILL_S, tour=tour_of(field), origin=origin, eye_height_m=field.eye_height_m
    )
    walk = Walk(settings, rig, build_terrain(field).ground_z_m)
    path = tmp_path / "field.mcap"
    blind = Rig(rig.T_body_imu, rig.T_body_gps, rig.T_body_cam, None)
    with LogWriter(path, blind, origin, t_start_ns=START_NS) as writer:
        for measurement in merge(simulate(walk), key=lambda m: m.t_recv_ns):
            writer.write(measurement)
    result = run(Log.open(path), "gps-imu/famm")
    t_ns = np.array([pose.t_ns for pose in result.poses])
    truth = walk.at(t_ns)
    found = np.array([pose.p_site_m for pose in result.poses])
    off_m = np.hypot(*(found - truth.p_m)[:, :2].T)
    assert t_ns[-1] - START_NS > (SECONDS - 0.5) * 1e9
    assert np.median(off_m) < 6.0
