"""The site as it stands today: what the simulated camera sees."""

from collections.abc import Callable, Mapping
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from assets import landscape, ruins_civic, ruins_works
from assets.axes import Array
from assets.errors import SiteError
from assets.gltf import Node, Scene
from assets.ground import paving_mesh, terrain_meshes
from assets.materials import MATERIALS
from assets.monuments import monument_facts
from assets.roman import PAVING
from assets.shape import Place, Shape
from assets.site import Monument, Site
from assets.terrain import Terrain, build_terrain
from assets.textures import noise

Ruin = Callable[[Monument, Shape, np.random.Generator], None]
RUINS: Mapping[str, Ruin] = {
    "altar": ruins_civic.walls,
    "arch": ruins_works.vaulted,
    "basilica": ruins_civic.basilica,
    "basin": ruins_works.basin,
    "baths": ruins_works.baths,
    "bouleuterion": ruins_civic.bouleuterion,
    "chambers": ruins_works.chambers,
    "court": ruins_civic.court,
    "gate": ruins_civic.walls,
    "hall": ruins_civic.walls,
    "nymphaeum": ruins_works.high_walls,
    "piers": ruins_works.piers,
    "platform_hall": ruins_works.platform_hall,
    "prytaneion": ruins_civic.prytaneion,
    "socle": ruins_works.socle,
    "steps": ruins_civic.stairs,
    "stoa": ruins_civic.stoa,
    "temple": ruins_civic.temple,
    "terrace": ruins_works.terrace,
    "tower": ruins_works.tower,
    "wall": ruins_works.wall,
}
SITE = Place.at(0.0, 0.0, 0.0)
PATH_WIDTH_M = 1.8


def build_today(site: Site, progress: Callable[[float], None]) -> Scene:
    """Return the ruins, the ground and what grows there.

    Args:
        site: Its facts.
        progress: Called with the share that is done.

    Raises:
        SiteError: A monument lacks a figure, or is of a kind that nothing builds.
    """
    terrain = build_terrain(site)
    nodes = [Node("ground", terrain_meshes(terrain, _ground, _tint), {"role": "ground"})]
    nodes += [_ruin(m, terrain) for m in site.shown_in("today") if m.id != "square"]
    progress(0.4)
    planting = landscape.Planting(site, terrain, np.random.default_rng(1))
    paths = Shape()
    for way in site.ways:
        closed = np.array([*way, way[0]])
        part = landscape.path(terrain, np.random.default_rng(2), closed, PATH_WIDTH_M)
        paths.copies(part, np.zeros((1, 3)))
    around = {
        "mountains": (landscape.mountains(terrain), "ground"),
        "paths": (paths, "ground"),
        "grass": (landscape.grasses(planting), "ground"),
        "stacked_blocks": (landscape.stacked(planting), "building"),
        "plants": (landscape.planted(planting), "building"),
    }
    nodes += [Node(name, shape.meshes(SITE), {"role": role}) for name, (shape, role) in around.items()]
    progress(0.8)
    used = dict.fromkeys(mesh.material for node in nodes for mesh in node.meshes)
    scene = Scene(nodes, {name: MATERIALS[name].paint() for name in used})
    progress(1.0)
    return scene


def _ruin(monument: Monument, terrain: Terrain) -> Node:
    if monument.kind == PAVING:
        return Node(
            monument.id, [paving_mesh(terrain, monument, "paving", 0.8)], monument_facts(monument) | {"role": "ground"}
        )
    if monument.kind not in RUINS:
        raise SiteError(
            f"monument '{monument.id}' is of kind '{monument.kind}', which nothing builds; use one of {', '.join(RUINS)}."
        )
    shape = Shape()
    RUINS[monument.kind](monument, shape, np.random.default_rng(crc32(monument.id.encode())))
    return Node(monument.id, shape.meshes(Place.of(monument)), monument_facts(monument) | {"role": "building"})


def _ground(points_m: Array) -> NDArray[np.str_]:
    """Dry grass, maquis on the hills with a ragged border between."""
    ragged = noise(321, 128, 2, 40, 0.7)
    i, j = (np.floor(points_m[:, k] / 9.0).astype(int) % 128 for k in (0, 1))
    return np.where(points_m[:, 2] + 3.0 * ragged[i, j] > 13.0, "scrub", "grass")


def _tint(points_m: Array) -> Array:
    """Greener and drier patches, tens of metres wide."""
    tone, green = noise(322, 256, 3, 50, 0.8), noise(323, 256, 3, 40, 0.8)
    i, j = (np.floor(points_m[:, k] / 3.0).astype(int) % 256 for k in (0, 1))
    level = 0.84 + 0.07 * tone[i, j]
    shift = 0.04 * green[i, j]
    return np.asarray(np.clip(np.stack([level * (1.0 - shift), level, level * (0.98 - shift)], -1), 0.0, 1.0))
