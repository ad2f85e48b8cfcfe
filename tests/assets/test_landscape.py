"""What stands around a site is the site's own: read from its data, and nothing of another place where it says nothing."""

from dataclasses import replace

import numpy as np
import pytest

from assets.errors import SiteError
from assets.landscape import PLANTS, Landscape, Planting, mountains, planted, wooded
from assets.site import Site
from assets.terrain import Terrain


def test_the_state_agora_has_its_two_mountains_and_its_plants(site: Site) -> None:
    land = Landscape.of(site)
    assert land.hills[:, 2].max() == 260.0
    assert all(len(land.plants[name]) for name in PLANTS)
    assert len(land.far_bushes_uv_m) == 2


def test_a_site_that_says_nothing_has_neither_hills_nor_plants(site: Site, terrain: Terrain) -> None:
    bare = Planting(replace(site, landscape={}), terrain, np.random.default_rng(1))
    assert planted(bare, 0) == []
    assert wooded(bare, 0) == []
    own = Planting(site, terrain, np.random.default_rng(1))
    highest = [
        max(float(batch.points[:, 2].max()) for batch in mountains(planting).batches) for planting in (bare, own)
    ]
    assert highest[0] < highest[1] - 100.0


def test_its_open_place_is_where_its_ways_go(site: Site) -> None:
    u0, u1, v0, v1 = Landscape.of(replace(site, landscape={})).square_uv_m
    assert u0 < u1
    assert v0 < v1
    stated = Landscape.of(site).square_uv_m
    assert u0 > stated[0] - 10.0
    assert u1 < stated[1] + 10.0


@pytest.mark.parametrize(
    ("key", "value"),
    [("square_uv_m", [1.0, 2.0]), ("hills", [[1.0, 2.0]]), ("trees", [["ten", 0.0, 1.0, 0.0, 1.0]]), ("bushes", 7)],
)
def test_numbers_of_another_shape_are_named(site: Site, key: str, value: object) -> None:
    with pytest.raises(SiteError, match=rf"landscape\.{key}"):
        Landscape.of(replace(site, landscape={key: value}))
