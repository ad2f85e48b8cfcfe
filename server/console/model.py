"""The ancient square as few coarse meshes, each of one material and one level of evidence: what the console draws and tints."""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from assets.levels import group_of
from assets.records import Evidence, Site
from assets.roman import build_roman
from assets.scene import Node, expanded
from assets.shape import Mesh
from assets.textures import Texture

Layer = Literal["buildings", "land"]
_COARSEST: Final = 2
#: Its lights are strong: by them, marble is as white as paper.
_UNDER_VISERS_LIGHT: Final = 0.78
#: The page's colours (web/src/evidence.ts), sRGB.
EVIDENCE_COLOURS: Final[dict[Evidence, tuple[int, int, int]]] = {
    "attested": (0x00, 0x50, 0x9D),
    "inferred": (0xC8, 0x63, 0x9C),
    "hypothetical": (0xFF, 0xD7, 0x5E),
}


@dataclass(frozen=True, eq=False)
class Part:
    """One mesh, site frame."""

    name: str
    layer: Layer
    evidence: Evidence
    colour: tuple[int, int, int]
    """Of its material, sRGB."""
    positions_m: NDArray[np.float32]
    """(n, 3)"""
    triangles: NDArray[np.uint32]
    """(m, 3)"""


def build_parts(site: Site) -> list[Part]:
    """Return the square of a site, of rival reconstructions the first: some seconds of work, some megabytes."""
    scene = expanded(build_roman(site, lambda done: None, level=_COARSEST))
    found: dict[tuple[Layer, str, Evidence], list[Mesh]] = defaultdict(list)
    for node in _of_first_variants(scene.nodes):
        for mesh in node.meshes:
            found[_layer_of(node), mesh.material, node.extras.get("evidence", "hypothetical")].append(mesh)
    colours = {name: _mean_colour(texture) for name, texture in scene.textures.items()}
    return [
        Part(f"{layer}/{material}-{evidence}", layer, evidence, colours[material], *_joined(meshes))
        for (layer, material, evidence), meshes in found.items()
    ]


def _of_first_variants(nodes: Iterable[Node]) -> Iterator[Node]:
    first: dict[str, str] = {}
    for node in nodes:
        variant = node.extras.get("variant")
        if variant is None or first.setdefault(group_of(node.name, node.extras), variant) == variant:
            yield node


def _layer_of(node: Node) -> Layer:
    """Return whether it is built, or land and plants, which would hide the picture through the walker's eyes."""
    return "buildings" if node.extras.get("role") in ("building", None) else "land"


def _joined(meshes: list[Mesh]) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    starts = np.cumsum([0] + [len(mesh.positions_m) for mesh in meshes[:-1]])
    triangles = [mesh.triangles.astype(np.int64) + start for mesh, start in zip(meshes, starts, strict=True)]
    positions_m = np.concatenate([mesh.positions_m for mesh in meshes])
    return positions_m.astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def _mean_colour(texture: Texture) -> tuple[int, int, int]:
    mean = _UNDER_VISERS_LIGHT * texture.reshape(-1, texture.shape[-1])[:, :3].mean(axis=0)
    blue, green, red = (round(float(channel)) for channel in mean)
    return red, green, blue
