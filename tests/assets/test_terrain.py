"""The ground: one height field for the models and for whoever walks on it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from assets.axes import agora_from_site
from assets.errors import SiteError
from assets.gltf import Scene
from assets.site import Site
from assets.terrain import Terrain, build_terrain

IN_THE_SITE = st.floats(-200.0, 200.0, allow_nan=False)


def drawn_triangles(scene: Scene) -> NDArray[np.float64]:
    """Return (m, 3, 3) triangles of the ground as a file holds them."""
    ground = next(node for node in scene.nodes if node.name == "ground")
    return np.concatenate([mesh.positions_m[mesh.triangles] for mesh in ground.meshes]).astype(np.float64)


def test_the_square_is_the_zero_of_all_heights(terrain: Terrain) -> None:
    assert terrain.ground_z_m(0.0, 0.0) == pytest.approx(0.0, abs=1e-6)
    assert terrain.ground_z_m(np.array([-40.0, 20.0]), np.array([-20.0, -40.0])) == pytest.approx([0.0, 0.0], abs=1e-6)


def test_levels_of_the_data_are_kept(site: Site, terrain: Terrain) -> None:
    axes = agora_from_site(site.azimuth_rad)
    for u, v, level in ((-118.0, -30.0, -6.0), (100.0, 0.0, 1.9), (-173.0, 57.0, -11.0)):
        e, n = np.array([u, v]) @ axes
        assert terrain.ground_z_m(float(e), float(n)) == pytest.approx(level, abs=0.05)


@pytest.mark.parametrize("epoch", ["roman", "today"])
def test_the_ground_is_exactly_what_is_drawn(epoch: str, terrain: Terrain, request: pytest.FixtureRequest) -> None:
    triangles = drawn_triangles(request.getfixturevalue(epoch))
    rng = np.random.default_rng(5)
    chosen = triangles[rng.integers(0, len(triangles), 4000)]
    weights = rng.dirichlet((1.0, 1.0, 1.0), len(chosen))
    points = np.einsum("ki,kij->kj", weights, chosen)
    assert terrain.ground_z_m(points[:, 0], points[:, 1]) == pytest.approx(points[:, 2], abs=2e-3)


def test_the_drawn_ground_covers_the_terrain_once(terrain: Terrain, roman: Scene) -> None:
    sides = drawn_triangles(roman)
    doubled = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])[:, 2]
    extent = (terrain.u_m[-1] - terrain.u_m[0]) * (terrain.v_m[-1] - terrain.v_m[0])
    assert (doubled > 0.0).all()
    assert doubled.sum() / 2.0 == pytest.approx(extent, rel=1e-5)


@given(e=IN_THE_SITE, n=IN_THE_SITE)
def test_the_ground_has_no_gaps(terrain: Terrain, e: float, n: float) -> None:
    here = terrain.ground_z_m(e, n)
    around = terrain.ground_z_m(np.array([e + 1e-5, e - 1e-5]), np.array([n - 1e-5, n + 1e-5]))
    assert around == pytest.approx([here, here], abs=1e-3)


@given(e=IN_THE_SITE, n=IN_THE_SITE)
def test_scalars_and_arrays_agree(terrain: Terrain, e: float, n: float) -> None:
    assert terrain.ground_z_m(np.array([[e]]), np.array([[n]]))[0, 0] == terrain.ground_z_m(e, n)


def test_beyond_the_grid_the_edge_goes_on(site: Site, terrain: Terrain) -> None:
    axes = agora_from_site(site.azimuth_rad)
    edge, far = (np.array([terrain.u_m[-1] + out, 10.0]) @ axes for out in (0.0, 5000.0))
    assert terrain.ground_z_m(float(far[0]), float(far[1])) == pytest.approx(
        terrain.ground_z_m(float(edge[0]), float(edge[1]))
    )


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("levels", None, "has no 'terrain.levels'"),
        ("levels", [[1.0, 2.0]], "'terrain.levels' must hold n by 6 numbers"),
        ("levels", [], "'terrain.levels' must hold"),
        ("levels", [["a"] * 6], "'terrain.levels' must hold"),
        ("u_extent_m", [0.0, float("nan")], "'terrain.u_extent_m' must hold 2 numbers"),
        ("fine_step_m", 0.0, "'terrain.fine_step_m' must be more than 0"),
        ("relief_m", [1.0], "'terrain.relief_m' must hold one numbers"),
    ],
)
def test_broken_levels_are_named(site: Site, key: str, value: Any, says: str) -> None:
    table = {k: v for k, v in site.terrain.items() if k != key} | ({} if value is None else {key: value})
    with pytest.raises(SiteError) as caught:
        build_terrain(replace(site, terrain=table))
    assert says in str(caught.value)
