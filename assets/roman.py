"""The square in the second century AD: every monument by the builder of its kind, on its ground."""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from assets import roman_halls, roman_temples, roman_works
from assets.axes import Array
from assets.errors import SiteError
from assets.gltf import Node, Scene
from assets.ground import paving_mesh, terrain_meshes
from assets.materials import MATERIALS
from assets.monuments import monument_facts
from assets.shape import Place, Shape
from assets.site import Monument, Site
from assets.terrain import Terrain, build_terrain
from assets.textures import noise

Builder = Callable[[Monument, Shape], None]
BUILDERS: Mapping[str, Builder] = {
    "altar": roman_temples.altar,
    "arch": roman_works.vaulted,
    "basilica": roman_halls.basilica,
    "basin": roman_works.basin,
    "baths": roman_works.baths,
    "bouleuterion": roman_temples.bouleuterion,
    "chambers": roman_works.chambers,
    "court": roman_temples.court,
    "gate": roman_works.gate,
    "hall": roman_halls.hall,
    "nymphaeum": roman_works.nymphaeum,
    "platform_hall": roman_halls.platform_hall,
    "prytaneion": roman_temples.prytaneion,
    "socle": roman_works.socle,
    "steps": roman_works.stairs,
    "stoa": roman_halls.stoa,
    "temple": roman_temples.temple,
    "terrace": roman_works.terrace,
    "tower": roman_works.tower,
    "wall": roman_works.wall,
}
PAVING = "paving"
"""The kind that lies on the ground instead of standing on it."""


def build_roman(site: Site, progress: Callable[[float], None]) -> Scene:
    """Return the ancient square.

    Args:
        site: Its facts.
        progress: Called with the share that is done.

    Raises:
        SiteError: A monument lacks a figure, or is of a kind that nothing builds.
    """
    terrain = build_terrain(site)
    shown = site.shown_in("roman")
    nodes = [Node("ground", terrain_meshes(terrain, _ground, _tint), {"role": "ground"})]
    for i, monument in enumerate(shown):
        nodes.append(_node(monument, terrain))
        progress((i + 1) / len(shown) * 0.8)
    used = dict.fromkeys(mesh.material for node in nodes for mesh in node.meshes)
    scene = Scene(nodes, {name: MATERIALS[name].paint() for name in used})
    progress(1.0)
    return scene


def _node(monument: Monument, terrain: Terrain) -> Node:
    if monument.kind == PAVING:
        return Node(
            monument.id, [paving_mesh(terrain, monument, "paving")], monument_facts(monument) | {"role": "ground"}
        )
    if monument.kind not in BUILDERS:
        raise SiteError(
            f"monument '{monument.id}' is of kind '{monument.kind}', which nothing builds; use one of {', '.join(BUILDERS)}."
        )
    shape = Shape()
    BUILDERS[monument.kind](monument, shape)
    return Node(monument.id, shape.meshes(Place.of(monument)), monument_facts(monument) | {"role": "building"})


def _ground(points_m: Array) -> NDArray[np.str_]:
    """Trodden earth in the city, maquis on the hills."""
    return np.where(points_m[:, 2] > 12.0, "scrub", "earth")


def _tint(points_m: Array) -> Array:
    """Large patches, so that the texture's repeats do not show."""
    patches = noise(201, 256, 2, 20, 1.0)
    i, j = (np.floor(points_m[:, k] / 4.0).astype(int) % 256 for k in (0, 1))
    return np.repeat((0.86 + 0.09 * patches[i, j])[:, None], 3, axis=1)
