"""The site as it stands today: what the simulated camera sees."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from assets import landscape, ruins_civic, ruins_works
from assets.axes import Array
from assets.brought_node import brought_node
from assets.building import Building
from assets.errors import SiteError
from assets.facts import monument_facts
from assets.ground import paving_mesh, terrain_meshes
from assets.materials import MATERIALS
from assets.records import MODEL, PAVING
from assets.scene import Node, Scene
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
LAND = {"role": "ground", "evidence": "hypothetical", "source": "design"}
"""What the land carries: it is like the place, not a survey of it."""


def build_today(
    site: Site, progress: Callable[[float], None], level: int = 0, variants: Mapping[str, str] = MappingProxyType({})
) -> Scene:
    """Return the ruins, the ground and what grows there.

    Args:
        site: Its facts.
        progress: Called with the share that is done.
        level: 0 is the finest, 1 the middle, 2 the first paint.
        variants: Of a monument's id, the one rival reconstruction to build; all of them where it is not named.

    Raises:
        SiteError: A monument lacks a figure, or is of a kind that nothing builds.
    """
    terrain = build_terrain(site)
    nodes = [Node("ground", terrain_meshes(terrain, _ground, _tint), LAND)]
    for monument in site.shown_in("today"):
        nodes += [] if monument.id == "square" else _ruin(monument, terrain, level)
    progress(0.5)
    nodes += _surroundings(site, terrain, level)
    progress(0.8)
    used = dict.fromkeys(name for node in nodes for name in node.materials)
    scene = Scene(nodes, {name: MATERIALS[name].paint() for name in used})
    progress(1.0)
    return scene


def _surroundings(site: Site, terrain: Terrain, level: int) -> list[Node]:
    planting = landscape.Planting(site, terrain, np.random.default_rng(1))
    paths = Shape()
    for way in site.ways:
        closed = np.array([*way, way[0]])
        part = landscape.path(terrain, np.random.default_rng(2), closed, PATH_WIDTH_M)
        paths.copies(part, np.zeros((1, 3)))
    nodes = [
        Node("mountains", landscape.mountains(planting).meshes(SITE), LAND | {"role": "backdrop"}),
        Node("paths", paths.meshes(SITE), LAND),
        Node("stacked_blocks", landscape.stacked(planting).meshes(SITE), LAND | {"role": "building"}),
        Node("stones", [], LAND, landscape.stones(planting, level)),
        Node("grass", [], LAND | {"role": "plant"}, landscape.grasses(planting, level)),
        Node("plants", [], LAND | {"role": "plant"}, landscape.planted(planting, level)),
    ]
    return [node for node in nodes if node.meshes or node.instances]


def _ruin(monument: Monument, terrain: Terrain, level: int) -> list[Node]:
    if monument.kind == PAVING:
        told = monument_facts(monument) | {"role": "ground", "monument": monument.id}
        return [Node(monument.id, [paving_mesh(terrain, monument, "paving", 0.8)], told)]
    if monument.kind == MODEL:
        return [brought_node(monument)]
    if monument.kind not in RUINS:
        raise SiteError(
            f"monument '{monument.id}' is of kind '{monument.kind}', which nothing builds; use one of {', '.join(RUINS)}."
        )
    building = Building(monument, level)
    building.face(0)
    RUINS[monument.kind](monument, building.element(), np.random.default_rng(crc32(monument.id.encode())))
    return building.nodes(terrain)


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
