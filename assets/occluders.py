"""What hides the ancient site from a visitor today: a depth-only stand-in of the ruins and the ground, never larger."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array, agora_from_site
from assets.prisms import indexed_mesh, plain_mesh
from assets.scene import Node, Scene, expanded
from assets.shape import Mesh, Place
from assets.site import Monument, Site
from assets.solidity import solid_cells
from assets.terrain import Terrain, build_terrain
from assets.today import build_today
from assets.walkable import WHITE

STEP_M = 0.5
"""Heights are rounded down to multiples of this."""
LEAST_M2 = 0.8
"""What a box must hide at least, seen from its broad side."""
MOST_OF_ONE, MOST_BOXES = 80, 520
"""Boxes of one monument, and of all."""
BROADEST_M = 4.0
"""No box counts as longer than this: else low long ones would leave no room for columns."""
CELL_M = 0.2
"""Solid at its middle; half of this is how far a box may stand out."""
DEEP_M = 1.0
"""How far a box reaches into the ground."""
PROBES = (0.103, 0.497, 0.953)
"""Shares of a step at which it must be solid; odd ones, so that they meet no edges of blocks."""
CRACK_M = 0.15
"""Between a ruin's worn floor and what stands on its floor level; counts as solid under what is."""
GROUND_OFF_M = 0.04
"""How far the ground's stand-in may be off it."""


def occluders(site: Site, today: Scene | None = None) -> Scene:
    """Return nodes `ground` and, per monument that hides anything, one of its name; role `occluder`.

    Args:
        site: The facts.
        today: The ruins, where they are built already.

    Raises:
        SiteError: The facts do not suffice.
    """
    terrain = build_terrain(site)
    scene = expanded(today or build_today(site, lambda share: None))
    by_monument = _triangles(scene, {m.id for m in site.monuments})
    found = {m.id: _boxes(m, by_monument[m.id], terrain) for m in site.shown_in("today") if m.id in by_monument}
    nodes = [Node("ground", [_ground(site, terrain)], {"role": "occluder"})]
    for monument_id, large in _largest(found, MOST_BOXES).items():
        if len(large):
            mesh = _mesh(site.monument(monument_id), large)
            nodes.append(Node(monument_id, [mesh], {"role": "occluder", "monument": monument_id}))
    return Scene(nodes, {mesh.material: WHITE for node in nodes for mesh in node.meshes})


def _largest(boxes: Mapping[str, Array], count: int) -> dict[str, Array]:
    """Of all monuments' boxes the `count` largest."""
    silhouettes = np.concatenate([_silhouettes(own) for own in boxes.values()] or [np.zeros(0)])
    least = np.sort(silhouettes)[::-1][count] if len(silhouettes) > count else 0.0
    return {monument_id: own[_silhouettes(own) > least] for monument_id, own in boxes.items()}


def _triangles(scene: Scene, known: set[str]) -> Mapping[str, Array]:
    """What stands, by monument: (m, 3, 3), site frame."""
    found: dict[str, list[Array]] = {}
    for node in scene.nodes:
        monument_id = node.extras.get("monument", node.name)
        if monument_id in known and node.extras.get("role") == "building":
            found.setdefault(monument_id, []).extend(m.positions_m[m.triangles].astype(np.float64) for m in node.meshes)
    return {monument_id: np.concatenate(parts) for monument_id, parts in found.items() if parts}


def _boxes(monument: Monument, triangles: Array, terrain: Terrain) -> Array:
    """Boxes (k, 2, 3) from lower to upper corner in the monument's own axes, all of them solid."""
    place = Place.of(monument)
    own = place.own(triangles)
    low, high = own.min(axis=(0, 1)), own.max(axis=(0, 1))
    x, y = (
        np.arange(a + CELL_M / 2.0, max(b, a + 2.0 * CELL_M), CELL_M) for a, b in zip(low[:2], high[:2], strict=True)
    )
    cells = np.stack(np.meshgrid(x, y, indexing="ij"), -1)
    site = np.concatenate([cells, np.zeros((*cells.shape[:2], 1))], -1) @ place.R_site_own.T + place.origin_m
    ground = terrain.ground_z_m(site[..., 0], site[..., 1]) - monument.base_z_m
    steps = _solid_steps(own, x, y, ground, float(high[2]))
    boxes = _merged(steps, np.array([x[0], y[0]]) - CELL_M / 2.0, float(ground.min()))
    broad = boxes[np.argsort(-_silhouettes(boxes), kind="stable")[:MOST_OF_ONE]]
    return broad[_silhouettes(broad) > LEAST_M2]


def _solid_steps(triangles: Array, x: Array, y: Array, ground: Array, top_m: float) -> NDArray[np.int64]:
    """How many steps up from the lowest ground every cell (a, b) is earth or solid without a gap; none where it is but earth."""
    lowest = float(ground.min())
    steps, rising = np.zeros((len(x), len(y)), dtype=np.int64), np.ones((len(x), len(y)), dtype=bool)
    for level in range(max(0, int((top_m - lowest) / STEP_M))):
        for share in PROBES:
            z = lowest + (level + share) * STEP_M
            if not -CRACK_M < z < 0.0:
                rising &= solid_cells(triangles, x, y, z) | (ground > z)
        steps += rising
        if not rising.any():
            break
    return np.where(lowest + steps * STEP_M > ground, steps, 0)


def _merged(steps: NDArray[np.int64], corner: Array, ground_m: float) -> Array:
    """Cover cells by boxes, the high ones first; a box may reach under higher ones."""
    boxes = []
    for level in range(int(steps.max(initial=0)), 0, -1):
        left, mask = steps == level, steps >= level
        while left.any():
            i, j = (int(k) for k in np.unravel_index(int(np.argmax(left)), left.shape))
            i1, j1 = _rectangle(mask, i, j)
            left[i:i1, j:j1] = False
            a, b = corner + np.array([i, j]) * CELL_M, corner + np.array([i1, j1]) * CELL_M
            boxes.append([[*a, ground_m - DEEP_M], [*b, ground_m + level * STEP_M]])
    return np.array(boxes).reshape(-1, 2, 3)


def _rectangle(mask: NDArray[np.bool_], i: int, j: int) -> tuple[int, int]:
    """How far a rectangle from cell (i, j) reaches within the mask: the larger of growing along x or along y first."""

    def grown(m: NDArray[np.bool_]) -> tuple[int, int]:
        first = np.append(m[:, 0], False)
        a = int(np.argmin(first))
        full = np.append(m[:a].all(axis=0), False)
        return a, int(np.argmin(full))

    a, b = grown(mask[i:, j:])
    d, c = grown(mask[i:, j:].T)
    return (i + a, j + b) if a * b >= c * d else (i + c, j + d)


def _silhouettes(boxes: Array) -> Array:
    """How much a box hides, above the ground: its height counts for more than its length."""
    size = boxes[:, 1] - boxes[:, 0]
    return np.asarray(np.minimum(np.hypot(size[:, 0], size[:, 1]), BROADEST_M) * (size[:, 2] - DEEP_M))


def _mesh(monument: Monument, boxes: Array) -> Mesh:
    """Boxes as five faces each, the underside is below the ground."""
    place = Place.of(monument)
    corner = np.array([[i, j, k] for k in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])
    points = boxes[:, corner, np.arange(3)] @ place.R_site_own.T + place.origin_m
    faces = np.array([[4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    triangles = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    every = triangles[None] + 8 * np.arange(len(boxes))[:, None, None]
    return indexed_mesh(points.reshape(-1, 3), every.reshape(-1, 3))


def _ground(site: Site, terrain: Terrain) -> Mesh:
    """The terrain within the rectangle whose levels are known, its cells joined where they lie in one plane."""
    u0, u1, v0, v1 = site.terrain["relief_beyond_m"]
    inside = (terrain.u_m >= u0) & (terrain.u_m <= u1), (terrain.v_m >= v0) & (terrain.v_m <= v1)
    u, v, z = terrain.u_m[inside[0]], terrain.v_m[inside[1]], terrain.z_m[np.ix_(*inside)]
    left = np.ones((len(u) - 1, len(v) - 1), dtype=bool)
    quads = []
    while left.any():
        i, j = (int(k) for k in np.unravel_index(int(np.argmax(left)), left.shape))
        i1, j1 = _plane(u, v, z, left, i, j)
        left[i:i1, j:j1] = False
        quads.append([(u[a], v[b], z[a, b]) for a, b in ((i, j), (i1, j), (i1, j1), (i, j1))])
    corners = np.array(quads)
    corners[..., :2] = corners[..., :2] @ agora_from_site(site.azimuth_rad)
    return plain_mesh(np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]]))


def _plane(u: Array, v: Array, z: Array, left: NDArray[np.bool_], i: int, j: int) -> tuple[int, int]:
    """How far the cell (i, j) grows along both axes while two triangles keep within `GROUND_OFF_M` of the ground."""
    i1, j1, growing = i + 1, j + 1, True
    while growing:
        growing = False
        for a, b in ((i1 + 1, j1), (i1, j1 + 1)):
            free = a <= left.shape[0] and b <= left.shape[1] and left[i:a, j:b].all()
            if free and _off_plane(u[i : a + 1], v[j : b + 1], z[i : a + 1, j : b + 1]) <= GROUND_OFF_M:
                i1, j1, growing = a, b, True
    return i1, j1


def _off_plane(u: Array, v: Array, z: Array) -> float:
    """How far a part of the grid is off the two triangles on its corners."""
    east = math.pi / 2.0  # the azimuth at which u is east
    two = Terrain(east, u[[0, -1]], v[[0, -1]], z[np.ix_([0, -1], [0, -1])])
    shares = np.linspace(0.0, 1.0, 4)
    uv = np.meshgrid(*(np.unique(x[:-1, None] + np.diff(x)[:, None] * shares) for x in (u, v)), indexing="ij")
    return float(np.abs(two.ground_z_m(*uv) - Terrain(east, u, v, z).ground_z_m(*uv)).max())
