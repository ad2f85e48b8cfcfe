"""The square in the second century AD: every monument by the builder of its kind, on its ground."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from assets import landscape
from assets.axes import Array
from assets.brought_node import brought_node
from assets.building import Builder, Building
from assets.errors import SiteError
from assets.facts import monument_facts
from assets.ground import paving_mesh, terrain_meshes
from assets.materials import MATERIALS
from assets.monuments import basilica, baths, bouleuterion, court, fountain, hall, memmius, stoa, temple, terrace, works
from assets.records import MODEL, PAVING, Monument, Site
from assets.scene import Node, Scene
from assets.shape import Place
from assets.terrain import Terrain, build_terrain
from assets.textures import noise

BUILDERS: Mapping[str, Builder] = {
    "altar": temple.altar,
    "arch": fountain.arch_fountain,
    "basilica": basilica.basilica,
    "basin": works.basin,
    "baths": baths.baths,
    "bouleuterion": bouleuterion.bouleuterion,
    "chambers": works.chambers,
    "court": court.court,
    "gate": works.gate,
    "hall": hall.hall,
    "nymphaeum": fountain.nymphaeum,
    "platform_hall": hall.platform_hall,
    "prytaneion": court.prytaneion,
    "socle": works.socle,
    "steps": works.stairs,
    "stoa": stoa.stoa,
    "temple": temple.temple,
    "terrace": terrace.terrace,
    "tower": memmius.memmius,
    "wall": works.wall,
}
GROUND = {"role": "ground", "evidence": "hypothetical", "source": "design"}
"""What the ground between the monuments carries: its levels are design values."""


def build_roman(
    site: Site, progress: Callable[[float], None], level: int = 0, variants: Mapping[str, str] = MappingProxyType({})
) -> Scene:
    """Return the ancient square.

    Args:
        site: Its facts.
        progress: Called with the share that is done.
        level: 0 is the finest, 1 the middle, 2 the first paint.
        variants: Of a monument's id, the one rival reconstruction to build; all of them where it is not named.

    Raises:
        SiteError: A monument lacks a figure, is of a kind that nothing builds, or has no such variant.
    """
    terrain = build_terrain(site)
    shown = site.shown_in("roman")
    nodes = [Node("ground", terrain_meshes(terrain, _ground, _tint), GROUND)]
    for i, monument in enumerate(shown):
        nodes += _nodes(monument, terrain, level, variants.get(monument.id))
        progress((i + 1) / len(shown) * 0.8)
    planting = landscape.Planting(site, terrain, np.random.default_rng(3))
    nodes += [
        Node("mountains", landscape.mountains(planting).meshes(Place.at(0.0, 0.0, 0.0)), GROUND | {"role": "backdrop"}),
    ]
    if wood := landscape.wooded(planting, level):
        nodes.append(Node("plants", [], GROUND | {"role": "plant"}, wood))
    used = dict.fromkeys(name for node in nodes for name in node.materials)
    scene = Scene(nodes, {name: MATERIALS[name].paint() for name in used})
    progress(1.0)
    return scene


def _nodes(monument: Monument, terrain: Terrain, level: int, variant: str | None) -> list[Node]:
    if monument.kind == PAVING:
        told = monument_facts(monument) | {"role": "ground", "monument": monument.id}
        return [Node(monument.id, [paving_mesh(terrain, monument, "paving")], told)]
    if monument.kind == MODEL:
        return [brought_node(monument)]
    if monument.kind not in BUILDERS:
        raise SiteError(
            f"monument '{monument.id}' is of kind '{monument.kind}', which nothing builds; use one of {', '.join(BUILDERS)}."
        )
    building = Building(monument, level, chosen=variant)
    BUILDERS[monument.kind](building)
    return building.nodes(terrain)


def _ground(points_m: Array) -> NDArray[np.str_]:
    """Trodden earth in the city, maquis on the hills."""
    return np.where(points_m[:, 2] > 10.0, "scrub", "earth")


def _tint(points_m: Array) -> Array:
    """Large patches, so that the texture's repeats do not show."""
    patches = noise(201, 256, 2, 20, 1.0)
    i, j = (np.floor(points_m[:, k] / 4.0).astype(int) % 256 for k in (0, 1))
    return np.repeat((0.86 + 0.09 * patches[i, j])[:, None], 3, axis=1)
