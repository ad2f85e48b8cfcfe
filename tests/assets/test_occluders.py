"""The stand-in of the ruins that hides the ancient square: few triangles, and never larger than what stands there."""

import numpy as np
import pytest
from numpy.typing import NDArray

from assets.gltf import Scene, expanded
from assets.occluders import occluders
from assets.shape import Shape
from assets.site import Site
from assets.solidity import section, solid_cells
from assets.terrain import Terrain
from tests.assets.geometry import corners, drawn

Points = NDArray[np.float64]
AXES = np.array([(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)])


@pytest.fixture(scope="module")
def stand_in(site: Site, today: Scene) -> Scene:
    return occluders(site, today)


def ruin(today: Scene, monument_id: str) -> Points:
    """Return the triangles of a ruin."""
    nodes = [n for n in expanded(today).nodes if n.extras.get("monument") == monument_id]
    return np.concatenate([corners(node) for node in nodes])


def hidden(points: Points, triangles: Points, direction: Points) -> NDArray[np.bool_]:
    """Return which points a visitor who looks against `direction` does not see: something real stands before them."""
    a, ab, ac = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    p = np.cross(direction, ac)
    determinant = np.einsum("ij,ij->i", ab, p)
    broad = np.abs(determinant) > 1e-12
    a, ab, ac, p, determinant = a[broad], ab[broad], ac[broad], p[broad], determinant[broad]
    leaving = np.sign(np.cross(ab, ac) @ direction)
    found = np.zeros(len(points), dtype=bool)
    for k, point in enumerate(points):
        s = np.einsum("ij,ij->i", point - a, p) / determinant
        q = np.cross(point - a, ab)
        t, r = q @ direction / determinant, np.einsum("ij,ij->i", ac, q) / determinant
        met = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0) & (r > 0.0)
        if met.any():
            found[k] = leaving[met].sum() > 0.0 or leaving[met][np.argmin(r[met])] > 0.0
    return found


def test_it_is_a_few_thousand_triangles_of_one_plain_material(stand_in: Scene) -> None:
    assert 1_000 < sum(node.triangles for node in stand_in.nodes) < 8_000
    assert {mesh.material for node in stand_in.nodes for mesh in node.meshes} == set(stand_in.textures)
    assert {node.extras["role"] for node in stand_in.nodes} == {"occluder"}


def test_what_hides_most_is_there(stand_in: Scene) -> None:
    names = {node.name for node in stand_in.nodes}
    assert {"ground", "basilica_stoa", "west_wall", "baths", "memmius", "prytaneion"} <= names


def test_the_ground_is_nowhere_above_the_ground(stand_in: Scene, terrain: Terrain) -> None:
    triangles = corners(next(node for node in stand_in.nodes if node.name == "ground"))
    rng = np.random.default_rng(8)
    chosen = triangles[rng.integers(0, len(triangles), 6000)]
    points = np.einsum("ki,kij->kj", rng.dirichlet((1.0, 1.0, 1.0), len(chosen)), chosen)
    over = points[:, 2] - terrain.ground_z_m(points[:, 0], points[:, 1])
    assert over.max() < 0.1
    assert np.median(over) > -0.3


@pytest.mark.parametrize("monument_id", ["basilica_stoa", "chalcidicum_w", "memmius", "baths", "prytaneion"])
def test_a_ruin_hides_its_stand_in(stand_in: Scene, today: Scene, terrain: Terrain, monument_id: str) -> None:
    """Within 10 cm of any place on the stand-in is one that something real hides from all sides."""
    faces = corners(next(node for node in stand_in.nodes if node.name == monument_id))
    real = ruin(today, monument_id)
    rng = np.random.default_rng(3)
    area = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)
    chosen = faces[rng.choice(len(faces), 60, p=area / area.sum())]
    normal = np.cross(chosen[:, 1] - chosen[:, 0], chosen[:, 2] - chosen[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    within = np.einsum("ki,kij->kj", rng.dirichlet((1.0, 1.0, 1.0), len(chosen)), chosen) - 0.02 * normal
    within = within[within[:, 2] > terrain.ground_z_m(within[:, 0], within[:, 1]) + 0.1]
    assert len(within) > 20
    near = [within, *(within + 0.1 * step for step in AXES)]
    behind = np.any([np.all([hidden(points, real, axis) for axis in AXES], axis=0) for points in near], axis=0)
    assert behind.mean() > 0.95


def test_a_block_is_solid_and_what_a_lintel_spans_is_not() -> None:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (2.0, 2.0, 3.0))
    shape.box("marble", (4.0, 0.0, 2.5), (6.0, 2.0, 3.0))
    x, y = np.arange(-0.45, 7.0, 0.2), np.arange(-0.45, 3.0, 0.2)
    inside_y = (y > 0.0) & (y < 2.0)
    for z, spans in ((1.03, [(0.0, 2.0)]), (2.71, [(0.0, 2.0), (4.0, 6.0)])):
        inside_x = np.any([(x > a) & (x < b) for a, b in spans], axis=0)
        assert np.array_equal(solid_cells(drawn(shape), x, y, z), inside_x[:, None] & inside_y)
    assert not solid_cells(drawn(shape), x, y, 3.2).any()


def test_a_box_inside_another_does_not_open_it() -> None:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (4.0, 4.0, 3.0))
    shape.box("marble", (1.53, 1.53, 0.0), (2.48, 2.48, 4.0))
    x = np.arange(-0.5, 4.6, 0.31)
    inside = (x > 0.0) & (x < 4.0)
    assert np.array_equal(solid_cells(drawn(shape), x, x, 1.4), inside[:, None] & inside)
    core = (x > 1.53) & (x < 2.48)
    assert np.array_equal(solid_cells(drawn(shape), x, x, 3.5), core[:, None] & core)


def test_a_round_shaft_under_a_broad_capital_is_a_shaft() -> None:
    shape = Shape()
    angle = np.linspace(0.0, 2.0 * np.pi, 25)
    ring = np.stack([np.cos(angle), np.sin(angle)], -1) * 0.5
    grid = np.stack([np.column_stack([ring, np.full(25, z)]) for z in (0.0, 5.0)], axis=1)
    shape.surface("marble", grid)
    shape.box("marble", (-1.0, -1.0, 5.0), (1.0, 1.0, 5.5))
    x = np.arange(-1.15, 1.2, 0.1)
    within = np.hypot(x[:, None], x)
    solid = solid_cells(drawn(shape), x, x, 2.51)
    assert solid[within < 0.45].all()
    assert not solid[within > 0.52].any()


def test_a_section_runs_along_the_faces() -> None:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (2.0, 3.0, 1.0))
    ends, outward = section(drawn(shape), 0.37)
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(10.0)
    middle = ends.mean(axis=1) - (1.0, 1.5)
    assert (np.einsum("ij,ij->i", middle, outward) > 0.0).all()
